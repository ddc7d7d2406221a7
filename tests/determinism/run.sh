#!/bin/sh
# Builds the golden program with both compilers at three levels, and with AVX2 where the CPU has it;
# all must print tests/determinism/golden.txt.   sh tests/determinism/run.sh BUILD_DIR
set -u
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
out=$1
mkdir -p "$out"

levels="-O0 -O2 -O3"
if grep -q -w avx2 /proc/cpuinfo && grep -q -w fma /proc/cpuinfo; then
    levels="$levels -O3,-mavx2,-mfma"
fi
launcher=""
command -v ccache > /dev/null 2>&1 && launcher=ccache

status=0
for compiler in g++ clang++-19; do
    for level in $levels; do
        name=$compiler$(echo "$level" | tr -d ',')
        # shellcheck disable=SC2046
        if ! $launcher "$compiler" -std=c++20 $(echo "$level" | tr ',' ' ') -ffp-contract=off -pthread \
            -I "$root/include" -I "$root/tests" -isystem /usr/include/eigen3 \
            -c "$here/golden.cpp" -o "$out/$name.o" || ! "$compiler" -pthread "$out/$name.o" -o "$out/$name"; then
            echo "$name: does not build"
            status=1
        elif ! "$out/$name" > "$out/$name.txt"; then
            echo "$name: does not run"
            status=1
        elif ! diff "$here/golden.txt" "$out/$name.txt"; then
            echo "$name: other bits (< golden.txt, > $name)"
            status=1
        else
            echo "$name: same bits"
        fi
    done
done
exit $status
