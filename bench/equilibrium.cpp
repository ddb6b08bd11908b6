// SPDX-License-Identifier: BSD-3-Clause
//
// Seconds to an equilibrium, to a tolerance of 1e-3: the first crack of the cartilage specimen's surface zone, its
// cascade of failures, and packings of discs and spheres between walls. Each case says how long the same number of
// particles takes for 120,000 damped steps, the least that the specimen needs. The exit status is 1 if an equilibrium
// is not found or not in balance; it does not depend on times.
//   bench_equilibrium [--cascade MPA] [--discs N]... [--spheres N]... [options of Google Benchmark]

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <lacuna/equilibrium.hpp>
#include <lacuna/packings/random_packing.hpp>

#include "cartilage/run/load_specimen.hpp"
#include "machine.hpp"

namespace {

bool all_good = true;
constexpr double tolerance = 1e-3, stiffness = 1e8, friction = 0.2;

using clock_type = std::chrono::steady_clock;
double seconds_since(clock_type::time_point start) {
    return std::chrono::duration<double>(clock_type::now() - start).count();
}

/// Seconds for 120,000 steps of a simulation, from a few.
template <class Model>
double explicit_seconds(lacuna::simulation<Model>& sim) {
    int const steps = std::max(10, int(2000000 / sim.size()));
    sim.run(3);
    auto const start = clock_type::now();
    sim.run(steps);
    return seconds_since(start) / steps * 120000;
}

template <class Model>
void report(benchmark::State& state, lacuna::equilibrium_result const& r, double seconds, double explicit_run,
            lacuna::simulation<Model> const& sim) {
    state.SetIterationTime(seconds);
    state.counters["particles"] = double(sim.size());
    state.counters["solves"] = r.solves;
    state.counters["factorisations"] = r.factorisations;
    state.counters["s/factorisation"] = seconds / std::max(1, r.factorisations);
    state.counters["fill"] = double(r.fill);
    state.counters["broken"] = double(r.broken);
    state.counters["explicit_s"] = explicit_run;
    if (r.reached() && r.unbalanced <= tolerance * r.largest_force) return;
    all_good = false;
    state.SkipWithError("not in equilibrium");
}

/// Of its own type, since parts of the program's model are compiled elsewhere.
struct tissue : cartilage::wet_model {};

/// The surface zone with sealed pores under a pressure, from the state without load.
void surface_zone(benchmark::State& state, double megapascals) {
    using model = tissue;
    cartilage::options o;
    o.zone = lacuna::cartilage_zone::surface;
    o.load_MPa = megapascals;
    o.seed = 1;
    o.choices.ramp_time = 0;
    auto const s = cartilage::build_specimen(o);
    for (auto _ : state) {
        auto const make = [&] {
            auto sim = std::make_unique<lacuna::simulation<model>>(
                s.discs, cartilage::model_parameters<model>(s, o.choices));
            cartilage::set_up(*sim, s, o.load_MPa * 1e6, o.choices);
            return sim;
        };
        auto stepped = make(), sim = make();
        double const explicit_run = explicit_seconds(*stepped);
        lacuna::equilibrium<model> rest(*sim, {.tolerance = tolerance});
        auto const start = clock_type::now();
        auto const found = rest.solve();
        report(state, found, seconds_since(start), explicit_run, *sim);
    }
}

template <int Dim>
lacuna::simulation<lacuna::default_model<Dim>> make_box(lacuna::packing<double, Dim> const& particles,
                                                        lacuna::vec<double, Dim> const& low,
                                                        lacuna::vec<double, Dim> const& high) {
    lacuna::simulation_parameters<lacuna::default_model<Dim>> p;
    p.materials.resize(1);
    p.materials[0].density = 1000;
    p.materials[0].contact = {stiffness, 0.5 * stiffness, friction};
    p.interactions.initial_contact_tolerance = 0.02;
    for (int axis = 0; axis < Dim; ++axis) {
        lacuna::vec<double, Dim> inward{};
        inward[axis] = 1;
        p.walls.push_back({low, inward, p.materials[0].contact});
        p.walls.push_back({high, inward * -1.0, p.materials[0].contact});
    }
    return lacuna::simulation<lacuna::default_model<Dim>>(particles, p);
}
/// Compresses a packing along all axes by the walls at its upper ends, then times a further move of the last wall.
template <int Dim>
void pressed_box(benchmark::State& state, lacuna::packing<double, Dim> const& particles,
                 lacuna::vec<double, Dim> const& low, lacuna::vec<double, Dim> const& high, double squeeze) {
    using model = lacuna::default_model<Dim>;
    for (auto _ : state) {
        auto sim = make_box<Dim>(particles, low, high);
        lacuna::equilibrium<model> rest(sim, {.tolerance = tolerance});
        auto const push = [&](int axis, double by) {
            lacuna::vec<double, Dim> inward{};
            inward[axis] = -by;
            rest.move_wall(std::size_t(2 * axis + 1), inward);
        };
        for (int axis = 0; axis < Dim; ++axis) push(axis, squeeze);
        auto start = clock_type::now();
        auto const compressed = rest.solve();
        double const first = seconds_since(start);
        push(Dim - 1, 0.3 * squeeze);
        start = clock_type::now();
        auto const found = rest.solve();
        double const seconds = seconds_since(start);
        report(state, found, seconds, explicit_seconds(sim), sim);
        state.counters["compress_s"] = first;
        state.counters["compress_factorisations"] = compressed.factorisations;
    }
}
void discs(benchmark::State& state, std::size_t count) {
    lacuna::random_packing_parameters p;
    p.r_min = 0.4;
    p.r_max = 0.5;
    p.area_fraction = 0.82;
    p.seed = 1;
    double const mean_area = 3.14159265358979 * (0.125 - 0.064) / 0.3;
    p.width = p.height = std::sqrt(double(count) * mean_area / p.area_fraction);
    pressed_box<2>(state, lacuna::random_packing<double>(p), {0, 0}, {p.width, p.height}, 0.03);
}
/// Spheres of random radii near the places of a close packing.
void spheres(benchmark::State& state, std::size_t count) {
    int const side = int(std::lround(std::cbrt(double(count))));
    double const row = std::sqrt(0.75), layer = std::sqrt(2.0 / 3);
    lacuna::packing<double, 3> p;
    std::mt19937_64 generator(1);
    for (int c = 0; c < side; ++c)
        for (int b = 0; b < side; ++b)
            for (int a = 0; a < side; ++a)
                p.add({a + 0.5 * ((b + c) % 2), (b + (c % 2) / 3.0) * row, c * layer},
                      0.495 + 0.005 * (double(generator() >> 11) * 0x1p-53));
    pressed_box<3>(state, p, {-0.5, -0.5, -0.5},
                   {double(side), (side - 1 + 1 / 3.0) * row + 0.5, (side - 1) * layer + 0.5}, 0.03);
}

template <class Run, class Size>
void add(char const* name, Run run, Size size) {
    benchmark::RegisterBenchmark((std::string(name) + "/" + std::to_string(int(size))).c_str(), run, size)
        ->Unit(benchmark::kSecond)
        ->UseManualTime()
        ->Iterations(1);
}

} // namespace

int main(int count, char** arguments) {
    std::vector<std::size_t> disc_counts, sphere_counts;
    double cascade = 70;
    std::vector<char*> rest;
    for (int k = 0; k < count; ++k) {
        auto const is = [&](char const* name) { return std::strcmp(arguments[k], name) == 0 && k + 1 < count; };
        if (is("--discs")) disc_counts.push_back(std::strtoul(arguments[++k], nullptr, 10));
        else if (is("--spheres")) sphere_counts.push_back(std::strtoul(arguments[++k], nullptr, 10));
        else if (is("--cascade")) cascade = double(std::strtoul(arguments[++k], nullptr, 10));
        else rest.push_back(arguments[k]);
    }
    int left = int(rest.size());
    benchmark::Initialize(&left, rest.data());
    if (benchmark::ReportUnrecognizedArguments(left, rest.data())) return 2;
    benchmark::AddCustomContext("commit", LACUNA_BENCH_COMMIT);
    benchmark::AddCustomContext("compiler", LACUNA_BENCH_COMPILER);
    benchmark::AddCustomContext("flags", LACUNA_BENCH_FLAGS);
    benchmark::AddCustomContext("cpu", bench::cpu_name());
    benchmark::AddCustomContext("threads", "1");
    if (disc_counts.empty()) disc_counts = {3000};
    if (sphere_counts.empty()) sphere_counts = {1000};
    add("first_crack", surface_zone, 34.0);
    if (cascade > 0) add("cascade", surface_zone, cascade);
    for (auto const n : disc_counts) add("discs", discs, n);
    for (auto const n : sphere_counts) add("spheres", spheres, n);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return all_good ? 0 : 1;
}
