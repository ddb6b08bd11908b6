#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
#
# sh cmake/dependencies.sh PROGRAM|documentation|bench|check|coverage|nightly [more Debian packages]: installs the packages
# that are missing on Debian or Ubuntu, as root or through sudo; does nothing when all are there. LACUNA_SKIP_DEPENDENCIES=1
# skips it.
set -eu

case "${1:-}" in
cartilage)
    wanted="g++ make cmake libeigen3-dev libnanoflann-dev libqhull-dev libcairo2-dev libcli11-dev
        nlohmann-json3-dev libcereal-dev"
    ;;
lacuna-run)
    wanted="g++ make cmake libeigen3-dev libnanoflann-dev libqhull-dev libcairo2-dev libcli11-dev
        libtomlplusplus-dev libcereal-dev zlib1g-dev"
    ;;
uniaxial)
    wanted="g++ make cmake libeigen3-dev libnanoflann-dev libqhull-dev libcairo2-dev libcli11-dev
        nlohmann-json3-dev"
    ;;
poroelasticity)
    wanted="g++ make cmake libeigen3-dev libnanoflann-dev libqhull-dev libcairo2-dev libcli11-dev"
    ;;
documentation)
    wanted="g++ make cmake libeigen3-dev libnanoflann-dev doxygen libjs-mathjax"
    ;;
bench)
    wanted="g++ make cmake libeigen3-dev libnanoflann-dev libqhull-dev libbenchmark-dev"
    ;;
check)
    wanted="g++ make cmake libeigen3-dev libnanoflann-dev libqhull-dev libcairo2-dev libcli11-dev
        libtomlplusplus-dev nlohmann-json3-dev libcereal-dev libnlopt-dev zlib1g-dev catch2 libbenchmark-dev
        python3-vtk9 doxygen libjs-mathjax"
    # Ubuntu has no packages of these names. Without them a test looks at no report in a browser, another tries no newer compiler,
    # a third counts no lines of functions.
    if [ -r /etc/os-release ] && grep -q '^ID=debian' /etc/os-release; then wanted="$wanted chromium clang-19 clang-tidy"; fi
    ;;
# What the presets of these names take beside `check`.
coverage)
    shift
    exec sh "$0" check gcovr "$@"
    ;;
nightly)
    shift
    exec sh "$0" check clang libomp-dev "$@"
    ;;
*)
    echo "usage: sh cmake/dependencies.sh cartilage|lacuna-run|uniaxial|poroelasticity|documentation|bench|check|coverage|nightly" \
        "[more Debian packages]" >&2
    exit 2
    ;;
esac
shift

[ "${LACUNA_SKIP_DEPENDENCIES:-0}" = 0 ] || exit 0

if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
    echo "dependencies: not a Debian system; this is needed:" >&2
    # shellcheck disable=SC2086 # a list of packages
    printf '  %s\n' $wanted "$@" >&2
    exit 0
fi

missing=
for package in $wanted "$@"; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" = 0 ]; then
    as_root=
elif command -v sudo >/dev/null 2>&1; then
    as_root=sudo
else
    echo "dependencies: neither root nor sudo; please install:$missing" >&2
    exit 1
fi

echo "dependencies: installing$missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Acquire::Retries=3 -o DPkg::Lock::Timeout=120 "$@" \
        >"$log" 2>&1
}

attempt=1
while :; do
    # A failed update is not the end: the lists that are there may do.
    apt update || true
    # shellcheck disable=SC2086 # a list of packages
    if apt install --no-install-recommends $missing; then
        break
    fi
    if [ "$attempt" -ge 3 ]; then
        cat "$log" >&2
        echo "dependencies: could not install:$missing" >&2
        exit 1
    fi
    echo "dependencies: attempt $attempt failed, again in $((attempt * 5)) s" >&2
    sleep $((attempt * 5))
    attempt=$((attempt + 1))
done
