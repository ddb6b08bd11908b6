// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "simulation/setups.hpp"

#include <lacuna/laws/hertz_mindlin.hpp>

using namespace setups;

namespace {

template <int Dim, class Damping = lacuna::no_damping>
struct spheres : lacuna::default_model<Dim> {
    using contact_law = lacuna::hertz_mindlin;
    using damping = Damping;
};

template <class Model>
lacuna::simulation_parameters<Model> glass(double friction = 0, double poisson = 0.3) {
    lacuna::simulation_parameters<Model> p;
    p.materials[0].density = 2500;
    p.materials[0].contact = {7e7, poisson, friction, 1};
    p.mass = lacuna::mass_model::sphere;
    return p;
}

} // namespace

TEST_CASE("two spheres collide as in Hertz's theory", "[hertz]") {
    using model = spheres<3>;
    auto const p = glass<model>();
    lacuna::packing<double, 3> two;
    two.add({0, 0, 0}, 0.01);
    two.add({0.03, 0, 0}, 0.02);
    double const speed = 0.5, modulus = 7e7 / (2 * (1 - 0.09)), radius = 0.01 * 0.02 / 0.03;
    lacuna::simulation<model> sim(two, p);
    sim.set_velocity(0, {speed, 0, 0});
    double const m1 = sim.mass(0), m2 = sim.mass(1), mass = m1 * m2 / (m1 + m2);
    double const k = 4.0 / 3 * modulus * std::sqrt(radius);
    double const deepest = std::pow(1.25 * mass * speed * speed / k, 0.4);
    // Contact time 2.943 d/v: 2 sqrt(pi) Gamma(7/5) / Gamma(9/10) of it.
    double const lasting = 2 * std::sqrt(pi) * std::tgamma(1.4) / std::tgamma(0.9) * deepest / speed;
    auto q = p;
    q.time_step = lasting / 5000;
    lacuna::simulation<model> fine(two, q);
    fine.set_velocity(0, {speed, 0, 0});
    double most = 0, strongest = 0, since = -1, until = 0;
    for (int step = 0; step < 6000; ++step) {
        fine.step();
        most = std::max(most, 0.03 - (fine.position(1)[0] - fine.position(0)[0]));
        double const force = -fine.pair_force(0, 1)[0];
        strongest = std::max(strongest, force);
        if (force > 0) {
            if (since < 0) since = fine.time();
            until = fine.time();
        }
    }
    REQUIRE_THAT(most, WithinRel(deepest, 1e-4));
    REQUIRE_THAT(strongest, WithinRel(k * std::pow(deepest, 1.5), 1e-4));
    REQUIRE_THAT(until - since, WithinRel(lasting, 1e-3));
    REQUIRE_THAT(fine.velocity(1)[0], WithinRel(2 * m1 / (m1 + m2) * speed, 1e-4));
}

TEST_CASE("dashpots give Hertzian collisions the given restitution", "[hertz]") {
    using model = spheres<3, lacuna::restitution_damping>;
    for (double const e : {0.2, 0.4, 0.6, 0.8, 0.95, 1.0})
        for (double const speed : {0.05, 2.0}) {
            auto p = glass<model>();
            p.damping = lacuna::restitution_damping::with_restitution(e);
            double const mass = 2500 * 4.0 / 3 * pi * 1e-6 / 2, k = 4.0 / 3 * 7e7 / (2 * 0.91) * std::sqrt(0.005);
            p.time_step = 3 * std::pow(1.25 * mass * speed * speed / k, 0.4) / speed / 4000;
            lacuna::packing<double, 3> two;
            two.add({0, 0, 0}, 0.01);
            two.add({0.02, 0, 0}, 0.01);
            lacuna::simulation<model> sim(two, p);
            sim.set_velocity(0, {speed, 0, 0});
            for (int step = 0; step < 40000; ++step) sim.step();
            INFO("e = " << e << ", v = " << speed);
            REQUIRE(sim.pair_force(0, 1)[0] == 0);
            REQUIRE_THAT((sim.velocity(1)[0] - sim.velocity(0)[0]) / speed, WithinAbs(e, 1e-3));
        }
    using linear = setups::space;
    struct springs_with_restitution : linear {
        using damping = lacuna::restitution_damping;
    };
    for (double const e : {0.2, 0.7}) {
        auto p = springs<springs_with_restitution>(1e5, 0);
        p.damping = lacuna::restitution_damping::with_restitution(e);
        p.time_step = 1e-4;
        auto two = chain<3>(2, false);
        lacuna::simulation<springs_with_restitution> sim(two, p);
        sim.set_velocity(0, {0.01, 0, 0});
        for (int step = 0; step < 20000; ++step) sim.step();
        REQUIRE_THAT((sim.velocity(1)[0] - sim.velocity(0)[0]) / 0.01, WithinAbs(e, 1e-3));
    }
    auto bad = glass<model>();
    bad.damping.restitution = 0.5;
    REQUIRE_THROWS_WITH(bad.validate(), contains_text("damping.ratio"));
    bad.damping = lacuna::restitution_damping::with_restitution(0.0);
    REQUIRE_THROWS_WITH(bad.validate(), contains_text("damping.restitution = 0"));
}

TEST_CASE("Mindlin's stiffness, Coulomb's limit, and no energy from nothing", "[hertz]") {
    using law = lacuna::hertz_mindlin;
    double const nu = 0.3, young = 1e6, mu = 0.4;
    law::material const m{young, nu, mu, 1};
    auto const p = law::combine(m, m, 1);
    double const overlap = 1e-3, radius = 0.05, a = std::sqrt(radius * overlap);
    lacuna::pair_motion<double, 2> motion{0.2 - overlap, 0.1, 0.1, {1e-5}, 0};
    auto r = law::evaluate(p, motion, law::initial<double, 2>(0.2, 0.2));
    double const plane_modulus = young / (2 * (1 - nu * nu)), shear_modulus = young / (4 * (2 - nu) * (1 + nu));
    REQUIRE_THAT(r.normal_force,
                 WithinRel(-4.0 / 3 * plane_modulus * std::sqrt(radius) * std::pow(overlap, 1.5), 1e-12));
    REQUIRE_THAT(r.shear_force[0], WithinRel(8 * shear_modulus * a * 1e-5, 1e-12));
    motion.slip = {1e-2};
    auto const slid = law::evaluate(p, motion, r.history);
    REQUIRE_THAT(slid.shear_force[0], WithinRel(mu * -slid.normal_force, 1e-12));
    // Loads in shear at a deep contact and unloads at a shallow one: work and energy balance.
    double work = 0, dissipated = 0;
    auto state = law::initial<double, 2>(0.2, 0.2);
    double last = 0;
    lacuna::pair_response<double, 2, law::history<double, 2>> now{};
    for (int k = 0; k <= 4000; ++k) {
        double const phase = 2 * pi * k / 4000.0;
        double const depth = overlap * (1.5 + std::sin(phase));
        double const s = 2e-5 * std::sin(phase + 0.7);
        double const before = now.shear_force[0];
        motion.distance = 0.2 - depth;
        motion.slip = {k == 0 ? 0.0 : s - last};
        last = s;
        now = law::evaluate(p, motion, state);
        state = now.history;
        work += 0.5 * (before + now.shear_force[0]) * motion.slip[0];
        REQUIRE(now.dissipated_energy >= -1e-15);
        dissipated += now.dissipated_energy;
    }
    double const elastic = 0.4 * (0.2 - motion.distance) * -now.normal_force;
    REQUIRE(dissipated > 0);
    REQUIRE_THAT(work - dissipated, WithinAbs(now.stored_energy - elastic, 1e-12));
    // The derivative of the shear force by dual numbers is the same stiffness.
    auto const k = lacuna::law_stiffness<law, 2>(p, 0.2 - overlap, 0.1, 0.1, false);
    REQUIRE_THAT(k.normal, WithinRel(2 * plane_modulus * a, 1e-9));
    REQUIRE_THAT(k.shear, WithinRel(8 * shear_modulus * a, 1e-9));
}

TEST_CASE("a bond that fails in shear under compression leaves a Hertzian contact with its forces", "[hertz]") {
    using law = lacuna::hertz_mindlin;
    auto const p = law::combine({1e6, 0.3, 10, 1}, {1e6, 0.3, 10, 1}, 1);
    // Normal forces equal to, above and below that of the overlap; and a pair with a gap.
    for (double const distance : {0.199, 0.2, 0.201})
        for (double const force : {-1e-3, -0.5, -7.0}) {
            lacuna::pair_motion<double, 2> const still{distance, 0.1, 0.1, {0}, 0};
            auto const handed_over = law::evaluate(p, still, law::hand_over(p, still, force, {0.2 * force}));
            REQUIRE_THAT(handed_over.normal_force, WithinRel(force, 1e-9));
            REQUIRE_THAT(handed_over.shear_force[0], WithinRel(0.2 * force, 1e-9));
        }
    // Without compression there is no friction.
    lacuna::pair_motion<double, 2> const apart{0.201, 0.1, 0.1, {0}, 0};
    auto const loose = law::evaluate(p, apart, law::hand_over(p, apart, 3.0, {0.2}));
    REQUIRE(loose.normal_force == 0);
    REQUIRE(loose.shear_force[0] == 0);
}

TEST_CASE("Hertzian materials are refused by field, value and rule", "[hertz][refusal]") {
    for (double const nu : {-1.0, 0.51, never, std::numeric_limits<double>::quiet_NaN()})
        REQUIRE_THROWS_WITH((lacuna::hertz_mindlin::material{1e6, nu, 0.1, 1}.validate("m")),
                            contains_text("m.poisson_ratio = " + lacuna::to_text(nu) + ": must be > -1 and <= 0.5"));
    for (double const young : {0.0, -1.0, never})
        REQUIRE_THROWS_WITH((lacuna::hertz_mindlin::material{young, 0.3, 0.1, 1}.validate("m")),
                            contains_text("m.young_modulus = " + lacuna::to_text(young) + ": must be"));
}

TEST_CASE("a sphere hits a wall as in Hertz's theory", "[hertz]") {
    using model = spheres<2>;
    auto p = glass<model>();
    p.walls = {{{0, 0}, {0, 1}, p.materials[0].contact}};
    lacuna::packing<double, 2> one;
    one.add({0, 0.01}, 0.01);
    double const speed = 0.3, modulus = 7e7 / (2 * 0.91), mass = 2500 * 4.0 / 3 * pi * 1e-6;
    double const deepest = std::pow(1.25 * mass * speed * speed / (4.0 / 3 * modulus * 0.1), 0.4);
    p.time_step = deepest / speed / 2000;
    lacuna::simulation<model> sim(one, p);
    sim.set_velocity(0, {0, -speed});
    double most = 0;
    for (int step = 0; step < 8000; ++step) {
        sim.step();
        most = std::max(most, 0.01 - sim.position(0)[1]);
    }
    REQUIRE_THAT(most, WithinRel(deepest, 1e-4));
    REQUIRE_THAT(sim.velocity(0)[1], WithinRel(speed, 1e-3));
}
