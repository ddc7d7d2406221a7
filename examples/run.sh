#!/bin/sh
# Weathers a rock by frost and draws it: out/frost.png (four states, coloured by link life) and
# out/frost_plot.png (volume and broken links over the paths).
#   sh examples/run.sh                 the built-in outcrop
#   sh examples/run.sh FILE            your mesh (.obj .ply .stl) or elevation grid (.asc)
#   --up x|y|z     which axis of the model points up (default z)
#   --shards N     about how many shards (default 3000; 10000 for a grid)
#   --paths N      water paths (default 20 for each shard; 6 for a grid)
#   --sites SPEC   where shards grow from (default: tilted slabs, shaken)
#   --small        few shards and small pictures, for a quick look; so does TAFONI_SMALL=1
#   --out DIR      where to write (default out)      --build DIR    where to build (default build/examples)
#   --no-install   never call apt-get                --jobs N       parallel jobs (default: all cores)
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
input=""
up=z
shards=""
paths=""
sites=""
width=760
height=640
small=no
[ -z "${TAFONI_SMALL:-}" ] || { small=yes; width=240; height=200; }
install=yes
jobs=$(nproc)
out=out
build=$root/build/examples
while [ $# -gt 0 ]; do
    case $1 in
        --up) shift; up=$1 ;;
        --shards) shift; shards=$1 ;;
        --paths) shift; paths=$1 ;;
        --sites) shift; sites=$1 ;;
        --small) small=yes; width=240; height=200 ;;
        --out) shift; out=$1 ;;
        --build) shift; build=$1 ;;
        --no-install) install=no ;;
        --jobs) shift; jobs=$1 ;;
        -h | --help) sed -n '2,13s/^# \{0,1\}//p' "$0"; exit 0 ;;
        -*) echo "examples/run.sh: unknown option $1" >&2; exit 2 ;;
        *) input=$1 ;;
    esac
    shift
done
[ -n "$input" ] || input=builtin:outcrop:seed=2,resolution=$([ $small = yes ] && echo 24 || echo 64)
each=20
many=3000
case $input in *.asc | *.ASC) each=6; many=10000 ;; esac
[ $small = no ] || many=400
[ -n "$shards" ] || shards=$many
[ -n "$paths" ] || paths=$((each * shards))
every=$(((paths + 2) / 3))
paths=$((3 * every))

. "$root/cmake/packages.sh"
need_packages "$install" g++ cmake ninja-build libeigen3-dev librange-v3-dev libboost-graph-dev libcli11-dev \
    nlohmann-json3-dev f3d xvfb xauth imagemagick fonts-dejavu-core gnuplot-nox || exit 1

mkdir -p "$build"
log=$build/weather.log
echo "building weather (Release) in $build"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTAFONI_BUILD_TESTS=OFF \
    -DTAFONI_BUILD_BENCHMARKS=OFF -DTAFONI_BUILD_EXAMPLES=ON > "$log" 2>&1 || { cat "$log" >&2; exit 1; }
cmake --build "$build" --target weather -j "$jobs" >> "$log" 2>&1 || { tail -40 "$log" >&2; exit 1; }
weather=$build/examples/weather/weather

# Down, the rain (slanting on to the front), the camera (looking at the front from above), by the axis that is up.
case $up in
    x) down=-1,0,0; rain=-0.9,0.2,0.8; tilt=1,0.25,0.1; view="0.45 0.35 -1"; view_up=1,0,0 ;;
    y) down=0,-1,0; rain=0.2,-0.9,-0.8; tilt=0.25,1,0.1; view="0.35 0.45 1"; view_up=0,1,0 ;;
    z) down=0,0,-1; rain=0.2,0.8,-0.9; tilt=0.25,0.1,1; view="0.35 -1 0.45"; view_up=0,0,1 ;;
    *) echo "examples/run.sh: --up $up: x, y or z" >&2; exit 2 ;;
esac
[ -n "$sites" ] || sites=slabs:up=$tilt
core="--core bottom:share=0.12"
distance=1.45
case $input in
    *.asc | *.ASC) core=""; view="0.35 -1 0.8"; distance=1.75 ;;
esac

mkdir -p "$out"
results=$out/frost
rm -rf "$results"
# shellcheck disable=SC2086
"$weather" frost "$input" -o "$results" --shards "$shards" --sites "$sites" --jitter 0.4 --gravity=$down --rain=$rain \
    --spread 40 --paths "$paths" --snapshots "$every" --resistance layers:values=0.3,0.85 --format vtp,obj --threads 0 $core

# One camera for all states, so that what is gone is seen to be gone.
camera=$(awk -v view="$view" -v distance=$distance -v up=$(echo $up | tr xyz 123) '
    $1 == "v" { for (a = 1; a <= 3; ++a) { x = $(a + 1); if (!n || x < lo[a]) lo[a] = x; if (!n || x > hi[a]) hi[a] = x } n = 1 }
    END {
        split(view, d, " ")
        for (a = 1; a <= 3; ++a) { s += (hi[a] - lo[a]) ^ 2; l += d[a] ^ 2 }
        away = distance * sqrt(s)
        tall = 2.2 * (hi[up] - lo[up]) + 0.3 * sqrt(s)
        if (tall > away) away = tall
        for (a = 1; a <= 3; ++a) { f[a] = (lo[a] + hi[a]) / 2; p[a] = f[a] + away * d[a] / sqrt(l) }
        printf "--camera-position=%.9g,%.9g,%.9g --camera-focal-point=%.9g,%.9g,%.9g", p[1], p[2], p[3], f[1], f[2], f[3]
    }' "$results"/snapshots/frost_00000000.obj)

pictures=""
state=0
while [ $state -le "$paths" ]; do
    name=frost_$(printf '%08d' $state)
    picture=$results/snapshots/$name.png
    # shellcheck disable=SC2086
    xvfb-run -a f3d "$results/snapshots/$name.vtp" --output "$picture" $camera --camera-view-up=$view_up \
        --camera-view-angle=30 --resolution $width,$height --ssao --fxaa --cells --scalars=life --range 0,1 \
        --colormap 0,0.85,0.35,0.2,0.4,0.95,0.65,0.4,0.75,0.95,0.88,0.72,1,0.9,0.9,0.88 --bg-color 1,1,1 \
        --roughness 0.7 --up "+$(echo $up | tr xyz XYZ)" --quiet
    # The headless renderer lights dimly: its brightest rock is about half as bright as the paper.
    convert "$picture" -fuzz 2% -transparent white -channel RGB -level 4%,62% +channel -background white -flatten \
        -gravity south -font DejaVu-Sans -pointsize $((height / 24)) -fill '#333333' -annotate +0+8 "$state paths" "$picture"
    pictures="$pictures $picture"
    state=$((state + every))
done
# shellcheck disable=SC2086
montage $pictures -tile 4x1 -geometry +0+0 "$out/frost.png"

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
