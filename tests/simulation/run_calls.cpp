// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "setups.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation/checkpoint.hpp>

/// \file
/// Results do not depend on how a run is split into calls of run() and step().

using namespace lacuna;
using setups::noise;

namespace {

struct sheet_explicit : default_model<2> {
    using flow = explicit_flow;
};
struct sheet_implicit : default_model<2> {
    using flow = implicit_flow;
};
struct block_explicit : default_model<3> {
    using flow = explicit_flow_with<hydraulic_section>;
};
struct block_implicit : default_model<3> {
    using flow = implicit_flow_with<hydraulic_section>;
};

/// A wet packing that is sheared by its own motion, so that pairs form and separate; its pores are drained on one side.
/// \param duration duration in the flow's parameters, s
template <class Model>
simulation<Model> wet_packing(double duration) {
    constexpr int dim = Model::dim;
    packing<double, dim> particles;
    int const n = dim == 2 ? 6 : 3;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int l = 0; l < (dim == 2 ? 1 : n); ++l) {
                auto const id = particles.size();
                vec<double, dim> x{};
                double const all[] = {double(i), double(j), double(l)};
                for (int axis = 0; axis < dim; ++axis) x[axis] = all[axis] + 0.04 * noise(id, axis);
                particles.add(x, 0.48 + 0.01 * noise(id, 7));
            }
    simulation_parameters<Model> p;
    p.materials = {{setups::unit_density(dim), {100, 70, 0.4}, {}}};
    p.interactions.skin = 0.02;
    p.time_step = 4e-3;
    p.flow.bulk_modulus = 20;
    p.flow.initial_pressure = 0.1;
    p.flow.minimum_volume_fraction = 0.05;
    p.flow.duration = duration;
    p.flow.skip_ratio = 10;
    p.flow.conductivity = dim == 2 ? 1e-2 : 2e-2;
    if constexpr (dim == 2) p.flow.aperture = {0.1, 1.0, 1.0};
    simulation<Model> sim(particles, p);
    auto const drained = reservoir("side", on_side{dim == 2 ? body_side::top : body_side::front}, 0.0);
    sim.fill_pores([&](auto points, double const* radii) {
        return make_pore_network(triangulate_body(points, radii), points, radii, flow_boundaries(drained));
    });
    for (std::size_t k = 0; k < sim.size(); ++k) {
        vec<double, dim> v{};
        for (int axis = 0; axis < dim; ++axis) v[axis] = 0.05 * noise(k, 3 + axis);
        v[0] += 0.1 * (particles.position[k][1] - 1);
        sim.set_velocity(k, v);
    }
    return sim;
}

template <class Simulation>
std::size_t inactive_throats(Simulation const& sim) {
    auto const& net = sim.flow().network();
    return std::size_t(std::count(net.inactive.begin(), net.inactive.begin() + std::ptrdiff_t(net.open_throats()), 1));
}

} // namespace

TEMPLATE_TEST_CASE("a wet packing has the same bits however its run is split into calls, and after a restart",
                   "[flow][same bits]",
                   sheet_explicit, sheet_implicit, block_explicit, block_implicit) {
    // A duration by which some throats matter and some do not.
    auto unlimited = wet_packing<TestType>(std::numeric_limits<double>::infinity());
    REQUIRE(inactive_throats(unlimited) == 0);
    auto const& net = unlimited.flow().network();
    std::vector<double> limits;
    for (std::size_t t = 0; t < net.open_throats(); ++t)
        limits.push_back(throat_time_step(net, t, unlimited.settings().flow.bulk_modulus));
    std::sort(limits.begin(), limits.end());
    REQUIRE(limits.size() > 10);
    double const middle = limits[limits.size() / 2], duration = middle / 10;

    constexpr long long steps = 200;
    auto whole = wet_packing<TestType>(duration);
    REQUIRE(inactive_throats(whole) ==
            std::size_t(std::count_if(limits.begin(), limits.end(), [&](double l) { return l > middle; })));
    whole.run(steps);
    std::size_t const inactive = inactive_throats(whole);
    REQUIRE(inactive > 0);
    REQUIRE(inactive < limits.size());

    auto twos = wet_packing<TestType>(duration), singles = wet_packing<TestType>(duration),
         ends = wet_packing<TestType>(duration);
    while (twos.steps() < steps) twos.run(2);
    while (singles.steps() < steps) singles.step();
    REQUIRE(state_hash(twos) == state_hash(whole));
    REQUIRE(state_hash(singles) == state_hash(whole));

    ends.run(37);
    auto const saved = checkpoint_of(ends);
    // The run may last longer than the given duration.
    auto again = wet_packing<TestType>(duration);
    resume_from(saved, "memory", again);
    again.run(steps - 37);
    REQUIRE(state_hash(again) == state_hash(whole));
    auto longer = wet_packing<TestType>(2 * duration);
    resume_from(saved, "memory", longer);
    REQUIRE(longer.settings().flow.duration == 2 * duration);

    // Without a duration all throats matter, however short the calls are.
    auto all = wet_packing<TestType>(std::numeric_limits<double>::infinity());
    unlimited.run(steps);
    while (all.steps() < steps) all.run(1);
    REQUIRE(inactive_throats(all) == 0);
    REQUIRE(state_hash(all) == state_hash(unlimited));
}

TEST_CASE("settings after resolve_time_step() have an effect on the first step of run() and of step()", "[same bits]") {
    auto const pair = [] {
        packing<double, 2> discs;
        discs.add({0.0, 0.0}, 0.5);
        discs.add({2.0, 0.0}, 0.5);
        simulation<default_model<2>> sim(discs, {});
        double const slow = sim.resolve_time_step();
        // So fast that a tenth of the radius is more than a step of the stiffness: m/s.
        sim.set_velocity(0, {1.0 / slow, 0.0});
        return sim;
    };
    auto by_run = pair(), by_step = pair(), by_energy = pair();
    by_run.run(1);
    by_step.step();
    by_energy.step_with_energy();
    REQUIRE(by_run.time_step() <= 0.05 * 0.5 / norm(by_run.velocity(0)) * (1 + 1e-12));
    REQUIRE(by_step.time_step() == by_run.time_step());
    REQUIRE(by_energy.time_step() == by_run.time_step());
    REQUIRE(by_step.position(0)[0] == by_run.position(0)[0]);
}
