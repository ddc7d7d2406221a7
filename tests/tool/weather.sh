#!/bin/sh
# What the tool `weather` promises: exit codes, keys of the report, equal bytes for equal runs, resuming.
#   sh tests/tool/weather.sh PATH/TO/weather EMPTY/FOLDER
. "$(dirname "$0")/promises.sh"

# usage: 2
expect 2 no_command "$weather"
expect 2 no_output "$weather" frost builtin:outcrop
expect 2 unknown_option "$weather" frost builtin:outcrop -o x --unknown 1
expect 2 bad_range "$weather" frost builtin:outcrop -o x --jitter 1.5
expect 2 bad_number "$weather" frost builtin:outcrop -o x --water nan
expect 2 zero_gravity "$weather" frost builtin:outcrop -o x --gravity 0,0,0
expect 2 bad_vector "$weather" frost builtin:outcrop -o x --rain 1,2
expect 2 bad_builtin "$weather" frost builtin:moon -o x
expect 2 bad_format "$weather" frost builtin:outcrop -o x --format xyz
expect 2 unknown_key "$weather" frost builtin:outcrop:resolution=8 -o x --shards 20 --resistance noise:colour=3
says unknown_key "known: wavelength"
expect 2 unknown_site "$weather" frost builtin:outcrop:resolution=8 -o x --sites nosuch
expect 2 out_of_range "$weather" frost builtin:outcrop:resolution=8 -o x --shards 20 --resistance constant:value=1.5
expect 0 help "$weather" frost --help
expect 0 version "$weather" --version

# bad input: 1, and nothing is made
: > plain_file
expect 1 below_a_file "$weather" frost no_such_file.obj -o plain_file/out
says below_a_file "cannot be made a folder"
expect 1 checkpoint_below "$weather" frost no_such_file.obj -o none --checkpoint plain_file/state
says checkpoint_below plain_file
expect 1 missing "$weather" frost no_such_file.obj -o none
says missing no_such_file.obj
expect 1 directory "$weather" frost . -o none
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > open.obj
expect 1 open_mesh "$weather" frost open.obj -o none
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n' > index.obj
expect 1 bad_index "$weather" frost index.obj -o none
says bad_index "index.obj:4:7"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' > corner.obj
expect 1 no_water "$weather" frost corner.obj -o none --shards 20 --rain 0,0,1
says no_water "no water enters"
[ ! -e none ] || complain "a refused run made its folder"

# a run, its files and its report
part="--shards 150 --snapshots 2000 --core bottom:share=0.1 --spread 30 --format obj,ply,stl,vtp --progress none"
small="$part --paths 6000"
rock=builtin:outcrop:resolution=12
# shellcheck disable=SC2086
expect 0 first "$weather" frost $rock -o first $small --checkpoint end1
for file in weathered.obj weathered.ply weathered.stl weathered.vtp blocks.vtp blocks.json history.csv report.json \
    snapshots/frost.pvd snapshots/frost_00000000.vtp snapshots/frost_00006000.vtp; do
    [ -s "first/$file" ] || complain "first/$file is missing or empty"
done
for key in schema version seed parameters threads stopped repaired cells sites links_interior links_exterior volume_solid \
    volume_cells paths links_broken cells_detached volume_detached seconds read shards graphs weather write; do
    grep -q "\"$key\":" first/report.json || complain "report.json has no $key"
done
[ "$(number first paths)" = 6000 ] || complain "paths is not 6000"
[ "$(number first links_broken)" -gt 0 ] || complain "nothing broke"
[ "$(number first cells_detached)" -gt 0 ] || complain "nothing fell"
awk -v a="$(number first volume_solid)" -v b="$(number first volume_cells)" 'BEGIN { exit !(a > 0 && (a - b)^2 < (1e-9 * a)^2) }' ||
    complain "the shards do not fill the solid"
tail -1 first/history.csv | grep -q "^6000,$(number first links_broken),$(number first cells_detached)," ||
    complain "the history does not end as the report"

# equal runs and thread counts
# shellcheck disable=SC2086
{
    expect 0 again "$weather" frost $rock -o again $small --threads 3 --checkpoint end2
    same first again
    cmp end1 end2 || complain "checkpoints differ"
    expect 0 batch1 "$weather" frost $rock -o batch1 $small --batch 16
    expect 0 batch2 "$weather" frost $rock -o batch2 $small --batch 16 --threads 4
    same batch1 batch2
    expect 0 seed "$weather" frost $rock -o seed $small --seed 9
    cmp -s first/weathered.obj seed/weathered.obj && complain "the seed changes nothing"
}

# resumed runs equal uninterrupted ones
# shellcheck disable=SC2086
{
    expect 0 half "$weather" frost $rock -o resumed $part --paths 3000 --checkpoint half.bin
    expect 0 rest "$weather" frost $rock -o resumed $small --resume half.bin
    cmp first/weathered.vtp resumed/weathered.vtp || complain "a resumed run ends differently"
    cmp first/blocks.json resumed/blocks.json || complain "a resumed run drops other blocks"
    cmp first/snapshots/frost.pvd resumed/snapshots/frost.pvd || complain "a resumed series differs"
    expect 1 other_seed "$weather" frost $rock -o none $small --seed 2 --resume half.bin
    expect 1 other_water "$weather" frost $rock -o none $small --water 2 --resume half.bin
    expect 1 other_core "$weather" frost $rock -o none $small --core bottom:share=0.3 --resume half.bin
    expect 2 too_few "$weather" frost $rock -o none $part --paths 10 --resume half.bin
    head -c 100 half.bin > cut.bin
    expect 1 truncated "$weather" frost $rock -o none $small --resume cut.bin
    [ ! -e none ] || complain "a refused resume made its folder"
}

# a folder that is used again holds nothing of the older run, and keeps what others put there
expect 0 old_run "$weather" frost $rock -o reused --shards 40 --paths 60 --snapshots 20 --format obj,ply,vtp --separate-blocks --graphs
: > reused/notes.txt
: > reused/snapshots/frost_mine.vtp
expect 0 new_run "$weather" frost $rock -o reused --shards 40 --paths 30 --snapshots 15 --format vtp
expect 0 clean_run "$weather" frost $rock -o clean --shards 40 --paths 30 --snapshots 15 --format vtp
for file in notes.txt snapshots/frost_mine.vtp; do [ -e reused/$file ] || complain "a run removed $file"; done
rm -rf reused/notes.txt reused/snapshots/frost_mine.vtp
rmdir reused/blocks 2> /dev/null
same reused clean

# a run that is killed goes on from its last snapshot
grown="--shards 60 --core bottom:share=0.2 --spread 30 --format vtp"
# shellcheck disable=SC2086
{
    "$weather" frost $rock -o killed $grown --paths 2000000000 --snapshots 2000 --checkpoint killed.bin 2> killed.log &
    child=$!
    tries=0
    until [ -s killed.bin ] || [ $tries -gt 300 ]; do sleep 0.1; tries=$((tries + 1)); done
    kill -KILL $child
    wait $child 2> /dev/null
    reached=$(ls killed/snapshots | sed -n 's/^frost_0*\([0-9]*\)\.vtp$/\1/p' | sort -n | tail -1)
    end=$((reached + 4000))
    expect 0 raised "$weather" frost $rock -o killed $grown --paths $end --snapshots 2000 --resume killed.bin
    expect 0 unkilled "$weather" frost $rock -o unkilled $grown --paths $end --snapshots 2000
    cmp killed/weathered.vtp unkilled/weathered.vtp || complain "going on after a kill ends differently"
    diff -r -x '.tafoni-*.tmp' killed/snapshots unkilled/snapshots || complain "the snapshots after a kill differ"
}

# rough breaks change the surface, not what happens
# shellcheck disable=SC2086
expect 0 rough "$weather" frost $rock -o rough $small --roughness 0.1
cmp first/history.csv rough/history.csv || complain "roughness changes what falls"
cmp -s first/weathered.obj rough/weathered.obj && complain "roughness changes nothing"

# Ctrl-C: 130 and a checkpoint that goes on to the same end
long="--shards 60 --core bottom:share=0.2 --spread 30 --format obj --progress json"
# shellcheck disable=SC2086
"$weather" frost $rock -o stopped $long --paths 2000000000 --water 0.01 2> stopped.log &
child=$!
tries=0
until grep -q '"weather"' stopped.log 2> /dev/null || [ $tries -gt 300 ]; do sleep 0.1; tries=$((tries + 1)); done
kill -INT $child
wait $child
code=$?
[ $code -eq 130 ] || { complain "Ctrl-C: exit code $code, expected 130"; tail -3 stopped.log; }
[ -s stopped/frost.checkpoint ] || complain "Ctrl-C wrote no checkpoint"
grep -q '"stopped": "interrupted"' stopped/report.json || complain "the report does not say that it was stopped"
done_paths=$(number stopped paths)
# shellcheck disable=SC2086
if [ -n "$done_paths" ] && [ "$done_paths" -lt 20000000 ]; then
    expect 0 gone_on "$weather" frost $rock -o stopped $long --water 0.01 --paths $((done_paths + 500)) --resume stopped/frost.checkpoint
    expect 0 straight "$weather" frost $rock -o straight $long --water 0.01 --paths $((done_paths + 500))
    cmp stopped/weathered.obj straight/weathered.obj || complain "going on after Ctrl-C ends differently"
fi

# repairs are counted
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n' > inside_out.obj
printf '0.2 0.2 0.2\n0.2 0.2 0.2\n0.1,0.3,0.1\n' > points.txt
expect 0 repaired "$weather" frost inside_out.obj -o repaired --sites points.txt --paths 10
[ "$(number repaired turned_faces)" = 4 ] || complain "turned faces are not counted"
[ "$(number repaired merged_sites)" = 1 ] || complain "merged sites are not counted"
[ "$(number repaired cells)" = 2 ] || complain "two sites do not make two shards"

# terrain: sides and base are core by default
printf 'ncols 5\nnrows 4\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nNODATA_value -9999\n' > hill.asc
printf '5 6 9 8 7\n7 12 20 11 8\n6 14 25 -9999 7\n5 8 9 7 6\n' >> hill.asc
expect 0 terrain "$weather" frost hill.asc -o terrain --shards 60 --paths 300 --format ply
[ "$(number terrain cells_core)" -gt 0 ] || complain "no cell of a terrain is core"

# every SPEC is understood
for sites in random surface grid hex:layers=2,axis=0.1,0,1 slabs:spacings=0.5,0.9 joints:turn=20,flat=2 poisson:ratio=3 vertices points.txt; do
    expect 0 sites "$weather" frost "$([ "$sites" = points.txt ] && echo inside_out.obj || echo $rock)" -o sites --shards 40 --sites "$sites" --paths 20 --format obj
done
printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\nABCDEFGH' > grid.nrrd
for field in constant:value=0.3 layers:values=0.2,0.9,fold=0.2 layers:tops=1,2,values=0.1,0.5,0.9 sine:wavelength=0.7 ramp \
    pockets:count=3 noise:octaves=2 grid:path=grid.nrrd; do
    expect 0 field "$weather" frost $rock -o field --shards 40 --resistance "$field" --paths 20 --format obj
done
printf '0 1, 2\n3\n' > cells.txt
for cells in none plane:point=0,0,1 box:lo=-9,-9,0,hi=9,9,1 bottom exterior exterior-except:direction=0,-1,0,angle=60 \
    file:path=cells.txt file:path=inside_out.obj; do
    expect 0 core "$weather" frost $rock -o core --shards 40 --core "$cells" --paths 20 --format obj
    expect 0 air "$weather" frost $rock -o air --shards 40 --air "$cells" --core artificial --paths 0 --format obj
done
expect 0 addon "$weather" frost $rock -o addon --shards 40 --preset addon --paths 200 --format obj --separate-blocks --graphs
for file in links.vtp bonds.vtp paths.vtp; do [ -s addon/$file ] || complain "addon/$file is missing"; done

[ $failed -eq 0 ] && echo "all passed"
exit $failed
