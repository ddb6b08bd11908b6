// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <lacuna/packings/lammps_data.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "reference.hpp"
#include "simulation/setups.hpp"

/// \file
/// Models in a periodic domain: closed forms of rings and endless strips, and comparisons with an open domain.

using namespace setups;

namespace {

struct damped_ring : plane {
    using domain = lacuna::periodic_domain;
    using damping = lacuna::local_damping; // off by default
};
struct cell : space {
    using domain = lacuna::periodic_domain;
    using damping = lacuna::local_damping;
};

template <class Model>
lacuna::simulation_parameters<Model> undamped(double kn, double ks, double friction, double density,
                                              double tensile = never, double shear = never) {
    auto p = springs<Model>(kn, ks, friction, density, tensile, shear);
    p.damping = {0};
    return p;
}

/// Discs of radius 0.5 along x that close to a ring of `count`.
lacuna::packing<double, 2> closed_chain(int count) {
    auto p = chain<2>(count);
    p.bonds.push_back({count - 1, 0});
    return p;
}

/// A crowd in a periodic box of 8 by 6 (by 5), half of it bonded, with random velocities.
template <class Model>
lacuna::simulation<Model> crowd(int threads, bool reversed = false) {
    constexpr int dim = Model::dim;
    int const size[3] = {8, 6, dim == 3 ? 5 : 1};
    auto const noise = [](std::size_t k, int salt) { return std::sin(12.9898 * double(k) + 78.233 * salt); };
    lacuna::packing<double, dim> packing;
    auto p = undamped<Model>(100, 70, 0.4, unit_density(dim), 1.0, 1.0);
    for (int z = 0; z < size[2]; ++z)
        for (int y = 0; y < size[1]; ++y)
            for (int x = 0; x < size[0]; ++x) {
                auto const k = packing.size();
                int const at[3] = {x, y, z};
                lacuna::vec<double, dim> position{};
                for (int axis = 0; axis < dim; ++axis) position[axis] = at[axis] + 0.02 * noise(k, axis);
                packing.add(position, 0.49 + 0.02 * noise(k, 3));
                if (noise(k, 4) > -0.3)
                    packing.bonds.push_back(
                        {std::int32_t(k), std::int32_t(x + 1 < size[0] ? k + 1 : k + 1 - std::size_t(size[0]))});
            }
    if (reversed) {
        std::reverse(packing.position.begin(), packing.position.end());
        std::reverse(packing.radius.begin(), packing.radius.end());
        for (auto& b : packing.bonds)
            for (auto& id : b) id = std::int32_t(packing.size()) - 1 - id;
    }
    for (int axis = 0; axis < dim; ++axis) p.domain.period[axis] = size[axis];
    p.time_step = 5e-3;
    p.threads = threads;
    p.interactions.initial_contact_tolerance = 0.02;
    p.interactions.skin = 0.05;
    lacuna::simulation<Model> sim(packing, p);
    for (std::size_t k = 0; k < sim.size(); ++k) {
        lacuna::vec<double, dim> v{};
        auto const id = reversed ? sim.size() - 1 - k : k;
        for (int axis = 0; axis < dim; ++axis) v[axis] = 0.4 * noise(k, 6 + axis) + (axis == 0 ? 2.0 : 0.0);
        sim.set_velocity(id, v);
    }
    return sim;
}

} // namespace

TEST_CASE("a closed chain oscillates with the frequencies of a ring", "[periodic]") {
    // omega = 2 sqrt(k/m) sin(pi n / N); the scheme's is 2/dt asin(omega dt / 2).
    int const count = 10;
    double const k = 100;
    for (int const n : {1, 3, 5}) {
        auto p = undamped<damped_ring>(k, 0, 0, unit_density(2));
        p.domain.period = {double(count), 0};
        p.time_step = 0.01;
        lacuna::simulation<damped_ring> sim(closed_chain(count), p);
        double const speed = 1e-3;
        for (std::size_t i = 0; i < sim.size(); ++i)
            sim.set_velocity(i, {speed * std::cos(2 * pi * n * double(i) / count), 0});
        double const omega = 2 * std::sqrt(k) * std::sin(pi * n / count);
        double const frequency = 2 * std::asin(0.5 * omega * p.time_step) / p.time_step;
        double worst = 0;
        // x = A sin(frequency t) from v(-dt/2) = speed: A = speed / frequency (of the scheme) up to first order in dt.
        double const first = p.time_step * speed / std::sin(frequency * p.time_step);
        for (int step = 1; step <= 400; ++step) {
            sim.step_with_energy();
            double const moved = sim.position(0)[0];
            worst = std::max(worst, std::fabs(moved - first * std::sin(frequency * double(step) * p.time_step)));
        }
        CHECK(worst < 1e-6 * first);
        CHECK(std::fabs(sim.energy().residual()) < 1e-9 * sim.energy().largest());
    }
}

TEST_CASE("an endless strip of lattice has the lattice's C11", "[periodic]") {
    // Rows along x, pulled along y: there is no free side, so the strain along x stays zero.
    int const columns = 6, rows = 5;
    double const height = std::sqrt(0.75);
    for (std::string const ratio : {"1", "0.5", "0"}) {
        double const ks = std::stod(ratio);
        lacuna::packing<double, 2> strip;
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns; ++c) strip.add({c + 0.5 * (r % 2), r * height}, 0.5);
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns; ++c) {
                auto const at = [&](int row, int column) {
                    return std::int32_t(row * columns + (column + columns) % columns);
                };
                strip.bonds.push_back({at(r, c), at(r, c + 1)});
                if (r + 1 == rows) continue;
                int const left = r % 2 == 0 ? c - 1 : c;
                strip.bonds.push_back({at(r, c), at(r + 1, left)});
                strip.bonds.push_back({at(r, c), at(r + 1, left + 1)});
            }
        auto p = undamped<damped_ring>(1, ks, 0, unit_density(2));
        p.domain.period = {double(columns), 0};
        p.damping = {0.6};
        p.safety = 0.5;
        lacuna::simulation<damped_ring> sim(strip, p);
        double const force = 1e-7;
        for (int c = 0; c < columns; ++c) {
            sim.fix(std::size_t(c));
            sim.apply(std::size_t((rows - 1) * columns + c), {0, force});
        }
        for (int step = 0; step < 4000; ++step) sim.step();
        double const strain =
            (sim.position(std::size_t(rows * columns - 1))[1] - (rows - 1) * height) / ((rows - 1) * height);
        INFO("k_s / k_n = " << ratio);
        CHECK_THAT(force / strain, WithinRel(reference("3a.moduli_ks/kn=" + ratio, "C11"), 1e-5));
    }
}

TEMPLATE_TEST_CASE("pairs across an end of the period behave as in an open domain", "[periodic]", damped_ring, cell) {
    // Three discs collide and drift through the end of the period, in the periodic domain and in an open one.
    constexpr int dim = TestType::dim;
    using open = std::conditional_t<dim == 2, plane, space>;
    lacuna::packing<double, dim> three;
    lacuna::vec<double, dim> x{};
    x[0] = 7.2;
    three.add(x, 0.5);
    x[0] = 8.19;
    x[1] = 0.1;
    three.add(x, 0.5);
    x[0] = 9.3;
    three.add(x, 0.4);
    three.bonds.push_back({0, 1});
    auto q = springs<open>(1e3, 7e2, 0.5, unit_density(dim), 20, 10);
    auto p = undamped<TestType>(1e3, 7e2, 0.5, unit_density(dim), 20, 10);
    p.time_step = q.time_step = 1e-3;
    p.domain.period[0] = 8;
    auto wrapped = three;
    for (auto& position : wrapped.position)
        if (position[0] > 8) position[0] -= 8;
    lacuna::simulation<TestType> periodic(wrapped, p);
    lacuna::simulation<open> straight(three, q);
    lacuna::vec<double, dim> v{};
    v[0] = -3;
    v[dim - 1] += 0.5;
    periodic.set_velocity(2, v);
    straight.set_velocity(2, v);
    std::size_t broken = 0;
    for (int step = 0; step < 1500; ++step) {
        periodic.step();
        straight.step();
        REQUIRE(periodic.events().size() == straight.events().size());
        for (std::size_t e = 0; e < periodic.events().size(); ++e, ++broken)
            CHECK(periodic.events()[e].mode == straight.events()[e].mode);
    }
    CHECK(broken == 1);
    for (std::size_t k = 0; k < 3; ++k) {
        auto const apart = straight.position(k) - periodic.position(k);
        for (int axis = 0; axis < dim; ++axis) {
            double const whole = axis == 0 ? 8 * std::round(apart[0] / 8) : 0.0;
            CHECK_THAT(apart[axis], WithinAbs(whole, 1e-9));
            CHECK_THAT(straight.velocity(k)[axis] - periodic.velocity(k)[axis], WithinAbs(0, 1e-8));
        }
    }
}

TEMPLATE_TEST_CASE("a periodic crowd conserves momentum and has the same bits with threads and after a restart",
                   "[periodic][determinism]", damped_ring, cell) {
    auto one = crowd<TestType>(1), two = crowd<TestType>(2), reversed = crowd<TestType>(1, true);
    auto const before = momentum(one);
    long long broken = 0;
    std::string const file = "periodic" + std::to_string(TestType::dim) + ".bin";
    auto resumed = crowd<TestType>(1);
    for (int step = 0; step < 800; ++step) {
        one.step_with_energy();
        two.step_with_energy();
        reversed.step_with_energy();
        broken += long(one.events().size());
        if (step == 300) {
            lacuna::save_checkpoint(file, one);
            lacuna::load_checkpoint(file, resumed);
            std::remove(file.c_str());
        }
        if (step > 300) resumed.step_with_energy();
    }
    CHECK(broken > 5);
    CHECK(one.position(0)[0] > 7.5); // once around, through the end of the period
    CHECK(one.pairs().neighbors().build_count() > 5);
    for (int axis = 0; axis < TestType::dim; ++axis) CHECK_THAT(momentum(one)[axis] - before[axis], WithinAbs(0, 1e-9));
    CHECK(std::fabs(one.energy().residual()) < 5e-3 * one.energy().largest());
    CHECK(lacuna::state_hash(one) == lacuna::state_hash(two));
    CHECK(lacuna::state_hash(one) == lacuna::state_hash(resumed));
    for (std::size_t k = 0; k < one.size(); ++k)
        for (int axis = 0; axis < TestType::dim; ++axis) {
            CHECK(one.position(k)[axis] == reversed.position(one.size() - 1 - k)[axis]);
            CHECK(one.velocity(k)[axis] == reversed.velocity(one.size() - 1 - k)[axis]);
        }
}

TEST_CASE("invalid periods are refused by name", "[periodic][refusal]") {
    auto p = undamped<damped_ring>(100, 0, 0, 1000);
    auto const make = [&] { lacuna::simulation<damped_ring>(closed_chain(4), p); };
    CHECK_THROWS_WITH(make(), contains_text("domain.period = 0: must be > 0 along one axis at least"));
    p.domain.period = {-4, 0};
    CHECK_THROWS_WITH(make(), contains_text("domain.period = -4"));
    p.domain.period = {2, 0};
    CHECK_THROWS_WITH(make(), contains_text("domain.period = 2: must be 0 or at least 2.01 times"));
    p.domain.period = {4, 0};
    CHECK_NOTHROW(make());
}

TEST_CASE("a ring through the sides of a LAMMPS box", "[periodic]") {
    std::string const text =
        "ring\n\n3 atoms\n3 bonds\n-1 2 xlo xhi\n0 9 ylo yhi\n\nAtoms # sphere\n\n1 1 1 2000 -0.5 1 0 0 0 0\n"
        "2 1 1 1000 0.5 1 0 0 0 0\n3 1 1 500 -1.5 1 0 1 0 0\n\nBonds\n\n1 1 1 2\n2 1 2 3\n3 1 3 1\n";
    auto const list = lacuna::parse_lammps_data<2>(text, "f", {true, false});
    auto p = undamped<damped_ring>(100, 70, 0, 1);
    p.domain.period = list.packing.period;
    lacuna::simulation<damped_ring> sim(list.packing, p);
    // Each bond is 1 m long: nothing pulls; the file's densities make the masses.
    sim.run(3);
    for (std::size_t k = 0; k < 3; ++k) {
        REQUIRE(sim.position(k)[0] == -0.5 + double(k));
        REQUIRE_THAT(sim.mass(k), WithinRel(list.density[k] * pi / 4, 1e-15));
    }
    p.domain.period[0] = 4;
    REQUIRE_THROWS_WITH(lacuna::simulation<damped_ring>(list.packing, p),
                        contains_text("domain.period = 4: must be that of the packing's box along this axis, 3"));
}
