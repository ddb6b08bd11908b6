#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
#
# sh bench/compare.sh [--quick] [--million] [--three] [--json]
#
# Compares Lacuna with LAMMPS (gran/hooke/history: friction, no bonds) on the same sheets, alternating on one core in
# several rounds. Prints medians: particle-steps/s of both, their ratio, and our ns per pair and peak memory.
#   --quick    fewer and shorter rounds, double precision only: under 50 s after the build
#   --million  also a fully bonded sheet of 1,000,000
#   --three    blocks of spheres instead of sheets: workloads full3 and frictional3
#   --json     prints a list of objects instead of a table: work, particles, real, ours, lammps, ratio, ns_per_pair,
#              rss_mb
# LAMMPS always runs its frictional sheet or block, for each of our workloads. Without LAMMPS, lammps and ratio are null.
# Exit status 1 if a workload fails its physics checks; it does not depend on times.
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
build="$root/build/compare"
quick=0 million=0 json=0 three=0
for option in "$@"; do
    case "$option" in
    --quick) quick=1 ;;
    --million) million=1 ;;
    --three) three=1 ;;
    --json) json=1 ;;
    *)
        sed -n '4,16s/^# \{0,1\}//p' "$0" >&2
        exit 2
        ;;
    esac
done

say() { echo "compare: $*" >&2; }

sh "$root/cmake/dependencies.sh" bench >&2
command -v lmp >/dev/null 2>&1 || sh "$root/cmake/dependencies.sh" bench lammps >&2 || say "LAMMPS could not be installed"
lammps=$(command -v lmp || true)

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM

say "building"
{
    cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -march=native -DNDEBUG" \
        -DLACUNA_BUILD_TESTS=OFF -DLACUNA_BUILD_EXAMPLES=OFF -DLACUNA_BUILD_BENCH=ON -DLACUNA_PORES=ON &&
        cmake --build "$build" --target bench_one_work bench_plain_kernel -j 2
} >"$scratch/build.log" 2>&1 || {
    cat "$scratch/build.log" >&2
    exit 1
}
ours="$build/bench/bench_one_work"
plain="$build/bench/bench_plain_kernel"

# Use the last allowed core: the system itself runs mostly on the first.
pin=
if command -v taskset >/dev/null 2>&1; then
    core=$(taskset -cp $$ | sed 's/.*[^0-9]//')
    pin="taskset -c $core"
fi
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

failed=0
# one_ours WORK PARTICLES REAL SECONDS: appends "ours WORK PARTICLES REAL rate ns rss" to the results.
one_ours() {
    status=0
    $pin "$ours" --work "$1" --real "$3" --sheet "$scratch/sheet_$2" --seconds "$4" >"$scratch/line" || status=$?
    if [ "$status" != 0 ]; then
        failed=1
        say "$1 $2 $3: physics checks failed: $(cat "$scratch/line")"
    fi
    sed -n 's/.*"ours": \([^,]*\),.*"ns_per_pair": \([^,]*\),.*"rss_mb": \([^,]*\),.*/\1 \2 \3/p' "$scratch/line" |
        sed "s/^/ours $1 $2 $3 /" >>"$scratch/results"
}
# time_lammps PARTICLES WARM STEPS: appends "lammps PARTICLES rate".
time_lammps() {
    [ -n "$lammps" ] || return 0
    load=$(sed -n '1s/.* //p' "$scratch/sheet_$1")
    if $pin "$lammps" -in "$root/bench/sheet.lammps" -log none -screen "$scratch/lammps" -var sheet "$scratch/sheet_$1" \
        -var load "$load" -var warm "$2" -var steps "$3" -var dim "$dim" >/dev/null 2>&1; then
        awk -v n="$1" '/^Loop time of/ { rate = $(NF - 1) * $(NF - 4) / $4 } END { if (rate) print "lammps", n, rate }' \
            "$scratch/lammps" >>"$scratch/results"
    else
        say "LAMMPS failed: $(tail -n 3 "$scratch/lammps")"
        lammps=
    fi
}
# one_plain PARTICLES SECONDS: appends "plain PARTICLES rate".
one_plain() {
    $pin "$plain" "$1" "$2" | sed -n 's/.*"ours": \([^,]*\),.*/\1/p' | sed "s/^/plain $1 /" >>"$scratch/results"
}

sizes="3200 100000"
dim=2 works_at_all="full half frictional half_fluid"
if [ "$three" = 1 ]; then dim=3 works_at_all="full3 frictional3" million=0; fi
reals="double float"
if [ "$quick" = 1 ]; then rounds=3 seconds=0.3 reals=double; else rounds=5 seconds=1; fi
if [ "$million" = 1 ]; then sizes="$sizes 1000000"; fi

: >"$scratch/results"
for particles in $sizes; do
    works=$works_at_all
    case "$particles" in
    3200) warm=200 steps=3000 ;;
    100000) warm=10 steps=50 ;;
    *) warm=2 steps=10 works=full ;;
    esac
    [ "$quick" = 1 ] || steps=$((steps * 4))
    "$ours" --write "$scratch/sheet_$particles" --work "${works%% *}" --particles "$particles" >/dev/null
    round=1
    while [ "$round" -le "$rounds" ]; do
        say "$particles particles, round $round of $rounds"
        for work in $works; do
            for real in $reals; do one_ours "$work" "$particles" "$real" "$seconds"; done
        done
        time_lammps "$particles" "$warm" "$steps"
        [ "$three" = 1 ] || one_plain "$particles" "$seconds"
        round=$((round + 1))
    done
done

awk -v json="$json" '
function median(list,    count, value, i, j, swap) {
    count = split(list, value, " ")
    for (i = 2; i <= count; ++i)
        for (j = i; j > 1 && value[j - 1] + 0 > value[j] + 0; --j) {
            swap = value[j]; value[j] = value[j - 1]; value[j - 1] = swap
        }
    return count % 2 ? value[(count + 1) / 2] + 0 : (value[count / 2] + value[count / 2 + 1]) / 2
}
$1 == "ours" {
    key = $2 " " $3 " " $4
    if (!(key in rate)) order[++keys] = key
    rate[key] = rate[key] " " $5
    pair[key] = pair[key] " " $6
    if ($7 > memory[key]) memory[key] = $7
}
$1 == "lammps" { lammps[$2] = lammps[$2] " " $3 }
$1 == "plain" { plain[$2] = plain[$2] " " $3; if (!($2 in seen)) { seen[$2] = 1; plains[++sizes] = $2 } }
END {
    if (json)
        printf "["
    else
        printf "%-11s %9s %-6s %8s %8s %6s %8s %8s   (M particle-steps/s)\n", "work", "particles", "real", "ours",
        "LAMMPS", "ratio", "ns/pair", "RSS MB"
    for (k = 1; k <= keys; ++k) {
        split(order[k], name, " ")
        ours = median(rate[order[k]])
        his = name[2] in lammps ? median(lammps[name[2]]) : 0
        if (json)
            printf "%s\n  {\"work\": \"%s\", \"particles\": %d, \"real\": \"%s\", \"ours\": %.6g, \"lammps\": %s, " \
                "\"ratio\": %s, \"ns_per_pair\": %.4g, \"rss_mb\": %.1f}", (k > 1 ? "," : ""), name[1], name[2], name[3],
                ours, (his ? sprintf("%.6g", his) : "null"), (his ? sprintf("%.4g", ours / his) : "null"),
                median(pair[order[k]]), memory[order[k]]
        else
            printf "%-11s %9d %-6s %8.2f %8s %6s %8.2f %8.1f\n", name[1], name[2], name[3], ours / 1e6,
                (his ? sprintf("%.2f", his / 1e6) : "-"), (his ? sprintf("%.2f", ours / his) : "-"),
                median(pair[order[k]]), memory[order[k]]
    }
    if (json) printf "\n]\n"
    for (k = 1; k <= sizes && !json; ++k) {
        kernel = median(plain[plains[k]])
        printf "plain kernel at %d: %.2f; full is %.2f of it\n", plains[k], kernel / 1e6,
            median(rate["full " plains[k] " double"]) / kernel
    }
}' "$scratch/results"
exit "$failed"
