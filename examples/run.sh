#!/bin/sh
# Weathers rocks and draws them, in about five minutes on two cores, once it is built:
#   out/frost.png       a rock weathered by frost: four states, coloured by link life
#   out/frost_plot.png  its volume and broken links over the paths
#   out/voxel.png       a hoodoo under the durability profile of examples/hoodoo.txt, from cube to sphere, a cavern
#   out/curvature.png   a cube, a hand and a bust that wear by their curvature, and a crack
#   out/hydraulic.png   water in a gorge, in a winding valley, over a bust and on a terrain
#   sh examples/run.sh                 the built-in outcrop
#   sh examples/run.sh FILE            your mesh (.obj .ply .stl) or elevation grid (.asc)
#   --up x|y|z     which axis of the model points up (default z)
#   --shards N     about how many shards (default 3000; 10000 for a grid)
#   --paths N      water paths (default 54 for each shard; 36 for a mesh, 14 for a grid)
#   --sites SPEC   where shards grow from (default: blocks between bedding and two joint sets)
#   --core SPEC    cells that never fall (default: the lowest 12 %; sides and base of a grid)
#   --small        few shards and small pictures, for a quick look; so does TAFONI_SMALL=1
#   --only NAME    frost, voxel, curvature or hydraulic
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
only=""
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
        --only) shift; only=$1 ;;
        -h | --help) sed -n '2,20s/^# \{0,1\}//p' "$0"; exit 0 ;;
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
    nlohmann-json3-dev libpng-dev f3d xvfb xauth imagemagick fonts-dejavu-core gnuplot-nox || exit 1

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

# One camera for all states of a rock, so that what is gone is seen to be gone; as close as the files allow.
camera_of() { # view up FILE.obj...
    look=$1
    upwards=$2
    shift 2
    grep -h '^v ' "$@" | awk -v view="$look" -v up="$upwards" '
    $1 == "v" {
        for (a = 1; a <= 3; ++a) { x = p[n + 0, a] = $(a + 1); if (!n || x < lo[a]) lo[a] = x; if (!n || x > hi[a]) hi[a] = x }
        ++n
    }
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
    }'
}

# Colours at equal distances, as f3d wants them.
colormap() { # colours
    i=0
    for c in "$@"; do
        hex=${c#?}
        awk -v at=$i -v last=$(($# - 1)) -v r=$((0x${hex%????})) -v g=$((0x$(echo "$hex" | cut -c3-4))) -v b=$((0x${hex#????})) \
            'BEGIN { printf "%s%.4f,%.3f,%.3f,%.3f", (at ? "," : ""), at / last, r / 255, g / 255, b / 255 }'
        i=$((i + 1))
    done
}

# Draws FILE.vtp at twice the size that is kept, so that edges are smooth; CAMERA is that of camera_of.
draw() { # FILE.vtp FILE.png camera up scalars range colours more...
    from=$1
    to=$2
    at=$3
    upwards=$4
    numbers=$5
    range=$6
    colours=$7
    shift 7
    # shellcheck disable=SC2086
    xvfb-run -a f3d "$from" --output "$to" $at --camera-view-up="$(echo "$upwards" | tr ' ' ,)" --camera-view-angle=28 \
        --resolution $((2 * panel)),$((2 * panel)) --ssao --fxaa --scalars="$numbers" --range "$range" --colormap "$colours" \
        --bg-color 1,1,1 --roughness 0.9 --quiet "$@"
}

# Cut to a box, brightened (the headless renderer lights dimly), with a label below.
finish() { # FILE.png box label
    convert "$1" -crop "$2" +repage -fuzz 2% -transparent white -channel RGB -level 3%,68% -gamma 1.15 +channel \
        -background white -flatten -resize 50% -bordercolor white -border $((panel / 40)) \
        -gravity south -splice 0x$((7 * letters / 2)) -font DejaVu-Sans -pointsize $letters -fill '#333333' \
        -annotate +0+$((letters / 3)) "$3" "$1"
}

# A strip of colours between two words.
legend() { # FILE.png left right colours...
    to=$1
    left=$2
    right=$3
    shift 3
    # shellcheck disable=SC2046
    convert $(for c in "$@"; do echo "xc:$c"; done) +append -filter triangle -resize 16x1! \
        -scale $((panel / 16 * 20))x$((letters * 2 / 3))! -bordercolor white -border $((letters / 2))x0 "$to"
    convert -font DejaVu-Sans -pointsize $((letters * 4 / 5)) -fill '#333333' -background white -gravity center \
        label:"$left" "$to" label:"$right" +append "$to"
}

letters=$((panel / 17))
case $only in
    "" | frost | voxel | curvature | hydraulic) ;;
    *) echo "examples/run.sh: --only $only: frost, voxel, curvature or hydraulic" >&2; exit 2 ;;
esac
for subject in ${only:-frost voxel curvature hydraulic}; do . "$root/examples/pictures/$subject.sh"; done
