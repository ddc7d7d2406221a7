# What the pictures of the processes on meshes share. Sourced by curvature.sh and hydraulic.sh.
# shellcheck shell=sh disable=SC2154

# Hollow, flat, ridge, as the source colours them.
bent="#1f3fbf #3f8fbf #57b357 #d9a23a #c92a17"
# shellcheck disable=SC2086
bent_map=$(colormap $bent)
# Dry, wet.
wet="#cdbda2 #8fb3c9 #2f6fb0 #123a7a"
# shellcheck disable=SC2086
wet_map=$(colormap $wet)

# The longest side of the box.
side_of() { # FILE.obj
    awk '$1 == "v" { for (a = 2; a <= 4; ++a) { if (!n || $a < lo[a]) lo[a] = $a; if (!n || $a > hi[a]) hi[a] = $a }; n = 1 }
        END { for (a = 2; a <= 4; ++a) if (hi[a] - lo[a] > s) s = hi[a] - lo[a]; print s }' "$1"
}
# Numbers in units of 1 / side.
over_side() { # FILE.obj number
    awk -v s="$(side_of "$1")" -v n="$2" 'BEGIN { printf "%.6g,%.6g", -n / s, n / s }'
}
# The box that holds what is seen in these pictures.
seen_in() { # FILE.png...
    for file in "$@"; do convert "$file" -fuzz 3% -trim -format '%w %h %X %Y\n' info:; done | awk '{
        if (NR == 1 || $3 < left) left = $3
        if (NR == 1 || $4 < top) top = $4
        if ($1 + $3 > right) right = $1 + $3
        if ($2 + $4 > low) low = $2 + $4
    } END { printf "%dx%d+%d+%d", right - left, low - top, left, top }'
}
# One .vtp with an .obj of the same name beside it, by its curvature or its flow.
shoot() { # FILE.vtp FILE.png camera up numbers range
    case $5 in
        curvature) draw "$1" "$2" "$3" "$4" curvature "$6" "$bent_map" --up "$facing" ;;
        *) draw "$1" "$2" "$3" "$4" "$5" "$6" "$wet_map" --up "$facing" ;;
    esac
}
# Cut to a box, brightened, with one line below.
caption() { # FILE.png box text
    convert "$1" -crop "$2" +repage -fuzz 2% -transparent white -channel RGB -level 3%,68% -gamma 1.15 +channel \
        -background white -flatten -resize 50% -bordercolor white -border $((panel / 30)) \
        -gravity south -splice 0x$((letters * 3 / 2)) -font DejaVu-Sans -pointsize $letters -fill '#333333' \
        -annotate +0+$((letters / 3)) "$3" "$1"
}
# Rows of pictures one below the other, and strips of colours below them.
stack() { # FILE.png parts...
    to=$1
    shift
    width=$(identify -format '%w\n' "$@" | sort -n | tail -1)
    for part in "$@"; do convert "$part" -background white -gravity center -extent "${width}x$(identify -format %h "$part")" "$part"; done
    convert "$@" -append -strip -dither None -colors 200 "png8:$to"
}
