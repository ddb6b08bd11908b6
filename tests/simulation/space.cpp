// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

lacuna::simulation_parameters<space> unit_springs_in_space(double tensile = never, double shear = never,
                                                           double friction = 0) {
    // The bond's area is pi R^2: strengths are divided by it, so that they are limits in N.
    double const area = pi * 0.25;
    auto p = springs<space>(1, 1, friction, unit_density(3), tensile / area, shear / area);
    p.time_step = 1e-3;
    return p;
}

} // namespace

TEST_CASE("mass and moment of inertia of a sphere", "[3d]") {
    lacuna::packing<double, 3> one;
    one.add({0, 0, 0}, 0.25);
    auto p = springs<space>(1, 1, 0, 3000);
    p.time_step = 1;
    lacuna::simulation<space> run(one, p);
    REQUIRE_THAT(run.mass(0), WithinRel(3000 * 4.0 / 3 * pi * 0.015625, 1e-14));
    REQUIRE_THAT(run.moment_of_inertia(0), WithinRel(0.4 * 3000 * 4.0 / 3 * pi * 0.015625 * 0.0625, 1e-14));
}

TEST_CASE("two spheres collide head-on in any direction", "[3d][collision]") {
    // m_eff = 1/2 kg, k = 1 N/m: half a period pi / sqrt(2), deepest v / sqrt(2).
    for (lacuna::vec<double, 3> const& n :
         {lacuna::vec<double, 3>{1, 0, 0}, lacuna::vec<double, 3>{0.36, -0.48, 0.8}}) {
        auto p = unit_springs_in_space(never, never, 0.5);
        lacuna::packing<double, 3> two;
        two.add({1, 2, 3}, 0.5);
        two.add(lacuna::vec<double, 3>{1, 2, 3} + n, 0.5);
        lacuna::simulation<space> run(two, p);
        double const speed = 1e-2;
        run.set_velocity(0, n * speed);
        double deepest = 0, end = 0;
        for (int k = 0; k < 3000; ++k) {
            double const now = run.time();
            run.step();
            deepest = std::max(deepest, 1 - norm(run.position(1) - run.position(0)));
            if (k > 2 && end == 0 && norm(pair_force(run, 0, 1)) == 0) end = now;
        }
        REQUIRE_THAT(deepest, WithinRel(speed / std::sqrt(2.0), 1e-4));
        REQUIRE_THAT(end, WithinAbs(pi / std::sqrt(2.0), 2e-3));
        REQUIRE(norm(run.velocity(1) - n * speed) < 1e-3 * speed);
        REQUIRE(norm(run.velocity(0)) < 1e-3 * speed);
        REQUIRE(norm(run.spin(0)) + norm(run.spin(1)) < 1e-12);
    }
}

TEST_CASE("two spheres that slide through a collision", "[3d][collision][friction]") {
    // Full sliding: the tangential impulse is mu times the normal impulse m v_n (equal masses, e = 1), opposite to the
    // slip; each sphere gains the spin R J_t / I, about the axis n x t.
    double const mu = 0.1, vn = 1e-4, vt = 1e-3;
    lacuna::vec<double, 3> const n{0.36, -0.48, 0.8}, t{0.8, 0.6, 0};
    auto p = unit_springs_in_space(never, never, mu);
    lacuna::packing<double, 3> two;
    two.add({0, 0, 0}, 0.5);
    two.add(n, 0.5);
    lacuna::simulation<space> run(two, p);
    run.set_velocity(0, n * vn + t * vt);
    for (int k = 0; k < 3000; ++k) run.step();
    double const impulse = vn;
    REQUIRE_THAT(dot(run.velocity(1), n), WithinRel(vn, 3e-2)); // the normal turns by v_t t / d = 2e-3
    REQUIRE_THAT(dot(run.velocity(1), t), WithinRel(mu * impulse, 3e-2));
    REQUIRE_THAT(dot(run.velocity(0), t), WithinRel(vt - mu * impulse, 1e-3));
    // Friction on sphere 0 is -mu J t at the arm + n R: torque R n x (-t).
    auto const axis = cross(n, t);
    double const spin = -0.5 * mu * impulse / (0.4 * 0.25);
    REQUIRE_THAT(dot(run.spin(0), axis), WithinRel(spin, 2e-2));
    REQUIRE_THAT(dot(run.spin(1), axis), WithinRel(spin, 2e-2));
    REQUIRE(norm(run.spin(0) - axis * dot(run.spin(0), axis)) < 1e-2 * std::fabs(spin));
}

TEST_CASE("a pair of spheres pulled and sheared to failure", "[3d][fracture]") {
    double const limit = 1e-5;
    lacuna::vec<double, 3> const n{0.36, -0.48, 0.8}, t{0.8, 0.6, 0};
    for (bool const pulled : {true, false}) {
        auto p = unit_springs_in_space(pulled ? limit : never, pulled ? never : limit);
        lacuna::packing<double, 3> two;
        two.add({0, 0, 0}, 0.5);
        two.add(n, 0.5);
        two.bonds.push_back({1, 0});
        lacuna::simulation<space> run(two, p);
        run.fix(0);
        run.fix(1);
        run.set_velocity(1, (pulled ? n : t) * limit); // reaches the limit after one second
        while (run.events().empty() && run.steps() < 2000) run.step();
        REQUIRE(run.events().size() == 1);
        auto const& e = run.events()[0];
        REQUIRE_THAT(e.time, WithinAbs(1, 1.01e-3));
        REQUIRE(e.mode == (pulled ? lacuna::bond_state::broken_in_tension : lacuna::bond_state::broken_in_shear));
        REQUIRE_THAT(pulled ? e.normal_force : e.shear_force, WithinRel(limit, 2e-3));
        REQUIRE_THAT(e.energy, WithinRel(limit * limit / 2, 4e-3));
        for (int axis = 0; axis < 3; ++axis) REQUIRE_THAT(e.position[axis], WithinAbs(n[axis] / 2, 2e-5));
        run.step();
        REQUIRE(run.pairs().bonds().size() == 0);
        REQUIRE(norm(pair_force(run, 0, 1)) < 1e-9);
    }
}

TEST_CASE("a shear force in 3D follows the slip, and rotates the spheres", "[3d]") {
    lacuna::packing<double, 3> two = chain<3>(2);
    lacuna::simulation<space> run(two, unit_springs_in_space());
    run.fix(0);
    run.fix(1);
    run.set_velocity(1, {0, 1e-6, 2e-6});
    for (int n = 0; n < 1001; ++n) run.step();
    auto const force = pair_force(run, 0, 1); // on the first: dragged along, k_s u
    REQUIRE_THAT(force[1], WithinRel(1e-6, 1e-5));
    REQUIRE_THAT(force[2], WithinRel(2e-6, 1e-5));
    lacuna::simulation<space> loose(two, unit_springs_in_space());
    loose.fix(1);
    loose.set_velocity(1, {0, 0, 1e-6});
    for (int n = 0; n < 100; ++n) loose.step();
    // Torque of a force along +z at +x R: about -y.
    REQUIRE(loose.spin(0)[1] < 0);
    REQUIRE_THAT(loose.spin(0)[0], WithinAbs(0, 1e-20));
    REQUIRE_THAT(loose.spin(0)[2], WithinAbs(0, 1e-20));
    auto const q = loose.orientation(0);
    REQUIRE_THAT(squared_norm(q), WithinRel(1.0, 1e-14));
}

TEST_CASE("the quaternion of a free sphere follows its rotation", "[3d]") {
    lacuna::packing<double, 3> one;
    one.add({0, 0, 0}, 0.5);
    auto p = unit_springs_in_space();
    lacuna::simulation<space> run(one, p);
    lacuna::vec<double, 3> const axis{0.36, 0.48, 0.8};
    run.set_spin(0, axis * 2.0);
    for (int n = 0; n < 1000; ++n) run.step();
    // Angle 2 rad: q = (cos 1, sin 1 axis); each step's angle is exact to second order, 2 rad * (2e-3)^2 / 12.
    auto const q = run.orientation(0);
    REQUIRE_THAT(q[0], WithinAbs(std::cos(1.0), 1e-6));
    for (int k = 0; k < 3; ++k) REQUIRE_THAT(q[k + 1], WithinAbs(std::sin(1.0) * axis[k], 1e-6));
}

TEST_CASE("the work of loads and of prescribed rotation in 3D is in the ledger", "[3d][energy]") {
    // The first sphere rotates at a given rate against the fixed second one: elastic work 1/2 k_s (R angle)^2.
    lacuna::simulation<space> run(chain<3>(2), unit_springs_in_space());
    run.fix(0);
    run.fix(1);
    run.set_spin(0, {0, 0, 1e-4});
    for (int n = 0; n < 1001; ++n) run.step_with_energy();
    double const expected = 0.5 * 0.5e-4 * 0.5e-4;
    REQUIRE_THAT(run.energy().strain, WithinRel(expected, 3e-3));
    REQUIRE_THAT(run.energy().external, WithinRel(expected, 3e-3));
    REQUIRE(std::fabs(run.energy().residual()) < 1e-3 * expected);
}

TEST_CASE("the shear force of a wall rotates with the sphere that twists on it", "[3d][friction]") {
    // Slid by u along x, then spun about the wall's normal: k_s u, turned by half the sphere's angle, as by the mean of
    // the two spins. Two full turns and a bit.
    auto p = unit_springs_in_space(never, never, 1.0);
    p.time_step = 1e-2;
    p.walls = {{{0, 0, 0}, {0, 0, 1}, p.materials[0].contact}};
    lacuna::packing<double, 3> one;
    one.add({0, 0, 0.49}, 0.5);
    lacuna::simulation<space> run(one, p);
    run.fix(0);
    double const slid = 1e-3, spin = 0.7;
    run.set_velocity(0, {slid, 0, 0});
    for (int n = 0; n < 100; ++n) run.step();
    run.set_velocity(0, {0, 0, 0});
    run.set_spin(0, {0, 0, spin});
    int const steps = 2000;
    for (int n = 0; n <= steps; ++n) run.step();
    auto const force = run.walls().force(0); // on the wall: along the slip
    double const angle = 0.5 * spin * steps * p.time_step;
    REQUIRE_THAT(std::hypot(force[0], force[1]), WithinRel(slid, 1e-10));
    REQUIRE_THAT(force[0], WithinAbs(slid * std::cos(angle), 1e-4 * slid));
    REQUIRE_THAT(force[1], WithinAbs(slid * std::sin(angle), 1e-4 * slid));
    REQUIRE(run.spin(0)[2] == spin);
}
