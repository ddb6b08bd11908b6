// SPDX-License-Identifier: BSD-3-Clause
//
// Cost of one extreme pair or particle for all others: a crowd of discs or spheres without outlier, with one long bond,
// one huge particle or one fast particle. Prints time, candidates, searches and the chosen time step. Exit status 1 if
// a touching pair is missing among the candidates, or if an outlier adds a tenth to candidates or searches, or shortens
// the step by a tenth.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <lacuna/neighbors/kd_tree.hpp>
#include <lacuna/particles/spatial_order.hpp>
#include <lacuna/simulation.hpp>

#include "options.hpp"

namespace {

enum class outlier { none, long_bond, huge, fast };
constexpr char const* names[] = {"none", "long bond", "huge particle", "fast particle"};
constexpr double radius = 0.5, spacing = 1.02, step_length = 2e-4, huge_radius = 500;

template <int Dim>
struct model : lacuna::default_model<Dim> {};

/// A crowd in random motion, `side` particles long, and one particle above it.
template <int Dim>
std::unique_ptr<lacuna::simulation<model<Dim>>> make(int side, outlier what, int threads) {
    lacuna::packing<double, Dim> p;
    int const layers = Dim == 3 ? side : 1;
    for (int z = 0; z < layers; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                lacuna::vec<double, Dim> at{};
                at[0] = spacing * x;
                at[1] = spacing * y;
                if constexpr (Dim == 3) at[2] = spacing * z;
                p.add(at, radius);
            }
    std::size_t const crowd = p.size();
    lacuna::vec<double, Dim> above{};
    above[0] = what == outlier::huge ? spacing * side / 2 : 0;
    double const one = what == outlier::huge ? huge_radius : radius;
    above[1] = spacing * side + one;
    if constexpr (Dim == 3) above[2] = spacing * side / 2;
    p.add(above, one);
    // The cases without a long bond need bonds, too, for a fair comparison.
    for (int y = 0; y < side; ++y) p.bonds.push_back({y * side, y * side + 1});
    if (what == outlier::long_bond) p.bonds.push_back({0, std::int32_t(crowd) - 1});

    lacuna::simulation_parameters<model<Dim>> s;
    s.materials[0].density = 1;
    s.materials[0].contact = {1e4, 5e3, 0.2};
    s.materials[0].bond = {1e4, 5e3, 1e9, 1e9};
    s.keep_pair_forces = false;
    s.interactions.skin = 0.4;
    s.threads = threads;
    if (what == outlier::long_bond) {
        // No shear stiffness: levers of half the bond's length would rotate its ends much faster than anything else
        // moves.
        s.bonds.resize(p.bonds.size());
        s.bonds.back().normal_stiffness = 1e3;
        s.bonds.back().shear_stiffness = 0;
    }
    auto sim = std::make_unique<lacuna::simulation<model<Dim>>>(p, s);
    double const chosen = sim->resolve_time_step();
    s.time_step = std::min(step_length, chosen);
    sim = std::make_unique<lacuna::simulation<model<Dim>>>(p, s);
    std::mt19937_64 engine(1);
    for (std::size_t k = 0; k < crowd; ++k) {
        lacuna::vec<double, Dim> v{};
        for (int axis = 0; axis < Dim; ++axis) v[axis] = double(engine() >> 11) * 0x1p-53 * 4 - 2;
        sim->set_velocity(k, v);
    }
    lacuna::vec<double, Dim> v{};
    if (what == outlier::fast) v[0] = 0.05 * radius / s.time_step;
    sim->set_velocity(crowd, v);
    return sim;
}

struct found {
    double nanoseconds = 0; ///< per particle and step
    double step = 0;        ///< chosen time step, s
    std::size_t candidates = 0, missing = 0;
    long long searches = 0;
};

/// The internal indices of the particles in a new simulation.
template <int Dim>
std::vector<std::int32_t> numbers(lacuna::simulation<model<Dim>> const& sim) {
    std::vector<lacuna::vec<double, Dim>> at;
    for (std::size_t k = 0; k < sim.size(); ++k) at.push_back(sim.position(k));
    auto const order = [&] {
        if constexpr (Dim == 2)
            return lacuna::strip_order(lacuna::view_points(at));
        else
            return lacuna::spatial_order(lacuna::view_points(at));
    }();
    std::vector<std::int32_t> number(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) number[std::size_t(order[k])] = std::int32_t(k);
    return number;
}

/// Touching pairs that are neither candidates nor bonded.
template <int Dim>
std::size_t missing_pairs(lacuna::simulation<model<Dim>> const& sim, std::vector<std::int32_t> const& number) {
    std::vector<lacuna::vec<double, Dim>> at;
    std::vector<double> radii;
    for (std::size_t k = 0; k < sim.size(); ++k) {
        at.push_back(sim.position(k));
        radii.push_back(sim.radius(k));
    }
    std::vector<lacuna::neighbor_pair> pairs;
    lacuna::kd_tree<double, Dim>().touching_pairs(lacuna::view_points(at), radii, 0.0, pairs);
    std::size_t missing = 0;
    for (auto const& pair : pairs) {
        auto i = number[std::size_t(pair.i)], j = number[std::size_t(pair.j)];
        if (i > j) std::swap(i, j);
        auto const& listed = sim.pairs().neighbors().pairs();
        lacuna::neighbor_pair const wanted{i, j};
        missing += !std::binary_search(listed.begin(), listed.end(), wanted, [](auto const& a, auto const& b) {
            return a.i < b.i || (a.i == b.i && a.j < b.j);
        });
    }
    return missing;
}

/// Processor time, s; with several threads wall-clock time.
double seconds(int threads) {
    if (threads == 1) return double(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <int Dim>
found measure(int side, outlier what, long long steps, int threads) {
    auto const sim = make<Dim>(side, what, threads);
    found f;
    f.step = sim->settings().safety * sim->limits().critical();
    auto const number = numbers(*sim);
    sim->run(20);
    long long const before = sim->pairs().neighbors().build_count();
    double const start = seconds(threads);
    sim->run(steps);
    f.nanoseconds = 1e9 * (seconds(threads) - start) / double(steps) / double(sim->size());
    f.searches = sim->pairs().neighbors().build_count() - before;
    f.candidates = sim->pairs().neighbors().pairs().size();
    f.missing = missing_pairs(*sim, number);
    return f;
}

template <int Dim>
bool compare(int side, int rounds, long long steps, int threads, bool json) {
    std::vector<double> times[4], ratios[4];
    found last[4];
    for (int round = 0; round < rounds; ++round)
        for (int w = 0; w < 4; ++w) {
            last[w] = measure<Dim>(side, outlier(w), steps, threads);
            times[w].push_back(last[w].nanoseconds);
            ratios[w].push_back(times[w].back() / times[0].back());
        }
    bool good = true;
    for (int w = 0; w < 4; ++w) {
        auto const& f = last[w];
        good = good && f.missing == 0 && 10 * f.candidates < 11 * last[0].candidates &&
               10 * f.searches <= 11 * last[0].searches + 10 && 1.1 * f.step > last[0].step;
        std::printf(
            json ? "{\"dimension\": %d, \"outlier\": \"%s\", \"ns\": %.4g, \"ratio\": %.4g, \"candidates\": %zu, "
                   "\"searches\": %lld, \"step\": %.4g, \"missing\": %zu}\n"
                 : "| %d | %-13s | %6.1f | %5.3f | %8zu | %4lld | %.3e | %zu |\n",
            Dim, names[w], bench::median(times[w]), bench::median(ratios[w]), f.candidates, f.searches, f.step,
            f.missing);
    }
    return good;
}

} // namespace

int main(int count, char** words) {
    int side = 100, rounds = 5, steps = 1000, threads = 1;
    bool json = false;
    if (!bench::read_options(count, words,
                             {{"--side", &side}, {"--rounds", &rounds}, {"--steps", &steps}, {"--threads", &threads}},
                             json)) {
        std::fprintf(stderr, "usage: bench_outliers [--side N] [--rounds N] [--steps N] [--threads N] [--json]\n");
        return 2;
    }
    try {
        if (!json)
            std::printf(
                "| dimension | outlier | ns a particle-step | ratio | candidates | searches | step, s | missing |\n"
                "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
        bool const plane = compare<2>(side, rounds, steps, threads, json);
        int const edge = std::max(6, int(std::lround(std::cbrt(double(side) * side))));
        bool const space = compare<3>(edge, rounds, std::max(steps / 4, 1), threads, json);
        return plane && space ? 0 : 1;
    } catch (std::exception const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
