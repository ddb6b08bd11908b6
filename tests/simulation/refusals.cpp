// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
using settings = lacuna::simulation_parameters<plane>;

std::string refusal(auto const& build) {
    try {
        build();
    } catch (std::invalid_argument const& e) {
        return e.what();
    }
    return "accepted";
}

/// Pushes three times as hard when a pair separates as when it approaches.
struct pusher : lacuna::frictional_spring {
    template <class T, int Dim>
    static lacuna::pair_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p,
                                                                   lacuna::pair_motion<T, Dim> const& m,
                                                                   history<T, Dim> const& h) {
        auto answer = lacuna::frictional_spring::evaluate(p, m, h);
        answer.normal_force = answer.normal_force * lacuna::select(m.normal_rate > T(0), T(1.5), T(0.5));
        return answer;
    }
};
struct plane_of_pushers : plane {
    using contact_law = pusher;
};

} // namespace

TEST_CASE("each bad parameter is refused by name", "[refusal]") {
    struct field {
        std::string name;
        double& (*get)(settings&);
        std::vector<double> bad;
    };
    std::vector<double> const positive{nan_value, never, -never, 0.0, -1.0};
    std::vector<double> const not_negative{nan_value, never, -never, -1.0};
    std::vector<double> const finite{nan_value, never, -never};
    std::vector<double> const limit{nan_value, -never, -1.0};
    field const fields[] = {
        {"materials[0].density", [](settings& p) -> double& { return p.materials[0].density; }, positive},
        {"materials[0].contact.normal_stiffness",
         [](settings& p) -> double& { return p.materials[0].contact.normal_stiffness; }, positive},
        {"materials[0].contact.shear_stiffness",
         [](settings& p) -> double& { return p.materials[0].contact.shear_stiffness; }, not_negative},
        {"materials[0].contact.friction", [](settings& p) -> double& { return p.materials[0].contact.friction; },
         not_negative},
        {"materials[0].bond.normal_stiffness",
         [](settings& p) -> double& { return p.materials[0].bond.normal_stiffness; }, positive},
        {"materials[0].bond.shear_stiffness",
         [](settings& p) -> double& { return p.materials[0].bond.shear_stiffness; }, not_negative},
        {"materials[0].bond.tensile_strength",
         [](settings& p) -> double& { return p.materials[0].bond.tensile_strength; }, limit},
        {"materials[0].bond.shear_strength", [](settings& p) -> double& { return p.materials[0].bond.shear_strength; },
         limit},
        {"thickness", [](settings& p) -> double& { return p.thickness; }, positive},
        {"gravity", [](settings& p) -> double& { return p.gravity[1]; }, finite},
        {"fluid_density", [](settings& p) -> double& { return p.fluid_density; }, not_negative},
        {"interactions.skin", [](settings& p) -> double& { return p.interactions.skin; }, not_negative},
        {"interactions.initial_contact_tolerance",
         [](settings& p) -> double& { return p.interactions.initial_contact_tolerance; },
         {nan_value, never, -1.0, 0.6}},
        {"time_step", [](settings& p) -> double& { return p.time_step; }, not_negative},
        {"safety", [](settings& p) -> double& { return p.safety; }, positive},
        {"start_time", [](settings& p) -> double& { return p.start_time; }, finite},
    };
    for (auto const& f : fields)
        for (double const value : f.bad) {
            settings p;
            f.get(p) = value;
            INFO(f.name << " = " << value);
            std::string const message = refusal([&] { lacuna::simulation<plane>(chain<2>(2), p); });
            REQUIRE_THAT(message, contains_text(f.name + " = " + lacuna::to_text(value) + ": must be "));
        }
    settings fine;
    REQUIRE(refusal([&] { lacuna::simulation<plane>(chain<2>(2), fine); }) == "accepted");
    fine.materials.clear();
    REQUIRE_THAT(refusal([&] { lacuna::simulation<plane>(chain<2>(2), fine); }), contains_text("materials.size()"));
    settings threads;
    threads.threads = 0;
    REQUIRE_THAT(refusal([&] { lacuna::simulation<plane>(chain<2>(2), threads); }), contains_text("threads = 0"));
    settings wall;
    wall.walls = {{{0, 0}, {0, 0}, {}}};
    REQUIRE_THAT(refusal([&] { lacuna::simulation<plane>(chain<2>(2), wall); }), contains_text("walls[0].normal"));
    lacuna::simulation_parameters<plane_locally_damped> local;
    for (double const value : {nan_value, -0.1, 1.1}) {
        local.damping.factor = value;
        REQUIRE_THAT(refusal([&] { lacuna::simulation<plane_locally_damped>(chain<2>(2), local); }),
                     contains_text("damping.factor = " + lacuna::to_text(value)));
    }
    lacuna::simulation_parameters<plane_viscous> viscous;
    for (double const value : {nan_value, never, -0.1}) {
        viscous.damping.ratio = value;
        REQUIRE_THAT(refusal([&] { lacuna::simulation<plane_viscous>(chain<2>(2), viscous); }),
                     contains_text("damping.ratio = " + lacuna::to_text(value)));
    }
}

TEST_CASE("each bad packing is refused by the particle's or bond's name", "[refusal]") {
    auto const attempt = [](auto const& spoil) {
        auto p = chain<2>(3);
        spoil(p);
        return refusal([&] { lacuna::simulation<plane> run(p); });
    };
    using pack = lacuna::packing<double, 2>;
    for (double const r : {nan_value, never, 0.0, -0.5})
        REQUIRE_THAT(attempt([&](pack& p) { p.radius[1] = r; }),
                     contains_text("particle 1.radius = " + lacuna::to_text(r)));
    for (double const x : {nan_value, never})
        REQUIRE_THAT(attempt([&](pack& p) { p.position[2][1] = x; }),
                     contains_text("particle 2.position = " + lacuna::to_text(x)));
    REQUIRE_THAT(attempt([](pack& p) { p.material[1] = 1; }), contains_text("particle 1.material = 1"));
    REQUIRE_THAT(attempt([](pack& p) { p.material[1] = -1; }), contains_text("particle 1.material = -1"));
    REQUIRE_THAT(attempt([](pack& p) { p.radius.pop_back(); }), contains_text("packing.radius.size()"));
    REQUIRE_THAT(attempt([](pack& p) { p.material.pop_back(); }), contains_text("packing.material.size()"));
    REQUIRE_THAT(attempt([](pack& p) { p.bonds[1] = {1, 3}; }), contains_text("bond 1.particle = 3"));
    REQUIRE_THAT(attempt([](pack& p) { p.bonds[1] = {-1, 2}; }), contains_text("bond 1.particle = -1"));
    REQUIRE_THAT(attempt([](pack& p) { p.bonds[1] = {2, 2}; }), contains_text("bond 1.particles = 2"));
    REQUIRE_THAT(attempt([](pack& p) { p.bonds.push_back({1, 0}); }), contains_text("a repeated pair"));
    REQUIRE_THAT(attempt([](pack& p) { p.density = {1, 1}; }), contains_text("packing.density.size() = 2"));
    REQUIRE_THAT(attempt([](pack& p) { p.density = {1, 0, 1}; }), contains_text("particle 1.density = 0: must be > 0"));
    REQUIRE_THAT(attempt([](pack& p) { p.density = {1, 1, nan_value}; }), contains_text("particle 2.density = nan"));
    REQUIRE_THAT(attempt([](pack& p) { p.bond_type = {0}; }), contains_text("packing.bond_type.size() = 1"));
    // Bonds of two types would become equal.
    REQUIRE_THAT(attempt([](pack& p) {
                     p.bond_type = {0, 2};
                 }),
                 contains_text("parameters.bonds = none") && contains_text("types 1 and 3"));
    REQUIRE(attempt([](pack& p) { p.bond_type = {2, 2}; }) == "accepted");
    auto typed = chain<2>(3);
    typed.bond_type = {0, 1};
    settings by_type;
    by_type.bonds = lacuna::by_bond_type(typed, std::vector<lacuna::bond_values>{{}, {.normal_stiffness = 7.0}});
    REQUIRE(refusal([&] { lacuna::simulation<plane> run(typed, by_type); }) == "accepted");
    // A periodic packing in an open domain.
    REQUIRE_THAT(attempt([](pack& p) {
                     p.period = {3, 0};
                 }),
                 contains_text("domain.period = 0: must be that of the packing's box") && contains_text("3"));
    REQUIRE_THAT(attempt([](pack& p) { p.position[1] = p.position[0]; }), contains_text("bond 0.distance"));
    REQUIRE(attempt([](pack&) {}) == "accepted");
}

TEST_CASE("bad calls are refused", "[refusal]") {
    lacuna::simulation<plane> run(chain<2>(3));
    REQUIRE_THROWS_WITH(run.position(3), contains_text("particle = 3"));
    REQUIRE_THROWS_WITH(run.apply(0, {nan_value, 0}), contains_text("load on particle 0.force"));
    REQUIRE_THROWS_WITH(run.apply(2, {0, 0}, never), contains_text("load on particle 2.torque"));
    REQUIRE_THROWS_WITH(run.apply(2, {0, 0}, 0, -1), contains_text("load on particle 2.ramp_time"));
    lacuna::packing<double, 2> one;
    one.add({0, 0}, 0.5);
    struct untouchable : plane {
        using contact_law = lacuna::no_contact;
    };
    lacuna::simulation<untouchable> alone(one);
    REQUIRE_THROWS_WITH(alone.step(), contains_text("time_step") && contains_text("without any stiffness"));
}

TEST_CASE("a run that went wrong says where", "[unstable]") {
    auto const expect = [](auto& run, long long step, long long particle, std::string const& text) {
        try {
            for (int n = 0; n < 1000; ++n) run.step();
            FAIL("nothing was thrown");
        } catch (lacuna::unstable_run const& e) {
            CHECK(e.step() == step);
            CHECK(e.particle() == particle);
            CHECK_THAT(e.what(), contains_text("step " + std::to_string(step)) && contains_text(text) &&
                                     contains_text("particle " + std::to_string(particle)));
        }
    };
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    p.time_step = 0.1;
    {
        lacuna::simulation<plane> run(chain<2>(5, false), p);
        for (int n = 0; n < 3; ++n) run.step();
        run.set_velocity(3, {0, 0.51}); // 0.051 m per step, 0.102 radii
        expect(run, 3, 3, "of its radius in one step");
    }
    {
        lacuna::simulation<plane> run(chain<2>(5, false), p);
        run.set_velocity(3, {0, 0.49});
        REQUIRE_NOTHROW(run.step());
    }
    {
        lacuna::simulation<plane> run(chain<2>(5), p);
        run.set_velocity(2, {nan_value, 0});
        expect(run, 0, 2, "not a number");
    }
    {
        // Only a spin: nothing touches the particle, so that no force and no velocity depends on it.
        lacuna::packing<double, 2> one;
        one.add({0, 0}, 0.5);
        lacuna::simulation<plane> run(one, p);
        run.set_spin(0, {nan_value});
        CHECK_THROWS_WITH(run.step(), contains_text("step 0") && contains_text("a velocity or spin is not a number"));
    }
    {
        lacuna::packing<double, 2> same;
        same.add({7, 7}, 0.5);
        same.add({1, 1}, 0.5);
        same.add({1, 1}, 0.5);
        CHECK_THROWS_WITH(lacuna::simulation<plane>(same, p),
                          contains_text("particles 1 and 2 are at the same position (1, 1)"));
    }
    {
        lacuna::packing<double, 2> two;
        two.add({0, 0}, 0.5);
        two.add({0.52, 0}, 0.5);
        two.add({9, 9}, 0.5);
        lacuna::simulation<plane> run(two, p);
        run.fix(0);
        run.fix(1);
        run.set_velocity(1, {-0.4, 0});
        try {
            run.run(2);
            FAIL("nothing was thrown");
        } catch (lacuna::unstable_run const& e) {
            CHECK((e.particle() == 0 || e.particle() == 1));
            CHECK_THAT(e.what(), contains_text("overlaps another particle by more than a radius"));
        }
    }
    {
        auto q = p;
        q.walls = {{{0, 0}, {0, 1}, q.materials[0].contact}};
        lacuna::packing<double, 2> one;
        one.add({0, 0.5}, 0.5);
        lacuna::simulation<plane> run(one, q);
        run.fix(0);
        run.set_velocity(0, {0, -0.4});
        expect(run, 13, 0, "beyond a wall"); // 0.5 - 13 * 0.04 < 0
    }
    {
        auto q = p;
        q.allow_unstable_step = true;
        q.time_step = 1.9;
        lacuna::simulation<plane> run(chain<2>(8), q);
        run.set_velocity(0, {1e-6, 0});
        CHECK_THROWS_AS(run.run(10000), lacuna::unstable_run);
    }
}

TEST_CASE("a run whose energy runs away is stopped", "[unstable]") {
    auto const outcome_of = [](auto const& play) {
        try {
            play();
        } catch (lacuna::unstable_run const& e) {
            CHECK(e.particle() >= 0);
            CHECK_THAT(e.what(), contains_text("step " + std::to_string(e.step())) &&
                                     contains_text("particle " + std::to_string(e.particle())));
            return std::string(e.what());
        }
        return std::string("nothing was thrown");
    };
    auto p = springs<plane>(1, 0, 0, unit_density(2));
    SECTION("seen from the speeds") {
        // A free pair of 1 kg each oscillates at sqrt(2 k / m); a step above its limit of sqrt(2) s makes the amplitude
        // grow.
        p.allow_unstable_step = true;
        p.time_step = 1.416;
        lacuna::simulation<plane> run(chain<2>(2), p);
        run.set_velocity(0, {1e-8, 0});
        REQUIRE_THAT(outcome_of([&] { run.run(10000); }), contains_text("grow fourfold") && contains_text("time step"));
    }
    SECTION("seen from the ledger: a law that makes energy") {
        auto q = springs<plane_of_pushers>(1, 0, 0, unit_density(2));
        q.time_step = 0.01;
        lacuna::simulation<plane_of_pushers> run(chain<2>(2, false), q);
        run.set_velocity(0, {1e-3, 0});
        auto const text = outcome_of([&] {
            for (int n = 0; n < 10000; ++n) run.step_with_energy();
        });
        REQUIRE_THAT(text, contains_text("energy runs away") && contains_text("have no source"));
    }
    SECTION("not below the limit, under loads and in impacts") {
        p.time_step = 0.5;
        p.gravity = {0, -1e-6};
        lacuna::simulation<plane> run(chain<2>(4), p);
        run.apply(0, {1e-4, 0}, 0, 300);
        run.set_velocity(3, {0, 1e-3});
        REQUIRE(outcome_of([&] { run.run(500); }) == "nothing was thrown");
    }
}
