// SPDX-License-Identifier: BSD-3-Clause
//
// Runs one workload once and prints one line of JSON. Exit status 1 if its physics checks fail, 2 for bad arguments.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

#include <sys/resource.h>

#include "works.hpp"

namespace {

struct options {
    std::string work = "full", real = "double", sheet_file, write_file;
    std::size_t particles = 3200;
    double seconds = 1;
    long long steps = 0;
    int threads = 1;
};

char const usage[] = "usage: bench_one_work [--work full|half|frictional|half_fluid|full3|frictional3] [--real "
                     "double|float] [--particles N]\n"
                     "                      [--sheet FILE] [--steps N | --seconds S] [--threads N]\n"
                     "       bench_one_work --write FILE [--work W] [--particles N]  only writes the sheet or block as "
                     "a data file for LAMMPS\n";

options parse(int count, char** arguments) {
    options o;
    for (int k = 1; k < count; ++k) {
        std::string const name = arguments[k];
        if (k + 1 == count) throw std::invalid_argument(name + ": unknown, or its value is missing");
        std::string const value = arguments[++k];
        if (name == "--work") o.work = value;
        else if (name == "--real") o.real = value;
        else if (name == "--sheet") o.sheet_file = value;
        else if (name == "--write") o.write_file = value;
        else if (name == "--particles") o.particles = std::stoul(value);
        else if (name == "--seconds") o.seconds = std::stod(value);
        else if (name == "--steps") o.steps = std::stoll(value);
        else if (name == "--threads") o.threads = std::stoi(value);
        else throw std::invalid_argument(name + ": unknown");
    }
    if (o.real != "double" && o.real != "float") throw std::invalid_argument("--real: must be double or float");
    if (o.particles < 16 || o.particles > 10000000) throw std::invalid_argument("--particles: must be 16 to 10000000");
    return o;
}

template <class Model, class Body>
bench::timing measure(Body const& s, bench::work w, options const& o) {
    bench::work_run<Model, Body> run(s, w, o.threads);
    if (o.steps > 0) {
        run.run(o.steps);
    } else {
        // Choose the number of steps from the speed of the first few.
        auto const start = std::chrono::steady_clock::now();
        long long const probe = std::clamp(160000 / (long long)s.size(), 3LL, 50LL);
        run.run(probe);
        double const one =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / double(probe);
        // At most 20,000: after 30,000, rounding of positions in single precision changes the energy by 1 %.
        run.run(std::clamp((long long)(o.seconds / one), 5LL, 20000LL));
    }
    return run.finish();
}

template <class Real>
bench::timing measure_in(bench::sheet const& s, options const& o) {
    auto const w = bench::parse_work(o.work);
    return w == bench::work::half_fluid ? measure<bench::wet_model<Real>>(s, w, o)
                                        : measure<bench::dry_model<Real>>(s, w, o);
}
template <class Real>
bench::timing measure_in(bench::block const& b, options const& o) {
    return measure<bench::dry_model<Real, 3>>(b, bench::parse_work(o.work), o);
}

/// Writes the sheet or block, or runs its workload. \return exit status
template <class Body>
int write_or_run(Body const& s, options const& o) {
    if (!o.write_file.empty()) {
        bench::write_lammps(s, o.write_file);
        auto const m = bench::measure(s);
        std::printf("{\"particles\": %zu, \"contacts\": %zu, \"contacts_per_disc\": %.4f, \"mean_overlap\": %.5f, "
                    "\"load\": %.6g, \"residual\": %.3g}\n",
                    s.size(), m.contacts, m.contacts_per_disc, m.mean_overlap, s.load, m.residual);
        return 0;
    }
    auto const r = o.real == "double" ? measure_in<double>(s, o) : measure_in<float>(s, o);
    rusage usage_now{};
    getrusage(RUSAGE_SELF, &usage_now);
    std::printf("{\"work\": \"%s\", \"particles\": %zu, \"real\": \"%s\", \"threads\": %d, \"ours\": %.6g, "
                "\"ns_per_pair\": %.4g, \"rss_mb\": %.1f, \"resident_mb\": %.1f, \"steps\": %lld, \"seconds\": %.4g, "
                "\"cpu_seconds\": %.4g, \"bonds\": %zu, "
                "\"contacts\": %zu, \"throats\": %zu, \"rebuilds\": %lld, \"energy_drift\": %.3g, "
                "\"ledger_residual\": %.3g, \"momentum_drift\": %.3g, \"good\": %s, \"why\": \"%s\"}\n",
                o.work.c_str(), r.particles, o.real.c_str(), o.threads, r.rate(), r.nanoseconds_per_pair(),
                double(usage_now.ru_maxrss) / 1024, r.resident_mb, r.steps, r.seconds, r.cpu_seconds, r.bonds,
                r.contacts, r.active_throats, r.rebuilds, r.energy_drift, r.ledger_residual, r.momentum_drift,
                r.found.good ? "true" : "false", r.found.why.c_str());
    return r.found.good ? 0 : 1;
}

} // namespace

int main(int count, char** arguments) {
    options o;
    try {
        o = parse(count, arguments);
        bench::parse_work(o.work);
    } catch (std::exception const& error) {
        std::fprintf(stderr, "%s\n%s", error.what(), usage);
        return 2;
    }
    try {
        if (bench::in_space(bench::parse_work(o.work)))
            return write_or_run(o.sheet_file.empty() ? bench::make_block(o.particles) : bench::read_block(o.sheet_file),
                                o);
        return write_or_run(o.sheet_file.empty() ? bench::make_sheet(o.particles) : bench::read_lammps(o.sheet_file),
                            o);
    } catch (std::exception const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
