# Running water: streams that cut a gorge (Figure 9.10 of the source) and a winding valley, rain that flutes a bust (Figure 9.9) and rain on a slope. Sourced by examples/run.sh.
# shellcheck shell=sh disable=SC2154
. "$root/examples/pictures/meshes.sh"

results=$out/hydraulic
full=$panel
panel=$((panel * 4 / 5))
letters=$((panel / 16))
coarse=1
part=1
[ $small = no ] || { coarse=2; part=6; }

# Clay that is dark in hollows and light on ridges.
clay_map=$(colormap "#2b241d" "#6b6053" "#a89b89" "#cdc2b1" "#f6f0e4")

# Before, after, and where water ran, from one camera.
pour() { # name iterations view|camera up range wettest labels options...
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
    case $look in
        --*) where=$look ;;
        *) where=$(camera_of "$look" "$upwards" "$first.obj") ;;
    esac
    draw "$first.vtp" "$first.png" "$where" "$upwards" curvature "$range" "$clay_map" --up "$facing"
    draw "$final.vtp" "$final.png" "$where" "$upwards" curvature "$range" "$clay_map" --up "$facing"
    shoot "$final.vtp" "$final.flow.png" "$where" "$upwards" flow "0,$wettest"
    box=$(seen_in "$first.png")
    caption "$first.png" "$box" "$before"
    caption "$final.png" "$box" "$after"
    caption "$final.flow.png" "$box" "where water ran"
    convert "$first.png" "$final.png" "$final.flow.png" -background white -gravity south +append "$results/$name.png"
}

facing=+Z
mkdir -p "$results"
# Water with pressure, for it has to get out of the pools that it digs.
pour gorge $((4000 / part)) "--camera-position=3.05,0.2,0.68 --camera-focal-point=1.1,0.53,0.12" "0 0 1" 45 $((8000 / part)) "a gorge" "cut by a stream" \
    builtin:canyon:resolution=$((80 / coarse)) --fluid sph --particles $((6000 / coarse)) --radius 0.022 \
    --emitter 0.02,0.44,0.15,0.12,0.62,0.32 --velocity 2,0,0 --step 30 --frame 0

pour river $((2500 / part)) "--camera-position=2.42,-1.07,1.67 --camera-focal-point=0.8,0.45,0.05" "0 0 1" 45 $((6000 / part)) "a valley" "cut by a river" \
    builtin:valley:resolution=$((120 / coarse)),width=0.16,depth=0.12,fall=0.2 --fluid sph --particles $((6000 / coarse)) --radius 0.012 \
    --emitter 0.03,0.52,0.3,0.12,0.62,0.36 --velocity 1,0.3,0

model=builtin:bust:resolution=$((110 / coarse))
look="0.5 -1 0.35"
upwards="0 0 1"
terrain=builtin:valley:resolution=$((110 / coarse)),fall=0.5,depth=0.03
over="--emitter 0.01,0.01,0.6,1.49,0.99,0.75"
case $input in
    *.asc | *.ASC) terrain=$input; over="" ;;
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
pour bust $((900 / part)) "$look" "$upwards" 60 1500 "a bust" "under rain" "$model" --up "$up" --particles $((6000 / coarse)) \
    --model curvature --durability 0.9 --step 40 --friction 6
facing=+Z
# shellcheck disable=SC2086
pour terrain $((500 / part)) "0.8 -1 0.9" "0 0 1" 50 $((900 / part)) "a slope" "under rain" "$terrain" $over --particles $((8000 / coarse)) \
    --durability 0.14 --step 20 --friction 12
# shellcheck disable=SC2086
legend "$results/bars.png" "water: none" much $wet
stack "$out/hydraulic.png" "$results/gorge.png" "$results/river.png" "$results/bust.png" "$results/terrain.png" "$results/bars.png"
rm -f "$results"/*.png
panel=$full
letters=$((panel / 17))
echo "$out/hydraulic.png"
