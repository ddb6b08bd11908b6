#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
#
# sh cmake/demo.sh [options of "cartilage run"]: from a fresh machine to pictures of cartilage that cracks under load.
# Without options: the surface zone at 60 MPa. Everything goes to build/demo and demo-output.
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
build="$root/build/demo"
output="$root/demo-output"
jobs=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)

sh "$root/cmake/dependencies.sh" demo

echo "configuring"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -march=native -DNDEBUG" \
    -DLACUNA_BUILD_TESTS=OFF -DLACUNA_BUILD_BENCH=OFF -DLACUNA_BUILD_EXAMPLES=ON -DLACUNA_PICTURES=ON -DLACUNA_PORES=ON \
    >"$log" 2>&1 || {
    cat "$log" >&2
    exit 1
}
echo "building"
cmake --build "$build" --target cartilage -j "$jobs"

program=$(find "$build/examples" -type f -name cartilage -perm -u+x | head -n 1)
[ -n "$program" ] || {
    echo "demo: no program 'cartilage' below $build/examples" >&2
    exit 1
}

[ $# -gt 0 ] || set -- --zone surface --load 60
rm -rf "$output"
echo "running: cartilage run $*"
"$program" run "$@" --out "$output"

echo "pictures:"
find "$output" -type f \( -name '*.png' -o -name '*.svg' \) | sort | sed 's/^/  /'
