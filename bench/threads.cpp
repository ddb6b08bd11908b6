// SPDX-License-Identifier: BSD-3-Clause
//
// Gain from several cores: one run of 100,000 particles on one thread and on several threads, and one run of 3,200
// particles per core side by side, each on one thread. Rounds alternate; prints medians. Exit status 1 if the number of
// threads or another run changes a single bit of the results; it does not depend on times.
//   bench_threads [--threads N] [--rounds N] [--json]

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "options.hpp"
#include "works.hpp"

namespace {

using model = bench::dry_model<double>;
using run = bench::work_run<model>;

/// Positions, velocities and spins as one number (FNV-1a over their bits).
std::uint64_t fingerprint(lacuna::simulation<model> const& sim) {
    std::uint64_t hash = 14695981039346656037ull;
    auto const take = [&](double value) { hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211ull; };
    for (std::size_t k = 0; k < sim.size(); ++k) {
        auto const x = sim.position(k), v = sim.velocity(k);
        for (double const value : {x[0], x[1], v[0], v[1], sim.spin(k)[0]}) take(value);
    }
    return hash;
}

/// Total particle-steps per second of several runs side by side, and a fingerprint of each.
struct outcome {
    double rate = 0;
    std::vector<std::uint64_t> bits;
};
outcome side_by_side(bench::sheet const& s, bench::work w, int runs, int threads, long long steps) {
    std::vector<std::unique_ptr<run>> all;
    for (int k = 0; k < runs; ++k) all.push_back(std::make_unique<run>(s, w, threads));
    auto const start = std::chrono::steady_clock::now();
    std::vector<std::thread> others;
    for (int k = 1; k < runs; ++k) others.emplace_back([&, k] { all[std::size_t(k)]->run(steps); });
    all[0]->run(steps);
    for (auto& other : others) other.join();
    double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome found{double(s.size()) * double(steps) * runs / seconds, {}};
    for (auto const& one : all) found.bits.push_back(fingerprint(one->simulation()));
    return found;
}

struct comparison {
    std::string name;
    std::size_t particles = 0;
    double one = 0, several = 0;
    bool same_bits = true;
};

comparison compare(std::string name, bench::work w, std::size_t particles, int runs, int threads, long long steps,
                   int rounds) {
    comparison c{std::move(name), particles};
    auto const s = bench::make_sheet(particles);
    std::vector<double> one, several;
    for (int round = 0; round < rounds; ++round) {
        auto const a = side_by_side(s, w, 1, 1, steps), b = side_by_side(s, w, runs, threads, steps);
        one.push_back(a.rate);
        several.push_back(b.rate);
        for (auto const bits : b.bits) c.same_bits = c.same_bits && bits == a.bits[0];
    }
    c.one = bench::median(one);
    c.several = bench::median(several);
    return c;
}

} // namespace

int main(int count, char** arguments) {
    int threads = std::max(2, int(std::thread::hardware_concurrency())), rounds = 5;
    bool json = false;
    if (!bench::read_options(count, arguments, {{"--threads", &threads}, {"--rounds", &rounds}}, json)) {
        std::fprintf(stderr, "usage: bench_threads [--threads N] [--rounds N] [--json]\n");
        return 2;
    }
#ifdef _OPENMP
    bool const openmp = true;
#else
    bool const openmp = false;
#endif
    std::vector<comparison> all;
    if (openmp) {
        all.push_back(compare("one full run, several threads", bench::work::full, 100000, 1, threads, 200, rounds));
        all.push_back(compare("one half run, several threads", bench::work::half, 100000, 1, threads, 200, rounds));
    }
    all.push_back(compare("several runs, one thread each", bench::work::half, 3200, threads, 1, 10000, rounds));
    if (json)
        std::printf("{\"commit\": \"%s\", \"compiler\": \"%s\", \"flags\": \"%s\", \"cpu\": \"%s\", \"threads\": %d, "
                    "\"openmp\": %s, \"cases\": [",
                    LACUNA_BENCH_COMMIT, LACUNA_BENCH_COMPILER, LACUNA_BENCH_FLAGS, bench::cpu_name().c_str(), threads,
                    openmp ? "true" : "false");
    else if (!openmp)
        std::printf("built without OpenMP: one run has one thread\n");
    bool good = true;
    for (std::size_t k = 0; k < all.size(); ++k) {
        auto const& c = all[k];
        good = good && c.same_bits;
        if (json)
            std::printf(
                "%s\n  {\"name\": \"%s\", \"particles\": %zu, \"one\": %.6g, \"several\": %.6g, \"gain\": %.4g, "
                "\"same_bits\": %s}",
                k ? "," : "", c.name.c_str(), c.particles, c.one, c.several, c.several / c.one,
                c.same_bits ? "true" : "false");
        else
            std::printf("%-30s %7zu particles: %7.2f M/s on 1, %7.2f M/s on %d: %.2f times%s\n", c.name.c_str(),
                        c.particles, c.one / 1e6, c.several / 1e6, threads, c.several / c.one,
                        c.same_bits ? "" : "; BITS DIFFER");
    }
    if (json) std::printf("\n]}\n");
    return good ? 0 : 1;
}
