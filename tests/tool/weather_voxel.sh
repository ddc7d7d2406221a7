#!/bin/sh
# What `weather voxel` promises: exit codes, keys of the report, an exact ledger, equal bytes for equal runs, resuming.
#   sh tests/tool/weather_voxel.sh PATH/TO/weather EMPTY/FOLDER
. "$(dirname "$0")/promises.sh"
ledger() { # rock + colluvium + vanished + fallen + left = initial, in the report and in every row of the history
    sum=0
    for key in voxels_rock voxels_colluvium voxels_vanished voxels_fallen voxels_left; do sum=$((sum + $(number "$1" $key))); done
    [ "$sum" = "$(number "$1" voxels_initial)" ] || complain "$1: the ledger does not close: $sum"
    awk -F, -v n="$sum" 'NR > 1 && $2 + $3 + $4 + $5 + $6 != n { exit 1 }' "$1/history.csv" || complain "$1: a row of the history does not add up"
}

# usage: 2, naming the option
bad() { # name says options...
    name=$1
    text=$2
    shift 2
    expect 2 "$name" "$weather" voxel builtin:cube -o none --resolution 8 "$@"
    says "$name" "$text"
}
expect 2 no_output "$weather" voxel builtin:cube
expect 2 unknown_option "$weather" voxel builtin:cube -o none --unknown 1
expect 2 bad_builtin "$weather" voxel builtin:moon -o none
says bad_builtin "hoodoo, cube, corner"
bad resolution resolution --resolution 0
bad radius radius --radius nan
bad big_radius "--bubble sphere:radius=80: radius" --bubble sphere:radius=80
bad bubble "--bubble potato" --bubble potato
bad axes axes --bubble ellipsoid:axes=1,2
bad above "above: must rise" --bubble sphere --bubble disc --bubble gumdrop:above=0.5
bad mixture "radii: one for each" --bubble mixture:shapes=sphere,disc,radii=1,2,3
bad rate "--rate sine" --rate sine
bad rate_key "unknown key 'colour'" --rate cubic:colour=3
bad schedule "--schedule 3x" --schedule 3x
bad no_schedule "--schedule: it is empty" --schedule ""
bad schedule_count "--schedule 2s,c" --schedule 2s,c
bad spheroidal spheroidal --spheroidal -1
bad cavernous cavernous --cavernous -1
bad durability "--durability nosuch" --durability nosuch
bad negative "value: -1 is not in" --durability constant:value=-1
bad negative_profile "values: a durability lies in" --durability profile:values=1,-1
bad negative_layers "values: a durability lies in" --durability layers:values=-1
bad profile "values: as many as at" --durability profile:at=0,1,values=1
bad noise "--noise cloud" --noise cloud
bad repose repose --repose 95
bad baseline baseline --baseline 0
bad joints "--joints brick" --rockfall --joints brick
bad joints_alone "--joints requires --rockfall" --joints planes
bad repose_alone "--repose requires --colluvium" --repose 30
bad baseline_alone "--baseline requires --colluvium" --baseline 2
bad friction_alone "--friction requires --rockfall" --friction 20
bad friction friction --friction 90
bad up up --up w
bad border border --border sea
bad measure measure --measure curvature
bad depth depth --depth 3
bad format format --format xyz
expect 0 help "$weather" voxel --help

# bad input: 1, and nothing is made
: > plain_file
expect 1 below_a_file "$weather" voxel builtin:cube -o plain_file/out
says below_a_file "cannot be made a folder"
expect 1 missing "$weather" voxel no_such_file.obj -o none
says missing no_such_file.obj
echo words > rock.txt
expect 1 unknown_kind "$weather" voxel rock.txt -o none
says unknown_kind "rock.txt: expected a mesh (.obj .ply .stl), an elevation grid (.asc), voxels (.vox .nrrd), an image"
expect 1 no_checkpoint "$weather" voxel builtin:cube -o none --resume no_such_file
says no_checkpoint "^weather: no_such_file"
expect 0 at_the_side "$weather" voxel builtin:cube -o at_the_side --resolution 12 --steps 4 --radius 2 --colluvium --margin 0 --progress none
says at_the_side "a larger --margin"
says help "DIR/voxel.checkpoint"
printf '0 0.01\n1 x\n' > bad.txt
expect 1 bad_file "$weather" voxel builtin:cube -o none --durability bad.txt
says bad_file "bad.txt:2:3"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > sheet.obj
expect 1 sheet "$weather" voxel sheet.obj -o none --resolution 8
says sheet "encloses no volume"
printf 'PNG, or not' > broken.png
expect 1 broken_png "$weather" voxel broken.png -o none
says broken_png broken.png
expect 1 huge "$weather" voxel builtin:cube -o none --resolution 60000 --steps 0
[ ! -e none ] || complain "a refused run made its folder"

# a run with everything on, its files and its report
printf 'relative\n0 0.006\n0.3 0.006 0.003 9\n0.3 0.03\n0.5 0.02\n0.5 0.004\n0.7 0.004\n0.7 0.05\n1 0.02\n' > layers.txt
part="--resolution 40 --radius 3 --noise noise:amplitude=0.002 --colluvium --margin 3 --repose 35 --baseline 2
    --rockfall --joints discs:normal=1,0,1,spacing=0.2,radius=0.3 --snapshots 10 --format obj,ply,stl,vtp --progress none"
plain_rock=$part
part="$part --durability layers.txt"
small="$part --steps 40"
rock=builtin:hoodoo
# shellcheck disable=SC2086
expect 0 first "$weather" voxel $rock -o first $small --checkpoint end1
for file in weathered.obj weathered.ply weathered.stl weathered.vtp blocks.vtp blocks.json history.csv report.json \
    snapshots/voxel.pvd snapshots/voxel_00000000.vtp snapshots/voxel_00000040.vtp; do
    [ -s "first/$file" ] || complain "first/$file is missing or empty"
done
for key in schema version seed parameters threads stopped repaired grid steps voxels_initial voxels_rock voxels_colluvium \
    voxels_vanished voxels_fallen voxels_left surface_voxels blocks joint_discs seconds read voxelise weather surface write; do
    grep -q "\"$key\":" first/report.json || complain "report.json has no $key"
done
for channel in curvature durability decimation cavernous material; do
    grep -q "Name=\"$channel\"" first/weathered.vtp || complain "weathered.vtp has no $channel"
done
grep -q '^g rock' first/weathered.obj && grep -q '^g colluvium' first/weathered.obj || complain "weathered.obj has no groups"
grep -q '"schema": "tafoni.weather.voxel/1"' first/report.json || complain "the schema is another"
[ "$(grep -c '"steps": 40' first/report.json)" -ge 1 ] || complain "steps is not 40"
for key in voxels_rock voxels_colluvium voxels_vanished voxels_fallen voxels_left surface_voxels blocks; do
    [ "$(number first $key)" -gt 0 ] || complain "$key is 0"
done
ledger first

# equal runs and thread counts
# shellcheck disable=SC2086
{
    expect 0 again "$weather" voxel $rock -o again $small --threads 3 --checkpoint end2
    same first again
    cmp end1 end2 || complain "checkpoints differ"
    expect 0 seed "$weather" voxel $rock -o seed $small --seed 9
    cmp -s first/weathered.obj seed/weathered.obj && complain "the seed changes nothing"
    expect 0 events "$weather" voxel $rock -o events $small --events
    expect 0 events3 "$weather" voxel $rock -o events3 $small --events --threads 3
    same events events3
    ledger events
}

# resumed runs equal uninterrupted ones
# shellcheck disable=SC2086
{
    expect 0 half "$weather" voxel $rock -o resumed $part --steps 20 --checkpoint half.bin
    expect 0 rest "$weather" voxel $rock -o resumed $small --resume half.bin --checkpoint end3
    for file in weathered.vtp weathered.obj blocks.json blocks.vtp snapshots; do
        diff -r first/$file resumed/$file > diff.log || complain "a resumed run ends with another $file"
    done
    cmp end1 end3 || complain "a resumed run ends with another checkpoint"
    expect 1 other_seed "$weather" voxel $rock -o none $small --seed 2 --resume half.bin
    expect 1 other_radius "$weather" voxel $rock -o none $small --bubble disc --resume half.bin
    expect 1 other_noise "$weather" voxel $rock -o none $plain_rock --steps 40 --durability constant --resume half.bin
    expect 1 other_input "$weather" voxel builtin:cube -o none $small --resume half.bin
    expect 2 too_few "$weather" voxel $rock -o none $part --steps 3 --resume half.bin
    says too_few "--steps 3"
    head -c 100 half.bin > cut.bin
    expect 1 truncated "$weather" voxel $rock -o none $small --resume cut.bin
    [ ! -e none ] || complain "a refused resume made its folder"
}

# a schedule that is cut and resumed in the middle of a phase
cave="--resolution 24 --measure excess --radius 4 --durability constant:value=0.002 --schedule 5c,2s,1sc --format obj --progress none"
# shellcheck disable=SC2086
{
    expect 0 cave "$weather" voxel builtin:corner -o cave $cave --steps 19
    expect 0 cave_half "$weather" voxel builtin:corner -o cave2 $cave --steps 6 --checkpoint cave.bin
    expect 0 cave_rest "$weather" voxel builtin:corner -o cave2 $cave --steps 19 --resume cave.bin
    cmp cave/weathered.obj cave2/weathered.obj || complain "a resumed schedule ends differently"
    tail -1 cave/history.csv | grep -q '^19,' && grep -q '"spheroidal": 0.0' cave/report.json || complain "a schedule does not go round"
    ledger cave
}

# Ctrl-C: 130 and a checkpoint that goes on to the same end
long="--resolution 24 --durability constant:value=100000 --format obj --progress json"
# shellcheck disable=SC2086
"$weather" voxel builtin:cube -o stopped $long --steps 2000000000 2> stopped.log &
child=$!
tries=0
until grep -q '"weather"' stopped.log 2> /dev/null || [ $tries -gt 300 ]; do sleep 0.1; tries=$((tries + 1)); done
kill -INT $child
wait $child
code=$?
[ $code -eq 130 ] || { complain "Ctrl-C: exit code $code, expected 130"; tail -3 stopped.log; }
[ -s stopped/voxel.checkpoint ] || complain "Ctrl-C wrote no checkpoint"
grep -q '"stopped": "interrupted"' stopped/report.json || complain "the report does not say that it was stopped"
reached=$(tail -1 stopped/history.csv | cut -d, -f1)
# shellcheck disable=SC2086
if [ -n "$reached" ] && [ "$reached" -lt 200000 ]; then
    expect 0 gone_on "$weather" voxel builtin:cube -o stopped $long --steps $((reached + 50)) --resume stopped/voxel.checkpoint
    expect 0 straight "$weather" voxel builtin:cube -o straight $long --steps $((reached + 50))
    cmp stopped/weathered.obj straight/weathered.obj || complain "going on after Ctrl-C ends differently"
fi

# a folder that is used again holds nothing of the older run, and keeps what others put there
again="builtin:cube --resolution 12 --progress none"
# shellcheck disable=SC2086
{
    expect 0 old_run "$weather" voxel $again -o reused --steps 6 --snapshots 2 --format obj,vtp --separate-blocks
    : > reused/notes.txt
    expect 0 new_run "$weather" voxel $again -o reused --steps 4 --snapshots 4 --format vtp
    expect 0 clean_run "$weather" voxel $again -o clean --steps 4 --snapshots 4 --format vtp
    [ -e reused/notes.txt ] || complain "a run removed notes.txt"
    rm -rf reused/notes.txt
    rmdir reused/blocks 2> /dev/null
    same reused clean
}

# no step changes nothing; every axis that is up gives the same rock turned
expect 0 nothing "$weather" voxel builtin:hoodoo -o nothing --resolution 20 --steps 0 --progress none
[ "$(number nothing voxels_rock)" = "$(number nothing voxels_initial)" ] || complain "no step takes rock"
for up in x y -x -y -z; do
    expect 0 "up$up" "$weather" voxel builtin:hoodoo -o "up$up" --resolution 20 --steps 0 --up=$up --progress none
    [ "$(number "up$up" voxels_rock)" = "$(number nothing voxels_rock)" ] || complain "up $up gives another rock"
done

# every kind of input
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n' > inside_out.obj
expect 0 mesh "$weather" voxel inside_out.obj -o mesh --resolution 16 --steps 2 --progress none
[ "$(number mesh turned_faces)" = 4 ] || complain "turned faces are not counted"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.4 0.3 0\nv 0.3 0.3 0\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 5\nf 4 3 5\nf 1 5 6\n' > holes.obj
expect 0 holes "$weather" voxel holes.obj -o holes --resolution 16 --steps 2 --progress none
[ "$(number holes holes)" -gt 0 ] || complain "holes are not counted"
printf 'ncols 5\nnrows 4\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nNODATA_value -9999\n' > hill.asc
printf '5 6 9 8 7\n7 12 20 11 8\n6 14 25 -9999 7\n5 8 9 7 6\n' >> hill.asc
expect 0 terrain "$weather" voxel hill.asc -o terrain --resolution 24 --steps 4 --progress none
grep -q '"border": "extend"' terrain/report.json || complain "terrain does not extend beyond its sides"
printf 'P2\n5 4\n255\n255 0 0 0 255\n255 255 0 255 255\n255 255 0 255 255\n255 0 0 0 255\n' > column.pgm
for image in revolve sweep:depth=0.5 revolve:axis=left; do
    expect 0 image "$weather" voxel column.pgm -o image --resolution 20 --image $image --steps 2 --progress none
    [ "$(number image voxels_initial)" -gt 0 ] || complain "an image gives no rock"
done
{
    printf '\211PNG\015\012\032\012\000\000\000\015IHDR\000\000\000\005\000\000\000\004\010\000\000\000\000c'
    printf 'X\252\234\000\000\000\024IDATx\332c\370\317\300\300\360\237\341\0772\002\211\000\000\217\210\013'
    printf '\365\227\021v\175\000\000\000\000IEND\256B\140\202'
} > column.png
if "$weather" voxel column.png -o png --resolution 20 --steps 2 --progress none > png.log 2>&1; then
    expect 0 pgm "$weather" voxel column.pgm -o pgm --resolution 20 --steps 2 --progress none
    cmp png/weathered.obj pgm/weathered.obj || complain "an image in PNG gives another rock than in PGM"
else
    says png "built without libpng"
fi
{
    printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n'
    printf 'zzzzzAAzzAAzzzzzzzzzzAAzzAAzzzzzzzzzzAAzzAAzzzzzzzzzzAAzzAAzzzzz'
} > grid.nrrd
expect 0 volume "$weather" voxel grid.nrrd -o volume --steps 0 --progress none
[ "$(number volume voxels_initial)" = 48 ] || complain "a volume is not read as it is"
expect 0 level "$weather" voxel grid.nrrd -o level --steps 0 --level 60 --progress none
[ "$(number level voxels_initial)" = 64 ] || complain "--level is not heeded"
{
    printf 'VOX \226\000\000\000MAIN\000\000\000\000\064\000\000\000SIZE\014\000\000\000\000\000\000\000\002\000\000\000\002\000\000\000\002\000\000\000'
    printf 'XYZI\020\000\000\000\000\000\000\000\003\000\000\000\000\000\000\001\001\000\000\001\000\000\001\001'
} > three.vox
expect 0 vox "$weather" voxel three.vox -o vox --steps 0 --progress none
[ "$(number vox voxels_initial)" = 3 ] || complain "a .vox file is not read as it is"

# every SPEC is understood
try() { expect 0 try "$weather" voxel builtin:hoodoo -o try --resolution 24 --steps 3 --progress none --format obj "$@"; }
try --bubble ellipsoid:axes=3,3,5 --rate linear --cavernous 0.3
try --bubble gumdrop:radius=4 --bubble disc:thickness=3,above=0.3 --bubble mixture:shapes=sphere,disc,radii=2,4,above=0.6
try --rate quartic:scale=2,lowest=0.1,highest=1 --depth 2 --measure excess
try --rate linear --depth 2 --measure flat --cavernous 1
try --durability profile:at=0,0.5,1,values=0.01,0.03,0.02,amplitude=0.002,frequency=8
try --durability layers:values=0.01,0.05,0.02,thickness=0.1
try --durability grid:path=grid.nrrd,place=fit --noise noise:wavelength=0.2,octaves=2
try --rockfall --joints planes:normal=0,0.2,1,spacing=0.2 --joints discs:normal=1,0,0,spread=20,radius=0.1,0.2 --friction 30
expect 0 order "$weather" voxel --bubble disc --format obj builtin:cube --resolution 8 --steps 1 --progress none -o try
try --border open --rockfall --separate-blocks
printf '0 0 0.5, 0 0 1, 0.5\n' > discs.txt
try --rockfall --joints file:path=discs.txt

[ $failed -eq 0 ] && echo "all passed"
exit $failed
