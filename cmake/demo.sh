#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
#
# sh cmake/demo.sh [options of "cartilage run"]: from a fresh machine to pictures of cartilage that cracks under load.
# Without options: the surface zone at 60 MPa. Everything goes to build/programs and demo-output.
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
output="$root/demo-output"

program=$(sh "$root/cmake/build.sh" cartilage | tail -n 1)
[ -n "$program" ] || exit 1

[ $# -gt 0 ] || set -- --zone surface --load 60
rm -rf "$output"
echo "running: cartilage run $*"
"$program" run "$@" --out "$output"

echo "pictures:"
find "$output" -type f \( -name '*.png' -o -name '*.svg' \) | sort | sed 's/^/  /'
