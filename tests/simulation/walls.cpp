// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <limits>

#include "catch.hpp"
#include "simulation/setups.hpp"

/// \file
/// Walls that move: with prescribed velocities, or by a servo.

using namespace setups;

namespace {

/// A disc or sphere of 1 kg and radius 0.5 m at the origin, and an upward facing wall `gap` below its lowest point.
template <class Model>
struct above_a_wall {
    static constexpr int dim = Model::dim;
    lacuna::simulation_parameters<Model> p;
    lacuna::packing<double, dim> packing;

    explicit above_a_wall(double gap, double friction = 0, double kn = 1e4)
        : p(springs<Model>(kn, 0.8 * kn, friction, unit_density(dim))) {
        packing.add({}, 0.5);
        lacuna::vec<double, dim> floor{}, up{};
        floor[1] = -0.5 - gap;
        up[1] = 1;
        p.walls = {{floor, up, p.materials[0].contact}};
        p.time_step = 0.02 / std::sqrt(kn);
    }
};
lacuna::vec<double, 2> along_y(double v) { return {0, v}; }

} // namespace

TEMPLATE_TEST_CASE("a particle leaves a moving wall at twice the speed of the wall", "[walls]", plane, space) {
    above_a_wall<TestType> s(1.2);
    lacuna::simulation<TestType> sim(s.packing, s.p);
    lacuna::vec<double, TestType::dim> v{};
    v[1] = 0.5;
    sim.move_wall(0, v);
    double worst = 0;
    while (sim.time() < 3.2) {
        sim.step_with_energy();
        worst = std::max(worst, std::fabs(sim.energy().residual()));
    }
    CHECK_THAT(sim.walls().point(0)[1], WithinRel(-1.7 + 0.5 * sim.time(), 1e-9));
    CHECK_THAT(sim.velocity(0)[1], WithinRel(1.0, 1e-4));
    CHECK_THAT(sim.energy().external, WithinRel(0.5, 1e-4)); // m (2 v)^2 / 2
    CHECK_THAT(sim.energy().prescribed, WithinRel(0.5, 1e-4));
    CHECK(worst < 1e-3 * 0.5);
}

TEST_CASE("a particle on a belt slips, then rolls at a third of the belt's speed", "[walls]") {
    double const g = 10, mu = 0.3, belt = 0.6, kn = 1e6;
    above_a_wall<plane> s(-1 * g / kn, mu, kn);
    s.p.gravity = {0, -g};
    lacuna::simulation<plane> sim(s.packing, s.p);
    sim.move_wall(0, {belt, 0});
    double const slips = belt / (3 * mu * g);
    while (sim.time() < 0.5 * slips) sim.step_with_energy();
    CHECK_THAT(sim.velocity(0)[0], WithinRel(mu * g * sim.time(), 5e-3));
    // Then it oscillates on the spring of the contact, with (mu g)^2 / (2 k_s) J: one percent of the speed.
    while (sim.time() < 3 * slips) sim.step_with_energy();
    // v = mu g t and r w = 2 v until the point of contact has the belt's speed, v + r w.
    double const t = sim.time() - slips;
    CHECK_THAT(sim.position(0)[0], WithinRel(belt * slips / 6 + belt / 3 * t, 5e-3));
    CHECK_THAT(sim.spin(0)[0] * 0.5, WithinRel(2 * belt / 3, 0.02));
    CHECK_THAT(sim.energy().prescribed, WithinRel(belt * belt / 3, 0.02));
    CHECK_THAT(sim.energy().friction, WithinRel(belt * belt / 6, 5e-3));
    CHECK(std::fabs(sim.energy().residual()) < 1e-3 * sim.energy().largest());
}

TEST_CASE("a particle that starts in or near contact with a wall is at rest there, and later touches it at its radius",
          "[walls]") {
    double const kn = 1e4, speed = 0.2, depth = speed / std::sqrt(kn); // m v^2 = k depth^2
    for (double const overlap : {0.005, -0.005})
        for (double const skin : {0.1, 0.0}) {
            INFO("overlap " << overlap << ", skin " << skin);
            above_a_wall<plane> s(-overlap);
            s.p.interactions.initial_contact_tolerance = 0.02; // of the radius of 0.5: 0.01
            s.p.interactions.skin = skin;
            lacuna::simulation<plane> sim(s.packing, s.p);
            sim.run(100);
            REQUIRE(sim.position(0) == lacuna::vec<double, 2>{});
            REQUIRE(sim.walls().force(0)[1] == 0);
            for (double const touching : {0.0, overlap}) {
                sim.set_velocity(0, along_y(-speed));
                double deepest = 1;
                while (sim.velocity(0)[1] < 0 || sim.position(0)[1] < 0.01) {
                    sim.run(1);
                    deepest = std::min(deepest, sim.position(0)[1]);
                }
                REQUIRE_THAT(deepest, WithinAbs(touching - depth, 1e-3 * depth));
                REQUIRE_THAT(sim.velocity(0)[1], WithinRel(speed, 1e-3));
            }
        }

    double const overlap = 0.005;
    above_a_wall<plane> deep(-3 * overlap); // beyond the tolerance: the overlap is a force
    deep.p.interactions.initial_contact_tolerance = 0.02;
    lacuna::simulation<plane> overlapping(deep.packing, deep.p);
    overlapping.run(1);
    CHECK_THAT(overlapping.walls().force(0)[1], WithinRel(-kn * 3 * overlap, 1e-9));
}

TEST_CASE("a wall's ramp is linear in its velocity", "[walls]") {
    above_a_wall<plane> s(10);
    lacuna::simulation<plane> sim(s.packing, s.p);
    sim.move_wall(0, {-0.1, 0.4}, 0.05);
    while (sim.steps() < 125) sim.step();
    CHECK_THAT(sim.walls().point(0)[1], WithinAbs(-10.5 + 0.5 * 0.4 * 0.025 * 0.025 / 0.05, 1e-12));
    while (sim.steps() < 500) sim.step();
    CHECK_THAT(sim.walls().point(0)[1], WithinAbs(-10.5 + 0.5 * 0.4 * 0.05 + 0.4 * 0.05, 1e-12));
    CHECK_THAT(sim.walls().velocity(0)[0], WithinAbs(-0.1, 1e-15));
}

TEST_CASE("a servo makes up a fixed share of the missing force in each step", "[walls][servo]") {
    above_a_wall<plane> s(-1e-4);
    lacuna::simulation<plane> sim(s.packing, s.p);
    sim.fix(0);
    sim.servo_wall(0, {5.0, 2.0, 9.0, 0.25, {}}); // 10 N; at first there is 1 N
    double missing = 9;
    for (int k = 0; k < 40; ++k) {
        sim.step();
        CHECK_THAT(sim.walls().force(0)[1], WithinAbs(-10 + missing, 1e-9));
        missing *= 0.75;
    }
    // move_wall() ends the servo.
    sim.move_wall(0, along_y(0));
    sim.step();
    double const position = sim.walls().point(0)[1];
    sim.apply(0, {0, -5});
    sim.step();
    CHECK(sim.walls().point(0)[1] == position);
}

TEST_CASE("a servo without contacts approaches at its largest speed, and stops at the stress", "[walls][servo]") {
    struct damped : plane {
        using damping = lacuna::local_damping;
    };
    auto p = springs<damped>(1e4, 8e3, 0, unit_density(2));
    p.damping = {0.5};
    p.walls = {{{0, -0.5}, {0, 1}, p.materials[0].contact}, {{0, 2.9}, {0, -1}, p.materials[0].contact}};
    lacuna::packing<double, 2> column;
    for (int k = 0; k < 3; ++k) column.add({0, double(k)}, 0.5);
    lacuna::simulation<damped> sim(column, p);
    lacuna::wall_servo<2> servo;
    servo.stress = 8;
    servo.area = 0.5;
    servo.max_speed = 0.05;
    sim.servo_wall(1, servo);
    while (sim.time() < 2) sim.step();
    CHECK_THAT(sim.walls().point(1)[1], WithinAbs(2.9 - 0.05 * sim.time(), 1e-9));
    while (sim.time() < 20) sim.step();
    CHECK_THAT(sim.walls().force(1)[1], WithinRel(4.0, 1e-3));
    CHECK_THAT(sim.walls().force(0)[1], WithinRel(-4.0, 1e-3));
    // Each of two contacts of discs and two with walls gives 4 N / k_n.
    CHECK_THAT(sim.walls().point(1)[1], WithinAbs(2.5 - 4 * 4 / 1e4, 1e-5));
    // Pushed from below it recedes and holds the force, except for the part that moves it: v dt k_n / relaxation.
    sim.move_wall(0, along_y(0.01), 1.0);
    while (sim.time() < 30) sim.step_with_energy();
    CHECK_THAT(sim.walls().velocity(1)[1], WithinAbs(0.01, 1e-4));
    CHECK_THAT(sim.walls().force(1)[1], WithinRel(4 + 0.01 * sim.time_step() * 1e4 / 0.5, 1e-3));
    CHECK(std::fabs(sim.energy().residual()) < 1e-3 * sim.energy().largest());
}

TEST_CASE("the area of a servo is that between the walls beside it", "[walls][servo]") {
    auto p = springs<plane>(1e4, 8e3, 0, unit_density(2));
    p.thickness = 0.2;
    p.time_step = 1e-4;
    auto const m = p.materials[0].contact;
    p.walls = {{{-0.5, 0}, {1, 0}, m}, {{0.5, 0}, {-1, 0}, m}, {{0, -0.5}, {0, 1}, m}, {{0, 0.5}, {0, -1}, m}};
    lacuna::packing<double, 2> one;
    one.add({0, 0}, 0.5);
    lacuna::simulation<plane> sim(one, p);
    sim.fix(0);
    sim.servo_wall(3, {10, 0, 1, 0.5, {{{0, 1}}}});
    sim.move_wall(1, {0.2, 0}); // away: the area grows with it
    for (int k = 0; k < 5000; ++k) sim.step();
    CHECK_THAT(sim.walls().force(3)[1], WithinRel(10 * 0.2 * (1 + 0.2 * 0.5), 1e-4));
}

TEST_CASE("bad walls, motions and servos are refused by name", "[walls][refusal]") {
    above_a_wall<plane> s(0);
    lacuna::simulation<plane> sim(s.packing, s.p);
    CHECK_THROWS_WITH(sim.move_wall(1, {0, 0}), contains_text("wall = 1: must be below the number of walls, 1"));
    CHECK_THROWS_WITH(sim.move_wall(0, {0, never}), contains_text("wall 0.velocity = inf"));
    CHECK_THROWS_WITH(sim.move_wall(0, {0, 0}, -1), contains_text("wall 0.ramp_time = -1"));
    CHECK_THROWS_WITH(sim.servo_wall(2, {1, 1, 1, 0.5, {}}), contains_text("wall = 2"));
    CHECK_THROWS_WITH(sim.servo_wall(0, {-1, 1, 1, 0.5, {}}), contains_text("wall 0.servo.stress = -1"));
    CHECK_THROWS_WITH(sim.servo_wall(0, {1, -1, 1, 0.5, {}}), contains_text("wall 0.servo.area = -1"));
    CHECK_THROWS_WITH(sim.servo_wall(0, {1, 1, 0, 0.5, {}}), contains_text("wall 0.servo.max_speed = 0"));
    CHECK_THROWS_WITH(sim.servo_wall(0, {1, 1, 1, 1.5, {}}),
                      contains_text("wall 0.servo.relaxation = 1.5: must be > 0 and <= 1"));
    CHECK_THROWS_WITH(sim.servo_wall(0, {1, 0, 1, 0.5, {}}),
                      contains_text("wall 0.servo.between = 0: must be two different walls"));
    CHECK_THROWS_WITH(sim.servo_wall(0, {1, 0, 1, 0.5, {{{0, 3}}}}), contains_text("wall 0.servo.between = 3"));
    sim.move_wall(0, along_y(-1e4));
    CHECK_THROWS_WITH(sim.step(), contains_text("a wall moved 4 of the smallest radius in one step (limit 0.1)"));
}
