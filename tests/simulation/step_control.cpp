// SPDX-License-Identifier: BSD-3-Clause

#include <cstdio>
#include <functional>

#include <lacuna/laws/hertz_mindlin.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

template <int Dim, class Real = double, class Damping = lacuna::no_damping>
struct elastic_spheres : lacuna::default_model<Dim, Real> {
    using contact_law = lacuna::hertz_mindlin;
    using damping = Damping;
};

template <class Model>
lacuna::simulation_parameters<Model> steel(double young = 1e9) {
    lacuna::simulation_parameters<Model> p;
    p.materials[0].density = 2500;
    p.materials[0].contact = {young, 0.3, 0, 1};
    p.mass = lacuna::mass_model::sphere;
    return p;
}

/// Hertz: deepest overlap and largest force of a collision, F = k x^(3/2).
struct hertz_collision {
    double k, deepest, force;
    hertz_collision(double young, double radius, double mass, double speed)
        : k(4.0 / 3 * young / (2 * (1 - 0.09)) * std::sqrt(radius)),
          deepest(std::pow(1.25 * mass * speed * speed / k, 0.4)), force(k * std::pow(deepest, 1.5)) {}
};

/// Two spheres of radius 1 cm that are 1 cm apart meet, each at `speed`; the step is not given.
template <class Model>
void meet(double speed, double young) {
    using real = typename Model::real;
    lacuna::packing<real, Model::dim> two;
    two.add({}, real(0.01));
    lacuna::vec<real, Model::dim> position{};
    position[0] = real(0.03);
    two.add(position, real(0.01));
    lacuna::simulation<Model> sim(two, steel<Model>(young));
    lacuna::vec<double, Model::dim> v{};
    v[0] = speed;
    sim.set_velocity(0, v);
    sim.set_velocity(1, -v);
    double strongest = 0;
    bool touched = false;
    long long steps = 0;
    for (; steps < 2000000 && !(touched && sim.position(1)[0] - sim.position(0)[0] > 0.025); ++steps) {
        sim.step_with_energy();
        double const force = -sim.pair_force(0, 1)[0];
        strongest = std::max(strongest, force);
        touched = touched || force > 0;
    }
    INFO("dim " << Model::dim << ", " << sizeof(real) << " bytes, v = " << speed << ", E = " << young << ", " << steps
                << " steps");
    hertz_collision const exact(young, 0.005, sim.mass(0) / 2, 2 * speed);
    CHECK_THAT(-sim.velocity(0)[0] / speed, WithinAbs(1, 1e-3));
    CHECK_THAT(sim.velocity(1)[0] / speed, WithinAbs(1, 1e-3));
    CHECK_THAT(strongest, WithinRel(exact.force, 5e-3));
    CHECK(std::fabs(sim.energy().residual()) < 0.02 * sim.energy().largest());
}

/// F = k x + c x^2, elastic or with a permanent dent: then unloading is stiffer than loading by a factor.
template <bool States>
struct curved_contact {
    struct material {
        double linear = 1e6, square = 0, unloading = 1e6;
        void validate(std::string const&) const {}
    };
    template <class T>
    struct parameters {
        T linear, square, unloading;
    };
    template <class T, int Dim>
    struct history {
        T deepest;
    };
    static parameters<double> combine(material const& a, material const&, double) {
        return {a.linear, a.square, a.unloading};
    }
    template <class T, int Dim>
    static history<T, Dim> initial(T, T) {
        return {T(0)};
    }
    template <class T, int Dim>
    static history<T, Dim> hand_over(parameters<T> const&, lacuna::pair_motion<T, Dim> const&, T,
                                     lacuna::vec<T, lacuna::shear_dim<Dim>> const&) {
        return {T(0)};
    }
    template <class T, int Dim>
    static lacuna::pair_response<T, Dim, history<T, Dim>>
    evaluate(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        using lacuna::max;
        T overlap = max(m.touching_distance() - m.distance, T(0)), deepest = max(overlap, h.deepest);
        T force = max(p.linear * deepest + p.square * deepest * deepest - p.unloading * (deepest - overlap), T(0));
        return {-force, {}, {deepest}, T(0), T(0)};
    }
    template <class T>
    static T stiffness(parameters<T> const& p) requires(!States) {
        return p.unloading;
    }
    template <class T, int Dim>
    static T stiffness(parameters<T> const& p, lacuna::pair_motion<T, Dim> const& m,
                       history<T, Dim> const&) requires(States) {
        using lacuna::max;
        return p.linear + T(2) * p.square * max(m.touching_distance() - m.distance, T(0));
    }
};
template <bool States, int Dim, class Real = double>
struct curved : lacuna::default_model<Dim, Real> {
    using contact_law = curved_contact<States>;
};

/// Stops a run after a step.
struct stop_at {
    static constexpr lacuna::stage stages = lacuna::stage::step;
    long long last;
    template <class Simulation>
    lacuna::run_control on_step(Simulation const& s) const {
        return s.steps() >= last ? lacuna::run_control::stop : lacuna::run_control::go_on;
    }
};

/// Calls sim.step() until done(sim), at most `most` times.
/// \return whether done(sim) became true
template <class Simulation>
bool run_until(Simulation& sim, long long most, std::function<bool(Simulation const&)> const& done) {
    for (long long n = 0; n < most; ++n) {
        sim.step();
        if (done(sim)) return true;
    }
    return false;
}

} // namespace

TEST_CASE("a chosen step resolves a Hertzian collision of a run that starts without contacts", "[step]") {
    for (auto const& [speed, young] :
         {std::pair{0.1, 1e9}, std::pair{0.1, 1e6}, std::pair{5.0, 1e9}, std::pair{1e-3, 1e9}}) {
        meet<elastic_spheres<3>>(speed, young);
        meet<elastic_spheres<2>>(speed, young);
    }
    meet<elastic_spheres<3, float>>(0.5, 1e8);
    meet<elastic_spheres<2, float>>(0.5, 1e8);
}

TEST_CASE("a chosen step resolves collisions with walls, at rest or in motion", "[step]") {
    // A sphere falls on a floor; a stiff wall moves towards a sphere at rest, which leaves at twice the speed of the
    // wall.
    for (bool const moving : {false, true}) {
        using model = elastic_spheres<3>;
        auto p = steel<model>(1e8);
        p.walls = {{{0, 0, 0}, {0, 0, 1}, {moving ? 1e11 : 1e8, 0.3, 0, 1}}};
        lacuna::packing<double, 3> one;
        one.add({0, 0, 0.013}, 0.01);
        lacuna::simulation<model> sim(one, p);
        if (moving)
            sim.move_wall(0, {0, 0, 0.4});
        else
            sim.set_velocity(0, {0, 0, -0.4});
        double strongest = 0;
        auto const left = [&](auto const& s) {
            strongest = std::max(strongest, -s.walls().force(0)[2]);
            return strongest > 0 && s.walls().force(0)[2] == 0;
        };
        REQUIRE(run_until<lacuna::simulation<model>>(sim, 100000, left));
        double const modulus = 1 / (0.91 / 1e8 + 0.91 / (moving ? 1e11 : 1e8));
        double const k = 4.0 / 3 * modulus * 0.1;
        double const force = k * std::pow(1.25 * sim.mass(0) * 0.16 / k, 0.6);
        INFO("moving: " << moving);
        CHECK_THAT(sim.velocity(0)[2], WithinRel(moving ? 0.8 : 0.4, 1e-3));
        CHECK_THAT(strongest, WithinRel(force, 5e-3));
    }
}

TEST_CASE("a chosen step includes dashpots, also beyond critical damping", "[step][damping]") {
    for (double const e : {0.05, 0.5}) {
        using model = elastic_spheres<3, double, lacuna::restitution_damping>;
        auto p = steel<model>();
        p.damping = lacuna::restitution_damping::with_restitution(e);
        lacuna::packing<double, 3> two;
        two.add({0, 0, 0}, 0.01);
        two.add({0.03, 0, 0}, 0.01);
        lacuna::simulation<model> sim(two, p);
        sim.set_velocity(0, {1, 0, 0});
        bool touched = false;
        REQUIRE(run_until<lacuna::simulation<model>>(sim, 100000, [&](auto const& s) {
            bool const now = s.pair_force(0, 1)[0] != 0;
            touched = touched || now;
            return touched && !now;
        }));
        INFO("e = " << e);
        CHECK_THAT(sim.velocity(1)[0] - sim.velocity(0)[0], WithinAbs(e, 0.02));
    }
    // x'' = -w^2 x - 2 z w x' with z = 2 pushes until spring and dashpot together do: at least e^(-t ...) of the speed
    // is left.
    auto p = springs<plane_combined>(1e6, 0);
    p.damping.viscous = 2;
    lacuna::packing<double, 2> two;
    two.add({0, 0}, 0.5);
    two.add({1.3, 0}, 0.5);
    lacuna::simulation<plane_combined> sim(two, p);
    sim.set_velocity(0, {0.5, 0});
    double const z = 2, w = std::sqrt(2 * 1e6 / sim.mass(0)), root = std::sqrt(z * z - 1);
    // x = v / (w root) e^(-z w t) sinh(w root t); the force vanishes where x'' = 0:
    // tanh(w root t) = 2 z root / (2 z^2 - 1).
    double const t = std::atanh(2 * z * root / (2 * z * z - 1)) / (w * root);
    double const left = -0.5 * std::exp(-z * w * t) * (std::cosh(w * root * t) - z / root * std::sinh(w * root * t));
    bool touched = false;
    REQUIRE(run_until<lacuna::simulation<plane_combined>>(sim, 100000, [&](auto const& s) {
        bool const now = s.pair_force(0, 1)[0] != 0;
        touched = touched || now;
        return touched && !now;
    }));
    CHECK_THAT(sim.velocity(1)[0] - sim.velocity(0)[0], WithinAbs(left, 0.02 * 0.5));
}

TEST_CASE("the step follows a light, stiff particle that flies into a soft, heavy bed", "[step]") {
    // It hits an equal particle that lies on the bed: they exchange their velocities.
    lacuna::simulation_parameters<plane> p;
    p.materials = {{2000, {1e4, 0, 0}, {}}, {2, {1e9, 0, 0}, {}}};
    lacuna::packing<double, 2> bed;
    for (int k = 0; k < 20; ++k) bed.add({1.0 * (k % 5), 1.0 * (k / 5)}, 0.5, 0);
    bed.add({6.0, 3.0}, 0.5, 1);
    bed.add({7.2, 3.0}, 0.5, 1);
    lacuna::simulation<plane> sim(bed, p);
    sim.set_velocity(21, {-3.0, 0});
    double const slow = sim.resolve_time_step();
    REQUIRE(run_until<lacuna::simulation<plane>>(sim, 1000000, [&](auto const& s) { return s.velocity(20)[0] < -1; }));
    sim.run(50);
    CHECK(sim.time_step() < 0.1 * slow);
    CHECK_THAT(sim.velocity(20)[0], WithinRel(-3.0, 0.02));
    CHECK_THAT(sim.velocity(21)[0], WithinAbs(0, 0.06));
}

TEST_CASE("a step that is chosen, or grows, includes contacts that may form within it", "[step]") {
    // Soft discs at rest give a long step. A stiff, light one flies towards another, which is closer than its path in
    // that step.
    for (double const gap : {0.004, 0.006, 0.012, 0.02, 0.045, 0.11, 0.3}) {
        CAPTURE(gap);
        lacuna::simulation_parameters<plane> p;
        p.materials = {{2000, {1e4, 0, 0}, {}}, {2, {1e9, 0, 0}, {}}};
        lacuna::packing<double, 2> bed;
        for (int k = 0; k < 20; ++k) bed.add({1.0 * (k % 5), 1.0 * (k / 5)}, 0.5, 0);
        bed.add({6.0, 3.0}, 0.5, 1);
        bed.add({7.0 + gap, 3.0}, 0.5, 1);
        bed.add({12.0, 3.0}, 0.5, 1);
        bed.add({13.0 + 3 * gap, 3.0}, 0.5, 1);
        lacuna::simulation<plane> sim(bed, p);
        sim.set_velocity(21, {-3.0, 0});
        sim.set_velocity(23, {-3.0, 0});
        REQUIRE(run_until<lacuna::simulation<plane>>(sim, 1000000,
                                                     [&](auto const& s) { return s.velocity(22)[0] < -2.9; }));
        sim.run(10);
        CHECK_THAT(sim.velocity(20)[0], WithinRel(-3.0, 0.02));
        CHECK_THAT(sim.velocity(22)[0], WithinRel(-3.0, 0.02));
    }
}

TEST_CASE("a given step that contacts make unsafe stops the run with both numbers", "[step][refusal]") {
    for (bool const allowed : {false, true}) {
        auto p = springs<plane>(1e6, 0, 0, 4 / pi);
        p.time_step = 1.6e-3; // the limit in contact is 2 / sqrt(2 k / m) = 1.4e-3
        p.allow_unstable_step = allowed;
        lacuna::packing<double, 2> two;
        two.add({0, 0}, 0.5);
        two.add({1.1, 0}, 0.5);
        lacuna::simulation<plane> sim(two, p);
        sim.set_velocity(0, {0.5, 0});
        auto const meets = [&] { run_until<lacuna::simulation<plane>>(sim, 400, [](auto const&) { return false; }); };
        if (allowed) {
            REQUIRE_NOTHROW(meets());
            continue;
        }
        REQUIRE_THROWS_AS(meets(), lacuna::unstable_run);
        REQUIRE(sim.position(1)[0] == 1.1); // before they push each other
        REQUIRE(sim.position(0)[0] > 0.08);
        REQUIRE_THROWS_WITH(sim.step(),
                            contains_text("time step of 0.0016 s is above the stable limit, which is 0.0014142") &&
                                contains_text("contacts have formed"));
    }
    // Hertz: a step that is safe for a light contact, but not for a deep overlap under a load.
    using model = elastic_spheres<3>;
    auto p = steel<model>(1e8);
    p.materials[0].contact.shear_factor = 0;
    lacuna::packing<double, 3> two;
    two.add({0, 0, 0}, 0.01);
    two.add({0.02, 0, 0}, 0.01);
    double const mass = 2500 * 4.0 / 3 * pi * 1e-6, modulus = 1e8 / (2 * 0.91), overlap = 2e-4;
    // At an overlap x the stiffness is 2 E* sqrt(R x), here of a sphere against a fixed one.
    p.time_step = 2 / std::sqrt(2 * modulus * std::sqrt(0.005 * overlap) / mass);
    lacuna::simulation<model> sim(two, p);
    sim.fix(0);
    double const force = 4.0 / 3 * modulus * std::sqrt(0.005) * std::pow(3 * overlap, 1.5);
    sim.apply(1, {-force, 0, 0}, {}, 1000 * p.time_step);
    double deepest = 0;
    REQUIRE_THROWS_AS(run_until<lacuna::simulation<model>>(sim, 3000,
                                                           [&](auto const& s) {
                                                               deepest = 0.02 - s.position(1)[0];
                                                               return false;
                                                           }),
                      lacuna::unstable_run);
    CHECK(deepest > 0.6 * overlap);
    CHECK(deepest < 1.1 * overlap);
}

TEST_CASE("the step follows contacts, and limits are rarely computed in a run with many events", "[step]") {
    auto p = springs<plane>(1e6, 5e5, 0.3, 2500);
    lacuna::packing<double, 2> gas;
    for (int k = 0; k < 400; ++k) gas.add({1.15 * (k % 20) + 0.1 * std::sin(7.0 * k), 1.15 * (k / 20)}, 0.5);
    p.walls = {{{-1, 0}, {1, 0}, p.materials[0].contact}, {{23, 0}, {-1, 0}, p.materials[0].contact},
               {{0, -1}, {0, 1}, p.materials[0].contact}, {{0, 23}, {0, -1}, p.materials[0].contact}};
    lacuna::simulation<plane> sim(gas, p);
    for (std::size_t k = 0; k < sim.size(); ++k)
        sim.set_velocity(k, {std::sin(12.9 * double(k)), std::cos(78.2 * double(k))});
    sim.run(2000);
    auto const before = sim.limit_updates();
    sim.run(4000);
    CHECK(sim.limit_updates() - before >= 2);
    CHECK(sim.limit_updates() - before <= 6);
    CHECK(sim.time_step() < 0.5 * sim.limits().critical());
}

TEST_CASE("a user's contact law: the step uses the stiffness that the law states", "[step][refusal]") {
    auto const limit_of = [](auto model, auto const& contact) {
        using type = decltype(model);
        using real = typename type::real;
        lacuna::packing<real, type::dim> two;
        two.add({}, real(0.5));
        lacuna::vec<real, type::dim> x{};
        x[0] = real(0.99);
        two.add(x, real(0.5));
        lacuna::simulation_parameters<type> p;
        p.materials[0].density = 2500;
        p.materials[0].contact = contact;
        lacuna::simulation<type> sim(two, p);
        return sim.limits().critical() / std::sqrt(sim.mass(0)); // 2 / omega = sqrt(2 m / k)
    };
    // Loading with 1e6 N/m, unloading with 4e6 N/m.
    curved_contact<false>::material const dents{1e6, 0, 4e6};
    CHECK_THAT(limit_of(curved<false, 2>{}, dents), WithinRel(std::sqrt(2 / 4e6), 1e-6));
    CHECK_THAT(limit_of(curved<false, 3>{}, dents), WithinRel(std::sqrt(2 / 4e6), 1e-6));
    CHECK_THAT(limit_of(curved<false, 2, float>{}, dents), WithinRel(std::sqrt(2 / 4e6), 1e-5));
    // A growing stiffness: the step follows it if the law states the present value, is bounded if the law states the
    // largest; otherwise the law is refused.
    curved_contact<false>::material const grows{1e6, 1e7, 1e6};
    CHECK_THROWS_WITH(limit_of(curved<false, 2>{}, grows),
                      contains_text("stiffness of the contact law") &&
                          contains_text("stiffness(parameters, pair_motion, history)"));
    CHECK_NOTHROW(limit_of(curved<false, 2>{}, curved_contact<false>::material{1e6, 1e7, 5e6}));
    CHECK(limit_of(curved<true, 2>{}, curved_contact<true>::material{1e6, 1e7, 0}) < std::sqrt(2 / 1.2e6) * (1 + 1e-6));
}

TEST_CASE("pairs that are far from touching make no step shorter", "[step]") {
    // Rows of discs; bonds connect neighbours in a row. A tether connects the first disc to the last.
    auto const sheet = [](double gap, bool tether) {
        lacuna::packing<double, 2> discs;
        for (int k = 0; k < 900; ++k) discs.add({1.0 * (k % 30), (1.0 + gap) * (k / 30)}, 0.5);
        for (int k = 0; k + 1 < 900; ++k)
            if (k % 30 < 29) discs.bonds.push_back({k, k + 1});
        if (tether) discs.bonds.push_back({0, 899});
        return discs;
    };
    auto p = springs<plane>(1e6, 5e5, 0.2, 2500);
    p.bonds.resize(900 - 30 + 1);
    p.bonds.back().normal_stiffness = 1e4;
    p.bonds.back().shear_stiffness = 0; // across 42 m its lever arm would be 21 m
    auto const with = [&](double gap, bool tether) {
        auto q = p;
        if (!tether) q.bonds.pop_back();
        return lacuna::simulation<plane>(sheet(gap, tether), q).resolve_time_step();
    };
    double const alone = with(1.0, false), touching = with(0, false);
    CHECK_THAT(with(0.05, false), WithinRel(alone, 1e-12));
    CHECK_THAT(with(1.0, true), WithinRel(alone, 0.01));
    CHECK(touching < 0.9 * alone);
    CHECK_THAT(with(0, true), WithinRel(touching, 0.01));
}

TEST_CASE("a run that is resumed in mid-flight adapts its step like the uninterrupted run", "[step][checkpoint]") {
    using model = elastic_spheres<2>;
    auto const make = [] {
        auto p = steel<model>(1e7);
        p.walls = {{{0, 0}, {0, 1}, p.materials[0].contact}};
        lacuna::packing<double, 2> some;
        for (int k = 0; k < 30; ++k) some.add({0.023 * (k % 6), 0.012 + 0.023 * (k / 6)}, 0.01);
        lacuna::simulation<model> sim(some, p);
        for (std::size_t k = 0; k < 30; ++k)
            sim.set_velocity(k, {std::sin(12.9 * double(k)), -1 + std::cos(78.2 * double(k))});
        return sim;
    };
    for (int const first : {37, 150, 700}) {
        auto whole = make();
        whole.run(2000);
        REQUIRE(whole.limit_updates() >= 3);
        auto part = make();
        part.run(2000, stop_at{first});
        std::string const path = "step_control.bin";
        lacuna::save_checkpoint(path, part);
        auto other = make();
        lacuna::load_checkpoint(path, other);
        std::remove(path.c_str());
        other.run(2000 - first);
        REQUIRE(lacuna::state_hash(other) == lacuna::state_hash(whole));
    }
}
