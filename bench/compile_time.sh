#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
#
# sh bench/compile_time.sh [--rounds N] [--json]
#
# Median seconds to compile a program with one simulator, without and with fluid, at -O0 and at -O3 -march=native.
# CXX is the compiler (g++). CXXFLAGS may add include paths of Eigen and nanoflann.
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
compiler=${CXX:-g++}
rounds=3 json=0
while [ $# -gt 0 ]; do
    case "$1" in
    --rounds) rounds=${2:?--rounds needs a number} && shift ;;
    --json) json=1 ;;
    *)
        sed -n '4,7s/^# \{0,1\}//p' "$0" >&2
        exit 2
        ;;
    esac
    shift
done

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM

cat >"$scratch/dry.cpp" <<'END'
#include <lacuna/simulation.hpp>
int main() {
    lacuna::packing<double, 2> body;
    body.add({0, 0}, 0.5);
    body.add({1, 0}, 0.5);
    body.bonds.push_back({0, 1});
    lacuna::simulation<lacuna::default_model<2>> sim(body);
    sim.run(1000);
    return sim.kinetic_energy() > 0;
}
END
cat >"$scratch/fluid.cpp" <<'END'
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation.hpp>
struct coupled : lacuna::default_model<2> {
    using flow = lacuna::explicit_flow;
};
int main() {
    lacuna::packing<double, 2> body;
    body.add({0, 0}, 0.5);
    body.add({1, 0}, 0.5);
    body.add({0.5, 0.9}, 0.5);
    lacuna::simulation<coupled> sim(body);
    sim.fill_pores([](auto points, double const* radii) {
        return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii);
    });
    sim.run(1000);
    return sim.kinetic_energy() > 0;
}
END

for level in -O0 "-O3 -march=native"; do
    for program in dry fluid; do
        round=1
        while [ "$round" -le "$rounds" ]; do
            start=$(date +%s.%N)
            # shellcheck disable=SC2086 # lists of options
            "$compiler" -std=c++20 $level ${CXXFLAGS:-} -I"$root/include" -I/usr/include/eigen3 -c "$scratch/$program.cpp" \
                -o "$scratch/$program.o"
            echo "$program|$level|$start $(date +%s.%N)"
            round=$((round + 1))
        done
    done
done >"$scratch/times"

awk -F'|' -v json="$json" -v compiler="$compiler" '
{
    split($3, at, " ")
    key = $1 "|" $2
    if (!(key in count)) order[++keys] = key
    value[key, ++count[key]] = at[2] - at[1]
}
END {
    if (json) printf "["
    for (k = 1; k <= keys; ++k) {
        key = order[k]
        n = count[key]
        for (i = 2; i <= n; ++i)
            for (j = i; j > 1 && value[key, j - 1] > value[key, j]; --j) {
                swap = value[key, j]; value[key, j] = value[key, j - 1]; value[key, j - 1] = swap
            }
        median = (value[key, int((n + 1) / 2)] + value[key, int(n / 2) + 1]) / 2
        split(key, name, "|")
        if (json)
            printf "%s\n  {\"program\": \"%s\", \"compiler\": \"%s\", \"flags\": \"%s\", \"seconds\": %.3f}",
                (k > 1 ? "," : ""), name[1], compiler, name[2], median
        else
            printf "%-6s %-18s %6.2f s\n", name[1], name[2], median
    }
    if (json) printf "\n]\n"
}' "$scratch/times"
