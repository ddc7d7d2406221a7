# Frost: four states of a rock and two curves. Sourced by examples/run.sh.
# shellcheck shell=sh disable=SC2154

# By the axis that is up: down, the rain (slanting on to the front), the normal of the beds (that of the built-in
# rock), and the camera, which looks at the front from above.
case $up in
    x) down=-1,0,0; rain=-0.9,0.2,0.8; beds=1,-0.13,-0.05; view="0.3 0.45 -1"; view_up="1 0 0" ;;
    y) down=0,-1,0; rain=0.2,-0.9,-0.8; beds=-0.13,1,-0.05; view="0.45 0.3 1"; view_up="0 1 0" ;;
    z) down=0,0,-1; rain=0.2,0.8,-0.9; beds=-0.13,0.05,1; view="0.45 -1 0.3"; view_up="0 0 1" ;;
    *) echo "examples/run.sh: --up $up: x, y or z" >&2; exit 2 ;;
esac
[ -n "$sites" ] || sites=joints:up=$beds,turn=-14,variation=0.8,left_out=0.35
case $input in
    *.asc | *.ASC) view="0.45 -1 0.75" ;;
    *) [ -n "$core" ] || core=bottom:share=0.12 ;;
esac

results=$out/frost
echo "weathering $input with about $shards shards and $paths paths in $results"
# shellcheck disable=SC2086
"$weather" frost "$input" -o "$results" --shards "$shards" --sites "$sites" --jitter 0.2 --gravity=$down --rain=$rain \
    --spread 40 --paths "$paths" --snapshots "$every" --resistance "layers:values=0.15,0.95,0.7,up=$beds" \
    --roughness 0.06 --format vtp,obj --threads 0 ${core:+--core "$core"}

camera=$(camera_of "$view" "$view_up" "$results"/snapshots/frost_00000000.obj)

# From worn through to intact: rust, ochre, warm grey.
ramp="#71341d #bb7340 #d6ab70 #cdbda2 #b9b3aa"
# shellcheck disable=SC2086
map=$(colormap $ramp)

state=0
pictures=""
while [ $state -le "$paths" ]; do
    name=frost_$(printf '%08d' $state)
    picture=$results/snapshots/$name.png
    echo "drawing the state after $state paths"
    draw "$results/snapshots/$name.vtp" "$picture" "$camera" "$view_up" hold 0,1 "$map" --cells --up "+$(echo "$up" | tr xyz XYZ)"
    pictures="$pictures $picture"
    state=$((state + every))
done

# Cut to the first state; a label with the share that is left.
box=$(convert "$results/snapshots/frost_00000000.png" -fuzz 3% -trim -format '%wx%h%O' info:)
state=0
for picture in $pictures; do
    left=$(awk -F, -v n=$state 'NR == 2 { first = $4 } $1 + 0 <= n && NR > 1 { now = $4 } END { printf "%.0f", 100 * now / first }' \
        "$results/history.csv")
    finish "$picture" "$box" "$(printf '%s paths\n%s %%%% left' "$state" "$left")"
    state=$((state + every))
done
# shellcheck disable=SC2086
convert $pictures +append "$out/frost.png"
# shellcheck disable=SC2086
legend "$results/bar.png" "links: worn through" intact $ramp
convert "$results/bar.png" -background white -gravity center -extent "$(identify -format %w "$out/frost.png")x$((letters * 2))" "$results/bar.png"
convert \( "$out/frost.png" -dither None -colors 200 \) \( "$results/bar.png" -dither None -colors 50 \) -append -strip \
    "png8:$out/frost.png"
rm -f "$results/bar.png"

gnuplot << PLOT
set terminal pngcairo size 900,520 background '#ffffff'
set output '$out/frost_plot.png'
set datafile separator ','
set key outside top center horizontal
set xlabel 'water paths'
set ylabel 'volume that stands (share of the start)'
set y2label 'broken links'
set ytics nomirror
set y2tics
set grid
set yrange [0:1.02]
first = 0
plot '$results/history.csv' using 1:(first = (first == 0 ? \$4 : first), \$4 / first) skip 1 with lines lw 2.5 lc rgb '#8a4b2a' title 'volume', \
     '' using 1:2 skip 1 axes x1y2 with lines lw 2.5 lc rgb '#3a6ea5' title 'broken links'
PLOT
echo "$out/frost.png $out/frost_plot.png $results/report.json"
