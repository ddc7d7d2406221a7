#!/bin/sh
# What `weather curvature`, `weather hydraulic` and `weather wrinkles` promise: exit codes, keys of the report, ledgers that
# add up, equal bytes for equal runs and any number of threads, resuming.
#   sh tests/tool/weather_mesh.sh PATH/TO/weather EMPTY/FOLDER
. "$(dirname "$0")/promises.sh"
bad() { # command name says options...
    process=$1
    name=$2
    text=$3
    shift 3
    expect 2 "$name" "$weather" "$process" builtin:cube:squares=3 -o none "$@"
    says "$name" "$text"
}

# usage: 2, naming the option
expect 2 no_output "$weather" curvature builtin:cube
expect 2 unknown_option "$weather" hydraulic builtin:cube -o none --unknown 1
expect 2 bad_builtin "$weather" curvature builtin:moon -o none
expect 2 bad_process "$weather" erode builtin:cube -o none
says bad_process "'erode' is none of frost, voxel, curvature, hydraulic, wrinkles"
says bad_builtin "cube, sphere, bust, hand, canyon, valley, outcrop"
bad curvature power power --power 0.5
bad curvature nan_power power --power nan
bad curvature step step --step 0
bad curvature estimator estimator --estimator guess
bad curvature ball ball --ball -1
bad curvature direction direction --direction up
bad curvature durability "--durability soft" --durability soft
bad curvature hard "--durability 0: is not in" --durability 0
bad curvature layers "values: one is out of range" --durability layers:values=1,-2
bad curvature field_key "unknown key 'colour'" --durability noise:colour=3
bad curvature small_edge small-edge --small-edge 0.9
bad curvature retries retries --retries 99
bad curvature hold_after hold-after --hold-after 99
bad curvature up up --up w
bad curvature format format --format xyz
bad hydraulic model model --model fire
bad hydraulic fluid fluid --fluid sand
bad hydraulic particles particles --particles 0
bad hydraulic emitter "--emitter 1,2,3: six numbers" --emitter 1,2,3
bad hydraulic inverted "the box is empty" --emitter 0,0,1,1,1,0
bad hydraulic velocity "--velocity fast" --velocity fast
bad hydraulic gravity "--gravity 1,2" --gravity 1,2
bad hydraulic radius radius --radius 0
bad hydraulic friction friction --friction -1
bad hydraulic lifetime lifetime --lifetime nan
bad hydraulic viscosity viscosity --viscosity -1
bad hydraulic adhesion adhesion --adhesion 11
bad hydraulic frame frame --frame -1
bad hydraulic k "--k -1" --k -1
bad hydraulic tau_c "--tau-c x" --tau-c x
bad hydraulic exponent "--a 0" --a 0
bad hydraulic K "--K -1" --K -1
bad hydraulic m "--m 0" --m 0
bad hydraulic influence influence --influence 0
bad hydraulic refine refine --refine -1
bad wrinkles nothing "--path, --through or --enlarge"
bad wrinkles path "--path 1" --path 1
bad wrinkles path_text "--path 1,x" --path 1,x
bad wrinkles through "at least two points" --through 0,0,0
bad wrinkles enlarge "v,radius,strength" --enlarge 1,2
bad wrinkles wrinkle_radius radius --path 0,1 --radius -1
bad wrinkles profile profile --path 0,1 --profile flat
bad wrinkles divisor divisor --path 0,1 --divisor 0
bad wrinkles strength strength --path 0,1 --strength nan
bad wrinkles subdivisions subdivisions --path 0,1 --subdivisions 7
for process in curvature hydraulic wrinkles; do expect 0 help_$process "$weather" $process --help; done
for process in curvature wrinkles; do says help_$process "INPUT and all options must be given again"; done

# bad input: 1, and nothing is made
for process in curvature hydraulic; do
    : > plain_file
    expect 1 below_a_file "$weather" $process builtin:cube -o plain_file/out
    expect 1 missing "$weather" $process no_such_file.obj -o none
    says missing no_such_file.obj
    printf 'v 0 0 0\nv 1 0 0\n' > points.obj
    expect 1 points "$weather" $process points.obj -o none
    says points "there is no face"
    printf 'v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n' > place.obj
    expect 1 place "$weather" $process place.obj -o none
done
expect 1 far_vertex "$weather" wrinkles builtin:cube:squares=3 -o none --path 0,9999
says far_vertex "vertex 9999"
echo words > rock.txt
for process in curvature hydraulic "wrinkles --path 0,1"; do
    # shellcheck disable=SC2086
    expect 1 unknown_kind "$weather" $process rock.txt -o none
    says unknown_kind "rock.txt: expected a mesh (.obj .ply .stl), an elevation grid (.asc) or builtin:SPEC"
done
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 7 0 0\nv 8 0 0\nv 7 1 0\nf 1 2 3\nf 5 6 7\n' > islands.obj
expect 1 lone_vertex "$weather" wrinkles islands.obj -o none --path 0,3
says lone_vertex "vertex 3 belongs to no triangle"
expect 1 lone_centre "$weather" wrinkles islands.obj -o none --enlarge 3,1,1
says lone_centre "vertex 3 belongs to no triangle"
expect 0 coarse "$weather" wrinkles builtin:cube:squares=1 -o coarse --path 0,7 --progress none
holds "$(number coarse volume_after) > 1" coarse
expect 1 islands "$weather" wrinkles islands.obj -o none --path 1,5
says islands "no edges lead from vertex 1 to vertex 5"
[ ! -e none ] || complain "a refused run made its folder"

# curvature: files, report, equal runs and thread counts
part="--power 1.5 --step 4 --small-edge 0.3 --durability noise:low=0.5,high=3 --map --progress none --snapshots 10 --format obj,ply,stl,vtp"
rock=builtin:bust:resolution=26
# shellcheck disable=SC2086
{
    expect 0 first "$weather" curvature $rock -o first $part --iterations 40 --checkpoint end1
    for file in weathered.obj weathered.ply weathered.stl weathered.vtp history.csv map.txt report.json snapshots/curvature.pvd \
        snapshots/curvature_00000000.vtp snapshots/curvature_00000040.vtp; do
        [ -s "first/$file" ] || complain "first/$file is missing or empty"
    done
    for key in schema version process seed parameters threads stopped repaired mesh bounds iterations vertices faces edges_collapsed \
        retries held step volume_removed largest_wear seconds read weather write; do
        grep -q "\"$key\":" first/report.json || complain "report.json has no $key"
    done
    for channel in curvature wear; do grep -q "Name=\"$channel\"" first/weathered.vtp || complain "weathered.vtp has no $channel"; done
    grep -q '"schema": "tafoni.weather.curvature/1"' first/report.json || complain "the schema is another"
    grep -q '"stopped": "finished"' first/report.json || complain "the run did not finish"
    holds "$(number first edges_collapsed) > 0 && $(number first volume_removed) > 0" first
    before=$(sed -n 's/^ *"mesh": {//p; s/^ *"vertices": \([0-9]*\),/\1/p' first/report.json | grep . | head -1)
    [ "$(wc -l < first/map.txt)" = "$before" ] || complain "the map has another length"
    [ "$(grep -c '^v ' first/weathered.obj)" = "$(tail -1 first/history.csv | cut -d, -f2)" ] || complain "the history counts other vertices"
    expect 0 again "$weather" curvature $rock -o again $part --iterations 40 --threads 3 --checkpoint end2
    same first again
    cmp end1 end2 || complain "checkpoints differ"
    # resumed runs equal uninterrupted ones
    expect 0 half "$weather" curvature $rock -o resumed $part --iterations 20 --checkpoint half.bin
    expect 0 rest "$weather" curvature $rock -o resumed $part --iterations 40 --resume half.bin --checkpoint end3
    for file in weathered.vtp weathered.obj map.txt history.csv snapshots; do
        diff -r first/$file resumed/$file > diff.log || complain "a resumed run ends with another $file"
    done
    cmp end1 end3 || complain "a resumed run ends with another checkpoint"
    expect 1 other_options "$weather" curvature $rock -o none $part --iterations 40 --check-every 7 --resume half.bin
    expect 1 other_field "$weather" curvature $rock -o none $part --iterations 40 --seed 5 --resume half.bin
    expect 1 other_estimator "$weather" curvature $rock -o none $part --iterations 40 --estimator quadric --resume half.bin
    expect 1 other_input "$weather" curvature builtin:cube -o none $part --iterations 40 --resume half.bin
    expect 2 too_few "$weather" curvature $rock -o none $part --iterations 3 --resume half.bin
    says too_few "--iterations 3"
    says other_options "half.bin: "
    head -c 100 half.bin > cut.bin
    expect 1 truncated "$weather" curvature $rock -o none $part --iterations 40 --resume cut.bin
    says truncated "cut.bin: "
    [ ! -e none ] || complain "a refused resume made its folder"
}
for option in "--estimator cotangent" "--estimator quadric" "--estimator bubble --ball 0.1" "--direction normal" "--direction blend" \
    "--durability ramp:low=1,high=3" "--durability layers:values=1,5,fold=0.05" "--keep-topology" "--check-every 2"; do
    # shellcheck disable=SC2086
    expect 0 try "$weather" curvature $rock -o try --iterations 4 --progress none --format obj $option
    cmp -s try/weathered.obj first/snapshots/curvature_00000010.obj && complain "$option: nothing happens"
done
expect 0 cube "$weather" curvature builtin:cube:squares=8 -o cube --iterations 60 --progress none
holds "$(number cube volume_removed) > 0.2" cube
# where triangles would cut each other: without and with vertices that are held still, across a break too
thin="builtin:outcrop:resolution=32 --step 2 --check-every 5 --progress none --format obj --iterations"
# shellcheck disable=SC2086
{
    expect 0 plain_thin "$weather" curvature $thin 60 -o plain_thin --retries 2
    grep -q '"stopped": "self_intersection"' plain_thin/report.json || complain "a surface that cuts itself is not told in the report"
    says plain_thin "ended early, after [0-9]* of 60 iterations: triangles would cut"
    says plain_thin "--estimator quadric"
    expect 0 thin "$weather" curvature $thin 60 -o thin --checkpoint thin.bin
    grep -q '"stopped": "finished"' thin/report.json || complain "one cut ends the run"
    holds "$(number thin held) > 0" thin
    says thin "were held still"
    expect 0 half_thin "$weather" curvature $thin 40 -o gone_thin --checkpoint half_thin.bin
    expect 0 rest_thin "$weather" curvature $thin 60 -o gone_thin --resume half_thin.bin --checkpoint gone_thin.bin
    cmp thin.bin gone_thin.bin || complain "a run that holds vertices and is resumed ends differently"
}
expect 0 none_at_all "$weather" curvature builtin:cube:squares=8 -o unchanged --iterations 0 --format obj --progress none
holds "$(number unchanged volume_removed) == 0" unchanged

# Ctrl-C: 130 and a checkpoint that goes on to the same end
"$weather" curvature builtin:bust:resolution=20 -o stopped --iterations 100000000 --step 1000000 --format obj --progress json 2> stopped.log &
child=$!
tries=0
until grep -q '"weather"' stopped.log 2> /dev/null || [ $tries -gt 300 ]; do sleep 0.1; tries=$((tries + 1)); done
kill -INT $child
wait $child
code=$?
[ $code -eq 130 ] || { complain "Ctrl-C: exit code $code, expected 130"; tail -3 stopped.log; }
[ -s stopped/curvature.checkpoint ] || complain "Ctrl-C wrote no checkpoint"
grep -q '"stopped": "interrupted"' stopped/report.json || complain "the report does not say that it was stopped"
reached=$(number stopped iterations)
if [ "$reached" -lt 3000 ]; then
    end=$((reached + 5))
    expect 0 gone_on "$weather" curvature builtin:bust:resolution=20 -o stopped --iterations $end --step 1000000 --format obj \
        --progress none --resume stopped/curvature.checkpoint
    expect 0 straight "$weather" curvature builtin:bust:resolution=20 -o straight --iterations $end --step 1000000 --format obj --progress none
    cmp stopped/weathered.obj straight/weathered.obj || complain "going on after Ctrl-C ends differently"
fi

# hydraulic: the ledger adds up, equal runs and thread counts, both models, both fluids
ledger() {
    awk -v e="$(number "$1" eroded)" -v d="$(number "$1" deposited)" -v c="$(number "$1" carried)" -v l="$(number "$1" left)" \
        'BEGIN { x = e - d - c - l; exit !(e > 0 && x * x <= 1e-18 * e * e) }' || complain "$1: the ledger does not add up"
    awk -F, 'NR > 1 { x = $5 - $6 - $7 - $8; if (x * x > 1e-18 * $5 * $5) exit 1 }' "$1/history.csv" || complain "$1: a row of the history does not add up"
}
flow="builtin:valley:resolution=24 --snapshots 30 --emitter 0.2,0.35,0.13,0.5,0.65,0.2 --progress none --format obj,vtp"
# shellcheck disable=SC2086
for case in "partheniades rain 600" "curvature rain 600" "partheniades sph 300"; do
    set -- $case
    kind=$1_$2
    water="--model $1 --fluid $2 --particles $3"
    expect 0 "$kind" "$weather" hydraulic $flow -o "$kind" $water --iterations 60 --checkpoint "$kind".bin
    expect 0 "$kind"_3 "$weather" hydraulic $flow -o "$kind"_3 $water --iterations 60 --threads 3 --checkpoint "$kind"_3.bin
    same "$kind" "$kind"_3
    cmp "$kind".bin "$kind"_3.bin || complain "$kind: checkpoints differ"
    expect 0 "$kind"_half "$weather" hydraulic $flow -o "$kind"_on $water --iterations 30 --checkpoint half.bin
    expect 0 "$kind"_rest "$weather" hydraulic $flow -o "$kind"_on $water --iterations 60 --resume half.bin --checkpoint "$kind"_on.bin
    for file in weathered.vtp weathered.obj history.csv snapshots; do
        diff -r "$kind/$file" "$kind"_on/$file > diff.log || complain "$kind: a resumed run ends with another $file"
    done
    cmp "$kind".bin "$kind"_on.bin || complain "$kind: a resumed run ends with another checkpoint"
    case $1 in curvature) rock="--influence 0.01" ;; *) rock="--k 0.001" ;; esac
    case $2 in rain) wet="--lifetime 2" ;; *) wet="--viscosity 0.5" ;; esac
    for other in "$rock" "$wet" "--step 7" "--refine 0.5" "--particles 17" "--frame 0.003" "--check-every 3" "--durability 2" "--gravity 0,0,-9"; do
        case $other in --particles*) drops="--model $1 --fluid $2" ;; *) drops=$water ;; esac
        expect 1 other "$weather" hydraulic $flow -o none $drops --iterations 60 --resume half.bin $other
        says other "half.bin: "
    done
    expect 2 too_few "$weather" hydraulic $flow -o none $water --iterations 7 --resume half.bin
    head -c 1000 half.bin > cut.bin
    expect 1 truncated "$weather" hydraulic $flow -o none $water --iterations 60 --resume cut.bin
    says truncated "cut.bin: "
    expect 1 foreign "$weather" hydraulic $flow -o none $water --iterations 60 --resume end1
    says foreign "end1: "
    [ ! -e none ] || complain "a refused resume of water made its folder"
    ledger "$kind"
    for key in schema version process seed parameters gravity emitter radius adhesion frame k tau_c influence check_every keep threads stopped repaired iterations time \
        particles contacts ledger eroded deposited carried left vertices_added largest_wear volume_before volume_after unused \
        self_intersections seconds read weather check write; do
        grep -q "\"$key\":" "$kind/report.json" || complain "$kind: report.json has no $key"
    done
    for channel in curvature wear flow sediment; do
        grep -q "Name=\"$channel\"" "$kind/weathered.vtp" || complain "$kind: weathered.vtp has no $channel"
    done
    [ -s "$kind/snapshots/hydraulic.pvd" ] || complain "$kind: no list of snapshots"
    cmp -s "$kind/snapshots/hydraulic_00000000.obj" "$kind/weathered.obj" && complain "$kind: nothing was eroded"
done
ridge="builtin:bust:resolution=20 --particles 800 --format obj --progress none"
# shellcheck disable=SC2086
{
    expect 0 pour "$weather" hydraulic $ridge -o pour --iterations 120 --seed 1
    expect 0 other_seed "$weather" hydraulic $ridge -o other_seed --iterations 120 --seed 2
    cmp -s pour/weathered.obj other_seed/weathered.obj && complain "the seed changes nothing"
    ledger pour
    expect 0 fine "$weather" hydraulic $ridge -o fine --iterations 120 --refine 0.03
    holds "$(number fine vertices_added) > 0" fine
    expect 0 soft "$weather" hydraulic $ridge -o soft --iterations 120 --k layers:values=0.0001,0.01 --tau-c ramp:low=0,high=9 --a 1.2 --K 2 --m noise:low=0.8,high=1.2 --durability 2
    ledger soft
    expect 0 sideways "$weather" hydraulic $ridge -o sideways --iterations 60 --up=-x --emitter 0.4,-0.1,0.3,0.5,0.1,0.8 --velocity=-1,0,0
    expect 0 sheer "$weather" hydraulic $ridge -o sheer --iterations 120 --seed 1 --adhesion 0
    cmp -s pour/weathered.obj sheer/weathered.obj && complain "adhesion changes nothing"
    expect 0 framed "$weather" hydraulic $ridge -o framed --iterations 40 --frame 0.01
    holds "($(number framed time) - 0.4)^2 < 1e-18 && $(number framed frame) == 0.01" framed
    expect 0 watched "$weather" hydraulic $ridge -o watched --iterations 60 --step 3 --k 1 --check-every 2
    ledger watched
    "$weather" hydraulic --help > water.help
    for option in adhesion frame check-every; do grep -q -e "--$option" water.help || complain "hydraulic --help has no --$option"; done
    expect 0 still "$weather" hydraulic $ridge -o still --iterations 0
    holds "$(number still eroded) == 0 && $(number still iterations) == 0" still
}

# a stream let into a valley of an elevation grid cuts about an edge deep by default, in metres or in leagues
for cell in 10 160; do
    awk -v cell=$cell 'BEGIN { n = 40; print "ncols " n "\nnrows " n "\nxllcorner 500000\nyllcorner 4000000\ncellsize " cell
        for (r = 0; r < n; ++r) {
            for (c = 0; c < n; ++c) { d = 0.08 * (c - 20 - 6 * sin(r / 6)) ^ 2; printf "%.3f ", cell * (0.25 * (n - 1 - r) + (d < 6 ? d : 6)) }
            print ""
        } }' > river$cell.asc
    box=$(awk -v c=$cell 'BEGIN { printf "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", 500000 + 21.9 * c, 4000000 + 35 * c, 10.3 * c, 500000 + 24.9 * c, 4000000 + 38 * c, 12 * c }')
    stream="river$cell.asc --fluid sph --particles 1000 --emitter $box --velocity 0,-$((40 * cell)),0 --progress none --format vtp"
    # shellcheck disable=SC2086
    {
        expect 0 river "$weather" hydraulic $stream -o river$cell
        ledger river$cell
        holds "$(number river$cell largest_wear) > 0.3 * $(number river$cell radius) && $(number river$cell largest_wear) < 3 * $(number river$cell radius)" river$cell
        expect 0 bare "$weather" hydraulic $stream -o bare$cell --model curvature
        holds "$(number bare$cell largest_wear) > 0.3 * $(number bare$cell radius) && $(number bare$cell largest_wear) < 3 * $(number bare$cell radius)" bare$cell
        expect 0 smooth "$weather" hydraulic $stream -o smooth$cell --friction 0
    }
    # On smooth ground the stream is out of the model sooner, with the rock that it took.
    holds "$(number smooth$cell friction) == 0 && $(number river$cell friction) > 0 && $(number smooth$cell left) > 10 * $(number river$cell left)" smooth$cell
done

# what would cut itself does not by default; where nobody looks it is counted, and told
thin_hand="builtin:hand:resolution=16 --iterations 300 --particles 4000 --format obj --progress none"
# shellcheck disable=SC2086
{
    expect 0 sound_hand "$weather" hydraulic $thin_hand -o sound_hand
    holds "$(number sound_hand after) == 0 && $(number sound_hand largest_wear) > 0" sound_hand
    expect 0 cut_hand "$weather" hydraulic $thin_hand -o cut_hand --check-every 0
    holds "$(number cut_hand before) == 0 && $(number cut_hand after) > 0" cut_hand
    says cut_hand "weather: note: [0-9]* pairs of triangles cut each other; --check-every 20 prevents it"
    expect 0 cut_rock "$weather" curvature builtin:outcrop:resolution=32 --step 2 --iterations 60 -o cut_rock --format obj --progress none
    says cut_rock "weather: note: [0-9]* pairs of triangles cut each other; --check-every 10 prevents it"
}
# the water as points, with snapshots, across a break as well
# shellcheck disable=SC2086
for fluid in rain sph; do
    drops="builtin:valley:resolution=16 --fluid $fluid --particles 300 --snapshots 10 --particles-out --format obj --progress none"
    expect 0 drops "$weather" hydraulic $drops -o drops --iterations 30
    expect 0 half_drops "$weather" hydraulic $drops -o half_drops --iterations 20 --checkpoint half_drops.bin
    expect 0 all_drops "$weather" hydraulic $drops -o half_drops --iterations 30 --resume half_drops.bin
    diff -r -x report.json drops half_drops > diff.log || complain "$fluid: a resumed run writes other water"
    for key in 'Name="vx"' 'Name="vz"' "NumberOfPoints=\"$(sed -n 's/^  "particles": \([0-9]*\),/\1/p' drops/report.json)\""; do grep -aq "$key" drops/water.vtp || complain "$fluid: water.vtp has no $key"; done
    [ "$(grep -c '<DataSet' drops/snapshots/water.pvd)" = 4 ] || complain "$fluid: the list of water has another length"
done
expect 0 no_drops "$weather" hydraulic builtin:valley:resolution=16 --iterations 1 -o drops --format obj --progress none
[ ! -e drops/water.vtp ] && [ ! -e drops/snapshots/water_00000010.vtp ] || complain "water of an older run is left"

# options without an effect are named on stderr and in the report, and refuse nothing
unused() { # folder options as in the report
    [ "$(tr -d ' \n' < "$1/report.json" | sed 's/.*"unused":\[\([^]]*\)\].*/\1/')" = "$2" ] || complain "$1: the report does not name $2 as unused"
}
small="builtin:bust:resolution=12 --progress none --format obj"
# shellcheck disable=SC2086
{
    expect 0 idle "$weather" hydraulic $small -o idle --particles 50 --iterations 5 --velocity 0,0,-1 --model partheniades --influence 0.5 --viscosity 0.01
    says idle "^weather: note: --viscosity has no effect without --fluid sph$"
    says idle "^weather: note: --influence has no effect without --model curvature$"
    unused idle '"--viscosity","--influence"'
    expect 0 idle_shear "$weather" hydraulic $small -o idle_shear --particles 50 --iterations 5 --model curvature --a 2 --K 3 --m 0.5 --k 1 --tau-c 2
    for option in a K m k tau-c; do says idle_shear "note: --$option has no effect without --model partheniades"; done
    expect 0 idle_rain "$weather" hydraulic $small -o idle_rain --particles 50 --iterations 5 --fluid sph --lifetime 3 --adhesion 1 --gravity 0,0,-1 --up y
    for option in lifetime adhesion; do says idle_rain "note: --$option has no effect without --fluid rain"; done
    says idle_rain "note: --up has no effect with --gravity"
    expect 0 idle_ball "$weather" curvature $small -o idle_ball --iterations 2 --ball 0.2 --retries 3
    says idle_ball "note: --ball has no effect without --estimator bubble"
    says idle_ball "note: --retries has no effect without --check-every"
    unused idle_ball '"--ball","--retries"'
    expect 0 idle_fold "$weather" wrinkles $small -o idle_fold --enlarge 3,0.2,1 --profile groove
    says idle_fold "note: --profile has no effect without --path or --through"
    expect 0 busy "$weather" hydraulic $small -o busy --particles 50 --iterations 5 --fluid sph --viscosity 0.01
    unused busy ""
    grep -q "no effect" busy.log && complain "an option with an effect is said to have none"
    # drops by the size of the mesh, and rock that is too hard for them
    expect 0 drops "$weather" hydraulic builtin:sphere:squares=61 -o drops --iterations 0
    holds "$(number drops particles) == int($(number drops vertices) / 2) && $(number drops particles) > 10000" drops
    expect 0 hard "$weather" hydraulic $small -o hard --particles 500 --iterations 100 --tau-c 1e9
    says hard "note: the water took no rock"
    # water that touches nothing, and water without weight
    expect 0 dry "$weather" hydraulic $small -o dry --particles 50 --iterations 20 --radius 1e-6
    says dry "note: no particle touched the mesh.*--emitter.*--radius"
    expect 0 weightless "$weather" hydraulic $small -o weightless --particles 50 --iterations 3 --fluid sph --gravity 0,0,0
    expect 0 loud "$weather" hydraulic $small -o loud --particles 50 --iterations 3 --fluid sph --gravity 0,0,0 --sound-speed 7
    holds "$(number loud sound_speed) == 7 && $(number weightless sound_speed) > 0" loud
}

# Ctrl-C: 130 and a checkpoint that goes on to the same end
# shellcheck disable=SC2086
{
    "$weather" hydraulic $ridge -o dammed --iterations 100000000 2> dammed.log &
    child=$!
    tries=0
    until [ -d dammed ] || [ $tries -gt 300 ]; do sleep 0.1; tries=$((tries + 1)); done
    sleep 0.3
    kill -INT $child
    wait $child
    code=$?
    [ $code -eq 130 ] || { complain "Ctrl-C of hydraulic: exit code $code, expected 130"; tail -3 dammed.log; }
    [ -s dammed/hydraulic.checkpoint ] || complain "Ctrl-C of hydraulic wrote no checkpoint"
    reached=$(number dammed iterations)
    if [ "$reached" -lt 1500 ]; then
        end=$((reached + 5))
        expect 0 broken "$weather" hydraulic $ridge -o dammed --iterations $end --resume dammed/hydraulic.checkpoint
        expect 0 unbroken "$weather" hydraulic $ridge -o unbroken --iterations $end
        cmp dammed/weathered.obj unbroken/weathered.obj || complain "hydraulic goes on after Ctrl-C to another end"
    fi
}

# wrinkles: files, a pattern that another mesh wears, both profiles
cube=builtin:cube:squares=12
expect 0 fold "$weather" wrinkles $cube -o fold --path 0,70 --radius 0.2 --progress none
grep -q '"schema": "tafoni.weather.wrinkles/1"' fold/report.json || complain "the schema is another"
for key in schema process parameters vertices_added volume_before volume_after seconds read weather write paths; do
    grep -q "\"$key\":" fold/report.json || complain "wrinkles: report.json has no $key"
done
holds "$(number fold volume_after) > $(number fold volume_before) && $(number fold vertices_added) > 0" fold
expect 0 crack "$weather" wrinkles $cube -o crack --through 0.2,0.2,1,0.5,0.6,1,0.8,0.4,1 --profile groove --times 3 --progress none --threads 2
expect 0 crack1 "$weather" wrinkles $cube -o crack1 --through 0.2,0.2,1,0.5,0.6,1,0.8,0.4,1 --profile groove --times 3 --progress none
same crack crack1
holds "$(number crack volume_after) < $(number crack volume_before)" crack
expect 0 swell "$weather" wrinkles $cube -o swell --enlarge 100,0.3,2 --enlarge 30,0.2,-1 --progress none
says swell "0 wrinkles, 2 enlargements"
expect 0 worn "$weather" wrinkles $cube -o worn --path 0,70 --radius 0.2 --wear-on builtin:sphere:squares=12 --progress none
[ -s worn/worn_0.obj ] || complain "no other mesh wears the wrinkles"
expect 1 other_shape "$weather" wrinkles $cube -o none --path 0,70 --wear-on builtin:cube:squares=11
says other_shape "--wear-on builtin:cube:squares=11: its triangles"
for channel in curvature wear factor; do grep -q "Name=\"$channel\"" fold/weathered.vtp || complain "wrinkles: weathered.vtp has no $channel"; done
expect 0 unmoved "$weather" wrinkles $cube -o unmoved --path 0,70 --strength 0 --progress none
says unmoved "nothing moves"
expect 0 told "$weather" wrinkles $cube -o told --path 0,70 --progress json
says told '"stage":"weather"'
# snapshots, and going on where a run ended
lines="--path 0,70 --through 0.2,0.2,1,0.8,0.4,1 --radius 0.2 --progress none --format obj,vtp --snapshots 2"
# shellcheck disable=SC2086
{
    expect 0 six "$weather" wrinkles $cube -o six $lines --times 6 --checkpoint six.bin
    for n in 0 2 4 6; do [ -s six/snapshots/wrinkles_0000000$n.vtp ] || complain "no snapshot after $n times"; done
    [ "$(grep -c '<DataSet' six/snapshots/wrinkles.pvd)" = 4 ] || complain "the list of snapshots has another length"
    cmp six/weathered.vtp six/snapshots/wrinkles_00000006.vtp || complain "the last snapshot is not the end"
    [ "$(number six times)" = 6 ] || complain "the report does not say how many times"
    expect 0 three "$weather" wrinkles $cube -o gone_on $lines --times 3 --checkpoint three.bin --threads 2
    expect 0 on_to_six "$weather" wrinkles $cube -o gone_on $lines --times 6 --resume three.bin --checkpoint on.bin
    same six gone_on
    cmp six.bin on.bin || complain "a resumed run of wrinkles ends with another checkpoint"
    expect 1 other_lines "$weather" wrinkles $cube -o none $lines --times 6 --strength 2 --resume three.bin
    expect 1 other_base "$weather" wrinkles builtin:sphere:squares=12 -o none --path 0,70 --times 6 --resume three.bin
    expect 2 too_often "$weather" wrinkles $cube -o none $lines --times 2 --resume three.bin
    head -c 60 three.bin > cut.bin
    expect 1 cut_short "$weather" wrinkles $cube -o none $lines --times 6 --resume cut.bin
    { head -c 3000 three.bin; printf x; tail -c +3002 three.bin; } > bent.bin
    expect 1 bent_bits "$weather" wrinkles $cube -o none $lines --times 6 --resume bent.bin
    says bent_bits "checksum"
    expect 1 foreign "$weather" wrinkles $cube -o none $lines --times 6 --resume six/weathered.obj
    [ ! -e none ] || complain "a refused resume of wrinkles made its folder"
}
"$weather" wrinkles builtin:cube:squares=60 -o halted --path 0,700 --times 10000 --divisor 1e9 --format obj --progress json 2> halted.log &
child=$!
tries=0
until grep -q '"weather"' halted.log 2> /dev/null || [ $tries -gt 300 ]; do sleep 0.1; tries=$((tries + 1)); done
kill -INT $child
wait $child
[ $? -eq 130 ] || { complain "Ctrl-C of wrinkles: another exit code"; tail -3 halted.log; }
[ -s halted/wrinkles.checkpoint ] || complain "Ctrl-C of wrinkles wrote no checkpoint"

# every kind of input: open, inside out, polygons, corners twice, vertices without faces, terrain with gaps
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n' > inside_out.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0.2\nv 0 1 0\nv 2 0 0\nv 2 1 0.1\nv 9 9 9\nf 1 2 3 4\nf 2 5 6 3\nf 1 1 2\n' > sheet.obj
printf 'ncols 5\nnrows 4\nxllcorner 400000\nyllcorner 2000000\ncellsize 10\nNODATA_value -9999\n' > hill.asc
printf '5 6 9 8 7\n7 12 20 11 8\n6 14 25 -9999 7\n5 8 9 7 6\n' >> hill.asc
for file in inside_out.obj sheet.obj hill.asc; do
    for process in curvature hydraulic; do
        expect 0 any_input "$weather" $process $file -o any_input --iterations 12 --progress none --format obj
        grep -qi nan any_input/weathered.obj && complain "$process of $file: a number is none"
    done
done
# what is odd about a mesh is counted; what has one side only is refused
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 5 5\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' > lone.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0.2\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n' > crowd.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 4 3\nf 1 3 4\n' > twice.obj
awk 'BEGIN { n = 24; p = 8 * atan2(1, 1)
    for (i = 0; i < n; ++i) for (s = -0.3; s < 0.4; s += 0.6) { a = p * i / n; print "v", (1 + s * cos(a / 2)) * cos(a), (1 + s * cos(a / 2)) * sin(a), s * sin(a / 2) }
    for (i = 0; i < n; ++i) { a = 2 * i + 1; c = i + 1 < n ? a + 2 : 2; d = i + 1 < n ? a + 3 : 1; print "f", a, c, d; print "f", a, d, a + 1 } }' > strip.obj
for process in "curvature --iterations 2" "hydraulic --iterations 5 --particles 50" "wrinkles --path 0,1 --radius 0.5"; do
    # shellcheck disable=SC2086
    {
        for case in "lone isolated_vertices 1" "crowd crowded_edges 1" "twice duplicate_faces 2"; do
            set -- $case
            expect 0 odd "$weather" $process $1.obj -o odd --progress none --format ply
            [ "$(number odd $2)" = "$3" ] || complain "$process: $2 of $1.obj is not $3"
        done
        expect 1 strip "$weather" $process strip.obj -o none
        says strip "strip.obj: .*not orientable"
    }
done
# very large and very small models
for size in 1e30 1e-30; do
    awk -v s=$size '/^v / { printf "v %.17g %.17g %.17g\n", $2 * s, $3 * s, $4 * s } /^f /' still/weathered.obj > scaled.obj
    expect 0 scaled "$weather" hydraulic scaled.obj -o scaled --particles 500 --iterations 60 --progress none --format ply,vtp
    grep -aq '^property double sediment' scaled/weathered.ply || complain "volumes of a model of $size are no doubles"
done
printf 'v 0 0 0\nv 1e150 0 0\nv 0 1e150 0\nv 0 0 1e150\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' > huge.obj
expect 1 huge "$weather" hydraulic huge.obj -o none
says huge "huge.obj: the model is 1e+150 long"
# sph needs no more places than particles
expect 0 pool "$weather" hydraulic hill.asc -o pool --fluid sph --radius 0.05 --particles 500 --iterations 1 --progress none --format obj
expect 0 turned "$weather" curvature inside_out.obj -o turned --iterations 1 --progress none
[ "$(number turned turned_faces)" = 4 ] || complain "turned faces are not counted"
expect 0 open "$weather" curvature hill.asc -o open --iterations 5 --progress none --format obj
grep -q '"terrain": true' open/report.json || complain "terrain is not named as such"
holds "$(number open open_edges) > 0 && $(number open largest_wear) > 0" open
# a folder that is used again holds nothing of the older run, and keeps what others put there
: > open/notes.txt
expect 0 reused "$weather" curvature hill.asc -o open --iterations 2 --progress none --format ply
[ -e open/notes.txt ] && [ ! -e open/weathered.obj ] || complain "a folder is not used again as promised"

[ $failed -eq 0 ] && echo "all passed"
exit $failed
