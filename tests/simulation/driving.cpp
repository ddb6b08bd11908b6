// SPDX-License-Identifier: BSD-3-Clause

#include <utility>

#include "catch.hpp"
#include "simulation/setups.hpp"

#include <lacuna/motion/velocity_verlet.hpp>

using namespace setups;

namespace {

struct verlet : plane {
    using integrator = lacuna::velocity_verlet;
};

/// Error of the position of the oscillator x'' = 1 - x from rest after `time`, with steps of time / count.
template <class Model>
double oscillator_error(int count) {
    auto p = springs<Model>(1, 1, 0, 4 / pi);
    double const duration = 2.0;
    p.time_step = duration / count;
    p.allow_unstable_step = true;
    lacuna::simulation<Model> sim(chain<2>(2), p);
    sim.fix(0);
    sim.apply(1, {1e-3, 0});
    sim.run(count);
    return std::fabs((sim.position(1)[0] - 1) / 1e-3 - (1 - std::cos(duration)));
}

} // namespace

TEST_CASE("velocity Verlet starts on time: its positions are of second order", "[motion]") {
    // Symplectic Euler uses the initial velocity as that of half a step earlier: first order.
    for (auto const& [fine, coarse, order] :
         {std::tuple{oscillator_error<verlet>(400), oscillator_error<verlet>(100), 2.0},
          std::tuple{oscillator_error<plane>(400), oscillator_error<plane>(100), 1.0}})
        REQUIRE_THAT(std::log(coarse / fine) / std::log(4), WithinAbs(order, 0.05));
    // A velocity given during the run also holds at the time of the positions.
    auto p = springs<verlet>(1, 1, 0, 4 / pi);
    p.time_step = 1e-3;
    lacuna::simulation<verlet> sim(chain<2>(2), p);
    sim.fix(0);
    sim.set_velocity(1, {1e-3, 0});
    sim.run(500);
    sim.set_velocity(1, {0, 0});
    double const start = (sim.position(1)[0] - 1) / 1e-3;
    sim.run(700);
    REQUIRE_THAT((sim.position(1)[0] - 1) / 1e-3, WithinAbs(start * std::cos(0.7), 1e-6));
}

TEST_CASE("a prescribed velocity rises linearly, and its work is in the ledger", "[loads]") {
    auto p = springs<plane>(1e4, 1e4, 0, 4 / pi);
    p.time_step = 1e-3;
    lacuna::simulation<plane> sim(chain<2>(2), p);
    sim.fix(0);
    sim.prescribe_velocity(1, {0.02, 0}, 0.5);
    for (int step = 0; step < 250; ++step) sim.step_with_energy();
    // v t^2 / (2 ramp) at half the ramp
    REQUIRE_THAT(sim.position(1)[0] - 1, WithinRel(0.02 * 0.25 * 0.25 / (2 * 0.5), 1e-9));
    for (int step = 0; step < 550; ++step) sim.step_with_energy();
    double const path = 0.02 * 0.5 / 2 + 0.02 * 0.3;
    REQUIRE_THAT(sim.position(1)[0] - 1, WithinRel(path, 1e-9));
    REQUIRE_THAT(sim.velocity(1)[0], WithinRel(0.02, 1e-12));
    double const stretched = path - 0.02 * p.time_step; // energies belong to the last forces
    REQUIRE_THAT(sim.energy().strain, WithinRel(0.5 * 1e4 * stretched * stretched, 1e-6));
    REQUIRE_THAT(sim.energy().residual(), WithinAbs(0, 1e-9 * sim.energy().largest()));
}

TEST_CASE("mass-proportional damping slows free motion exponentially, and counts in the bound", "[damping]") {
    auto p = springs<plane_combined>(1e4, 1e4, 0, 4 / pi);
    p.damping = {0, 3.0, 0};
    p.time_step = 1e-4;
    lacuna::packing<double, 2> two;
    two.add({0, 0}, 0.5);
    two.add({5, 0}, 0.5);
    lacuna::simulation<plane_combined> sim(two, p);
    sim.fix(1);
    sim.set_velocity(0, {0.7, 0});
    sim.set_spin(0, {0.4});
    for (int step = 0; step < 10000; ++step) sim.step_with_energy();
    REQUIRE_THAT(sim.velocity(0)[0], WithinRel(0.7 * std::exp(-3.0), 1e-3));
    REQUIRE_THAT(sim.spin(0)[0], WithinRel(0.4 * std::exp(-3.0), 1e-3));
    REQUIRE_THAT(sim.energy().residual(), WithinAbs(0, 1e-9 * sim.energy().largest()));
    // An oscillator with the drag alone: 4 / (b + sqrt(b^2 + 4 a)) of x'' = -a x - b x'.
    auto q = springs<plane_combined>(1.0, 0, 0, 4 / pi);
    q.damping = {0, 5.0, 0};
    lacuna::simulation<plane_combined> one(chain<2>(2), q);
    one.fix(0);
    REQUIRE_THAT(one.limits().rigorous, WithinRel(4 / (5 + std::sqrt(25 + 4.0)), 1e-12));
}

TEST_CASE("a torque accelerates the spin of a sphere, and its work is in the ledger", "[loads]") {
    auto p = springs<setups::space>(1e4, 1e4, 0, unit_density(3));
    p.time_step = 1e-3;
    lacuna::packing<double, 3> one;
    one.add({0, 0, 0}, 0.5);
    lacuna::simulation<setups::space> sim(one, p);
    lacuna::vec<double, 3> const torque{0.1, 0, -0.2};
    sim.apply(0, {}, torque, 0.5);
    for (int step = 0; step < 1500; ++step) sim.step_with_energy();
    double const inertia = 0.4 * 0.25, seconds = 1.0 + 0.25;
    for (int axis = 0; axis < 3; ++axis)
        REQUIRE_THAT(sim.spin(0)[axis], WithinAbs(torque[axis] / inertia * seconds, 3e-3));
    REQUIRE_THAT(sim.torque(0)[2], WithinRel(-0.2, 1e-12));
    REQUIRE_THAT(sim.energy().residual(), WithinAbs(0, 1e-9 * sim.energy().largest()));
}

TEST_CASE("the step follows the critical one when bonds break", "[limits]") {
    auto p = springs<plane>(1e4, 1e4, 0, 4 / pi);
    p.follow_critical_step = true;
    p.bonds.resize(3);
    p.bonds[0].normal_stiffness = 1e6;
    p.bonds[0].tensile_force = 1;
    p.interactions.contacts = false;
    lacuna::simulation<plane> sim(chain<2>(4), p);
    sim.fix(0);
    sim.prescribe_velocity(3, {1e-2, 0});
    double const first = sim.resolve_time_step();
    double time = 0;
    while (sim.events().empty()) {
        sim.run(1);
        time += first;
    }
    sim.run(1);
    REQUIRE(sim.time_step() > 3 * first);
    REQUIRE_THAT(sim.time_step(), WithinRel(p.safety * sim.limits().critical(), 1e-2));
    double const second = sim.time_step();
    sim.run(10);
    REQUIRE_THAT(sim.time(), WithinRel(time + 11 * second, 1e-9));
    // The particle with the prescribed speed has moved by speed times time.
    REQUIRE_THAT(sim.position(3)[0] - 3, WithinRel(1e-2 * sim.time(), 1e-9));
}

TEST_CASE("particles without contacts pass through each other", "[interactions]") {
    auto p = springs<plane>(1e4, 1e4, 0, 4 / pi);
    p.interactions.contacts = false;
    p.time_step = 1e-2;
    lacuna::packing<double, 2> two;
    two.add({0, 0}, 0.5);
    two.add({1.5, 0}, 0.5);
    lacuna::simulation<plane> sim(two, p);
    sim.set_velocity(0, {1, 0});
    sim.run(300);
    REQUIRE_THAT(sim.position(0)[0], WithinRel(3.0, 1e-12));
    REQUIRE(sim.pairs().contacts().size() == 0);
}

TEST_CASE("a rigid plate moves its particles as one, under the sum of their forces", "[loads]") {
    // Springs of 1 and 3 N/m to fixed discs, masses of 1 and 4 kg, and a load on one of them: one oscillator of 4 N/m
    // and 5 kg about F / 4.
    lacuna::packing<double, 2> discs;
    discs.add({0, 0}, 0.5);
    discs.add({1, 0}, 0.5);
    discs.add({0, 5}, 1);
    discs.add({2, 5}, 1);
    discs.bonds = {{0, 1}, {2, 3}};
    auto p = springs<plane>(1, 1, 0, 4 / pi);
    p.bonds = {{.normal_stiffness = 1}, {.normal_stiffness = 3}};
    p.time_step = 1e-3;
    lacuna::simulation<plane> sim(discs, p);
    sim.fix(0);
    sim.fix(2);
    REQUIRE_THAT(sim.mass(3), WithinRel(4.0, 1e-12));
    std::size_t const both[] = {3, 1};
    sim.attach_to_rigid_plate(both, 0);
    sim.apply(1, {1e-3, 2e-4});
    double worst = 0;
    for (int step = 1; step <= 4000; ++step) {
        sim.step_with_energy();
        double const expected = 1e-3 / 4 * (1 - std::cos(std::sqrt(4.0 / 5) * sim.time()));
        worst = std::max(worst, std::fabs(sim.position(1)[0] - 1 - expected));
        REQUIRE_THAT(sim.position(3)[0] - 2, WithinAbs(sim.position(1)[0] - 1, 1e-13));
        REQUIRE_THAT(sim.velocity(3)[0], WithinAbs(sim.velocity(1)[0], 1e-16));
    }
    // The first velocity of Euler's scheme is half a step early: v dt / 2, at most 1e-3 / 4 * 0.9 * 5e-4.
    REQUIRE(worst < 1.2e-7);
    REQUIRE(sim.position(3)[1] == 5);
    REQUIRE(std::fabs(sim.position(1)[1]) > 1e-5); // it is free along the plate
    REQUIRE_THAT(sim.energy().residual(), WithinAbs(0, 1e-9 * sim.energy().largest()));
    // Fixing one particle fixes the plate.
    lacuna::simulation<plane> held(discs, p);
    held.fix(0);
    held.fix(3);
    held.attach_to_rigid_plate(both, 0);
    held.apply(1, {1e-3, 0});
    held.run(100);
    REQUIRE(held.position(1)[0] == 1);

    std::size_t const again[] = {1}, twice[] = {0, 0};
    REQUIRE_THROWS_WITH(sim.attach_to_rigid_plate(again, 0),
                        "particle 1 of a rigid plate = given twice: must be in one plate along an axis, once");
    REQUIRE_THROWS_AS(sim.attach_to_rigid_plate(twice, 1), std::invalid_argument);
    REQUIRE_THROWS_AS(sim.attach_to_rigid_plate({}, 1), std::invalid_argument);
    REQUIRE_THROWS_AS(sim.attach_to_rigid_plate(both, 2), std::invalid_argument);
    sim.set_velocity(1, {0, 1});
    REQUIRE_THROWS_WITH(sim.attach_to_rigid_plate(both, 1), contains_text("velocity"));
}
