// SPDX-License-Identifier: BSD-3-Clause
//
// Particle-steps per second of the four workloads in the plane, in double and single precision, with 3,200 and 100,000
// particles; with --million also 1,000,000 (full, double). Each case checks its physics after timing. The exit status
// is 1 if a check fails; it does not depend on times.
//   bench_step_rate [--million] [options of Google Benchmark, such as --benchmark_out=FILE --benchmark_filter=full]

#include <benchmark/benchmark.h>

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "works.hpp"

namespace {

bool all_good = true;

bench::sheet const& sheet_of(std::size_t particles) {
    static std::map<std::size_t, bench::sheet> made;
    auto const found = made.find(particles);
    return found != made.end() ? found->second : made.emplace(particles, bench::make_sheet(particles)).first->second;
}

template <class Model>
void step_rate(benchmark::State& state, bench::work w, std::size_t particles) {
    // Steps per iteration: some tens of milliseconds, which include the usual rebuilds of the lists.
    auto const batch = std::max(5LL, 800000LL / (long long)particles);
    bench::work_run<Model> run(sheet_of(particles), w);
    for (auto _ : state) run.run(batch);
    auto const r = run.finish();
    state.counters["particle_steps/s"] =
        benchmark::Counter(double(particles) * double(batch), benchmark::Counter::kIsIterationInvariantRate);
    state.counters["ns/pair"] = r.nanoseconds_per_pair();
    state.counters["bonds"] = double(r.bonds);
    state.counters["contacts"] = double(r.contacts);
    state.counters["throats"] = double(r.active_throats);
    state.counters["steps/rebuild"] = r.rebuilds ? double(r.steps) / double(r.rebuilds) : 0;
    state.counters["energy_drift"] = r.energy_drift;
    state.counters["momentum_drift"] = r.momentum_drift;
    if (!r.found.good) {
        all_good = false;
        state.SkipWithError(r.found.why.c_str());
    }
}

template <class Real>
void add(bench::work w, std::size_t particles) {
    std::string const name = std::string(bench::work_names[std::size_t(w)]) + "/" + std::to_string(particles) + "/" +
                             (sizeof(Real) == 4 ? "float" : "double");
    auto* const one = w == bench::work::half_fluid
                          ? benchmark::RegisterBenchmark(name.c_str(), step_rate<bench::wet_model<Real>>, w, particles)
                          : benchmark::RegisterBenchmark(name.c_str(), step_rate<bench::dry_model<Real>>, w, particles);
    one->Unit(benchmark::kMillisecond);
}

} // namespace

int main(int count, char** arguments) {
    bool million = false;
    std::vector<char*> rest;
    for (int k = 0; k < count; ++k) {
        if (std::strcmp(arguments[k], "--million") == 0)
            million = true;
        else
            rest.push_back(arguments[k]);
    }
    int left = int(rest.size());
    benchmark::Initialize(&left, rest.data());
    if (benchmark::ReportUnrecognizedArguments(left, rest.data())) return 2;
    benchmark::AddCustomContext("commit", LACUNA_BENCH_COMMIT);
    benchmark::AddCustomContext("compiler", LACUNA_BENCH_COMPILER);
    benchmark::AddCustomContext("flags", LACUNA_BENCH_FLAGS);
    benchmark::AddCustomContext("cpu", bench::cpu_name());
    benchmark::AddCustomContext("threads", "1");
    for (std::size_t const particles : {3200, 100000})
        for (std::size_t w = 0; w < bench::work_names.size(); ++w) {
            if (bench::in_space(bench::work(w))) continue; // see bench_one_work
            add<double>(bench::work(w), particles);
            add<float>(bench::work(w), particles);
        }
    if (million) add<double>(bench::work::full, 1000000);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return all_good ? 0 : 1;
}
