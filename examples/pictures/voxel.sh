# Voxels: a hoodoo under its durability profile (as Figures 7 and 15 of the paper), tafoni in a cliff, from cube to
# sphere (Figure 9), an inside corner to a cavern (Figure 10). Sourced by examples/run.sh.
# shellcheck shell=sh disable=SC2154

results=$out/voxel
part=1
[ $small = no ] || part=2

# Weathers one shape and draws its snapshots from one camera, cut to the first.
scene() { # name steps snapshots view scalars range colours options...
    name=$1
    steps=$2
    each=$3
    from_where=$4
    numbers=$5
    span=$6
    colours=$7
    shift 7
    echo "weathering a $name for $steps steps in $results/$name"
    "$weather" voxel -o "$results/$name" --steps "$steps" --snapshots "$each" --format vtp,obj --threads 0 "$@"
    shots=$results/$name/snapshots
    view_of_all=$(camera_of "$from_where" "0 0 1" "$shots/voxel_00000000.obj" "$shots/voxel_$(printf '%08d' "$steps").obj")
    state=0
    while [ $state -le "$steps" ]; do
        shot=$shots/voxel_$(printf '%08d' $state)
        draw "$shot.vtp" "$shot.png" "$view_of_all" "0 0 1" "$numbers" "$span" "$colours" --up +Z
        state=$((state + each))
    done
}
# Labels the snapshot after so many steps and adds it to the row.
add() { # name steps label
    shot=$results/$1/snapshots/voxel_$(printf '%08d' "$2").png
    finish "$shot" "$box" "$3"
    row="$row $shot"
}
# The box that holds what is seen in all these states.
box_of() { # name steps...
    shape=$1
    shift
    for state in "$@"; do
        convert "$results/$shape/snapshots/voxel_$(printf '%08d' "$state").png" -fuzz 3% -trim -format '%w %h %X %Y\n' info:
    done | awk '{
        if (NR == 1 || $3 < left) left = $3
        if (NR == 1 || $4 < top) top = $4
        if ($1 + $3 > right) right = $1 + $3
        if ($2 + $4 > low) low = $2 + $4
    } END { printf "%dx%d+%d+%d", right - left, low - top, left, top }'
}

# Colluvium (-1), then from soft to hard.
beds="#e0cfa6 #d6a56a #a5562f #6b2f1c"
# shellcheck disable=SC2086
bed_map="0,0.45,0.40,0.55,0.499,0.45,0.40,0.55,$(colormap $beds | awk -F, '{ for (i = 1; i <= NF; i += 4) printf "%s%.4f,%s,%s,%s", (i > 1 ? "," : ""), 0.5 + $i / 2, $(i + 1), $(i + 2), $(i + 3) }')"
# Hollow, flat, edge.
bends="#1f4e9c #7f9db5 #c9bfa5 #cf8a4a #a83218"
# shellcheck disable=SC2086
bend_map=$(colormap $bends)

age=$((36 / part))
scene hoodoo $((3 * age)) $age "0.5 -1 0.22" tint -1,1 "$bed_map" builtin:hoodoo:bulge=0.06,radius=0.24,plinth=0 \
    --resolution $((192 / part)) --margin $((30 / part)) --radius $((6 / part)) --colluvium --repose 35 --baseline 4 --rockfall \
    --durability "$root/examples/hoodoo.txt"
row=""
box=$(box_of hoodoo 0 $age $((2 * age)) $((3 * age)))
for state in 0 $age $((2 * age)) $((3 * age)); do add hoodoo $state "$state steps"; done

deep=$((60 / part))
scene cliff $deep $deep "0.3 -1 0.25" tint -1,1 "$bed_map" builtin:cliff --resolution $((224 / part)) --rockfall \
    --radius $((7 / part)) --measure excess --schedule 3c,1s --noise noise:amplitude=0.003,wavelength=0.1 \
    --durability profile:at=0,0.2,0.3,0.45,0.55,0.75,0.8,1,values=0.02,0.02,0.004,0.005,0.014,0.012,0.005,0.03,amplitude=0.003,frequency=6
box=$(box_of cliff $deep)
add cliff $deep "tafoni in a cliff"
# shellcheck disable=SC2086
convert $row -background white -gravity south +append "$results/hoodoo.png"

round=$((75 / part))
scene cube $((2 * round)) $round "0.5 -1 0.45" curvature -0.7,0.7 "$bend_map" builtin:cube --border open \
    --resolution $((56 / part)) --radius $((16 / part)) --measure excess --durability constant:value=0.004 --smooth $((6 / part))
dig=$((60 / part))
scene corner $((2 * dig)) $dig "0.8 -1 0.35" curvature -0.7,0.7 "$bend_map" builtin:corner:wall=0.5,height=0.9 \
    --resolution $((128 / part)) --radius $((14 / part)) --measure excess --schedule 3c,2s --rockfall \
    --durability profile:at=0,0.2,0.28,0.62,0.70,1,values=0.08,0.08,0.002,0.002,0.08,0.08
row=""
box=$(box_of cube 0)
add cube 0 "a cube"
add cube $((2 * round)) "a sphere after $((2 * round)) steps"
box=$(box_of corner 0)
add corner 0 "an inside corner"
add corner $((2 * dig)) "a cavern after $((2 * dig)) steps"
# shellcheck disable=SC2086
convert $row -background white -gravity south +append "$results/shapes.png"

# shellcheck disable=SC2086
legend "$results/beds.png" "durability: soft" "hard   lilac: colluvium" $beds
# shellcheck disable=SC2086
legend "$results/bends.png" "curvature: hollow" edge $bends
width=$(identify -format '%w\n' "$results/hoodoo.png" "$results/shapes.png" | sort -n | tail -1)
set --
for part in hoodoo beds shapes bends; do
    case $part in
        beds | bends) tall=$((letters * 2)) ;;
        *) tall=$(identify -format %h "$results/$part.png") ;;
    esac
    convert "$results/$part.png" -background white -gravity center -extent "${width}x$tall" "$results/$part.png"
    set -- "$@" "$results/$part.png"
done
convert "$@" -append -strip -dither None -colors 250 "png8:$out/voxel.png"
rm -f "$@"
echo "$out/voxel.png"
