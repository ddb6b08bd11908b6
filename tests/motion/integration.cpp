// SPDX-License-Identifier: BSD-3-Clause

#include <Eigen/Dense>

#include <cmath>
#include <random>

#include <lacuna/loads/surface_traction.hpp>
#include <lacuna/motion/stable_step.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

/// Least-squares slope of log(error) over log(step).
double order(std::vector<double> const& step, std::vector<double> const& error) {
    double const n = double(step.size());
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t k = 0; k < step.size(); ++k) {
        double const x = std::log(step[k]), y = std::log(error[k]);
        sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

} // namespace

TEST_CASE("uniform acceleration gives the positions and velocities of the scheme", "[motion]") {
    // Semi-implicit steps give exactly x_n = g dt^2 n (n + 1) / 2 and v_n = n g dt.
    auto p = springs<plane>(1, 1);
    p.gravity = {0.5, -2};
    p.time_step = 0.125;
    p.start_time = 3;
    lacuna::packing<double, 2> one;
    one.add({1, 2}, 50); // large enough for long paths in a step
    lacuna::simulation<plane> run(one, p);
    for (int n = 0; n < 8; ++n) run.step();
    REQUIRE_THAT(run.velocity(0)[0], WithinRel(0.5, 1e-14));
    REQUIRE_THAT(run.velocity(0)[1], WithinRel(-2.0, 1e-14));
    REQUIRE_THAT(run.position(0)[0], WithinRel(1 + 0.5 * 0.015625 * 36, 1e-14));
    REQUIRE_THAT(run.position(0)[1], WithinRel(2 - 2 * 0.015625 * 36, 1e-14));
    REQUIRE_THAT(run.time(), WithinRel(4.0, 1e-15));
}

TEST_CASE("loads act on their particles only, and need memory only for the blocks of these", "[motion]") {
    // 700 discs far from each other: six blocks of at most 128.
    auto p = springs<plane>(1, 1);
    p.time_step = 0.125;
    lacuna::packing<double, 2> apart;
    for (int k = 0; k < 700; ++k) apart.add({1000.0 * k, 0}, 1);
    lacuna::simulation<plane> run(apart, p);
    auto const& store = run.particles();
    std::size_t const block = store.load_block;
    for (std::size_t first = 0; first < 700; first += block) REQUIRE(store.loads_of(first) == nullptr);
    std::size_t const one = 350;
    run.apply(one, {3, -4});
    std::size_t found = 0;
    for (std::size_t first = 0; first < 700; first += block) found += store.loads_of(first) != nullptr;
    REQUIRE(found == 1);
    for (int n = 0; n < 4; ++n) run.step();
    double const m = run.mass(one);
    for (std::size_t k = 0; k < 700; ++k) {
        REQUIRE_THAT(run.velocity(k)[0], WithinAbs(k == one ? 1.5 / m : 0.0, 1e-15));
        REQUIRE_THAT(run.velocity(k)[1], WithinAbs(k == one ? -2.0 / m : 0.0, 1e-15));
    }
    auto const inside = [&](std::size_t id) { return std::size_t(store.internal(id)); };
    REQUIRE(store.applied_force(inside(one))[1] == -4);
    REQUIRE(store.applied_force(inside(one - 1))[1] == 0);
}

TEST_CASE("a torque rotates a disc, and the orientation is a unit vector", "[motion]") {
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    p.time_step = 0.01;
    lacuna::packing<double, 2> one;
    one.add({0, 0}, 0.5);
    lacuna::simulation<plane> run(one, p);
    REQUIRE_THAT(run.moment_of_inertia(0), WithinRel(0.125, 1e-14)); // m r^2 / 2
    run.apply(0, {0, 0}, 0.25);                                       // 2 rad/s^2
    for (int n = 0; n < 100; ++n) run.step();
    REQUIRE_THAT(run.spin(0)[0], WithinRel(2.0, 1e-12));
    double const angle = 2 * 1e-4 * 5050;
    REQUIRE_THAT(run.orientation(0)[0], WithinRel(std::cos(angle), 1e-12));
    REQUIRE_THAT(run.orientation(0)[1], WithinRel(std::sin(angle), 1e-12));
}

TEST_CASE("the velocity along prescribed axes stays, along others it changes", "[motion]") {
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    p.time_step = 0.01;
    lacuna::packing<double, 2> one;
    one.add({0, 0}, 0.5);
    lacuna::simulation<plane> run(one, p);
    run.fix(0, {.x = true});
    run.set_velocity(0, {0.25, 0});
    run.apply(0, {1, 1}, 1);
    for (int n = 0; n < 100; ++n) run.step();
    REQUIRE(run.velocity(0)[0] == 0.25);
    REQUIRE_THAT(run.position(0)[0], WithinRel(0.25, 1e-12));
    REQUIRE_THAT(run.velocity(0)[1], WithinRel(1.0, 1e-12));
    REQUIRE_THAT(run.spin(0)[0], WithinRel(8.0, 1e-12));
}

TEST_CASE("a load ramps up linearly", "[motion]") {
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    p.time_step = 0.01;
    lacuna::packing<double, 2> one;
    one.add({0, 0}, 0.5);
    lacuna::simulation<plane> run(one, p);
    run.apply(0, {1, 0}, 0, 0.5);
    for (int n = 0; n < 100; ++n) run.step();
    // Sum of F dt: 0.01 * (0 + 0.02 + ... + 0.98) + 0.5 = 0.245 + 0.5.
    REQUIRE_THAT(run.velocity(0)[0], WithinRel(0.745, 1e-12));
}

TEST_CASE("the scheme is of second order in the positions", "[motion][order]") {
    // One disc on a spring, omega = 1. Velocities belong to half a step before the positions: v(-dt/2) = cos(dt/2).
    std::vector<double> steps, errors;
    for (int n = 50; n <= 800; n *= 2) {
        auto p = springs<plane>(1, 1, 0, unit_density(2));
        p.time_step = 5.0 / n;
        lacuna::simulation<plane> run(chain<2>(2), p);
        run.fix(0);
        run.set_velocity(1, {1e-3 * std::cos(p.time_step / 2), 0});
        double worst = 0;
        for (int k = 1; k <= n; ++k) {
            run.step();
            worst = std::max(worst, std::fabs(run.position(1)[0] - 1 - 1e-3 * std::sin(k * p.time_step)));
        }
        steps.push_back(p.time_step);
        errors.push_back(worst);
    }
    REQUIRE_THAT(order(steps, errors), WithinAbs(2, 0.02));
}

TEST_CASE("the bound is above every eigenfrequency of random assemblies", "[stability]") {
    std::mt19937_64 engine(11);
    auto const number = [&](double low, double high) { return low + (high - low) * double(engine() >> 11) * 0x1p-53; };
    double tightest = 0;
    for (int round = 0; round < 40; ++round) {
        std::size_t const n = 2 + std::size_t(round) % 9;
        lacuna::frequency_bound<2> bound(n);
        Eigen::MatrixXd k = Eigen::MatrixXd::Zero(int(3 * n), int(3 * n));
        Eigen::VectorXd root(int(3 * n));
        for (std::size_t i = 0; i < n; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                double const mobility = number(0, 1) < 0.1 ? 0 : number(0.5, 2) * (axis == 2 ? 8 : 1);
                bound.set_mobility(i, axis, mobility);
                root[int(3 * i) + axis] = std::sqrt(mobility);
            }
        auto const spring = [&](int i, int j, double gx, double gy, double li, double lj, double stiffness) {
            Eigen::VectorXd g = Eigen::VectorXd::Zero(int(3 * n));
            g[3 * i] = -gx, g[3 * i + 1] = -gy, g[3 * i + 2] = li;
            if (j >= 0) g[3 * j] = gx, g[3 * j + 1] = gy, g[3 * j + 2] = lj;
            k += stiffness * g * g.transpose();
        };
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 1; j < n; ++j) {
                if (j != i + 1 && number(0, 1) < 0.6) continue;
                double const angle = number(0, 2 * pi), kn = number(0.5, 3), ks = number(0, 2), pre = number(0, 0.2);
                double const li = number(0.3, 0.7), lj = number(0.3, 0.7), c = std::cos(angle), s = std::sin(angle);
                bound.add_pair(i, j, {c, s}, kn, ks, pre, li, lj);
                spring(int(i), int(j), c, s, 0, 0, kn);
                spring(int(i), int(j), -s, c, -li, -lj, ks); // slip (u_j - u_i).s - l_i theta_i - l_j theta_j
                spring(int(i), int(j), -s, c, 0, 0, pre);
            }
        bound.add_support(0, {0.6, 0.8}, 1.5, 0.5, 0.4);
        spring(0, -1, 0.6, 0.8, 0, 0, 1.5);
        spring(0, -1, -0.8, 0.6, -0.4, 0, 0.5);
        Eigen::MatrixXd const a = root.asDiagonal() * k * root.asDiagonal();
        double const exact = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues().maxCoeff());
        REQUIRE(bound.frequency() >= exact * (1 - 1e-12));
        REQUIRE_THAT(bound.time_step(), WithinRel(2 / bound.frequency(), 1e-15));
        tightest = std::max(tightest, exact / bound.frequency());
    }
    REQUIRE(tightest > 0.7); // the checks above would also accept a bound that is far too large
    REQUIRE(lacuna::frequency_bound<2>(3).frequency() == 0);
    REQUIRE(lacuna::frequency_bound<2>(3).time_step() == never);
}

TEST_CASE("pressure on a row of particles becomes forces", "[loads]") {
    REQUIRE_THAT(lacuna::traction_force(2e6, 1.5e-6, 3.5e-6, lacuna::traction_area::disc),
                 WithinRel(2e6 * pi * 2.25e-12, 1e-14));
    REQUIRE_THAT(lacuna::traction_force(2e6, 1.5e-6, 3.5e-6, lacuna::traction_area::strip),
                 WithinRel(2e6 * 3e-6 * 3.5e-6, 1e-14));
    REQUIRE_THROWS_WITH(lacuna::traction_force(never, 1, 1, lacuna::traction_area::disc), contains_text("pressure"));
    REQUIRE_THROWS_WITH(lacuna::traction_force(1, 0, 1, lacuna::traction_area::disc), contains_text("radius"));
    REQUIRE_THROWS_WITH(lacuna::traction_force(1, 1, 0, lacuna::traction_area::strip), contains_text("thickness"));
}
