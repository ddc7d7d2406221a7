# Curvature: a cube to a sphere (Figure 9.5 of the source), a hand whose fingers last (Figure 9.8), a bust, and a crack
# carved into it. Sourced by examples/run.sh.
# shellcheck shell=sh disable=SC2154
. "$root/examples/pictures/meshes.sh"

results=$out/curvature
full=$panel
panel=$((panel * 13 / 20))
letters=$((panel / 14))

# Three states of one shape from one camera, cut to the first.
wear_shape() { # name view up range options...
    name=$1
    look=$2
    upwards=$3
    most=$4
    shift 4
    echo "weathering $1 for $last iterations in $results/$name"
    "$weather" curvature -o "$results/$name" --iterations "$last" --snapshots "$middle" --format vtp,obj --threads 0 "$@"
    shots=$results/$name/snapshots
    range=$(over_side "$shots/curvature_00000000.obj" "$most")
    where=$(camera_of "$look" "$upwards" "$shots/curvature_00000000.obj")
    for n in 0 "$middle" "$last"; do
        shot=$shots/curvature_$(printf '%08d' "$n")
        shoot "$shot.vtp" "$shot.png" "$where" "$upwards" curvature "$range"
    done
    box=$(seen_in "$shots/curvature_00000000.png")
    for n in 0 "$middle" "$last"; do
        shot=$shots/curvature_$(printf '%08d' "$n").png
        caption "$shot" "$box" "$n iterations"
        row="$row $shot"
    done
}

middle=50
last=200
coarse=1
[ $small = no ] || coarse=3
row=""
facing=+Z
wear_shape cube "0.5 -1 0.45" "0 0 1" 6 builtin:cube
wear_shape hand "0.25 -1 0.15" "0 0 1" 60 builtin:hand:resolution=$((110 / coarse)) --power 2 --step 4
# shellcheck disable=SC2086
convert $row -background white -gravity south +append "$results/first.png"

row=""
panel=$((panel * 7 / 5))
model=builtin:bust:resolution=$((130 / coarse))
look="0.5 -1 0.2"
upwards="0 0 1"
crack="0.05,-0.12,0.92,0.01,-0.16,0.86,0.06,-0.17,0.82,0.035,-0.2,0.75,0.1,-0.15,0.7,0.06,-0.14,0.63,0.1,-0.07,0.56,0.04,-0.06,0.47,0.12,-0.09,0.38,0.06,-0.12,0.29"
case $input in
    builtin:* | *.asc | *.ASC) ;;
    *)
        model=$input
        crack=front
        facing=+$(echo "$up" | tr xyz XYZ)
        case $up in
            x) look="0.2 0.5 -1"; upwards="1 0 0" ;;
            y) look="0.5 0.2 1"; upwards="0 1 0" ;;
        esac
        ;;
esac
wear_shape bust "$look" "$upwards" 40 "$model"
# Down the front of the box of a model that is not ours; the tool takes the nearest vertices.
if [ "$crack" = front ]; then
    crack=$(awk -v up="$up" '
        $1 == "v" { for (a = 1; a <= 3; ++a) { x = $(a + 1); if (!n || x < lo[a]) lo[a] = x; if (!n || x > hi[a]) hi[a] = x }; n = 1 }
        END {
            u = index("xyz", up)
            side = up == "x" ? 2 : 1
            front = 6 - u - side
            ahead = up == "y" ? hi[front] : lo[front]
            split("0 0.09 -0.03 0.1 0.02 0.13 0.04 0.11 -0.02", off, " ")
            for (k = 1; k <= 9; ++k) {
                p[u] = hi[u] - (0.02 + 0.08 * k) * (hi[u] - lo[u])
                p[side] = (lo[side] + hi[side]) / 2 + off[k] * (hi[side] - lo[side])
                p[front] = ahead
                printf "%s%.9g,%.9g,%.9g", (k > 1 ? "," : ""), p[1], p[2], p[3]
            }
        }' "$results/bust/snapshots/curvature_00000000.obj")
fi
if [ -n "$crack" ]; then
    "$weather" wrinkles "$results/bust/snapshots/curvature_$(printf '%08d' $middle).obj" -o "$results/crack" --profile groove \
        --radius "$(awk -v s="$(side_of "$results/bust/snapshots/curvature_00000000.obj")" 'BEGIN { print 0.023 * s }')" --times 4 --through "$crack" --format vtp,obj --threads 0
    shoot "$results/crack/weathered.vtp" "$results/crack/crack.png" "$where" "$upwards" curvature "$range"
    caption "$results/crack/crack.png" "$box" "a crack carved"
    row="$row $results/crack/crack.png"
fi
# shellcheck disable=SC2086
convert $row -background white -gravity south +append "$results/second.png"
# shellcheck disable=SC2086
legend "$results/bar.png" "curvature: hollow" ridge $bent
stack "$out/curvature.png" "$results/first.png" "$results/second.png" "$results/bar.png"
rm -f "$results/first.png" "$results/second.png" "$results/bar.png"
panel=$full
letters=$((panel / 17))
echo "$out/curvature.png"
