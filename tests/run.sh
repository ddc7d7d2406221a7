#!/bin/sh
# Builds and passes the tests on Debian 12.
#   sh tests/run.sh            everything that fits into half an hour on two cores
#   sh tests/run.sh --fast     the quick tests with g++ only, for the inner loop
#   sh tests/run.sh --full     also what the plain run leaves out
#   --no-install   never call apt-get      --jobs N   parallel jobs (default: all cores)
#   --build DIR    where to build (default: build)
set -u

root=$(cd "$(dirname "$0")/.." && pwd)
mode=plain
install=yes
jobs=$(nproc)
build=$root/build
while [ $# -gt 0 ]; do
    case $1 in
        --fast) mode=fast ;;
        --full) mode=full ;;
        --no-install) install=no ;;
        --jobs) shift; jobs=$1 ;;
        --build) shift; build=$1 ;;
        -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
        *) echo "tests/run.sh: unknown option $1" >&2; exit 2 ;;
    esac
    shift
done

. "$root/cmake/packages.sh"
packages="g++ cmake ninja-build catch2 libeigen3-dev librange-v3-dev libboost-graph-dev libcli11-dev nlohmann-json3-dev libpng-dev"
[ $mode = fast ] || packages="$packages clang-19 libclang-rt-19-dev"
[ $mode = full ] && packages="$packages libbenchmark-dev"
need_packages "$install" $packages || exit 1
# The tests of interop/ run where these are; nothing else needs them.
[ $mode = fast ] || need_packages "$install" libopenvdb-dev libopenmesh-dev libcgal-dev 2> /dev/null || :

mkdir -p "$build"
build=$(cd "$build" && pwd)
logs=$build/logs
rm -rf "$logs"
mkdir -p "$logs"
passed=0
failed=0
broken=""
left_out=""
start=$(date +%s)

# Seconds since the start, and processor seconds of all that ran so far: those do not depend on the machine's load.
say() {
    times > "$logs/times"
    cpu=$(awk 'NR == 2 { gsub(/[ms]/, " "); $0 = $0; print int(60 * $1 + $2 + 60 * $3 + $4) }' "$logs/times")
    printf '[%4ds, cpu %5ds] %s\n' $(($(date +%s) - start)) "$cpu" "$*"
}
count() { # name status
    if [ "$2" -eq 0 ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        broken="$broken $1"
    fi
}
step() { # name command...: one pass or fail
    name=$1
    shift
    say "$name"
    "$@" > "$logs/$name.log" 2>&1
    status=$?
    count "$name" $status
    [ $status -eq 0 ] || grep -v -E '^\[[0-9]+/[0-9]+\]' "$logs/$name.log" | grep -E -A5 'error|Error|FAILED' | head -n 60
    return $status
}
tests() { # preset ctest-arguments...: every Catch case or program counts
    preset=$1
    shift
    say "$preset: ctest $*"
    (cd "$build/$preset" && ctest -j "$jobs" --output-on-failure "$@") > "$logs/$preset-ctest.log" 2>&1
    status=$?
    sum=$(awk -f "$root/tests/support/count.awk" "$build/$preset/Testing/Temporary/LastTest.log" 2> /dev/null)
    sum=${sum:-0 1}  # nothing to test where the build was not even configured
    not_run=$(grep -c '\*\*\*Not Run' "$logs/$preset-ctest.log")
    bad=$((${sum#* } + not_run))
    [ $status -eq 0 ] || [ $bad -gt 0 ] || bad=1
    passed=$((passed + ${sum% *}))
    failed=$((failed + bad))
    if [ $status -ne 0 ]; then
        broken="$broken $preset-ctest"
        grep -v -E ' Passed |^ *Start +[0-9]+|^(/|[a-z/_]+/tests/|Could not find|Looked in)' "$logs/$preset-ctest.log" | head -n 300
    fi
}
configured() { # preset cmake-arguments...
    preset=$1
    shift
    step "$preset-configure" cmake -S "$root" -B "$build/$preset" --preset "$preset" "$@"
}
# A file that does not compile fails its own tests, and those of the files that it is compiled with, and no others.
built() { # preset targets...
    preset=$1
    shift
    step "$preset-build" cmake --build "$build/$preset" -j "$jobs" --target "$@" -- -k 0
}

# Short cuts for the compiler, none of them with --full: tests at -Og (half of the time that -O2 takes), related ones as
# one unit, and g++ clears up behind itself only above a gigabyte.
if [ $mode = full ]; then
    group=-DTAFONI_GROUP_TESTS=OFF
    set -- -DTAFONI_VERIFY_DETAILS=ON -DTAFONI_TEST_FLAGS= -DCMAKE_CXX_FLAGS= $group
else
    group=-DTAFONI_GROUP_TESTS=ON
    set -- -DTAFONI_TEST_FLAGS=-Og "-DCMAKE_CXX_FLAGS=--param=ggc-min-heapsize=1000000" $group
fi

if [ $mode = fast ]; then
    configured gcc -DTAFONI_BUILD_EXAMPLES=OFF "$@"
    built gcc all
    tests gcc -L fast
    left_out="slow tests, examples, compile-fail cases, header self-containment, consumer, clang, golden bits, sanitizers, fuzzing"
else
    configured gcc -DTAFONI_BUILD_EXAMPLES=ON "$@"
    built gcc all $([ $mode = full ] && echo all_verify_interface_header_sets || echo tafoni_check_headers)
    step include-arrows cmake -P "$root/cmake/arrows.cmake"
    step umbrella cmake -DCHECK=ON -P "$root/cmake/umbrella.cmake"
    tests gcc

    for compiler in g++ clang++-19; do
        step "consumer-$compiler" sh "$root/tests/consumer/run.sh" "$compiler" "$build/consumer-$compiler" \
            $([ $mode$compiler = plainclang++-19 ] && echo --installed)
    done
    step golden sh "$root/tests/determinism/run.sh" "$build/golden" "$jobs" $([ $mode = full ] || echo --ends)

    if [ $mode = full ]; then
        configured clang
        built clang all all_verify_interface_header_sets
        tests clang
        configured bench
        built bench all
    else
        left_out="the plain clang build (its fast tests ran under the sanitizers), slow tests with clang, the tests at -O2 and each file as
a unit of its own, golden bits at -O2 and at -O3 without AVX2, headers on their own without Eigen, those of detail/ on their own,
the consumer by sources with clang, under the sanitizers the paper's scenes, real data, foreign libraries, random cases, and what
reliability/ says of parameters and environment, the checks of pointers for null, alignment, size, type and overflow, fuzzing of
whole algorithms, benchmarks"
    fi

    if [ $mode = full ]; then
        configured asan-ubsan $group -DTAFONI_LEAVE_OUT_TESTS= -DTAFONI_FUZZ_ALGORITHMS=ON -DTAFONI_FUZZ_SEED=0 \
            "-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined -fno-sanitize-recover=all"
    else
        configured asan-ubsan $group
    fi
    built asan-ubsan all
    if [ $mode = full ]; then
        tests asan-ubsan -L 'fast|slow|compile_fail|fuzz'
    else
        tests asan-ubsan -L 'fast|compile_fail|fuzz'
    fi
    configured tsan $group
    built tsan all
    tests tsan -L threads
fi

# What this machine lacks is said, never silently passed over.
lacking=$(sed -n 's/^-- \(.* is left out: .*\)/\1/p' "$logs/gcc-configure.log"
    grep -s -E '^ *skipped' "$build/gcc/Testing/Temporary/LastTest.log" | sort | uniq -c)
[ -z "$lacking" ] || left_out="${left_out:+$left_out
}$lacking"

[ -z "$broken" ] || echo "failed in:$broken (logs in $logs)"
[ -z "$left_out" ] || echo "left out: $left_out"
say "done"
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
