#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
#
# sh cmake/check.sh: dependencies, configure, build, all tests.
#   --preset dev|release|clang|asan   which preset of CMakePresets.json (dev; asan runs the unit tests only)
#   --compiler g++|clang++            another compiler (preset clang: clang++)
#   --strict                          warnings are errors
#   --jobs N                          how many at once (LACUNA_JOBS, else the number of processors)
set -eu

usage() {
    sed -n '4,8s/^# \{0,1\}//p' "$0" >&2
    exit 2
}

preset=dev
compiler=
strict=OFF
jobs=${LACUNA_JOBS:-$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)}
while [ $# -gt 0 ]; do
    case "$1" in
    --strict)
        strict=ON
        shift
        continue
        ;;
    esac
    [ $# -ge 2 ] || usage
    case "$1" in
    --preset) preset=$2 ;;
    --compiler) compiler=$2 ;;
    --jobs) jobs=$2 ;;
    *) usage ;;
    esac
    shift 2
done
case "$preset" in dev | release | clang | asan) ;; *) usage ;; esac
case "$compiler" in "" | g++ | clang++) ;; *) usage ;; esac
[ "$preset" != clang ] || compiler=clang++

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"

if [ "$compiler" = clang++ ]; then
    # libomp: clang's own runtime for loops over several threads.
    sh cmake/dependencies.sh check clang libomp-dev
    [ "$preset" != dev ] || preset=clang
else
    sh cmake/dependencies.sh check
fi

build="build/$preset"
set -- --preset "$preset" -D "LACUNA_WERROR=$strict" -D LACUNA_TEST_UNITY=ON
if [ -n "$compiler" ] && [ "$preset" != clang ]; then
    build="$build-$compiler"
    set -- "$@" -B "$build" -D "CMAKE_CXX_COMPILER=$compiler"
fi
cmake "$@"
cmake --build "$build" -j "$jobs"

set -- --test-dir "$build" --output-on-failure --no-tests=error -j "$jobs"
case "$preset" in
asan | clang)
    export ASAN_OPTIONS="${ASAN_OPTIONS:-detect_stack_use_after_return=1}"
    export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"
    ;;
esac
case "$preset" in
asan) set -- "$@" -L unit ;;
# What does not depend on the compiler was seen with g++.
clang) set -- "$@" -LE "once|package" ;;
esac
ctest "$@"
