// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

/// Reproducible pseudo-random numbers in (-1, 1).
struct sequence {
    std::uint64_t state = 12345;
    double operator()() {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return double(state >> 11) * 0x1p-52 - 1;
    }
};

template <int Dim>
lacuna::packing<double, Dim> cluster() {
    // A lattice of mixed radii at spacing 1, some pairs overlapping a little, some apart.
    lacuna::packing<double, Dim> p;
    sequence next;
    for (int x = 0; x < 5; ++x)
        for (int y = 0; y < 5; ++y)
            for (int z = 0; z < (Dim == 3 ? 4 : 1); ++z) {
                lacuna::vec<double, Dim> at{};
                at[0] = x + 0.02 * next();
                at[1] = y + 0.02 * next();
                if constexpr (Dim == 3) at[2] = z + 0.02 * next();
                p.add(at, 0.48 + 0.06 * next());
            }
    lacuna::packing<double, Dim> all = p;
    bond_touching(all, 0.03);
    for (std::size_t b = 0; b < all.bonds.size(); b += 2) p.bonds.push_back(all.bonds[b]);
    return p;
}

template <class Model>
void check_momentum(double friction, double tensile, double shear, double speed) {
    constexpr int dim = Model::dim;
    auto p = springs<Model>(100, 70, friction, unit_density(dim), tensile, shear);
    p.interactions.initial_contact_tolerance = 0.01;
    p.safety = 0.1;
    p.mass = dim == 2 ? lacuna::mass_model::disc : lacuna::mass_model::sphere;
    lacuna::simulation<Model> run(cluster<dim>(), p);
    sequence next;
    double scale_p = 0, scale_l = 0;
    for (std::size_t k = 0; k < run.size(); ++k) {
        lacuna::vec<double, dim> v{};
        lacuna::vec<double, lacuna::rotation_dim<dim>> w{};
        // Velocities point inwards, so that contacts form, slide and separate.
        for (int axis = 0; axis < dim; ++axis) v[axis] = speed * (next() - 0.3 * (run.position(k)[axis] - 2));
        for (int axis = 0; axis < lacuna::rotation_dim<dim>; ++axis) w[axis] = 3 * speed * next();
        run.set_velocity(k, v);
        run.set_spin(k, w);
        scale_p += run.mass(k) * norm(v);
        scale_l += run.mass(k) * norm(v) * norm(run.position(k)) + run.moment_of_inertia(k) * norm(w);
    }
    auto const linear = momentum(run);
    auto const angular = angular_momentum(run);
    std::size_t broken = 0;
    for (int n = 0; n < 10000; ++n) {
        run.step_with_energy();
        broken += run.events().size();
    }
    REQUIRE(norm(momentum(run) - linear) < 1e-12 * scale_p);
    REQUIRE(norm(angular_momentum(run) - angular) < 1e-12 * scale_l);
    // The run contains the events that the test needs.
    REQUIRE((broken > 3) == (tensile < 1e10));
    if (friction > 0) REQUIRE(run.energy().friction > 0.01 * run.energy().initial);
    REQUIRE(std::fabs(run.energy().residual()) < 0.05 * run.energy().largest());
}

} // namespace

TEST_CASE("a free cluster in 2D conserves momentum", "[conservation]") {
    check_momentum<plane>(0, never, never, 0.05);
    check_momentum<plane>(0.5, never, never, 0.2);
    check_momentum<plane>(0.5, 1, 1, 0.2);
    check_momentum<plane_viscous>(0.5, 1, 1, 0.2);
}

TEST_CASE("a free cluster in 3D conserves momentum", "[conservation][3d]") {
    check_momentum<space>(0, never, never, 0.05);
    check_momentum<space>(0.5, 1, 1, 0.2);
}

TEST_CASE("the energy of a linear bonded chain adds up to rounding", "[energy]") {
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    p.time_step = 0.3;
    lacuna::simulation<plane> run(chain<2>(12), p);
    run.fix(0);
    // Large compared with the rounding of positions of about 10 m, the only error that remains.
    run.apply(11, {0.02, 0});
    for (std::size_t k = 1; k < 12; ++k) run.set_velocity(k, {0.01 * std::sin(3.7 * double(k)), 0});
    double worst = 0;
    for (int n = 0; n < 100000; ++n) {
        run.step_with_energy();
        worst = std::max(worst, std::fabs(run.energy().residual()) / run.energy().largest());
    }
    REQUIRE(worst < 1e-9);
    REQUIRE(run.energy().strain > 0);
    REQUIRE(run.energy().external != 0);
}

TEST_CASE("the energy terms of a spring at rest, of a load, of a prescribed motion", "[energy]") {
    // One free disc (m = 1 kg) on a spring k = 1 N/m, loaded by F = 1e-4 N at once: it oscillates between 0 and 2 F/k.
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    p.time_step = 0.001;
    lacuna::simulation<plane> run(chain<2>(2), p);
    run.fix(0);
    run.apply(1, {1e-4, 0});
    while (run.time() < pi) run.step_with_energy();
    // At half a period: displacement 2 F/k, strain 2 F^2/k = work of the load.
    REQUIRE_THAT(run.energy().strain, WithinRel(2e-8, 1e-5));
    REQUIRE_THAT(run.energy().external, WithinRel(2e-8, 1e-5));
    REQUIRE_THAT(run.energy().kinetic, WithinAbs(0, 1e-13));

    lacuna::simulation<plane> pulled(chain<2>(2), p);
    pulled.fix(0);
    pulled.fix(1);
    pulled.step_with_energy();
    for (int n = 0; n < 1001; ++n) {
        // A prescribed velocity of 1e-4 m/s for one second: 1/2 k u^2 with u = 1e-4 m.
        pulled.set_velocity(1, {n < 1000 ? 1e-4 : 0.0, 0});
        pulled.step_with_energy();
        if (n == 500) REQUIRE_THAT(pulled.energy().kinetic, WithinRel(5e-9, 1e-9));
    }
    REQUIRE_THAT(pulled.energy().strain, WithinRel(5e-9, 1e-8));
    REQUIRE_THAT(pulled.energy().external, WithinRel(5e-9, 2e-3));
    REQUIRE(std::fabs(pulled.energy().residual()) < 2e-3 * 5e-9);
}

TEST_CASE("the ledger of damped, sliding and breaking runs", "[energy]") {
    SECTION("local damping takes what kinetic and strain energy lose") {
        auto p = springs<plane_locally_damped>(1, 1, 0, unit_density(2));
        p.damping.factor = 0.2;
        p.time_step = 0.01;
        lacuna::simulation<plane_locally_damped> run(chain<2>(6), p);
        run.fix(0);
        run.set_velocity(5, {1e-3, 0});
        for (int n = 0; n < 20000; ++n) run.step_with_energy();
        auto const& e = run.energy();
        REQUIRE_THAT(e.initial, WithinRel(0.5e-6, 1e-2));
        REQUIRE(e.kinetic + e.strain < 1e-3 * e.initial);
        REQUIRE_THAT(e.damping, WithinRel(e.initial, 2e-3));
        REQUIRE(std::fabs(e.residual()) < 2e-3 * e.initial);
    }
    SECTION("a dashpot") {
        auto p = springs<plane_viscous>(1, 1, 0, unit_density(2));
        p.damping.ratio = 0.1;
        p.time_step = 0.005;
        lacuna::simulation<plane_viscous> run(chain<2>(6), p);
        run.fix(0);
        run.set_velocity(5, {1e-3, 0});
        for (int n = 0; n < 100000; ++n) run.step_with_energy();
        auto const& e = run.energy();
        REQUIRE(e.kinetic + e.strain < 2e-3 * e.initial);
        REQUIRE_THAT(e.damping, WithinRel(0.5e-6, 5e-3));
    }
    SECTION("the strain energy of a bond that breaks is fracture energy") {
        double const limit = 1e-3;
        auto p = springs<plane>(1, 1, 0, unit_density(2), limit);
        p.time_step = 0.001;
        lacuna::simulation<plane> run(chain<2>(2), p);
        run.set_velocity(0, {-1e-3, 0});
        run.set_velocity(1, {1e-3, 0});
        std::vector<lacuna::break_event<2>> events;
        for (int n = 0; n < 5000; ++n) {
            run.step_with_energy();
            events.insert(events.end(), run.events().begin(), run.events().end());
        }
        // Of the kinetic energy of 1e-6 J, F^2 / 2k = 0.5e-6 J are in the spring when it breaks.
        REQUIRE(events.size() == 1);
        REQUIRE_THAT(events[0].energy, WithinRel(0.5e-6, 5e-3));
        REQUIRE_THAT(run.energy().fracture, WithinRel(0.5e-6, 5e-3));
        REQUIRE_THAT(run.energy().kinetic, WithinRel(0.5e-6, 5e-3));
        REQUIRE(run.energy().strain == 0);
        REQUIRE(std::fabs(run.energy().residual()) < 1e-9 * run.energy().largest());
    }
    SECTION("shear failure under pressure leaves the compressive energy in the contact") {
        double const limit = 1e-3;
        auto p = springs<plane>(1, 1, 0.5, unit_density(2), never, limit);
        p.time_step = 0.001;
        lacuna::packing<double, 2> two = chain<2>(2);
        lacuna::simulation<plane> run(two, p);
        run.fix(0);
        run.fix(1);
        run.set_velocity(1, {-1e-3, 0});
        for (int n = 0; n < 1000; ++n) run.step_with_energy();
        run.set_velocity(1, {0, 1e-3});
        std::size_t broken = 0;
        for (int n = 0; n < 2000; ++n) {
            run.step_with_energy();
            broken += run.events().size();
        }
        // N = 1e-3: strain 1/2 N^2/k + 1/2 (mu N)^2/k_s; lost at the failure 1/2 (limit^2 - (mu N)^2) / k_s; then it
        // slides for 1 s at mu N.
        REQUIRE(broken == 1);
        REQUIRE_THAT(run.energy().strain, WithinRel(0.5e-6 + 0.125e-6, 5e-3));
        REQUIRE_THAT(run.energy().fracture, WithinRel(0.375e-6, 5e-3));
        REQUIRE_THAT(run.energy().friction, WithinRel(0.5e-6, 5e-3));
        REQUIRE(std::fabs(run.energy().residual()) < 5e-3 * run.energy().largest());
    }
}

TEST_CASE("the parts of the ledger's terms", "[energy]") {
    auto p = springs<plane>(1, 1, 0.5, unit_density(2));
    p.time_step = 0.001;
    SECTION("rotation of a spinning disc, translation of a flying one") {
        lacuna::packing<double, 2> apart;
        apart.add({0, 0}, 0.5);
        apart.add({5, 0}, 0.5);
        lacuna::simulation<plane> run(apart, p);
        run.set_spin(0, {0.2});
        run.set_velocity(1, {0, 0.3});
        run.step_with_energy();
        // I = m r^2 / 2 = 1/8 kg m^2
        REQUIRE_THAT(run.energy().rotation, WithinRel(0.5 * 0.125 * 0.04, 1e-14));
        REQUIRE_THAT(run.energy().kinetic, WithinRel(0.5 * 0.125 * 0.04 + 0.5 * 0.09, 1e-14));
    }
    SECTION("strain of bonds and of contacts, work of prescribed motion and of loads") {
        // Two pairs, one bonded, both pressed together by 0.01 m: 1/2 k u^2 each.
        lacuna::packing<double, 2> pairs;
        for (double const y : {0.0, 5.0})
            for (double const x : {0.0, 1.0}) pairs.add({x, y}, 0.5);
        pairs.bonds.push_back({0, 1});
        lacuna::simulation<plane> run(pairs, p);
        for (std::size_t const k : {0, 1, 2, 3}) run.fix(k);
        run.step_with_energy();
        run.set_velocity(1, {-1e-2, 0});
        run.set_velocity(3, {-1e-2, 0});
        for (int n = 0; n < 1000; ++n) run.step_with_energy();
        run.set_velocity(1, {0, 0});
        run.set_velocity(3, {0, 0});
        run.step_with_energy();
        REQUIRE_THAT(run.energy().strain, WithinRel(1e-4, 1e-9));
        REQUIRE_THAT(run.energy().bond_strain, WithinRel(0.5e-4, 1e-9));
        REQUIRE_THAT(run.energy().prescribed, WithinRel(1e-4, 1e-2));
        REQUIRE(run.energy().prescribed == run.energy().external);

        lacuna::simulation<plane> loaded(chain<2>(2), p);
        loaded.fix(0);
        loaded.apply(1, {1e-4, 0});
        for (int n = 0; n < 1000; ++n) loaded.step_with_energy();
        REQUIRE(loaded.energy().external > 0);
        REQUIRE(loaded.energy().prescribed == 0);
        REQUIRE(loaded.energy().bond_strain == loaded.energy().strain);
    }
    SECTION("failure in tension and in shear") {
        for (bool const shear : {false, true}) {
            auto q = springs<plane>(1, 1, 0, unit_density(2), shear ? never : 1e-3, shear ? 1e-3 : never);
            q.time_step = 0.001;
            lacuna::simulation<plane> run(chain<2>(2), q);
            run.fix(0);
            run.fix(1);
            run.step_with_energy();
            run.set_velocity(1, {shear ? 0.0 : 1e-3, shear ? 1e-3 : 0.0});
            for (int n = 0; n < 2000; ++n) run.step_with_energy();
            // 1/2 limit^2 / k
            REQUIRE_THAT(run.energy().fracture, WithinRel(0.5e-6, 5e-3));
            REQUIRE_THAT(run.energy().shear_fracture, WithinAbs(shear ? run.energy().fracture : 0.0, 1e-15));
            REQUIRE(run.energy().bond_strain == 0);
        }
    }
}
