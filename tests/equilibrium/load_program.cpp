// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/equilibrium.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

double const stiffness = 1e6, radius = 0.5; // N/m, m

/// Ropes of four bonds each, side by side, far apart. Rope r hangs on disc 5 r and ends in disc 5 r + 4. The second
/// bond of rope r fails at the r-th of the given forces; the others are twice as strong.
lacuna::simulation<plane> ropes(std::vector<double> const& strengths) {
    lacuna::packing<double, 2> discs;
    auto p = springs<plane>(stiffness, stiffness, 0);
    for (std::size_t r = 0; r < strengths.size(); ++r)
        for (int k = 0; k < 5; ++k) {
            discs.add({2 * radius * k, 10.0 * double(r)}, radius);
            if (k == 4) continue;
            discs.bonds.push_back({std::int32_t(5 * r) + k, std::int32_t(5 * r) + k + 1});
            double const force = strengths[r] * (k == 1 ? 1 : 2);
            p.bonds.push_back({.tensile_force = force, .shear_force = force});
        }
    lacuna::simulation<plane> sim(discs, p);
    for (std::size_t r = 0; r < strengths.size(); ++r) sim.fix(5 * r);
    return sim;
}

} // namespace

TEST_CASE("a bond fails at the load of its strength, whatever the load steps", "[equilibrium][loads]") {
    for (int const steps : {1, 3, 20}) {
        auto sim = ropes({10});
        lacuna::equilibrium<plane> eq(sim, {.tolerance = 1e-10});
        std::size_t seen = 0;
        auto const path = eq.follow({0, 13, steps}, [&](double force) { sim.apply(4, {force, 0}); },
                                    [&](lacuna::load_point const& point) {
                                        // The rope is a spring of k / 4.
                                        REQUIRE_THAT(sim.position(4)[0] - 8 * radius,
                                                     WithinAbs(point.value / (stiffness / 4), 1e-12));
                                        REQUIRE_THAT(point.energy.work,
                                                     WithinAbs(2 * point.value * point.value / stiffness, 1e-12));
                                        REQUIRE(point.broken == 0);
                                        ++seen;
                                    });
        REQUIRE(path.outcome == lacuna::equilibrium_outcome::mechanism);
        REQUIRE_THAT(path.value, WithinRel(10.0, 1e-7));
        REQUIRE(eq.events().size() == 1);
        REQUIRE(eq.events()[0].bond == 1);
        REQUIRE_THAT(eq.events()[0].load, WithinRel(10.0, 1e-7));
        REQUIRE(seen == std::size_t(10 * steps / 13) + 1);
        REQUIRE(path.points.size() == seen);
    }
}

TEST_CASE("a bundle of ropes under a growing displacement: the force falls with each rope that fails",
          "[equilibrium][loads]") {
    std::vector<double> const strengths{10, 17, 25};
    auto sim = ropes(strengths);
    std::vector<std::size_t> const ends{4, 9, 14};
    for (auto const id : ends) sim.fix(id);
    lacuna::equilibrium<plane> eq(sim, {.tolerance = 1e-10});
    auto const path = eq.follow({0, 1.5e-4, 5}, [&](double from, double to) {
        for (auto const id : ends) eq.move(id, {to - from, 0});
    });
    REQUIRE(path.reached());
    REQUIRE(eq.events().size() == 3);
    double lost = 0, work = 0;
    for (std::size_t r = 0; r < 3; ++r) {
        REQUIRE(eq.events()[r].bond == std::int32_t(4 * r) + 1);
        REQUIRE_THAT(eq.events()[r].load, WithinRel(4 * strengths[r] / stiffness, 1e-8));
        // A rope that fails loses the energy of its four springs: that of the bond that fails, and that of the others,
        // which snap back.
        lost += 0.5 * strengths[r] * strengths[r] / stiffness;
        work += 2 * strengths[r] * strengths[r] / stiffness;
    }
    REQUIRE_THAT(path.energy.fracture, WithinRel(lost, 1e-7));
    REQUIRE_THAT(path.energy.released, WithinRel(3 * lost, 1e-6));
    REQUIRE_THAT(path.energy.work, WithinRel(work, 1e-7));
    REQUIRE_THAT(path.energy.strain, WithinAbs(0, 1e-9 * work));
    REQUIRE_THAT(path.energy.residual(), WithinAbs(0, 1e-9 * work));
}

TEST_CASE("bonds that are overloaded at once fail one by one, or the worst of each group", "[equilibrium][loads]") {
    // Three ropes pull at one disc each; each stands 15 % of the load more than the one before.
    for (bool const groups : {false, true}) {
        auto sim = ropes({10, 11.5, 13});
        std::vector<std::size_t> const ends{4, 9, 14};
        for (auto const id : ends) sim.fix(id);
        lacuna::equilibrium<plane> eq(
            sim, {.tolerance = 1e-10,
                  .failures = groups ? lacuna::failure_choice::worst_of_groups : lacuna::failure_choice::first});
        std::vector<int> group_of(12, 0);
        for (std::size_t b = 8; b < 12; ++b) group_of[b] = 1;
        if (groups) eq.group_bonds(group_of);
        for (auto const id : ends) eq.move(id, {4 * 14.0 / stiffness, 0});
        auto const found = eq.solve();
        REQUIRE(found.reached());
        REQUIRE(eq.events().size() == 3);
        std::vector<int> order;
        for (auto const& e : eq.events()) order.push_back(e.bond);
        REQUIRE(order == (groups ? std::vector<int>{1, 9, 5} : std::vector<int>{1, 5, 9}));
        REQUIRE_THAT(eq.events()[0].load, WithinRel(10.0 / 14, 1e-8));
    }
}

TEST_CASE("a disc that is dragged over a floor: friction and strain are the work", "[equilibrium][loads]") {
    double const press = 100, friction = 0.4, limit = friction * press; // N
    auto p = springs<plane>(stiffness, stiffness, friction);
    p.walls = {{{0, 0}, {0, 1}, p.materials[0].contact}};
    lacuna::packing<double, 2> one;
    one.add({0, radius}, radius);
    lacuna::simulation<plane> sim(one, p);
    sim.fix(0, {.x = true, .rotation = true});
    lacuna::equilibrium<plane> eq(sim, {.tolerance = 1e-10});
    auto const pressed = eq.follow({0, press, 3}, [&](double force) { sim.apply(0, {0, -force}); });
    REQUIRE_THAT(pressed.energy.strain, WithinRel(0.5 * press * press / stiffness, 1e-8));
    REQUIRE_THAT(pressed.energy.work, WithinRel(pressed.energy.strain, 1e-8));
    double const sticks = limit / stiffness;
    auto const drag = [&](double from, double to) { eq.move(0, {to - from, 0}); };
    auto const stuck = eq.follow({0, sticks, 2}, drag);
    REQUIRE_THAT(stuck.energy.work, WithinRel(0.5 * limit * sticks, 1e-6));
    REQUIRE_THAT(stuck.energy.friction, WithinAbs(0, 1e-8 * stuck.energy.work));
    auto const slid = eq.follow({sticks, 5 * sticks, 3}, drag);
    REQUIRE_THAT(slid.energy.friction, WithinRel(4 * limit * sticks, 1e-6));
    REQUIRE_THAT(slid.energy.work, WithinRel(4 * limit * sticks, 1e-6));
    REQUIRE_THAT(slid.energy.residual(), WithinAbs(0, 1e-9 * slid.energy.work));
    // Back again: the shear force turns round, and its springs give their energy back on the way.
    auto const back = eq.follow({5 * sticks, 4 * sticks, 2}, drag);
    REQUIRE_THAT(back.energy.work, WithinRel(-0.5 * limit * sticks, 1e-6));
    REQUIRE_THAT(back.energy.residual(), WithinAbs(0, 1e-9 * slid.energy.work));
}

TEST_CASE("stages of a load program: up and down again", "[equilibrium][loads]") {
    auto sim = ropes({10});
    lacuna::equilibrium<plane> eq(sim, {.tolerance = 1e-10});
    auto const pull = [&](double force) { sim.apply(4, {force, 0}); };
    REQUIRE_THAT(eq.follow({0, 8, 4}, pull).energy.work, WithinRel(2 * 64 / stiffness, 1e-8));
    auto const down = eq.follow({8, 2, 3}, pull);
    REQUIRE(down.reached());
    REQUIRE(down.value == 2);
    REQUIRE_THAT(down.energy.work, WithinRel(2 * (4 - 64) / stiffness, 1e-8));
    REQUIRE_THAT(sim.position(4)[0] - 8 * radius, WithinRel(8 / stiffness, 1e-6));
    REQUIRE_THAT(eq.follow({2, 20, 2}, pull).value, WithinRel(10.0, 1e-7));
    REQUIRE(eq.events().size() == 1);
}

TEST_CASE("an observer ends a stage of a load program", "[equilibrium][loads]") {
    auto sim = ropes({10});
    lacuna::equilibrium<plane> eq(sim, {.tolerance = 1e-10});
    std::size_t seen = 0;
    auto const path = eq.follow({0, 8, 8}, [&](double force) { sim.apply(4, {force, 0}); },
                                [&](lacuna::load_point const& point) { return ++seen, point.value < 3; });
    REQUIRE(path.reached());
    REQUIRE(path.value == 3);
    REQUIRE(seen == 4);
    REQUIRE(path.points.size() == 4);
    REQUIRE_THAT(sim.position(4)[0] - 8 * radius, WithinRel(3 / (stiffness / 4), 1e-6));
}

TEST_CASE("what is displaced arrives, also where only regularised solves converge", "[equilibrium][loads]") {
    int reached = 0;
    for (int iterations = 2; iterations < 30; ++iterations) {
        lacuna::simulation<plane> sim(chain<2>(2, false), springs<plane>(stiffness, stiffness, 0.3));
        sim.fix(0);
        sim.fix(1);
        auto const start = sim.position(1);
        lacuna::equilibrium<plane> eq(sim, {.iterations = iterations});
        auto const path =
            eq.follow({0, 1e-3, 3}, [&](double from, double to) { eq.move(1, {from - to, 0.5 * (to - from)}); });
        CAPTURE(iterations);
        if (!path.reached()) continue;
        ++reached;
        REQUIRE_THAT(start[0] - sim.position(1)[0], WithinAbs(1e-3, 1e-12));
        REQUIRE_THAT(sim.position(1)[1] - start[1], WithinAbs(5e-4, 1e-12));
    }
    REQUIRE(reached > 10);
}

TEST_CASE("a load program refuses what has no meaning", "[equilibrium][loads]") {
    auto sim = ropes({10});
    lacuna::equilibrium<plane> eq(sim, {.failures = lacuna::failure_choice::worst_of_groups});
    auto const nothing = [](double) {};
    REQUIRE_THROWS_WITH(eq.follow({0, 1, 0}, nothing), contains_text("load_stage.steps"));
    REQUIRE_THROWS_WITH(eq.follow({0, std::nan(""), 1}, nothing), contains_text("load_stage.to"));
    REQUIRE_THROWS_WITH(eq.group_bonds({1}), contains_text("as many as bonds, 4"));
    REQUIRE_THROWS_WITH(eq.solve(), contains_text("group_bonds()"));
    lacuna::equilibrium<plane> one(sim);
    REQUIRE_THROWS_WITH(one.follow({0, 1, 1}, [&](double, double) { one.move(4, {1e-3, 0}); }),
                        contains_text("displacement of particle 4"));
    REQUIRE(one.solve().reached());
}
