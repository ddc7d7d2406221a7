# Running water: a stream that cuts a gorge (Figure 9.10 of the source), rain over a bust (Figure 9.9) and a terrain. Sourced by examples/run.sh.
# shellcheck shell=sh disable=SC2154
. "$root/examples/pictures/meshes.sh"

results=$out/hydraulic
full=$panel
panel=$((panel * 4 / 5))
letters=$((panel / 16))
coarse=1
part=1
[ $small = no ] || { coarse=2; part=6; }

# Before, after, and where water ran, from one camera.
pour() { # name iterations view up range wettest labels options...
    name=$1
    steps=$2
    look=$3
    upwards=$4
    most=$5
    wettest=$6
    before=$7
    after=$8
    shift 8
    echo "water over $name for $steps steps in $results/$name"
    "$weather" hydraulic -o "$results/$name" --iterations "$steps" --snapshots "$steps" --format vtp,obj --threads 0 "$@"
    shots=$results/$name/snapshots
    first=$shots/hydraulic_00000000
    final=$shots/hydraulic_$(printf '%08d' "$steps")
    range=$(over_side "$first.obj" "$most")
    where=$(camera_of "$look" "$upwards" "$first.obj")
    shoot "$first.vtp" "$first.png" "$where" "$upwards" curvature "$range"
    shoot "$final.vtp" "$final.png" "$where" "$upwards" curvature "$range"
    shoot "$final.vtp" "$final.flow.png" "$where" "$upwards" flow "0,$wettest"
    box=$(seen_in "$first.png")
    caption "$first.png" "$box" "$before"
    caption "$final.png" "$box" "$after"
    caption "$final.flow.png" "$box" "where water ran"
    convert "$first.png" "$final.png" "$final.flow.png" -background white -gravity south +append "$results/$name.png"
}

facing=+Z
mkdir -p "$results"
pour gorge $((400 / part)) "1 -0.3 0.75" "0 0 1" 20 $((400 / part)) "a gorge" "cut by a stream" \
    builtin:canyon:resolution=$((70 / coarse)) --particles $((5000 / coarse)) --emitter 0.02,0.44,0.15,0.12,0.62,0.32 --velocity 2,0,0 \
    --friction 1 --model curvature --step 1.2

model=builtin:bust:resolution=$((100 / coarse))
look="0.5 -1 0.35"
upwards="0 0 1"
terrain=builtin:valley:resolution=$((80 / coarse)),fall=0.4
case $input in
    *.asc | *.ASC) terrain=$input ;;
    builtin:*) ;;
    *)
        model=$input
        facing=+$(echo "$up" | tr xyz XYZ)
        case $up in
            x) look="0.35 0.5 -1"; upwards="1 0 0" ;;
            y) look="0.5 0.35 1"; upwards="0 1 0" ;;
        esac
        ;;
esac
pour bust $((400 / part)) "$look" "$upwards" 40 60 "a bust" "under rain" "$model" --up "$up" --particles $((6000 / coarse)) \
    --model curvature --step 1 --friction 10
facing=+Z
pour terrain $((300 / part)) "0.35 -1 1" "0 0 1" 40 $((400 / part)) "terrain" "under rain" "$terrain" --particles $((8000 / coarse)) --model curvature --step 1 --friction 4
# shellcheck disable=SC2086
legend "$results/bar.png" "curvature: hollow" ridge $bent
# shellcheck disable=SC2086
legend "$results/wet.png" "water: none" much $wet
convert "$results/bar.png" "$results/wet.png" -bordercolor white -border $((panel / 20))x0 -background white -gravity center \
    +append "$results/bars.png"
stack "$out/hydraulic.png" "$results/gorge.png" "$results/bust.png" "$results/terrain.png" "$results/bars.png"
rm -f "$results"/*.png
panel=$full
letters=$((panel / 17))
echo "$out/hydraulic.png"
