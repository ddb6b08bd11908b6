// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <vector>

#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "scratch_directory.hpp"
#include "simulation/setups.hpp"

using namespace setups;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using lacuna::acted_particle;

namespace {

/// -k x - c v, N: an isotropic spring to the origin and a drag.
struct spring_and_drag {
    double stiffness = 9, drag = 0; ///< N/m, N s/m
    template <int Dim>
    lacuna::vec<double, Dim> operator()(acted_particle<Dim> const& p) const {
        return p.position * -stiffness + p.velocity * -drag;
    }
    void validate(std::string const& name) const { lacuna::require_not_negative(name + ".stiffness", stiffness); }
};
template <int Dim, class Real = double>
struct held_by_spring : lacuna::default_model<Dim, Real> {
    using forces = lacuna::body_force<spring_and_drag>;
};
/// A force that acts along one direction only.
inline constexpr auto lift = [](acted_particle<2> const& p) {
    return lacuna::vec<double, 2>{0, 0.5 * p.mass * p.time};
};
struct lifted : lacuna::default_model<2> {
    using forces = lacuna::body_force<decltype(lift)>;
};

/// One particle of 1 kg at `x` along the first axis.
template <int Dim, class Real>
lacuna::packing<Real, Dim> one(double x) {
    lacuna::packing<Real, Dim> p;
    lacuna::vec<Real, Dim> at{};
    at[0] = Real(x);
    p.add(at, Real(0.5));
    return p;
}
template <class Model>
lacuna::simulation_parameters<Model> of_one_kilogram(double step) {
    lacuna::simulation_parameters<Model> p;
    p.materials[0].density = unit_density(Model::dim);
    p.time_step = step;
    return p;
}
/// Particles without contacts; some are bonded.
template <class Model>
lacuna::simulation<Model> cloud(int threads) {
    lacuna::packing<double, Model::dim> p;
    for (int k = 0; k < 400; ++k) {
        lacuna::vec<double, Model::dim> x{};
        x[0] = 1.2 * (k % 20) - 11;
        x[1] = 1.2 * (k / 20) - 13;
        p.add(x, 0.5);
        if (k % 7 == 1) p.bonds.push_back({k - 1, k});
    }
    auto q = springs<Model>(1e3, 1e3, 0.1);
    q.threads = threads;
    q.forces.force = {50, 10};
    q.time_step = 1e-3;
    return lacuna::simulation<Model>(p, q);
}

} // namespace

TEMPLATE_TEST_CASE("a body force: harmonic motion, to the order of the scheme", "[body_force]", (held_by_spring<2>),
                   (held_by_spring<3>), (held_by_spring<2, float>), (held_by_spring<3, float>)) {
    using real = typename TestType::real;
    // Frequency of the leapfrog scheme: 2 sin(w' dt / 2) / dt = sqrt(k / m) = 3. From rest half a step before x = A at
    // the start.
    double const dt = 0.01, w = 2 / dt * std::asin(3 * dt / 2);
    lacuna::simulation<TestType> run(one<TestType::dim, real>(0.25), of_one_kilogram<TestType>(dt));
    for (int n = 0; n < 200; ++n) run.step_with_energy();
    // x_n = A cos(w' (n + 1/2) dt) / cos(w' dt / 2) has v(-dt/2) = 0.
    double const expected = 0.25 * std::cos(w * 200.5 * dt) / std::cos(w * dt / 2);
    double const rounding = sizeof(real) == 8 ? 1e-12 : 2e-5;
    CHECK_THAT(run.position(0)[0], WithinAbs(expected, rounding));
    // The work of the force is the kinetic energy of the particle.
    CHECK_THAT(run.energy().external, WithinAbs(run.energy().kinetic, rounding));
    CHECK_THAT(run.energy().residual(), WithinAbs(0.0, rounding));
    CHECK(run.energy().kinetic > 0.01);
    CHECK_THAT(run.force(0)[0],
               WithinRel(-9 * (run.position(0)[0] - dt * run.velocity(0)[0]), sizeof(real) == 8 ? 1e-12 : 1e-4));
}

TEMPLATE_TEST_CASE("a body force's derivatives bound the time step",
                   "[body_force]", (held_by_spring<2>), (held_by_spring<3>)) {
    auto p = of_one_kilogram<TestType>(0);
    lacuna::simulation<TestType> stiff(one<TestType::dim, double>(0.25), p);
    CHECK_THAT(stiff.limits().rigorous, WithinRel(2 / 3.0, 1e-8)); // 2 / sqrt(k / m)
    CHECK_THAT(stiff.resolve_time_step(), WithinRel(0.2 * 2 / 3, 1e-8));
    // With drag c: dt^2 k / m + 2 dt c / m = 4.
    p.forces.force.drag = 7;
    lacuna::simulation<TestType> dragged(one<TestType::dim, double>(0.25), p);
    CHECK_THAT(dragged.limits().rigorous, WithinRel((-7 + std::sqrt(49.0 + 4 * 9)) / 9, 1e-8));
    p.time_step = 0.3;
    CHECK_THROWS_WITH(lacuna::simulation<TestType>(one<TestType::dim, double>(0.25), p).step(),
                      contains_text("time_step = 0.3") && contains_text("stable limit"));
    // Just below the bound the motion stays bounded; a fixed particle does not move.
    p.forces.force.drag = 0;
    p.time_step = 0.66;
    p.guards.motion = false;
    lacuna::simulation<TestType> rings(one<TestType::dim, double>(0.01), p);
    rings.run(1000);
    CHECK(std::fabs(rings.position(0)[0]) < 0.5);
    lacuna::simulation<TestType> held(one<TestType::dim, double>(0.25), of_one_kilogram<TestType>(0));
    held.fix(0);
    CHECK(std::isinf(held.limits().rigorous));
}

TEST_CASE("a body force that depends on time: half of g t^3 / 3", "[body_force]") {
    auto p = of_one_kilogram<lifted>(1e-3);
    lacuna::simulation<lifted> run(one<2, double>(0), p);
    run.run(2000);
    CHECK_THAT(run.position(0)[1], WithinRel(0.5 * 8.0 / 6, 2e-3));
    CHECK(run.position(0)[0] == 0);
}

TEST_CASE("a body force acts with walls, bonds and plates: a spring against a wall", "[body_force]") {
    // Two bonded discs pulled to x = 0 with 2 * 9 N/m meet a wall at x = 1; at rest the wall carries the sum of the
    // pulls.
    using model = held_by_spring<2>;
    struct damped : model {
        using damping = lacuna::local_damping;
    };
    auto p = springs<damped>(1e4, 1e4, 0, unit_density(2));
    p.walls.push_back({{1, 0}, {1, 0}});
    lacuna::packing<double, 2> discs;
    discs.add({1.5, 0}, 0.5);
    discs.add({2.5, 0}, 0.5);
    discs.bonds.push_back({0, 1});
    for (bool const joined : {false, true}) {
        lacuna::simulation<damped> run(discs, p);
        std::vector<std::size_t> const both{0, 1};
        if (joined) run.attach_to_rigid_plate(both, 0);
        run.run(60000);
        CHECK_THAT(std::fabs(run.walls().force(0)[0]), WithinRel(9 * (run.position(0)[0] + run.position(1)[0]), 1e-6));
    }
}

TEST_CASE("a body force leaves the same bits for any number of threads and after a restart", "[body_force][restart]") {
    using model = held_by_spring<2>;
    auto whole = cloud<model>(1), wide = cloud<model>(3), first = cloud<model>(2);
    whole.run(3000);
    wide.run(3000);
    REQUIRE(lacuna::state_hash(whole) == lacuna::state_hash(wide));
    first.run(1234);
    scratch_directory const there;
    std::string const file = there.file("cloud");
    lacuna::save_checkpoint(file, first);
    auto second = cloud<model>(1);
    lacuna::load_checkpoint(file, second);
    second.run(3000 - 1234);
    REQUIRE(lacuna::state_hash(second) == lacuna::state_hash(whole));
    // A checkpoint with another force is refused.
    lacuna::simulation_parameters<model> p = whole.settings();
    p.forces.force.stiffness = 51;
    lacuna::packing<double, 2> packing;
    for (int k = 0; k < 400; ++k) {
        packing.add({1.2 * (k % 20) - 11, 1.2 * (k / 20) - 13}, 0.5);
        if (k % 7 == 1) packing.bonds.push_back({k - 1, k});
    }
    lacuna::simulation<model> other(packing, p);
    CHECK_THROWS_WITH(lacuna::load_checkpoint(file, other), contains_text("forces.force.stiffness = 50, here 51"));
}

TEST_CASE("the parameters of a body force are checked, and a force that is not a number ends the run", "[body_force]") {
    auto p = of_one_kilogram<held_by_spring<2>>(0.01);
    p.forces.force.stiffness = -1;
    CHECK_THROWS_WITH(lacuna::simulation<held_by_spring<2>>(one<2, double>(0), p),
                      contains_text("forces.force.stiffness = -1: must be"));
    p.forces.force = {0, std::numeric_limits<double>::quiet_NaN()};
    p.allow_unstable_step = true;
    lacuna::simulation<held_by_spring<2>> run(one<2, double>(0), p);
    CHECK_THROWS_AS(run.run(3), lacuna::unstable_run);
}
