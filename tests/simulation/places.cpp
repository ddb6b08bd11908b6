// SPDX-License-Identifier: BSD-3-Clause
//
// Positions of particles: at rest in both precisions, too far from the origin for one of them, coinciding.

#include <array>
#include <cmath>
#include <string>

#include "catch.hpp"
#include "simulation/setups.hpp"

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation/checkpoint.hpp>

using namespace setups;

namespace {

template <int Dim>
struct single : lacuna::default_model<Dim, float> {
    using damping = lacuna::combined_damping;
};
struct wet_single : lacuna::default_model<2, float> {
    using flow = lacuna::explicit_flow_with<lacuna::constant_aperture>;
};
struct wet_plane : plane {
    using flow = lacuna::explicit_flow_with<lacuna::constant_aperture>;
};

template <class Real, int Dim>
lacuna::packing<Real, Dim> moved(lacuna::packing<double, Dim> const& from, double scale, double offset) {
    lacuna::packing<Real, Dim> p;
    for (std::size_t k = 0; k < from.size(); ++k) {
        lacuna::vec<Real, Dim> x{};
        for (int axis = 0; axis < Dim; ++axis) x[axis] = Real(scale * from.position[k][axis] + offset);
        p.add(x, Real(scale * from.radius[k]));
    }
    p.bonds = from.bonds;
    return p;
}
/// Discs of 1 mm radius in rows, as in a file; spheres on a cubic lattice.
template <int Dim>
lacuna::packing<double, Dim> cluster(int n) {
    if constexpr (Dim == 2) {
        return lattice(n, n, true);
    } else {
        lacuna::packing<double, 3> p;
        for (int i = 0; i < n * n * n; ++i) p.add({double(i % n), double(i / n % n), double(i / n / n)}, 0.5);
        bond_touching(p);
        return p;
    }
}
template <class Model>
lacuna::simulation<Model> filled(lacuna::packing<typename Model::real, Model::dim> const& packing,
                                 lacuna::simulation_parameters<Model> p) {
    p.flow.bulk_modulus = 1e5;
    p.flow.aperture.aperture = 1e-5;
    p.flow.conductivity = 1e-9;
    lacuna::simulation<Model> sim(packing, p);
    sim.fill_pores([](auto points, auto const* radii) {
        return make_pore_network(triangulate_body(points, radii), points, radii);
    });
    return sim;
}
template <class Simulation>
void stay(Simulation& sim, int steps) {
    double const r = sim.radius(0);
    std::vector<typename Simulation::point> at;
    for (std::size_t k = 0; k < sim.size(); ++k) at.push_back(sim.position(k));
    for (int n = 0; n < steps; ++n) sim.step_with_energy();
    for (std::size_t k = 0; k < sim.size(); ++k) REQUIRE(norm(sim.position(k) - at[k]) < 1e-2 * r);
}

} // namespace

TEST_CASE("particles at rest stay at rest in single precision", "[places]") {
    for (double const offset : {0.0, 0.1, 1.0}) { // 0, 100 and 1,000 radii
        INFO("offset " << offset);
        auto p = springs<single<2>>(1e6, 5e5, 0.3, 2500);
        lacuna::simulation<single<2>> plain(moved<float, 2>(cluster<2>(4), 2e-3, offset), p);
        stay(plain, 1500);
        auto q = springs<single<3>>(1e6, 5e5, 0.3, 2500);
        lacuna::simulation<single<3>> spheres(moved<float, 3>(cluster<3>(3), 2e-3, offset), q);
        stay(spheres, 1500);
        auto w = springs<wet_single>(1e6, 5e5, 0.3, 2500);
        auto soaked = filled<wet_single>(moved<float, 2>(cluster<2>(4), 2e-3, offset), w);
        stay(soaked, 1500);
    }
}

TEST_CASE("squeezed and loaded packings come to rest and stay there", "[places]") {
    // Rows that overlap by a twentieth, in a fixed frame; without and with gravity and damping.
    auto const squeezed = [](int n) {
        auto p = lattice(n, n, true);
        p.bonds.clear();
        for (auto& x : p.position) x = x * 0.95;
        return p;
    };
    auto const play = [&](auto model, double offset, double damping, int steps) {
        using type = decltype(model);
        auto p = springs<type>(1e6, 5e5, 0.3, 2500);
        p.gravity = {0, damping > 0 ? -9.81 : 0.0};
        if constexpr (std::is_same_v<typename type::damping, lacuna::combined_damping>)
            p.damping = {0, 0, damping};
        else if constexpr (!std::is_same_v<typename type::damping, lacuna::no_damping>)
            p.damping = {damping};
        auto const body = squeezed(6);
        lacuna::simulation<type> sim(moved<typename type::real, 2>(body, 2e-3, offset), p);
        for (std::size_t k = 0; k < 36; ++k)
            if (k / 6 % 5 == 0 || k % 6 % 5 == 0) sim.fix(k);
        stay(sim, steps);
    };
    for (double const offset : {0.0, 0.1, 1.0}) {
        INFO("offset " << offset);
        play(single<2>{}, offset, 0, 3000);
        play(single<2>{}, offset, 0.3, 3000);
    }
    play(plane{}, 0, 0, 3000);
    // So long that the last velocities are too small to change any position.
    play(plane_viscous{}, 1.0, 0.5, 20000);
}

TEST_CASE("positions too far from the origin are refused", "[places]") {
    auto const refusal = [](auto model, double at, double radius, bool guarded) {
        using type = decltype(model);
        auto p = springs<type>(1e6, 5e5, 0.3, 2500);
        p.guards.resolution = guarded;
        return thrown_by([&] {
            lacuna::simulation<type> sim(
                moved<typename type::real, type::dim>(chain<type::dim>(3, false), 2 * radius, at), p);
        });
    };
    CHECK_THAT(refusal(single<2>{}, 100, 1e-3, true),
               contains_text("particle 2.position = (100.00") && contains_text("single precision") &&
                   contains_text("radius of 0.001") && contains_text(": must be within"));
    CHECK_THAT(refusal(single<3>{}, 100, 1e-3, true), contains_text("particle 2.position = (100.00"));
    CHECK(refusal(single<2>{}, 100, 1e-3, false).empty());
    CHECK(refusal(single<2>{}, 1000, 0.5, true).empty()); // a sheet of 1,000 diameters
    CHECK(refusal(single<2>{}, -1000, 0.5, true).empty());
    CHECK(refusal(plane{}, 5e6, 1e-3, true).empty());
    CHECK_THAT(refusal(plane{}, 1e13, 1e-3, true), contains_text("double precision"));
}

TEST_CASE("motion that is lost to rounding is reported", "[places]") {
    // 5,000 km from the origin numbers are 9.3e-10 m apart; 1 mm/s is 1e-10 m in a step of 1e-7 s.
    auto p = springs<plane>(1e2, 5e1, 0.3, 2500);
    p.time_step = 1e-7;
    auto const far = moved<double, 2>(chain<2>(3, false), 2e-3, 5e6);
    for (int const how : {0, 1, 2}) {
        lacuna::simulation<plane> sim(far, p);
        for (std::size_t k = 0; k < 3; ++k)
            if (how == 0)
                sim.set_velocity(k, {0, 1e-3});
            else
                sim.prescribe_velocity(k, {0, 1e-3}, how == 1 ? 0.0 : 1e-5);
        CHECK_THAT(thrown_by([&] { sim.run(1000); }), contains_text("lost to rounding") && contains_text("(5e+06") &&
                                                          contains_text("(0, 0.001") && contains_text("9.31322574") &&
                                                          contains_text("shift the body to the origin") &&
                                                          contains_text("double precision"));
        p.guards.resolution = false;
        lacuna::simulation<plane> unguarded(far, p);
        unguarded.set_velocity(0, {0, 1e-3});
        REQUIRE_NOTHROW(unguarded.run(1000));
        p.guards.resolution = true;
    }
    {
        // A particle that a light one has pushed: its velocity was not given.
        lacuna::packing<double, 2> two;
        two.add({5e6, 0}, 1e-3);
        two.add({5e6 + 1.1e-3 + 1e-5, 0}, 1e-4);
        auto q = p;
        q.time_step = 1e-5;
        lacuna::simulation<plane> sim(two, q);
        sim.set_velocity(1, {-5e-4, 0}); // 5e-9 m a step
        sim.fix(1, {false, true, false, true});
        // After the rebound the heavy particle keeps 2 / 101 of 5e-4 m/s: 1e-10 m a step; the light one is stopped.
        REQUIRE(thrown_by([&] { sim.run(10000); }).empty());
        REQUIRE_THAT(sim.velocity(0)[0], WithinRel(-1e-3 / 101, 0.03));
        sim.set_velocity(1, {0, 0});
        CHECK_THAT(thrown_by([&] { sim.run(1000); }), contains_text("particle 0") && contains_text("lost to rounding"));
    }
    {
        // Fast enough: displacements agree with the velocity.
        p.time_step = 1e-5;
        lacuna::simulation<plane> sim(far, p);
        sim.set_velocity(1, {0, 1e-3});
        REQUIRE_NOTHROW(sim.run(1000));
        REQUIRE_THAT(sim.position(1)[1] - 5e6, WithinRel(1e-5, 0.1));
    }
    {
        lacuna::simulation<single<2>> sim(moved<float, 2>(chain<2>(3, false), 2e-3, 5.0), [] {
            auto q = springs<single<2>>(1e2, 5e1, 0.3, 2500);
            q.time_step = 1e-6;
            return q;
        }());
        sim.set_velocity(1, {0, 1e-3});
        REQUIRE_THROWS_WITH(sim.run(10000), contains_text("lost to rounding") && contains_text("use double precision"));
    }
}

TEST_CASE("two particles at the same position are reported before any other fault", "[places]") {
    auto flat = lattice(3, 3, true);
    flat.bonds.clear();
    auto const n = std::to_string(flat.size());
    flat.add(flat.position[4], 0.5);
    std::string const named = "particles 4 and " + n + " are at the same position ";
    std::string const there = named + lacuna::to_text(flat.position[4]);
    auto p = springs<plane>(1, 1);
    auto const dry = [&] { lacuna::simulation<plane> sim(flat, p); };
    CHECK_THAT(thrown_by(dry), contains_text(there));
    CHECK_THAT(thrown_by([&] { (void)filled<wet_plane>(flat, springs<wet_plane>(1, 1)); }), contains_text(there));
    p.guards.overlap = false;
    CHECK_THAT(thrown_by(dry), contains_text(there));
    // So close that rounding determines the direction.
    flat.position.back()[0] += 2.3e-16;
    REQUIRE(flat.position.back()[0] != flat.position[4][0]);
    CHECK_THAT(thrown_by(dry), contains_text(named));
    flat.bonds = {{4, std::int32_t(flat.size()) - 1}};
    CHECK_THAT(thrown_by(dry), contains_text(named));
    flat.position.back() = flat.position[4];
    CHECK_THAT(thrown_by(dry), contains_text("bond 0.distance") && contains_text(there));

    auto block = chain<3>(4, false);
    block.add(block.position[1], 0.5);
    CHECK_THAT(thrown_by([&] { lacuna::simulation<space> sim(block, springs<space>(1, 1)); }),
               contains_text("particles 1 and 4 are at the same position (1, 0, 0)"));
}

TEST_CASE("messages name an initial overlap as such", "[places]") {
    lacuna::packing<double, 2> two;
    two.add({9, 9}, 0.5);
    two.add({0, 0}, 0.5);
    two.add({0.45, 0}, 0.5);
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    REQUIRE_THROWS_WITH(
        lacuna::simulation<plane>(two, p),
        contains_text("initial overlap of particles 1 and 2 at (0, 0) and (0.45, 0) m = 1.1 of the smaller radius") &&
            contains_text("must be at most 1 (guards.overlap_limit)"));
    p.guards.overlap_limit = 1.2;
    REQUIRE_NOTHROW(lacuna::simulation<plane>(two, p));
    p.guards.overlap = false;
    p.guards.overlap_limit = 1;
    REQUIRE_NOTHROW(lacuna::simulation<plane>(two, p));
    p.guards.overlap = true;
    p.interactions.contacts = false;
    REQUIRE_NOTHROW(lacuna::simulation<plane>(two, p));
    two.bonds = {{1, 2}};
    p.interactions.contacts = true;
    REQUIRE_NOTHROW(lacuna::simulation<plane>(two, p));
}

TEST_CASE("steps above the limit are caught within 100 steps, in either precision and space", "[places]") {
    // Squeezed between two fixed particles: omega = 2 sqrt(k / m) sin(N pi / (2 (N + 1))), N = 6.
    double const limit = 1 / std::sin(6 * pi / 14);
    auto const caught = [&](auto model, bool bonded, double share, int steps) {
        using type = decltype(model);
        using real = typename type::real;
        auto p = springs<type>(1, 0, 0, unit_density(type::dim));
        p.time_step = share * limit;
        p.allow_unstable_step = true;
        auto row = chain<type::dim>(8, bonded);
        if (!bonded)
            for (auto& x : row.position) x = x * 0.9;
        lacuna::simulation<type> run(moved<real, type::dim>(row, 1, 0), p);
        for (std::size_t k = 0; k < 8; ++k) {
            lacuna::vec<double, type::dim> v{};
            v[0] = k % 2 ? 1e-4 : -1e-4;
            k % 7 == 0 ? run.fix(k) : run.set_velocity(k, v);
        }
        return !thrown_by([&] { run.run(steps); }).empty();
    };
    for (bool const bonded : {true, false}) {
        INFO("bonded " << bonded);
        for (double const share : {1.05, 1.2, 2.0}) {
            INFO(share);
            CHECK(caught(plane{}, bonded, share, 100));
            CHECK(caught(space{}, bonded, share, 100));
            CHECK(caught(single<2>{}, bonded, share, 100));
            CHECK(caught(single<3>{}, bonded, share, 100));
        }
        CHECK_FALSE(caught(plane{}, bonded, 0.98, 500));
        CHECK_FALSE(caught(single<3>{}, bonded, 0.98, 500));
    }
}

TEST_CASE("guards continue after a restart", "[places]") {
    // The guard follows a pair with a step above the stable one for some windows before it ends the run.
    auto p = springs<plane>(1, 0, 0, unit_density(2));
    p.time_step = 1.005 * std::sqrt(2.0);
    p.allow_unstable_step = true;
    std::string const file = "guards_restart.bin";
    auto const start = [&] {
        lacuna::simulation<plane> run(chain<2>(2), p);
        run.fix(0);
        return run;
    };
    auto const end_of = [](auto& run) {
        try {
            run.run(1000);
        } catch (lacuna::unstable_run const& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    auto run = start();
    run.set_velocity(1, {1e-8, 0});
    run.run(10);
    run.fix(0, {});
    run.run(30);
    lacuna::save_checkpoint(file, run);
    auto const whole = end_of(run);
    REQUIRE_THAT(whole, contains_text("grow fourfold"));
    auto again = start();
    lacuna::load_checkpoint(file, again);
    std::remove(file.c_str());
    REQUIRE(end_of(again) == whole);
}
