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

/// Duration of a contact, s. The contact begins one step before the first row with a force, because the discs start in
/// touch without a force. It ends within the step after the last such row: half a step on average.
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
    for (auto const& [name, id] :
         {std::pair{"collision_damped_0_1", "1b.zeta=0.1"}, {"collision_damped_0_3", "1b.zeta=0.3"}}) {
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
        // A force along +s slows the particle and rotates it clockwise.
        REQUIRE_THAT(std::fabs(t.last("spin[0]")) * 0.5 / 0.01, WithinRel(reference(id, key, "omegaR_after/vn"), 2e-3));
    }
}

TEST_CASE("a chain below and above its critical time step (2a)", "[cases][reference]") {
    double const critical = reference("2a.dt_crit_fixed_fixed_N10");
    auto const step_of = [](std::string const& name) {
        return lacuna_run::read_scenario_file(std::string(LACUNA_RUN_CASES) + "/" + name + ".toml")
            .simulation.time_step;
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
    REQUIRE(table(here / "out/probes.csv").column("position.x[5]").size() ==
            summary.at("steps").get<std::size_t>() + 1);
}

TEST_CASE("chains and beams (4b, 4c, 4d)", "[cases][reference]") {
    REQUIRE_THAT(probes_of("chain_locked").last("position.y[10]") / 1e-6,
                 WithinRel(reference("4b.rotations_locked", "N=10 tip deflection"), 1e-6));
    REQUIRE_THAT(probes_of("rope").last("position.y[10]"), WithinRel(reference("4c.tension_rope", "tip"), 1e-3));
    auto const t = probes_of("beam");
    REQUIRE_THAT(t.last("position.y[5]") / 1e-9, WithinRel(reference("4d.with_bending_spring", "5", "tip"), 1e-6));
    REQUIRE_THAT(t.last("rotation[5]") / 1e-9,
                 WithinRel(reference("4d.with_bending_spring", "5", "tip_rotation"), 1e-6));
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
        // The error of forward Euler is of first order in the step and relative to the initial pulse.
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
    REQUIRE_THAT(t.column("pore.volume[0.5;0.2]").front(),
                 WithinRel(0.25 * reference("9a.three_equal", "area/R^2"), 1e-12));
    double const rim = reference("9e.uniform_pressure", "rim_disc_outward_force/(pR)") * 3.0 * 0.5;
    REQUIRE_THAT(t.last("force.x[0]"), WithinAbs(reference("9e.uniform_pressure", "interior_net_force"), 1e-12));
    REQUIRE_THAT(t.last("force.y[0]"), WithinAbs(reference("9e.uniform_pressure", "interior_net_force"), 1e-12));
    REQUIRE_THAT(t.last("force.x[1]"), WithinRel(rim, 1e-9));
    REQUIRE_THAT(t.last("force.y[1]"), WithinAbs(0, 1e-9));
    REQUIRE_THAT(t.last("force.x[2]"), WithinRel(0.5 * rim, 1e-9));
    REQUIRE_THAT(t.last("force.y[2]"), WithinRel(std::sqrt(0.75) * rim, 1e-9));
}

namespace {

/// A wet triangle of bonded discs, and a fourth disc that leaves it at 2 m/s. `fluid_keys` decide whether the water
/// tears.
std::string flyer(std::string const& fluid_keys, std::string const& settings = "end_time = 1.0") {
    return "[simulation]\n" + settings + R"(
[materials.m]
density = 1000.0
normal_stiffness = 1e6
shear_stiffness = 5e5
friction = 0.5
[particles]
position = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.8660254037844386], [1.5, 0.8660254037844386]]
radius = 0.5
material = "m"
velocity = [[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [2.0, 0.5]]
[bonds]
pairs = [[0, 1], [1, 2], [0, 2]]
[fluid]
bulk_modulus = 1e6
conductivity = 1e-9
aperture = { law = "constant", value = 1e-4 }
)" + fluid_keys + R"(
[[probes]]
quantity = "velocity.x"
particle = 3
[[probes]]
quantity = "position.x"
particle = 3
[[probes]]
quantity = "energy.residual"
[[probes]]
quantity = "energy.kinetic"
[[probes]]
quantity = "pore.pressure"
near = [1.0, 0.5]
)";
}

table run_flyer(std::string const& name, std::string const& text) {
    folder const here(name);
    here.write("case.toml", text);
    auto const ran = here.run("--quiet case.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    return table(here / "out/probes.csv");
}

} // namespace

TEST_CASE("a disc leaves the water freely if the water tears", "[cases]") {
    // Water without tension, at zero pressure from the start: nothing pulls the disc back.
    auto const free = run_flyer("flyer_torn", flyer("minimum_pressure = 0.0"));
    REQUIRE_THAT(free.last("velocity.x[3]"), WithinRel(2.0, 1e-12));
    REQUIRE_THAT(free.last("position.x[3]"), WithinRel(1.5 + 2.0 * free.last("time"), 1e-9));
    REQUIRE(free.last("pore.pressure[1;0.5]") == 0);
    // 1000 Pa push the disc for at most one step, because the pore then grows by far more than p / K: m dv <= p l dt, l
    // <= 1 m.
    auto const pushed = run_flyer("flyer_pushed", flyer("minimum_pressure = 0.0\ninitial_pressure = 1000.0"));
    auto const speeds = pushed.column("velocity.x[3]");
    double const mass = 1000 * 3.14159265358979323846 * 0.25;
    REQUIRE(std::fabs(speeds.back() - 2) < 1000 * 1.0 * pushed.column("time").at(1) / mass);
    REQUIRE(speeds.back() == speeds.at(2));
    // A fluid that never tears holds the disc back.
    auto const held = run_flyer("flyer_held", flyer(""));
    REQUIRE(held.last("velocity.x[3]") < 1.5);
}

TEST_CASE("pores are rebuilt if the scenario asks for it, also after a restart", "[cases][checkpoint]") {
    std::string const keys = "remeshing = { rule = \"when_needed\", interval = 10 }\nminimum_pressure = 0.0";
    std::string const text = flyer(keys, "steps = 4000\ntime_step = 2e-4") + "[output]\ncheckpoint_every = 2000\n";
    folder const whole("remeshed"), half("remeshed_half");
    whole.write("case.toml", text);
    auto const ran = whole.run("--quiet case.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    auto first = text;
    first.replace(first.find("steps = 4000"), 12, "steps = 2000");
    half.write("first.toml", first);
    half.write("case.toml", text);
    REQUIRE(half.run("--quiet first.toml").status == 0);
    program::fs::copy_file(half / "out/checkpoint.bin", half / "kept.bin");
    auto const resumed = half.run("--quiet --restart kept.bin case.toml");
    INFO(resumed.err);
    REQUIRE(resumed.status == 0);
    REQUIRE(program::read_file(whole / "out/summary.json") == program::read_file(half / "out/summary.json"));
    auto const t = table(whole / "out/probes.csv");
    REQUIRE_THAT(t.last("velocity.x[3]"), WithinRel(2.0, 1e-12));
    REQUIRE_THAT(t.last("energy.residual"), WithinAbs(0, 1e-9 * t.last("energy.kinetic")));
}

TEST_CASE("a pressure on a row acts on the length that the row covers", "[cases]") {
    // Ten discs of 1 mm side by side on a floor, 1 m thick: 1e6 Pa x 0.02 m x 1 m; on their faces 10 pi r^2 x 1e6 Pa.
    std::string const text = R"([simulation]
steps = 60000
damping = { local = 0.3, viscous = 0.3 }
[materials.m]
density = 2500.0
normal_stiffness = 1e8
shear_stiffness = 0.0
friction = 0.0
[particles]
position = [[0.001, 0.001], [0.003, 0.001], [0.005, 0.001], [0.007, 0.001], [0.009, 0.001],
            [0.011, 0.001], [0.013, 0.001], [0.015, 0.001], [0.017, 0.001], [0.019, 0.001]]
radius = 0.001
material = "m"
[[walls]]
point = [0.0, 0.0]
normal = [0.0, 1.0]
normal_stiffness = 1e8
shear_stiffness = 0.0
friction = 0.0
[[probes]]
quantity = "wall.force.y"
wall = 0
every = 60000
[[loads]]
pressure = 1e6
)";
    for (auto const& [area, force] : {std::pair<std::string, double>{"", 20000.0},
                                      {"area = \"strip\"\n", 20000.0},
                                      {"area = \"disc\"\n", 10 * 3.14159265358979323846}}) {
        auto const t = run_flyer("pressure", text + area);
        REQUIRE_THAT(t.last("wall.force.y[0]"), WithinRel(-force, 1e-6));
    }
}
