#!/bin/sh
# Installs the library and builds the consumer against it, then again by add_subdirectory.
#   sh tests/consumer/run.sh COMPILER BUILD_DIR [--installed]
#   --installed   only the first
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
compiler=$1
out=$2
rm -rf "$out"

cmake -S "$root" -B "$out/library" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_INSTALL_PREFIX="$out/prefix" \
    -DTAFONI_BUILD_TESTS=OFF -DTAFONI_BUILD_BENCHMARKS=OFF -DTAFONI_BUILD_EXAMPLES=OFF
cmake --install "$out/library"

# Some warnings only come with optimisation, so once with and once without.
cmake -S "$here" -B "$out/by_package" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS=-O2 \
    -DCMAKE_PREFIX_PATH="$out/prefix"
cmake --build "$out/by_package"
(cd "$out/by_package" && ctest --output-on-failure --no-tests=error)

[ "${3:-}" = --installed ] && exit 0
cmake -S "$here" -B "$out/by_sources" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DBY_SOURCES=ON -DTAFONI_SOURCES="$root"
cmake --build "$out/by_sources"
(cd "$out/by_sources" && ctest --output-on-failure --no-tests=error)
