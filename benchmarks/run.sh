#!/bin/sh
# Builds the benchmarks in Release and runs them.
#   sh benchmarks/run.sh [--benchmark_filter=REGEX] [--json FILE] [--avx2] [--no-install] [--build DIR] [--benchmark_...]
#   A filter of plain words (parts, `/`, `^`, `$`, `|`, `.*`) builds only the programs that speak of all of its parts.
#   --json FILE   all results as one JSON array of Google Benchmark reports, one per program
#   --avx2        also build and run every benchmark with -mavx2 -mfma
set -u

root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build-bench
install=yes
json=""
avx2=OFF
filter=.
others=""
while [ $# -gt 0 ]; do
    case $1 in
        --json) shift; json=$1 ;;
        --json=*) json=${1#--json=} ;;
        --avx2) avx2=ON ;;
        --no-install) install=no ;;
        --build) shift; build=$1 ;;
        --benchmark_filter=*) filter=${1#--benchmark_filter=} ;;
        --benchmark_*) others="$others $1" ;;
        -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
        *) echo "benchmarks/run.sh: unknown option $1" >&2; exit 2 ;;
    esac
    shift
done

. "$root/cmake/packages.sh"
need_packages "$install" g++ cmake ninja-build libeigen3-dev librange-v3-dev libboost-graph-dev libbenchmark-dev \
    voro++-dev || exit 1

# Sources of the programs that may hold such a name: each part of one of the alternatives stands in the text. What the
# library adds to names (n:1000, threads:2, real_time, plain numbers) does not. All, where that cannot be told.
sources() {
    case $filter in
        . | -* | *[!A-Za-z0-9_/:^\$.\|*]*) found="" ;;
        *) found=$(
            for source in "$root"/benchmarks/*/*.bench.cpp; do
                # Alternatives by line, parts by word.
                printf '%s\n' "$filter" | tr '|' '\n' | sed -e 's/\.\*/ /g' -e 's/[\/^$]/ /g' | while read -r parts; do
                    all=yes
                    for part in $parts; do
                        case $part in
                            *:* | *[!0-9]*_time | *[*.]*) continue ;;
                            *[!0-9]*) grep -v '^#include' "$source" | grep -qF -e "$part" || all=no ;;
                        esac
                    done
                    [ $all = no ] || echo "$source"
                done
            done | sort -u
        ) ;;
    esac
    [ -n "$found" ] && echo "$found" || ls "$root"/benchmarks/*/*.bench.cpp
}
programs=$(sources | sed -e 's/\.bench\.cpp$//' -e 's|.*/\([^/]*\)/\([^/]*\)$|bench_\1_\2|')
[ $avx2 = OFF ] || programs="$programs $(echo "$programs" | sed 's/$/_avx2/')"

# shellcheck disable=SC2086
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=g++ \
    -DTAFONI_BUILD_TESTS=OFF -DTAFONI_BUILD_EXAMPLES=OFF -DTAFONI_BUILD_BENCHMARKS=ON -DTAFONI_BENCH_AVX2=$avx2 \
    > "$build.log" 2>&1 && cmake --build "$build" --target $programs >> "$build.log" 2>&1
status=$?
[ $status -eq 0 ] || { grep -E -A5 'error|Error|FAILED' "$build.log" | head -n 60; exit 1; }
rm -f "$build.log"

reports=$build/reports
rm -rf "$reports"
mkdir -p "$reports"
for name in $programs; do
    program=$build/benchmarks/$name
    [ -x "$program" ] && [ -f "$program" ] || continue
    # A program whose benchmarks the filter leaves out has nothing to say.
    [ -n "$("$program" --benchmark_list_tests --benchmark_filter="$filter" 2> /dev/null)" ] || continue
    echo "== $name"
    # shellcheck disable=SC2086
    "$program" --benchmark_filter="$filter" --benchmark_out="$reports/$name.json" --benchmark_out_format=json \
        --benchmark_counters_tabular=true $others || status=1
done

if [ -n "$json" ]; then
    {
        separator="["
        for report in "$reports"/*.json; do
            [ -s "$report" ] || continue
            printf '%s\n' "$separator"
            cat "$report"
            separator=","
        done
        [ "$separator" = "," ] || printf '['
        printf ']\n'
    } > "$json"
fi
exit $status
