#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
#
# sh cmake/build.sh PROGRAM: installs what the program needs, builds it at full speed, prints its path as the last line.
# PROGRAM is lacuna-run, cartilage, uniaxial or poroelasticity. LACUNA_JOBS says how many compilers run at once.
set -eu

programs="lacuna-run cartilage uniaxial poroelasticity"
root=$(cd "$(dirname "$0")/.." && pwd)
build="$root/build/programs"
jobs=${LACUNA_JOBS:-$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)}

program=${1:-}
known=
meant=
for name in $programs; do
    [ "$program" != "$name" ] || known=yes
    # A word that begins as a name does, or is written with another dash.
    case "$program" in
    ???*) case "$name" in "$program"* | "$(echo "$program" | tr '_A-Z' '-a-z')"*) meant=$name ;; esac ;;
    esac
done
if [ $# -ne 1 ] || [ -z "$known" ]; then
    [ -z "$program" ] || echo "build: '$program' is no program of Lacuna${meant:+ (did you mean $meant?)}" >&2
    echo "usage: sh cmake/build.sh $(echo "$programs" | sed 's/ / | /g')" >&2
    exit 2
fi

sh "$root/cmake/dependencies.sh" "$program" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "configuring" >&2
cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -march=native -DNDEBUG" \
    -DLACUNA_BUILD_TESTS=OFF -DLACUNA_BUILD_BENCH=OFF -DLACUNA_BUILD_EXAMPLES=ON -DLACUNA_PORES=ON >"$log" 2>&1 || {
    cat "$log" >&2
    exit 1
}
echo "building" >&2
cmake --build "$build" --target "$program" -j "$jobs" >&2

path=$(find "$build/examples" -type f -name "$program" -perm -u+x | head -n 1)
[ -n "$path" ] || {
    echo "build: no program '$program' below $build/examples; what cmake said:" >&2
    cat "$log" >&2
    exit 1
}
echo "$path"
