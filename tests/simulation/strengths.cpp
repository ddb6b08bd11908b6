// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>

#include <lacuna/laws/weibull.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

/// \file
/// Failure of bonds with Mohr-Coulomb's envelope, and of bonds with scattered strengths, in a run.

using namespace setups;

namespace {

struct rock : plane {
    using bond_law = lacuna::mohr_coulomb_bond;
};

/// Cohesion 10 N, tan phi = 0.5, cut-off at 4 N: bonds of 1 m^2.
lacuna::simulation_parameters<rock> rock_parameters() {
    lacuna::simulation_parameters<rock> p;
    p.materials[0].density = unit_density(2);
    p.materials[0].bond = {1e5, 1e5, 4, 10, {0.5}};
    p.materials[0].contact = {1e5, 1e5, 0.3};
    p.time_step = 1e-4;
    return p;
}

/// Runs until a bond fails.
template <class Model>
lacuna::break_event<2> first_break(lacuna::simulation<Model>& sim) {
    while (sim.events().empty() && sim.steps() < 1000000) sim.step();
    REQUIRE(sim.events().size() == 1);
    return sim.events().front();
}

} // namespace

TEST_CASE("a bond breaks on Mohr-Coulomb's line, and the event has the mode", "[envelope]") {
    // Pressed by a given force, then sheared: |F_s| = 10 - F_n tan phi.
    for (double const normal : {-20.0, -6.0, 0.0, 2.0}) {
        lacuna::simulation<rock> sim(chain<2>(2), rock_parameters());
        sim.fix(0);
        double const speed = 1e-4, path = normal / 1e5;
        sim.prescribe_velocity(1, {normal < 0 ? -speed : speed, 0});
        sim.fix(1);
        while (std::fabs(sim.position(1)[0] - 1) < std::fabs(path)) sim.step();
        sim.prescribe_velocity(1, {0, speed});
        sim.fix(1);
        auto const event = first_break(sim);
        INFO("F_n = " << normal);
        CHECK(event.mode == lacuna::bond_state::broken_in_shear);
        CHECK_THAT(event.normal_force, WithinAbs(normal, 0.01));
        CHECK_THAT(std::fabs(event.shear_force), WithinRel(10 - 0.5 * event.normal_force, 2e-3));
        // A frictional contact replaces it: its limit is 0.3 |F_n|.
        CHECK_THAT(std::fabs(sim.pair_force(0, 1)[1]), WithinAbs(0.3 * std::max(-normal, 0.0), 0.01));
    }
    lacuna::simulation<rock> pulled(chain<2>(2), rock_parameters());
    pulled.fix(0);
    pulled.prescribe_velocity(1, {1e-4, 0});
    auto const event = first_break(pulled);
    CHECK(event.mode == lacuna::bond_state::broken_in_tension);
    CHECK_THAT(event.normal_force, WithinRel(4.0, 1e-3));
}

TEST_CASE("Mohr-Coulomb's bond is elastic under any compression, the paper's is crushed", "[envelope]") {
    auto const press = [](auto model, auto const& p) {
        lacuna::simulation<decltype(model)> sim(chain<2>(2), p);
        sim.fix(0);
        sim.prescribe_velocity(1, {-0.01, 0});
        while (sim.position(1)[0] > 1 - 1e-3) sim.step();
        double const deepest = sim.position(1)[0];
        sim.step(); // the force at that position
        return force_along_x(sim, 0, 1) / (1e5 * (deepest - 1));
    };
    auto paper = springs<plane>(1e5, 1e5, 0.3, unit_density(2), 4, 10);
    CHECK_THAT(press(rock{}, rock_parameters()), WithinRel(1.0, 1e-9));
    CHECK_THAT(press(plane{}, paper), WithinRel(4 / (1e5 * 1e-3), 1e-2));
}

TEST_CASE("the weakest of bonds with scattered strengths breaks first, for any order of the bonds", "[weibull]") {
    lacuna::weibull_strengths const scatter{3, 11};
    auto discs = chain<2>(12);
    std::vector<double> strength;
    for (auto const& bond : discs.bonds) strength.push_back(4 * scatter.factor(bond[0], bond[1]));
    auto const weakest = std::min_element(strength.begin(), strength.end());
    std::array<lacuna::break_event<2>, 3> events;
    for (int round = 0; round < 3; ++round) {
        if (round == 1) {
            std::reverse(discs.bonds.begin(), discs.bonds.end());
            for (auto& b : discs.bonds) std::swap(b[0], b[1]);
        }
        auto p = rock_parameters();
        p.threads = round == 2 ? 2 : 1;
        p.bonds = scatter.draw(discs.bonds);
        lacuna::simulation<rock> sim(discs, p);
        sim.fix(0);
        sim.prescribe_velocity(11, {1e-4, 0});
        events[std::size_t(round)] = first_break(sim);
    }
    int const first = int(weakest - strength.begin());
    CHECK(events[0].bond == first);
    CHECK(events[0].mode == lacuna::bond_state::broken_in_tension);
    CHECK_THAT(events[0].normal_force, WithinRel(*weakest, 0.02));
    for (int round : {1, 2}) {
        CHECK(events[std::size_t(round)].bond == 10 - first);
        CHECK(events[std::size_t(round)].step == events[0].step);
        CHECK(events[std::size_t(round)].normal_force == events[0].normal_force);
    }
}
