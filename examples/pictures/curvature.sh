# Curvature: a cube to a sphere (Figure 9.5 of the source), a hand whose fingers last (Figure 9.8), a bust, and what
# wrinkles do to it: a crack with branches, and a face that is old. Sourced by examples/run.sh.
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
crack="0.05,-0.12,0.93,0.022,-0.15,0.895,0.03,-0.17,0.868,0.005,-0.175,0.845,0.03,-0.178,0.818,0.06,-0.17,0.8,0.05,-0.18,0.77,\
0.075,-0.17,0.745,0.07,-0.165,0.715,0.105,-0.14,0.695,0.09,-0.145,0.66,0.065,-0.14,0.635,0.09,-0.1,0.6,0.1,-0.07,0.56,\
0.07,-0.065,0.525,0.06,-0.06,0.48,0.09,-0.07,0.44,0.11,-0.09,0.4,0.08,-0.11,0.36,0.09,-0.12,0.31"
branches="0.06,-0.17,0.8,0.09,-0.15,0.825,0.105,-0.13,0.815,0.135,-0.07,0.85 0.1,-0.07,0.56,0.105,-0.04,0.53,0.13,0,0.5,0.125,-0.02,0.465
0.03,-0.178,0.818,-0.02,-0.178,0.83,-0.035,-0.17,0.85 0.11,-0.09,0.4,0.15,-0.09,0.385,0.17,-0.08,0.35
0.105,-0.14,0.695,0.13,-0.1,0.7,0.135,-0.08,0.67"
folds="-0.085,-0.15,0.852,0,-0.17,0.862,0.085,-0.15,0.852 -0.07,-0.14,0.895,0,-0.16,0.9,0.07,-0.14,0.895
-0.08,-0.14,0.82,0,-0.2,0.825,0.08,-0.14,0.82 0.03,-0.2,0.695,0.055,-0.17,0.665,0.065,-0.16,0.61
-0.03,-0.2,0.695,-0.055,-0.17,0.665,-0.065,-0.16,0.61"
case $input in
    builtin:* | *.asc | *.ASC) ;;
    *)
        model=$input
        crack=front
        branches=""
        folds=""
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
through() { for line in "$@"; do echo "--through $line"; done; }
of_side() { awk -v s="$(side_of "$results/bust/snapshots/curvature_00000000.obj")" -v n="$1" 'BEGIN { print n * s }'; }
# Stone of one colour: what is carved shows by its shade.
stone() { # FILE.vtp FILE.png text
    shoot "$1" "$2" "$where" "$upwards" wear 0,1e30
    caption "$2" "$box" "$3"
    row="$row $2"
}
"$weather" wrinkles "$results/bust/snapshots/curvature_$(printf '%08d' $middle).obj" -o "$results/crack" --profile groove \
    --radius "$(of_side 0.006)" --strength -10 --subdivisions 3 --through "$crack" --format vtp,obj --threads 0
if [ -n "$branches" ]; then
    # shellcheck disable=SC2046,SC2086
    "$weather" wrinkles "$results/crack/weathered.obj" -o "$results/branches" --profile groove --radius "$(of_side 0.0045)" \
        --strength -8 $(through $branches) --format vtp --threads 0
    stone "$results/branches/weathered.vtp" "$results/crack/crack.png" "a crack"
else
    stone "$results/crack/weathered.vtp" "$results/crack/crack.png" "a crack"
fi
if [ -n "$folds" ]; then
    # shellcheck disable=SC2046,SC2086
    "$weather" wrinkles builtin:bust:resolution=$((260 / coarse)) -o "$results/folds" --radius "$(of_side 0.035)" --times 3 \
        $(through $folds) --format vtp --threads 0
    stone "$results/folds/weathered.vtp" "$results/folds/folds.png" "wrinkles"
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
