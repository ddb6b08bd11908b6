// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <lacuna/equilibrium.hpp>
#include <lacuna/laws/law_defaults.hpp>
#include <lacuna/packings/random_packing.hpp>

#include "catch.hpp"
#include "reference.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

/// The contact of tutorial 3: stiffness `loading`, and the higher `unloading` once it has been pressed deeper.
struct yielding_contact : lacuna::law_defaults<yielding_contact> {
    struct material {
        double loading = 1e6, unloading = 4e6;
        void validate(std::string const&) const {}
    };
    template <class T>
    struct parameters {
        T loading, unloading;
    };
    template <class T, int Dim>
    struct history {
        T touching_distance, deepest;
    };
    template <class T, int Dim>
    static lacuna::pair_response<T, Dim, history<T, Dim>>
    evaluate(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        using lacuna::max;
        T overlap = max(h.touching_distance - m.distance, T(0)), deepest = max(overlap, h.deepest);
        T yielded = T(1) - p.loading / p.unloading;
        T pressed = p.unloading * max(overlap - deepest * yielded, T(0));
        T plastic = T(0.5) * p.loading * yielded * (deepest * deepest - h.deepest * h.deepest);
        return {-pressed, {}, {h.touching_distance, deepest}, T(0.5) * pressed * pressed / p.unloading, plastic};
    }
    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.unloading;
    }
};
struct yielding : plane {
    using contact_law = yielding_contact;
};

/// A contact whose force falls beyond an overlap of 1e-4 of the radius.
struct softening_contact : lacuna::law_defaults<softening_contact> {
    struct material {
        double stiffness = 1e6;
        void validate(std::string const&) const {}
    };
    template <class T>
    struct parameters {
        T stiffness;
    };
    template <class T, int Dim>
    struct history {
        T touching_distance;
    };
    template <class T, int Dim>
    static lacuna::force_response<T, Dim, history<T, Dim>>
    evaluate(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        using lacuna::max;
        T overlap = max(h.touching_distance - m.distance, T(0));
        return {-(p.stiffness * overlap / (T(1) + overlap * overlap * T(4e8))), {}, h};
    }
    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.stiffness;
    }
};
/// A contact that pulls up to an overlap of 1e-3 m.
struct adhesive_contact : softening_contact {
    template <class T, int Dim>
    static lacuna::force_response<T, Dim, history<T, Dim>>
    evaluate(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        using lacuna::max;
        T overlap = max(h.touching_distance - m.distance, T(0));
        T pull = lacuna::select(overlap > T(0), T(1e-3), T(0));
        return {-(p.stiffness * (overlap - pull)), {}, h};
    }
};
/// A contact that pushes across a gap of up to 0.1 m.
struct distant_contact : softening_contact {
    template <class T, int Dim>
    static lacuna::force_response<T, Dim, history<T, Dim>>
    evaluate(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        using lacuna::max;
        return {-(p.stiffness * max(h.touching_distance + T(0.1) - m.distance, T(0))), {}, h};
    }
};
struct softening : plane {
    using contact_law = softening_contact;
};

/// A spring from every particle to a line x = 0.
struct to_line {
    double stiffness = 3;
    lacuna::vec<double, 2> operator()(lacuna::acted_particle<2> const& p) const {
        return {-stiffness * p.position[0], 0};
    }
};
struct held_by_lines : plane {
    using forces = lacuna::body_force<to_line>;
};

/// A random packing in a box whose lid is wall 3.
lacuna::simulation<plane_locally_damped> box(double friction, std::uint64_t seed, double size) {
    auto p = springs<plane_locally_damped>(1e8, 5e7, friction, 1000);
    p.interactions.initial_contact_tolerance = 0.02;
    p.damping.factor = 0.7;
    auto const rigid = p.materials[0].contact;
    p.walls = {{{0, 0}, {0, 1}, rigid},
               {{0, 0}, {1, 0}, rigid},
               {{size, 0}, {-1, 0}, rigid},
               {{0, size}, {0, -1}, rigid}};
    auto const discs = lacuna::random_packing<double>({.width = size,
                                                       .height = size,
                                                       .r_min = 0.4,
                                                       .r_max = 0.5,
                                                       .area_fraction = size > 10 ? 0.82 : 0.79,
                                                       .seed = seed});
    return lacuna::simulation<plane_locally_damped>(discs, p);
}

} // namespace

TEST_CASE("a row of discs under a load shortens by F / k per contact", "[equilibrium]") {
    for (double const friction : {0.0, 0.3}) {
        lacuna::simulation<plane> sim(chain<2>(4, false), springs<plane>(1e6, 1e6, friction));
        sim.fix(0);
        sim.apply(3, {-10, 0});
        lacuna::equilibrium<plane> eq(sim, {.tolerance = 1e-8});
        auto const found = eq.solve();
        REQUIRE(found.reached());
        REQUIRE(found.unbalanced <= 1e-8 * 10);
        REQUIRE_THAT(found.largest_force, WithinRel(10, 1e-8));
        for (std::size_t k = 1; k < 4; ++k)
            REQUIRE_THAT(sim.position(k)[0] - double(k), WithinRel(-1e-5 * double(k), 1e-7));
        // Proportional: twice the load, twice the displacement.
        sim.apply(3, {-20, 0});
        REQUIRE(eq.solve().reached());
        REQUIRE_THAT(sim.position(3)[0] - 3, WithinRel(-6e-5, 1e-7));
        // Unloaded, the row is as long as before.
        sim.apply(3, {-1e-6, 0});
        REQUIRE(eq.solve().reached());
        REQUIRE_THAT(sim.position(3)[0] - 3, WithinAbs(-3e-12, 1e-12));
    }
}

TEST_CASE("a bonded chain under tension is a rope, and with locked rotations a shear beam",
          "[equilibrium][reference]") {
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    lacuna::simulation<plane> rope(chain<2>(11), p);
    rope.fix(0);
    rope.apply(10, {0.01, 1e-5});
    lacuna::equilibrium<plane> to_rope(rope);
    REQUIRE(to_rope.solve().reached());
    REQUIRE_THAT(rope.position(10)[1], WithinRel(reference("4c.tension_rope", "tip"), 1e-3));
    for (std::size_t k = 1; k <= 10; ++k)
        REQUIRE_THAT(rope.position(k)[1] / rope.position(k)[0],
                     WithinRel(reference("4c.tension_rope", "slope"), 1e-3));

    lacuna::simulation<plane> beam(chain<2>(11), p);
    beam.fix(0);
    for (std::size_t k = 1; k <= 10; ++k) beam.fix(k, {.rotation = true});
    beam.apply(10, {0, 1e-6});
    lacuna::equilibrium<plane> to_beam(beam);
    REQUIRE(to_beam.solve().reached());
    for (int k = 1; k <= 10; ++k)
        REQUIRE_THAT(beam.position(std::size_t(k))[1] / 1e-6, WithinRel(double(k), 1e-6));
}

TEST_CASE("a chain without bending stiffness under a transverse force is a mechanism", "[equilibrium][reference]") {
    REQUIRE(reference("4a.zero_modes", "transverse_static_stiffness") == 0);
    lacuna::simulation<plane> sim(chain<2>(11), springs<plane>(1, 1, 0, unit_density(2)));
    sim.fix(0);
    sim.apply(10, {0, 1e-7});
    lacuna::equilibrium<plane> eq(sim);
    auto const found = eq.solve();
    REQUIRE(found.outcome == lacuna::equilibrium_outcome::mechanism);
    REQUIRE(found.displacement > 1);
    REQUIRE(!found.trials.empty());
}

TEST_CASE("the interior of a lattice follows an affine motion of its rim", "[equilibrium][reference]") {
    int const n = 8;
    auto const packing = lattice(n, n, true);
    auto const g = reference_table("3b.patch_test", "G");
    double const turn = reference("3b.patch_test", "theta");
    lacuna::simulation<plane> sim(packing, springs<plane>(1, 1, 0, unit_density(2)));
    lacuna::equilibrium<plane> eq(sim, {.tolerance = 1e-8});
    auto const affine = [&](std::size_t k) {
        auto const& x = packing.position[k];
        return lacuna::vec<double, 2>{g[0][0] * x[0] + g[0][1] * x[1], g[1][0] * x[0] + g[1][1] * x[1]};
    };
    for (std::size_t k = 0; k < sim.size(); ++k)
        if (std::size_t const c = k % n, r = k / n; c == 0 || c == n - 1 || r == 0 || r == n - 1) {
            sim.fix(k);
            eq.move(k, affine(k));
            eq.turn(k, {turn});
        }
    REQUIRE(eq.solve().reached());
    for (std::size_t k = 0; k < sim.size(); ++k)
        for (int axis = 0; axis < 2; ++axis)
            REQUIRE_THAT(sim.position(k)[axis] - packing.position[k][axis], WithinAbs(affine(k)[axis], 2e-10));
}

TEST_CASE("a block on a slope rests up to the angle of friction and slides beyond", "[equilibrium]") {
    double const friction = 0.5, weight = 9.81 * 1000 * pi * 0.25, kn = 1e8, ks = 5e7;
    for (double const share : {0.5, 0.95, 1.05}) {
        double const angle = std::atan(share * friction);
        auto p = springs<plane>(kn, ks, friction, 1000);
        p.gravity = {0, -9.81};
        lacuna::vec<double, 2> const normal{-std::sin(angle), std::cos(angle)}, along{std::cos(angle), std::sin(angle)};
        p.walls = {{{0, 0}, normal, p.materials[0].contact}};
        lacuna::packing<double, 2> one;
        one.add(normal * 0.5, 0.5);
        lacuna::simulation<plane> sim(one, p);
        sim.fix(0, {.rotation = true});
        lacuna::equilibrium<plane> eq(sim);
        auto const found = eq.solve();
        auto const moved = sim.position(0) - normal * 0.5;
        if (share < 1) {
            REQUIRE(found.reached());
            REQUIRE_THAT(-dot(moved, normal), WithinRel(weight * std::cos(angle) / kn, 1e-6));
            REQUIRE_THAT(-dot(moved, along), WithinRel(weight * std::sin(angle) / ks, 1e-6));
        } else {
            REQUIRE(found.outcome == lacuna::equilibrium_outcome::mechanism);
        }
    }
}

TEST_CASE("a contact law of one's own: loading, unloading along its steeper branch, loading again", "[equilibrium]") {
    lacuna::simulation_parameters<yielding> p;
    p.materials[0].contact = {.loading = 1e6, .unloading = 4e6};
    lacuna::simulation<yielding> sim(chain<2>(2, false), p);
    sim.fix(0);
    lacuna::equilibrium<yielding> eq(sim, {.tolerance = 1e-8});
    auto const overlap_under = [&](double force) {
        sim.apply(1, {-force, 0});
        REQUIRE(eq.solve().reached());
        return 1 - sim.position(1)[0];
    };
    REQUIRE_THAT(overlap_under(100), WithinRel(1e-4, 1e-6));                  // k_1
    REQUIRE_THAT(overlap_under(40), WithinRel(1e-4 - 60 / 4e6, 1e-6));        // back along k_2
    REQUIRE_THAT(overlap_under(100), WithinRel(1e-4, 1e-6));                  // up again along k_2
    REQUIRE_THAT(overlap_under(150), WithinRel(1.5e-4, 1e-6));                // beyond: k_1
    REQUIRE_THAT(overlap_under(1e-3), WithinRel(0.75 * 1.5e-4 + 1e-3 / 4e6, 1e-6)); // the dent remains
}

TEST_CASE("the model's own forces balance loads, and their stiffness counts", "[equilibrium]") {
    auto p = springs<held_by_lines>(1e3, 1e3);
    lacuna::packing<double, 2> one;
    one.add({0, 0}, 0.5);
    lacuna::simulation<held_by_lines> sim(one, p);
    sim.apply(0, {0.3, 0});
    lacuna::equilibrium<held_by_lines> eq(sim);
    auto const found = eq.solve();
    REQUIRE(found.reached());
    REQUIRE(found.factorisations < 20);
    REQUIRE_THAT(sim.position(0)[0], WithinRel(0.1, 1e-6));
}

TEST_CASE("the weakest bond of a chain fails at its strength, and the chain is a mechanism then", "[equilibrium]") {
    auto p = springs<plane>(1e6, 1e6);
    p.bonds = std::vector<lacuna::bond_values>(4);
    for (auto& b : p.bonds) b.tensile_force = 100;
    p.bonds[2].tensile_force = 30;
    lacuna::simulation<plane> sim(chain<2>(5), p);
    sim.fix(0);
    lacuna::equilibrium<plane> eq(sim);
    sim.apply(4, {29.9, 0});
    auto found = eq.solve();
    REQUIRE(found.reached());
    REQUIRE(found.first_failure == 1);
    REQUIRE(eq.events().empty());
    sim.apply(4, {32, 0});
    found = eq.solve();
    REQUIRE(found.outcome == lacuna::equilibrium_outcome::mechanism);
    REQUIRE(eq.events().size() == 1);
    REQUIRE(eq.events()[0].bond == 2);
    REQUIRE(eq.events()[0].mode == lacuna::bond_state::broken_in_tension);
    REQUIRE_THAT(eq.events()[0].normal_force, WithinRel(30, 1e-6));
    // The load of the failure, from the share of the increment between both loads.
    REQUIRE_THAT(29.9 + found.first_failure * (32 - 29.9), WithinRel(30, 1e-5));
}

TEST_CASE("packings with friction from 0 to 1 come to equilibrium, and stay there in steps", "[equilibrium]") {
    for (double const friction : {0.0, 0.3, 1.0})
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
            INFO("friction " << friction << " seed " << seed);
            auto sim = box(friction, seed, 12);
            lacuna::equilibrium<plane_locally_damped> eq(sim);
            eq.move_wall(3, {0, -0.05});
            auto const found = eq.solve();
            REQUIRE(found.reached());
            REQUIRE(found.unbalanced <= 1e-6 * found.largest_force);
            REQUIRE(found.complementarity <= 1e-10);
            std::vector<lacuna::vec<double, 2>> rest;
            for (std::size_t k = 0; k < sim.size(); ++k) rest.push_back(sim.position(k));
            sim.run(200);
            for (std::size_t k = 0; k < sim.size(); ++k) REQUIRE(norm(sim.position(k) - rest[k]) < 1e-6);
            // Without gravity the walls' forces on the packing balance.
            lacuna::vec<double, 2> sum{};
            for (std::size_t w = 0; w < 4; ++w) sum += sim.walls().force(w);
            REQUIRE(norm(sum) < 1e-4 * norm(sim.walls().force(3)));
        }
}

TEST_CASE("servo walls go where the stress on them is the servo's", "[equilibrium]") {
    auto sim = box(0.3, 2, 8);
    // All around but for the floor and the left side; the area follows the walls.
    sim.servo_wall(3, {.stress = 1e5, .max_speed = 1, .between = {{{1, 2}}}});
    sim.servo_wall(2, {.stress = 0.6e5, .max_speed = 1, .between = {{{0, 3}}}});
    lacuna::equilibrium<plane_locally_damped> eq(sim);
    REQUIRE(eq.solve().reached());
    auto const& walls = sim.walls();
    double const width = walls.point(2)[0] - walls.point(1)[0], height = walls.point(3)[1] - walls.point(0)[1];
    REQUIRE(height < 8);
    REQUIRE_THAT(walls.force(3)[1], WithinRel(1e5 * width, 1e-4));
    REQUIRE_THAT(walls.force(2)[0], WithinRel(0.6e5 * height, 1e-4));
}

TEST_CASE("none of twenty packings with a friction of 1 fails", "[equilibrium]") {
    int failures = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        auto sim = box(1.0, seed, 8);
        lacuna::equilibrium<plane_locally_damped> eq(sim);
        eq.move_wall(3, {0, -0.1});
        auto const found = eq.solve();
        failures += !found.reached() || found.unbalanced > 1e-6 * found.largest_force;
    }
    REQUIRE(failures == 0);
}

TEST_CASE("an equilibrium in the middle of a run stops what moves freely and keeps what is prescribed",
          "[equilibrium]") {
    auto p = springs<plane_locally_damped>(1e8, 5e7, 0.3, 1000);
    p.damping.factor = 0.3;
    p.gravity = {0, -9.81};
    auto const rigid = p.materials[0].contact;
    p.walls = {{{0, -0.5}, {0, 1}, rigid}, {{-0.5, 0}, {1, 0}, rigid}, {{8, 0}, {-1, 0}, rigid}};
    auto discs = lattice(8, 8, true);
    discs.bonds.clear();
    lacuna::simulation<plane_locally_damped> sim(discs, p);
    sim.prescribe_velocity(62, {0, -0.01});
    sim.run(300);
    REQUIRE(norm(sim.velocity(20)) > 1e-3);
    auto const held = sim.position(62);
    lacuna::equilibrium<plane_locally_damped> eq(sim);
    REQUIRE(eq.solve().reached());
    REQUIRE(sim.velocity(62) == lacuna::vec<double, 2>{0, -0.01});
    REQUIRE(sim.velocity(20) == lacuna::vec<double, 2>{});
    REQUIRE(sim.position(62) == held);
    sim.prescribe_velocity(62, {});
    auto const rest = sim.position(20);
    sim.run(500);
    REQUIRE(norm(sim.position(20) - rest) < 1e-6);
}

TEST_CASE("what no equilibrium knows is refused with its name", "[equilibrium]") {
    lacuna::simulation<plane> sim(chain<2>(2, false), springs<plane>(1, 1));
    lacuna::equilibrium<plane> eq(sim);
    REQUIRE(thrown_by([&] { eq.move(0, {1, 0}); }) ==
            "displacement of particle 0 = 1: must be 0 along an axis along which it is not fixed");
    REQUIRE(thrown_by([&] { eq.turn(1, {1}); }) == "rotation of particle 1 = 1: must be 0 where rotation is not fixed");
    REQUIRE(thrown_by([&] { eq.move_wall(0, {1, 0}); }) == "wall = 0: must be below the number of walls, 0");
    REQUIRE(thrown_by([&] { lacuna::equilibrium<plane>(sim, {.tolerance = 0}); }) ==
            "equilibrium.tolerance = 0: must be > 0 and <= 0.1");

    lacuna::simulation_parameters<softening> p;
    lacuna::simulation<softening> soft(chain<2>(2, false), p);
    soft.set_velocity(1, {0.1, 0});
    lacuna::equilibrium<softening> never_there(soft);
    auto const why = thrown_by([&] { never_there.solve(); });
    CAPTURE(why);
    REQUIRE(why.find("contact law = a force of") == 0);
    REQUIRE(why.find("must be a force that grows with the overlap") != std::string::npos);
    REQUIRE(soft.velocity(1)[0] == 0.1); // a refusal changes nothing

    std::string const rule = "must be a force that pushes and begins with the overlap, for an equilibrium";
    auto const pulls = thrown_by([] { lacuna::contact_formula<adhesive_contact, 2>({1e6}, {1.0}, 0.5, 0.5); });
    REQUIRE(pulls.find(rule) != std::string::npos);
    auto const reaches = thrown_by([] { lacuna::contact_formula<distant_contact, 2>({1e6}, {1.0}, 0.5, 0.5); });
    REQUIRE(reaches.find(rule) != std::string::npos);

    auto with_servo = box(0.1, 1, 8);
    with_servo.servo_wall(3, {.stress = 1e3, .area = 8, .max_speed = 1});
    lacuna::equilibrium<plane_locally_damped> held(with_servo);
    REQUIRE(thrown_by([&] { held.move_wall(3, {0, -1}); }) ==
            "wall 3 = moved by a servo: must be free of it to be moved");
}
