#!/bin/sh
# Weathers a rock by frost and draws it: out/frost.png (four states, coloured by link life) and
# out/frost_plot.png (volume and broken links over the paths). About a minute on two cores, once it is built.
#   sh examples/run.sh                 the built-in outcrop
#   sh examples/run.sh FILE            your mesh (.obj .ply .stl) or elevation grid (.asc)
#   --up x|y|z     which axis of the model points up (default z)
#   --shards N     about how many shards (default 3000; 10000 for a grid)
#   --paths N      water paths (default 54 for each shard; 36 for a mesh, 14 for a grid)
#   --sites SPEC   where shards grow from (default: blocks between bedding and two joint sets)
#   --core SPEC    cells that never fall (default: the lowest 12 %; sides and base of a grid)
#   --small        few shards and small pictures, for a quick look; so does TAFONI_SMALL=1
#   --out DIR      where to write (default out)      --build DIR    where to build (default build/examples)
#   --no-install   never call apt-get                --jobs N       parallel jobs (default: all cores)
#   --weather FILE a tool that is built already
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
input=""
up=z
shards=""
paths=""
sites=""
core=""
small=no
[ -z "${TAFONI_SMALL:-}" ] || small=yes
install=yes
weather=""
jobs=$(nproc)
out=out
build=$root/build/examples
while [ $# -gt 0 ]; do
    case $1 in
        --up) shift; up=$1 ;;
        --shards) shift; shards=$1 ;;
        --paths) shift; paths=$1 ;;
        --sites) shift; sites=$1 ;;
        --core) shift; core=$1 ;;
        --small) small=yes ;;
        --out) shift; out=$1 ;;
        --build) shift; build=$1 ;;
        --no-install) install=no ;;
        --jobs) shift; jobs=$1 ;;
        --weather) shift; weather=$1 ;;
        -h | --help) sed -n '2,15s/^# \{0,1\}//p' "$0"; exit 0 ;;
        -*) echo "examples/run.sh: unknown option $1" >&2; exit 2 ;;
        *) input=$1 ;;
    esac
    shift
done
[ -n "$input" ] || input=builtin:outcrop:seed=2,resolution=$([ $small = yes ] && echo 24 || echo 64)
each=36
many=3000
case $input in
    builtin:*) each=54 ;;
    *.asc | *.ASC) each=14; many=10000 ;;
esac
panel=460
[ $small = no ] || { many=400; panel=160; }
[ -n "$shards" ] || shards=$many
[ -n "$paths" ] || paths=$((each * shards))
every=$(((paths + 2) / 3))
paths=$((3 * every))

. "$root/cmake/packages.sh"
need_packages "$install" g++ cmake ninja-build libeigen3-dev librange-v3-dev libboost-graph-dev libcli11-dev \
    nlohmann-json3-dev f3d xvfb xauth imagemagick fonts-dejavu-core gnuplot-nox || exit 1

mkdir -p "$out"
if [ -z "$weather" ]; then
    mkdir -p "$build"
    log=$build/weather.log
    echo "building weather (Release) in $build"
    cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTAFONI_BUILD_TESTS=OFF \
        -DTAFONI_BUILD_BENCHMARKS=OFF -DTAFONI_BUILD_EXAMPLES=ON > "$log" 2>&1 || { cat "$log" >&2; exit 1; }
    cmake --build "$build" --target weather -j "$jobs" >> "$log" 2>&1 || { tail -40 "$log" >&2; exit 1; }
    weather=$build/examples/weather/weather
fi

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

# One camera for all states, so that what is gone is seen to be gone; as close as the first state allows.
camera=$(awk -v view="$view" -v up="$view_up" '
    $1 == "v" {
        for (a = 1; a <= 3; ++a) { x = p[n + 0, a] = $(a + 1); if (!n || x < lo[a]) lo[a] = x; if (!n || x > hi[a]) hi[a] = x }
        ++n
    }
    $1 == "f" { exit }
    END {
        split(view, d, " "); split(up, u, " ")
        l = sqrt(d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2)
        for (a = 1; a <= 3; ++a) { d[a] /= l; s += d[a] * u[a]; f[a] = (lo[a] + hi[a]) / 2 }
        l = sqrt(1 - s * s)
        for (a = 1; a <= 3; ++a) u[a] = (u[a] - s * d[a]) / l
        r[1] = u[2] * d[3] - u[3] * d[2]; r[2] = u[3] * d[1] - u[1] * d[3]; r[3] = u[1] * d[2] - u[2] * d[1]
        for (k = 0; k < n; ++k) {
            x = y = z = 0
            for (a = 1; a <= 3; ++a) { q = p[k, a] - f[a]; x += q * r[a]; y += q * u[a]; z += q * d[a] }
            if (x < 0) x = -x
            if (y < 0) y = -y
            if (x < y) x = y
            need = z + 1.03 * x / 0.249328  # tan 14 degrees
            if (need > away) away = need
        }
        printf "--camera-position=%.9g,%.9g,%.9g --camera-focal-point=%.9g,%.9g,%.9g", f[1] + away * d[1], f[2] + away * d[2],
            f[3] + away * d[3], f[1], f[2], f[3]
    }' "$results"/snapshots/frost_00000000.obj)

# From worn through to intact: rust, ochre, warm grey.
ramp="#71341d #bb7340 #d6ab70 #cdbda2 #b9b3aa"
map=$(i=0; for c in $ramp; do
    hex=${c#?}
    for v in $((0x${hex%????})) $((0x$(echo "$hex" | cut -c3-4))) $((0x${hex#????})); do
        [ -n "${triple:-}" ] || { triple=1; printf '%s%s' "${comma:-}" "$(awk "BEGIN { print $i / 4 }")"; comma=,; }
        printf ',%s' "$(awk "BEGIN { printf \"%.3f\", $v / 255 }")"
    done
    triple=""
    i=$((i + 1))
done)

state=0
pictures=""
while [ $state -le "$paths" ]; do
    name=frost_$(printf '%08d' $state)
    picture=$results/snapshots/$name.png
    echo "drawing the state after $state paths"
    # shellcheck disable=SC2086
    xvfb-run -a f3d "$results/snapshots/$name.vtp" --output "$picture" $camera --camera-view-up="$(echo $view_up | tr ' ' ,)" \
        --camera-view-angle=28 --resolution $((2 * panel)),$((2 * panel)) --ssao --fxaa --cells --scalars=hold --range 0,1 \
        --colormap "$map" --bg-color 1,1,1 --roughness 0.9 --up "+$(echo $up | tr xyz XYZ)" --quiet
    pictures="$pictures $picture"
    state=$((state + every))
done

# Cut to the first state (drawn at twice the size, so that edges are smooth), brightened: the headless renderer lights
# dimly; a label with the share that is left.
box=$(convert "$results/snapshots/frost_00000000.png" -fuzz 3% -trim -format '%wx%h%O' info:)
letters=$((panel / 17))
state=0
for picture in $pictures; do
    left=$(awk -F, -v n=$state 'NR == 2 { first = $4 } $1 + 0 <= n && NR > 1 { now = $4 } END { printf "%.0f", 100 * now / first }' \
        "$results/history.csv")
    label=$(printf '%s paths\n%s %%%% left' "$state" "$left")
    convert "$picture" -crop "$box" +repage -fuzz 2% -transparent white -channel RGB -level 3%,68% -gamma 1.15 +channel \
        -background white -flatten -resize 50% -bordercolor white -border $((panel / 40)) \
        -gravity south -splice 0x$((7 * letters / 2)) -font DejaVu-Sans -pointsize $letters -fill '#333333' \
        -annotate +0+$((letters / 3)) "$label" "$picture"
    state=$((state + every))
done
# shellcheck disable=SC2086
convert $pictures +append "$out/frost.png"
# shellcheck disable=SC2086
convert $(for c in $ramp; do echo "xc:$c"; done) +append -filter triangle -resize 16x1! \
    -scale $((panel / 16 * 20))x$((letters * 2 / 3))! -bordercolor white -border $((letters / 2))x0 "$results/bar.png"
convert -font DejaVu-Sans -pointsize $((letters * 4 / 5)) -fill '#333333' -background white -gravity center \
    label:"links: worn through" "$results/bar.png" label:"intact" +append \
    -extent "$(identify -format %w "$out/frost.png")x$((letters * 2))" "$results/bar.png"
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
