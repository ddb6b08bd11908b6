// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "reference.hpp"
#include "scenario/program.hpp"

#include "scenario.hpp"

/// \file
/// The files of examples/scenario/cases against tests/reference/cases.json.

using program::folder;
using program::table;

namespace {

table probes_of(std::string const& name, int status = 0) {
    folder const here(name);
    auto const ran = here.run_case(name);
    INFO(ran.err);
    REQUIRE(ran.status == status);
    return table(here / "out/probes.csv");
}

/// How long the pair pushes. It begins to within the step before the first row with a force, and ends within the one after
/// the last: half a step more at the end, by a first row at which it touches without a force a whole one at the beginning.
double contact_time(table const& t) {
    auto const time = t.column("time"), force = t.column("contact.normal_force[0-1]");
    double first = -1, last = -1;
    for (std::size_t k = 0; k < force.size(); ++k)
        if (force[k] < 0) {
            if (first < 0) first = time[k];
            last = time[k];
        }
    return last - first + 1.5 * time.at(1);
}

double restitution(table const& t) {
    auto const v0 = t.column("velocity.x[0]"), v1 = t.column("velocity.x[1]");
    return -(v1.back() - v0.back()) / (v1.front() - v0.front());
}

} // namespace

TEST_CASE("collision of two discs (1a)", "[cases][reference]") {
    for (std::string const name : {"collision", "collision_verlet"}) {
        auto const t = probes_of(name);
        double const dt = t.column("time").at(1);
        REQUIRE_THAT(contact_time(t), WithinAbs(reference("1a.t_c"), dt));
        auto const x0 = t.column("position.x[0]"), x1 = t.column("position.x[1]");
        double deepest = 0;
        for (std::size_t k = 0; k < x0.size(); ++k) deepest = std::max(deepest, 1 - (x1[k] - x0[k]));
        REQUIRE_THAT(deepest, WithinRel(reference("1a.delta_max"), 1e-4));
        auto const force = t.column("contact.normal_force[0-1]");
        REQUIRE_THAT(-*std::min_element(force.begin(), force.end()), WithinRel(reference("1a.F_max"), 1e-4));
        REQUIRE_THAT(restitution(t), WithinAbs(reference("1a.e"), 1e-3));
    }
}

TEST_CASE("collision of unequal discs (1a)", "[cases][reference]") {
    auto const t = probes_of("collision_unequal");
    REQUIRE_THAT(t.last("velocity.x[0]"), WithinRel(reference("1a.e_unequal", "v1_after"), 1e-3));
    REQUIRE_THAT(t.last("velocity.x[1]"), WithinRel(reference("1a.e_unequal", "v2_after"), 1e-3));
    REQUIRE_THAT(contact_time(t), WithinAbs(reference("1a.e_unequal", "t_c"), t.column("time").at(1)));
}

TEST_CASE("damped collisions (1b)", "[cases][reference]") {
    for (auto const& [name, id] : {std::pair{"collision_damped_0_1", "1b.zeta=0.1"}, {"collision_damped_0_3", "1b.zeta=0.3"}}) {
        auto const t = probes_of(name);
        REQUIRE_THAT(restitution(t), WithinRel(reference(id, "e_end_at_zero_force"), 1e-3));
        REQUIRE_THAT(contact_time(t), WithinRel(reference(id, "t_zero_force"), 1e-3));
    }
}

TEST_CASE("oblique impact on a wall (1d)", "[cases][reference]") {
    std::string const id = "1d.oblique_mu0.3_ks=kn_disc";
    for (auto const& [name, key] : {std::pair{"oblique_sticking", "vt/vn=0.5"}, {"oblique_sliding", "vt/vn=3"}}) {
        auto const t = probes_of(name);
        REQUIRE(t.last("wall.force.y[0]") == 0);
        REQUIRE_THAT(t.last("velocity.x[0]") / 0.01, WithinRel(reference(id, key, "vt_after/vn"), 2e-3));
        // A force along +s on the particle slows it and turns it clockwise.
        REQUIRE_THAT(std::fabs(t.last("spin[0]")) * 0.5 / 0.01, WithinRel(reference(id, key, "omegaR_after/vn"), 2e-3));
    }
}

TEST_CASE("a chain below and above its critical time step (2a)", "[cases][reference]") {
    double const critical = reference("2a.dt_crit_fixed_fixed_N10");
    auto const step_of = [](std::string const& name) {
        return lacuna_run::read_scenario_file(std::string(LACUNA_RUN_CASES) + "/" + name + ".toml").simulation.time_step;
    };
    REQUIRE_THAT(step_of("chain_stable"), WithinRel(0.999 * critical, 1e-12));
    REQUIRE_THAT(step_of("chain_unstable"), WithinRel(1.001 * critical, 1e-12));
    auto const t = probes_of("chain_stable");
    auto const x = t.column("position.x[5]");
    REQUIRE(*std::max_element(x.begin(), x.end()) < 5 + 1e-3);
    folder const here("chain_unstable");
    auto const ran = here.run_case("chain_unstable");
    REQUIRE(ran.status == 3);
    REQUIRE_THAT(ran.err, contains_text("unstable run at step"));
    REQUIRE(here.files() == std::vector<std::string>{"out/events.csv", "out/probes.csv", "out/summary.json"});
    auto const summary = nlohmann::json::parse(program::read_file(here / "out/summary.json"));
    REQUIRE(summary.at("ended") == "unstable");
    REQUIRE(table(here / "out/probes.csv").column("position.x[5]").size() == summary.at("steps").get<std::size_t>() + 1);
}

TEST_CASE("chains and beams (4b, 4c, 4d)", "[cases][reference]") {
    REQUIRE_THAT(probes_of("chain_locked").last("position.y[10]") / 1e-6,
                 WithinRel(reference("4b.rotations_locked", "N=10 tip deflection"), 1e-6));
    REQUIRE_THAT(probes_of("rope").last("position.y[10]"), WithinRel(reference("4c.tension_rope", "tip"), 1e-3));
    auto const t = probes_of("beam");
    REQUIRE_THAT(t.last("position.y[5]") / 1e-9, WithinRel(reference("4d.with_bending_spring", "5", "tip"), 1e-6));
    REQUIRE_THAT(t.last("rotation[5]") / 1e-9, WithinRel(reference("4d.with_bending_spring", "5", "tip_rotation"), 1e-6));
}

TEST_CASE("pores in a line (5a)", "[cases][reference]") {
    auto const pressures = [](table const& t, std::size_t row) {
        std::vector<double> p;
        for (int k = 0; k < 10; ++k) p.push_back(t.column("pore.pressure[" + std::to_string(k) + "]").at(row));
        return p;
    };
    auto const compare = [](std::vector<double> const& p, std::string const& id, double tolerance) {
        auto const expected = reference_list(id);
        INFO(id);
        // The error of forward Euler is first order in the step and relative to the pulse, not to what is left of it.
        for (std::size_t k = 0; k < p.size(); ++k) REQUIRE_THAT(p[k], WithinAbs(expected.at(k), tolerance));
    };
    auto const steps = pressures(probes_of("pulse_steps"), 1);
    auto const exact = reference_list("5a.sealed_pulse_FE_dt0.25_n20");
    for (std::size_t k = 0; k < steps.size(); ++k) REQUIRE_THAT(steps[k], WithinRel(exact.at(k), 1e-11));
    auto const pulse = probes_of("pulse");
    compare(pressures(pulse, 1), "5a.sealed_pulse_t=1", 5e-4);
    compare(pressures(pulse, 5), "5a.sealed_pulse_t=5", 1e-4);
    auto const implicit = probes_of("pulse_implicit");
    compare(pressures(implicit, 5), "5a.sealed_pulse_t=5", 1e-4);
    compare(pressures(probes_of("drained_line"), 1), "5a.drained_right_t=20", 1e-4);
}

TEST_CASE("slow fracture (8a, 8c)", "[cases][reference]") {
    folder const pull("pull");
    REQUIRE(pull.run_case("pull").status == 0);
    table const events(pull / "out/events.csv");
    REQUIRE(events.rows.size() >= 1);
    double const stretch = 1e-7 * std::stod(events.rows[0].at(1)) / 1e-3; // in units of force over stiffness
    REQUIRE_THAT(stretch, WithinRel(reference("8a.quasistatic", "u_c"), 1e-3));
    REQUIRE(events.rows[0].at(5) == "tension");

    folder const shear("shear_break");
    REQUIRE(shear.run_case("shear_break").status == 0);
    table const breaks(shear / "out/events.csv");
    REQUIRE(breaks.rows.size() == 1);
    REQUIRE(breaks.rows[0].at(5) == "shear");
    // u_s in units of force over stiffness, 1e-3 m; one step is 1e-9 m.
    REQUIRE_THAT(1e-6 * std::stod(breaks.rows[0].at(1)) / 1e-3, WithinAbs(reference("8c.shear_break", "u_s"), 2e-6));
}

TEST_CASE("pores between discs (9a, 9e)", "[cases][reference]") {
    auto const t = probes_of("hexagon");
    REQUIRE_THAT(t.column("pore.volume[0.5;0.2]").front(), WithinRel(0.25 * reference("9a.three_equal", "area/R^2"), 1e-12));
    double const rim = reference("9e.uniform_pressure", "rim_disc_outward_force/(pR)") * 3.0 * 0.5;
    REQUIRE_THAT(t.last("force.x[0]"), WithinAbs(reference("9e.uniform_pressure", "interior_net_force"), 1e-12));
    REQUIRE_THAT(t.last("force.y[0]"), WithinAbs(reference("9e.uniform_pressure", "interior_net_force"), 1e-12));
    REQUIRE_THAT(t.last("force.x[1]"), WithinRel(rim, 1e-9));
    REQUIRE_THAT(t.last("force.y[1]"), WithinAbs(0, 1e-9));
    REQUIRE_THAT(t.last("force.x[2]"), WithinRel(0.5 * rim, 1e-9));
    REQUIRE_THAT(t.last("force.y[2]"), WithinRel(std::sqrt(0.75) * rim, 1e-9));
}
