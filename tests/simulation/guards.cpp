// SPDX-License-Identifier: BSD-3-Clause
//
// Guards distinguish a time step that is too long from physical growth.

#include <cmath>
#include <string>

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

/// Message of a run that a guard stops; "" if none does.
template <class Model>
std::string stop_message(lacuna::simulation<Model>& run, int steps) {
    try {
        for (int n = 0; n < steps; ++n) run.step_with_energy();
    } catch (lacuna::unstable_run const& e) {
        return e.what();
    }
    return "";
}

/// Five discs that overlap by a tenth. The outer ones are fixed, the inner ones lie slightly off the line.
lacuna::simulation<plane> squeezed_row(lacuna::simulation_parameters<plane> p) {
    lacuna::packing<double, 2> row;
    for (int k = 0; k < 5; ++k) row.add({0.9 * k, k == 0 || k == 4 ? 0.0 : k % 2 == 1 ? 1e-8 : -1e-8}, 0.5);
    lacuna::simulation<plane> run(row, p);
    run.fix(0);
    run.fix(4);
    return run;
}

} // namespace

TEST_CASE("a squeezed row of discs buckles at its growth rate", "[guards]") {
    // Three discs between two fixed ones: m y_j'' = P / d (2 y_j - y_{j-1} - y_{j+1}), P = k (2 r - d). The fastest
    // mode is (1, -sqrt 2, 1), with g^2 = (2 + sqrt 2) P / (m d): 21.97 / s.
    double const force = 1e6 * 0.1, mass = 1000 * pi * 0.25,
                 rate = std::sqrt((2 + std::sqrt(2.0)) * force / (mass * 0.9));
    REQUIRE_THAT(rate, WithinRel(21.97, 1e-3));
    auto run = squeezed_row(springs<plane>(1e6, 0));
    auto const amplitude = [&] {
        return (run.position(1)[1] - std::sqrt(2.0) * run.position(2)[1] + run.position(3)[1]) / 4;
    };
    double from = 0, to = 0, first = 0, last = 0;
    for (int n = 0; n < 3000 && std::fabs(amplitude()) < 0.05; ++n) {
        run.step_with_energy();
        double const a = std::fabs(amplitude());
        if (a > 1e-6 && from == 0) from = run.time(), first = a;
        if (a < 1e-3) to = run.time(), last = a;
    }
    REQUIRE_THAT(std::log(last / first) / (to - from), WithinRel(rate, 0.01));
    REQUIRE(std::fabs(amplitude()) >= 0.05);
    REQUIRE(stop_message(run, 100).empty());
    REQUIRE(std::fabs(run.energy().residual()) < 1e-2 * run.energy().largest());
}

TEST_CASE("an energy that is not a number ends a run", "[guards]") {
    // In single precision 1 / 1e-40 is infinite. So is the energy of the bond's spring, although it has no force.
    using single = lacuna::default_model<2, float>;
    lacuna::packing<float, 2> row;
    for (int k = 0; k < 3; ++k) row.add({float(k), 0}, 0.5f);
    row.bonds = {{0, 1}, {1, 2}};
    auto p = springs<single>(1e6, 1e6);
    lacuna::simulation<single> sound(row, p);
    REQUIRE(stop_message(sound, 1).empty());
    p.bonds.resize(2);
    p.bonds[0].normal_stiffness = 1e-40;
    lacuna::simulation<single> run(row, p);
    REQUIRE_THAT(stop_message(run, 1), contains_text("an energy is not a number") && contains_text("single precision"));
}

TEST_CASE("a bound of zero is no time step", "[guards]") {
    // The square of the dashpot's rate is infinite and the bound is zero: time would not advance.
    auto p = springs<plane_viscous>(1e6, 0);
    p.damping.ratio = 1e200;
    lacuna::simulation<plane_viscous> run(chain<2>(2), p);
    REQUIRE_THROWS_WITH(run.resolve_time_step(),
                        contains_text("time_step = ") && contains_text("leaves the range of double precision"));
    p.damping.ratio = 0.5;
    REQUIRE(lacuna::simulation<plane_viscous>(chain<2>(2), p).resolve_time_step() > 0);
}

TEST_CASE("a shallow truss of two bars snaps through beyond its limit load, not below", "[guards]") {
    // Half span b, height h: F(y) = 2 k y (L0 / L - 1), L^2 = b^2 + y^2, is largest where L^3 = L0 b^2.
    double const b = 2, h = 0.3, k = 1, l0 = std::hypot(b, h), l = std::cbrt(l0 * b * b), y = std::sqrt(l * l - b * b);
    double const limit = 2 * k * y * (l0 / l - 1);
    for (double const share : {0.95, 1.05}) {
        lacuna::packing<double, 2> truss;
        truss.add({-b, 0}, 0.5);
        truss.add({0, h}, 0.5);
        truss.add({b, 0}, 0.5);
        truss.bonds = {{0, 1}, {1, 2}};
        auto p = springs<plane>(k, 0, 0, unit_density(2));
        lacuna::simulation<plane> run(truss, p);
        run.fix(0);
        run.fix(2);
        run.apply(1, {0, -share * limit}, 0, 1000); // much longer than a period
        bool below = false;
        for (int n = 0; run.time() < 1500; ++n) {
            run.step_with_energy();
            below = below || run.position(1)[1] < -0.5 * h;
        }
        INFO(share);
        CHECK(below == (share > 1));
    }
}

TEST_CASE("a chain that falls and whips is not stopped", "[guards]") {
    auto p = springs<plane>(1e5, 0, 0, unit_density(2));
    p.gravity = {0, -10};
    lacuna::simulation<plane> run(chain<2>(12), p);
    run.fix(0);
    double fastest = 0;
    for (int n = 0; run.time() < 6; ++n) {
        run.step_with_energy();
        fastest = std::max(fastest, norm(run.velocity(11)));
    }
    // Faster than a free fall by the length of the chain.
    CHECK(fastest > std::sqrt(2 * 10 * 22.0));
    CHECK(std::fabs(run.energy().residual()) < 1e-2 * run.energy().largest());
}

TEST_CASE("a step that is too long for a force of the program is caught within 100 steps, by the speeds alone",
          "[guards]") {
    // The program pulls a disc back with a spring of 1 N/m that the bound does not include: 2 s = 2 sqrt(m / k) is
    // stable.
    for (double const share : {1.005, 1.05, 1.2}) {
        auto p = springs<plane>(1, 0, 0, unit_density(2));
        p.time_step = 2 * share;
        p.guards.motion = false;
        for (bool const guarded : {true, false}) {
            p.guards.growth = guarded;
            lacuna::packing<double, 2> one;
            one.add({0, 0}, 0.5);
            lacuna::simulation<plane> run(one, p);
            REQUIRE_THAT(run.mass(0), WithinRel(1, 1e-12));
            run.set_velocity(0, {1e-8, 0});
            std::string text;
            try {
                for (int n = 0; n < 100; ++n) {
                    run.apply(0, {-run.position(0)[0], 0});
                    run.step();
                }
            } catch (lacuna::unstable_run const& e) {
                text = e.what();
            }
            INFO(share << ": " << text);
            if (guarded)
                CHECK_THAT(text, contains_text("grow fourfold") && contains_text("reverse in nearly") &&
                                     contains_text("time step"));
            else
                CHECK(text.empty());
        }
    }
}

TEST_CASE("the bound stops a run whose step is too long after a support was released", "[guards]") {
    // If one particle of a pair is fixed, it oscillates at sqrt(k / m), and 2 s is stable; if both are free,
    // at sqrt(2 k / m).
    for (double const share : {1.005, 1.05, 1.2}) {
        auto p = springs<plane>(1, 0, 0, unit_density(2));
        p.time_step = share * std::sqrt(2.0);
        lacuna::simulation<plane> run(chain<2>(2), p);
        run.fix(0);
        run.set_velocity(1, {1e-8, 0});
        run.run(10);
        run.fix(0, {});
        INFO(share);
        REQUIRE_THROWS_WITH(run.run(100), contains_text("above the stable limit, which is 1.41421"));
    }
}

TEST_CASE("spins that run away are caught within 100 steps", "[guards]") {
    // A sphere or disc at a fixed position, turned back by a spring of I N m/rad (m r^2 / 2, 2/5 m r^2) that the bound
    // does not include: 2 s is stable.
    auto const play = [](auto model, double share, double spin) {
        using type = decltype(model);
        constexpr int dim = type::dim;
        auto p = springs<type>(1, 1, 0, unit_density(dim));
        p.time_step = 2 * share;
        lacuna::packing<double, dim> one;
        one.add({}, 0.5);
        lacuna::simulation<type> run(one, p);
        run.fix(0, {true, true, true, false});
        lacuna::vec<double, lacuna::rotation_dim<dim>> w{}, angle{};
        w[w.size() - 1] = spin;
        run.set_spin(0, w);
        double const inertia = dim == 2 ? 0.125 : 0.1;
        for (int n = 0; n < 100; ++n) {
            run.apply(0, {}, angle * -inertia);
            run.step();
            angle += run.spin(0) * p.time_step;
        }
    };
    auto const text = [&](auto model, double share, double spin) {
        return thrown_by([&] { play(model, share, spin); });
    };
    for (double const share : {1.005, 1.02}) {
        CHECK_THAT(text(plane{}, share, 1e-10), contains_text("grow fourfold") && contains_text("reverse in nearly"));
        CHECK_THAT(text(space{}, share, 1e-10), contains_text("grow fourfold") && contains_text("reverse in nearly"));
    }
    // Spins that grow too fast for the growth watch.
    CHECK_THAT(text(plane{}, 1.2, 1e-6),
               contains_text("rad in one step (limit 1)") && contains_text("above the stable one"));
    CHECK_THAT(text(space{}, 1.2, 1e-6),
               contains_text("rad in one step (limit 1)") && contains_text("above the stable one"));
}

TEST_CASE("with allow_unstable_step only the consequences of an unstable step end a run", "[guards]") {
    auto p = springs<plane>(1, 0, 0, unit_density(2));
    p.allow_unstable_step = true;
    p.time_step = 1.002 * std::sqrt(2.0);
    p.guards.overlap = false;
    {
        lacuna::simulation<plane> run(chain<2>(2), p);
        run.set_velocity(0, {1e-12, 0});
        REQUIRE_THAT(stop_message(run, 10000), contains_text("of its radius in one step") &&
                                                   contains_text("reverse in nearly every step") &&
                                                   contains_text("the time step is above the stable one"));
        REQUIRE(run.steps() > 100);
    }
    p.guards.motion = false;
    lacuna::simulation<plane> run(chain<2>(2), p);
    run.set_velocity(0, {1e-12, 0});
    REQUIRE(stop_message(run, 300).empty());
    REQUIRE(run.kinetic_energy() > 1);
}

TEST_CASE("invalid limits of guards are refused", "[guards]") {
    auto p = springs<plane>(1, 0);
    for (double const bad : {0.0, -1.0, std::nan("")}) {
        p.guards.overlap_limit = bad;
        REQUIRE_THROWS_WITH(p.validate(), contains_text("guards.overlap_limit = " + lacuna::to_text(bad)));
        p.guards.overlap_limit = 1;
        p.guards.motion_limit = bad;
        REQUIRE_THROWS_WITH(p.validate(), contains_text("guards.motion_limit = " + lacuna::to_text(bad)));
        p.guards.motion_limit = 0.1;
    }
}

TEST_CASE("messages name the overlapping particles and a bond that yields", "[guards]") {
    auto p = springs<plane>(1e6, 5e5, 0.5, 1000, 1e4, 1e4);
    auto const squeeze = [](auto const& parameters) {
        lacuna::simulation<plane> run(chain<2>(2), parameters);
        run.fix(0);
        run.apply(1, {-1.5e4, 0}, 0, 1);
        return stop_message(run, 3000);
    };
    SECTION("bonds between discs that overlap by a radius from the start") {
        lacuna::packing<double, 2> two;
        two.add({0, 0}, 0.5);
        two.add({0.5, 0}, 0.5);
        two.bonds.push_back({0, 1});
        lacuna::simulation<plane> run(two, p);
        run.fix(0);
        run.apply(1, {-100, 0}, 0, 1);
        REQUIRE(stop_message(run, 300).empty());
        REQUIRE(run.position(1)[0] < 0.49999);
    }
    SECTION("a crushed bond") {
        REQUIRE_THAT(squeeze(p), contains_text("bond 0 between them is crushed") && contains_text("10000 N") &&
                                     contains_text("yields without limit"));
    }
    SECTION("not if the guard is off or the limit is larger") {
        p.guards.overlap = false;
        REQUIRE(squeeze(p).find("overlap") == std::string::npos);
        auto soon = p;
        soon.guards.motion_limit = 0.005; // while the bond yields
        REQUIRE_THAT(squeeze(soon), contains_text("bond 0 between particles 0 and 1 is crushed"));
        p.guards.overlap = true;
        p.guards.overlap_limit = 1.5;
        REQUIRE_THAT(squeeze(p), contains_text("more than 1.5 of a radius") && contains_text("bond 0"));
    }
    SECTION("a contact under too large a load") {
        auto q = springs<plane>(1e6, 0);
        lacuna::simulation<plane> run(chain<2>(2, false), q);
        run.fix(0);
        run.apply(1, {-1e6, 0}, 0, 1);
        REQUIRE_THAT(stop_message(run, 3000),
                     contains_text("it overlaps another particle by more than a radius: particle") &&
                         contains_text("of the smaller radius") && contains_text("contact stiffness"));
    }
    SECTION("bonds that overlapped at the start are allowed") {
        lacuna::packing<double, 2> two;
        two.add({0, 0}, 0.5);
        two.add({0.3, 0}, 0.5);
        two.bonds = {{0, 1}};
        lacuna::simulation<plane> run(two, springs<plane>(1, 0, 0, unit_density(2)));
        run.set_velocity(0, {0.01, 0});
        REQUIRE(stop_message(run, 500).empty());
    }
}

TEST_CASE("messages name the reason why a particle is fast", "[guards]") {
    auto p = springs<plane>(1, 0, 0, unit_density(2));
    p.time_step = 0.1;
    lacuna::simulation<plane> given(chain<2>(3, false), p);
    given.set_velocity(1, {0, 0.6});
    CHECK_THAT(stop_message(given, 1), contains_text("likely cause: the velocity that it was given"));
    lacuna::simulation<plane> moved(chain<2>(3, false), p);
    moved.prescribe_velocity(1, {0, 0.6}, 5);
    CHECK_THAT(stop_message(moved, 100), contains_text("likely cause: the velocity that is prescribed to it"));
    lacuna::simulation<plane> loaded(chain<2>(3, false), p);
    loaded.apply(1, {0, 6});
    CHECK_THAT(stop_message(loaded, 5), contains_text("the load on it, (0, 6) N, is large for its mass"));
    lacuna::packing<double, 2> close;
    close.add({0, 0}, 0.5);
    close.add({0.6, 0}, 0.5);
    auto q = springs<plane>(100, 0, 0, unit_density(2));
    lacuna::simulation<plane> pressed(close, q);
    CHECK_THAT(stop_message(pressed, 100), contains_text("overlap at the start") && contains_text("0 and 1"));
}
