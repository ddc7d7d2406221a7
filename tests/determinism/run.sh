#!/bin/sh
# Builds the golden program with both compilers at three levels, and with AVX2 where the CPU has it; all must
# print tests/determinism/golden.txt.
#   sh tests/determinism/run.sh BUILD_DIR [JOBS] [--accept | --ends]
#   --ends     only without optimisation and with all of it
#   --accept   when all variants agree with each other, their answer becomes golden.txt (say why in the commit)
set -u
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
out=$1
jobs=${2:-$(nproc)}
choice=${3:-}
mkdir -p "$out"
rm -f "$out"/*.txt

levels="-O0 -O2 -O3"
if grep -q -w avx2 /proc/cpuinfo && grep -q -w fma /proc/cpuinfo; then
    levels="$levels -O3,-mavx2,-mfma"
fi
[ "$choice" = --ends ] && levels="-O0 ${levels##* }"

for compiler in g++ clang++-19; do
    for level in $levels; do
        echo "$compiler $level"
    done
done | ROOT=$root OUT=$out xargs -P "$jobs" -n 2 sh -c '
    name=$0$(echo "$1" | tr -d ,)
    launcher=$(command -v ccache)
    $launcher "$0" -std=c++20 $(echo "$1" | tr , " ") -ffp-contract=off -pthread -I "$ROOT/include" -I "$ROOT/tests" \
        -isystem /usr/include/eigen3 -c "$ROOT/tests/determinism/golden.cpp" -o "$OUT/$name.o" &&
        "$0" -pthread "$OUT/$name.o" -o "$OUT/$name" && "$OUT/$name" > "$OUT/$name.part" &&
        mv "$OUT/$name.part" "$OUT/$name.txt"'

golden=$here/golden.txt
[ "$choice" = --accept ] && golden=$out/g++-O2.txt
status=0
for compiler in g++ clang++-19; do
    for level in $levels; do
        name=$compiler$(echo "$level" | tr -d ',')
        if [ ! -f "$out/$name.txt" ]; then
            echo "$name: does not build or run"
            status=1
        elif ! diff "$golden" "$out/$name.txt"; then
            echo "$name: other bits (< $(basename "$golden"), > $name)"
            status=1
        else
            echo "$name: same bits"
        fi
    done
done
if [ "$choice" = --accept ] && [ $status -eq 0 ]; then
    cp "$golden" "$here/golden.txt"
fi
exit $status
