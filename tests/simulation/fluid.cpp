// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "setups.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

using namespace lacuna;

namespace {

struct wet : setups::plane {
    using flow = explicit_flow_with<constant_aperture>;
    using damping = viscous_damping;
};
struct wet_undamped : setups::plane {
    using flow = explicit_flow_with<constant_aperture>;
};
struct wet_implicit : setups::plane {
    using flow = implicit_flow_with<constant_aperture>;
    using damping = viscous_damping;
};

/// A triangular sheet on a fixed base, drained and loaded at its top.
template <class Model>
simulation<Model> sheet(typename Model::flow::parameters const& flow, double time_step, double load = 200) {
    auto const discs = setups::lattice(8, 7, true);
    auto p = setups::springs<Model>(1e6, 5e5, 0, setups::unit_density(2));
    if constexpr (std::is_same_v<typename Model::damping, viscous_damping>) p.damping = {0.3};
    p.flow = flow;
    p.time_step = time_step;
    simulation<Model> sim(discs, p);
    sim.fill_pores([&](auto points, double const* radii) {
        return make_pore_network(triangulate_body(points, radii), points, radii,
                                 flow_boundaries(reservoir("top", on_side{body_side::top}, 0.0)));
    });
    for (std::size_t i = 0; i < discs.size(); ++i) {
        if (discs.position[i][1] < 0.1) sim.fix(i);
        if (discs.position[i][1] > 5) sim.apply(i, {0, -load});
    }
    return sim;
}

template <class Model>
typename Model::flow::parameters fluid(double conductance) {
    typename Model::flow::parameters p;
    p.bulk_modulus = 1e6;
    p.aperture.aperture = 0.01;
    p.conductivity = conductance / 1e-6;
    return p;
}

template <class Simulation>
double mean_pressure(Simulation const& sim) {
    double sum = 0;
    for (double const p : sim.flow().network().pressure) sum += p / double(sim.flow().network().pores());
    return sum;
}

constexpr double dt = 1e-4;

} // namespace

TEST_CASE("flow in one of n steps converges to flow in every step, at first order") {
    double const conductance = 8e-6;
    auto const pressure = [&](int interval) {
        auto p = fluid<wet>(conductance);
        p.interval = interval;
        auto sim = sheet<wet>(p, dt);
        sim.run(320);
        return mean_pressure(sim);
    };
    double const one = pressure(1), two = pressure(2), four = pressure(4), eight = pressure(8);
    INFO(one << ", " << two << ", " << four << ", " << eight << " Pa");
    REQUIRE(one > 1);
    REQUIRE_THAT((four - one) / (two - one), WithinRel(3.0, 0.1));
    REQUIRE_THAT((eight - one) / (two - one), WithinRel(7.0, 0.25));
    REQUIRE_THAT(eight, WithinRel(one, 0.05));
}

TEST_CASE("flow steps within a step, explicit and implicit, agree") {
    double const conductance = 1e-5;
    auto const p = fluid<wet>(conductance);
    auto many = p;
    many.substeps = 4;
    auto one = sheet<wet>(p, dt), other = sheet<wet>(many, dt);
    auto third = sheet<wet_implicit>(fluid<wet_implicit>(conductance), dt);
    REQUIRE_THAT(other.limits().flow, WithinRel(4 * one.limits().flow, 1e-12));
    REQUIRE(third.limits().flow == setups::never);
    for (auto* sim : {&one, &other}) sim->run(400);
    third.run(400);
    REQUIRE(mean_pressure(one) > 1);
    REQUIRE_THAT(mean_pressure(other), WithinRel(mean_pressure(one), 0.02));
    REQUIRE_THAT(mean_pressure(third), WithinRel(mean_pressure(one), 0.02));
}

TEST_CASE("mass is conserved to rounding with flow in one of n steps, and with n flow steps in one step") {
    auto p = fluid<wet>(1e-5);
    p.interval = GENERATE(1, 5);
    p.substeps = GENERATE(1, 3);
    auto sim = sheet<wet>(p, dt);
    double gross = 0, missing = 0;
    for (int s = 0; s < 200; ++s) {
        auto const before = sim.flow().network();
        sim.step_with_energy();
        auto const& net = sim.flow().network();
        missing += sim.flow().ledger().mass_residual;
        gross += sim.flow().ledger().gross_volume;
        if (p.substeps == 1) {
            double content = 0, stored = 0;
            for (std::size_t k = 0; k < net.pores(); ++k) {
                stored += net.volume[k] * std::fabs(net.pressure[k]) / p.bulk_modulus;
                content += net.volume[k] * (net.pressure[k] - before.pressure[k]) / p.bulk_modulus +
                           (net.volume[k] - before.volume[k]);
            }
            double const left = content - (net.sources[0].volume - before.sources[0].volume);
            INFO(s << ": " << left << " m^3");
            // Pressures that hardly change have their own rounding error.
            REQUIRE(std::fabs(left) <= 1e-12 * sim.flow().ledger().gross_volume + 1e-15 * stored);
        }
        bool const flowed = net.sources[0].volume != before.sources[0].volume;
        // One step until something has moved, another until the pressure has risen.
        if (s > 1) REQUIRE(flowed == ((s + 1) % p.interval == 0));
    }
    REQUIRE_THAT(missing, WithinAbs(0, 1e-13 * gross));
    REQUIRE_THAT(sim.flow().network().sources[0].volume, WithinRel(sim.flow().ledger().boundary_inflow, 1e-11));
    REQUIRE(sim.flow().network().sources[0].volume < 0);
}

TEST_CASE("the energy of a vibrating wet sheet adds up for any interval of the flow") {
    int const interval = GENERATE(1, 10);
    double const conductance = GENERATE(0.0, 2e-6);
    auto p = fluid<wet_undamped>(conductance);
    p.interval = interval;
    auto sim = sheet<wet_undamped>(p, dt);
    double most = 0;
    for (int s = 0; s < 3000; ++s) {
        sim.step_with_energy();
        most = std::max(most, std::fabs(sim.energy().residual()));
    }
    auto const& e = sim.energy();
    INFO("residual " << e.residual() << ", most " << most << ", of " << e.largest() << " J");
    REQUIRE(e.fluid_storage > 0);
    // No drift: only the integrator's oscillation, of second order in the step, remains.
    REQUIRE_THAT(most, WithinAbs(0, 5e-3 * e.largest()));
    if (conductance > 0) REQUIRE(e.fluid_viscous > 0);
}

TEST_CASE("a step that is too long for the flow is refused, with its interval and substeps") {
    auto p = fluid<wet>(1e-4);
    double const limit = sheet<wet>(p, 0.0).limits().flow;
    REQUIRE(limit > dt);
    p.interval = int(limit / dt) + 1;
    REQUIRE_THROWS_WITH(sheet<wet>(p, dt).run(1), contains_text("of the flow between pores"));
    p.substeps = 2;
    REQUIRE_NOTHROW(sheet<wet>(p, dt).run(1));
    p.substeps = 0;
    p.interval = 1000;
    REQUIRE_NOTHROW(sheet<wet>(p, dt).run(1));
    p.interval = 0;
    REQUIRE_THROWS_WITH(sheet<wet>(p, dt), contains_text("flow.interval = 0"));
}

TEST_CASE("a reservoir's pressure is changed while the simulation runs") {
    auto sim = sheet<wet_implicit>(fluid<wet_implicit>(1e-3), dt, 0.0);
    sim.run(100);
    REQUIRE(mean_pressure(sim) == 0);
    sim.flow().set_source(find_source(sim.flow().network(), "top"), 50.0);
    sim.run(20000);
    REQUIRE_THAT(mean_pressure(sim), WithinRel(50.0, 1e-3));
    REQUIRE(sim.flow().network().sources[0].volume > 0);
}
