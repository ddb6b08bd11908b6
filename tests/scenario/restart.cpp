// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "catch.hpp"
#include "key_table.hpp"
#include "scenario/program.hpp"

/// \file
/// Restart with a changed deck: allowed changes take effect, every other change is refused by its key.

using program::folder;
using program::table;

namespace {

std::string with(std::string text, std::string const& old, std::string const& replacement) {
    auto const at = text.find(old);
    if (at == std::string::npos || text.find(old, at + 1) != std::string::npos)
        throw std::invalid_argument(old + " is not there once");
    return text.replace(at, old.size(), replacement);
}

/// Runs `first`, then restarts from its checkpoint with `second`. \return the probes
table two_stages(std::string const& name, std::string const& first, std::string const& second) {
    folder const here(name);
    here.write("first.toml", first + "[output]\ndirectory = \"first\"\ncheckpoint_every = 1\n");
    here.write("second.toml", second + "[output]\ndirectory = \"second\"\n");
    auto ran = here.run("--quiet first.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    ran = here.run("--quiet --restart first/checkpoint.bin second.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    return table(here / "second/probes.csv");
}

} // namespace

TEST_CASE("ten times the load at a restart stretches the bond as its closed form says", "[restart][checkpoint]") {
    auto const deck = [](int steps, double force) {
        return R"(
[simulation]
time_step = 1e-3
steps = )" + std::to_string(steps) + R"(
[materials.m]
density = 1000.0
normal_stiffness = 1e6
shear_stiffness = 5e5
friction = 0.2
[particles]
position = [[0.0, 0.0], [1.0, 0.0]]
radius = 0.5
material = "m"
fix = [{ particles = [0], axes = "xyr" }]
[bonds]
pairs = [[0, 1]]
[[loads]]
particles = [1]
force = [)" + std::to_string(force) + R"(, 0.0]
[[probes]]
quantity = "bond.normal_force"
bond = 0
every = 50
)";
    };
    auto const t = two_stages("restart_load", deck(200, 1000), deck(400, 10000));
    auto const time = t.column("time"), force = t.column("bond.normal_force[0]");
    double const w = std::sqrt(1e6 / (1000 * std::numbers::pi * 0.25));
    // A mass on a spring; velocities are half a step behind the positions.
    auto const swing = [&](double since) { return since > 0 ? 1 - std::cos(w * (since - 0.5e-3)) : 0.0; };
    std::size_t later = 0;
    for (std::size_t k = 0; k < time.size(); ++k) {
        if (time[k] < 0.201) continue;
        ++later;
        REQUIRE_THAT(force[k], WithinAbs(1000 * swing(time[k]) + 9000 * swing(time[k] - 0.2), 30));
    }
    REQUIRE(later == 4);
}

namespace {

/// Two discs or spheres without contact; `loads` drive the first or both.
std::string free_bodies(int steps, std::string const& loads, bool space = false, bool single = false) {
    std::string const z = space ? ", 0.0" : "";
    return "[simulation]\ntime_step = 0.01\nsteps = " + std::to_string(steps) + (space ? "\ndimension = 3" : "") +
           (single ? "\nreal = \"float\"" : "") + "\ngravity = [0.0, -2.0" + z + R"(]
[materials.m]
density = 1000.0
normal_stiffness = 1.0
shear_stiffness = 1.0
friction = 0.0
[particles]
position = [[0.0, 0.0)" + z + "], [9.0, 0.0" + z + R"(]]
radius = 0.5
material = "m"
)" + loads + R"(
[[probes]]
quantity = "velocity.x"
particle = 0
[[probes]]
quantity = "velocity.y"
particle = 0
[[probes]]
quantity = "velocity.y"
particle = 1
)";
}

std::string load(std::string const& what, double ramp = 0, std::string const& particles = "particles = [0]\n") {
    return "[[loads]]\n" + particles + what + "\nramp_time = " + std::to_string(ramp) + "\n";
}

} // namespace

TEST_CASE("a force changed at a restart starts from the force that acts then", "[restart]") {
    double const disc = 1000 * std::numbers::pi * 0.25, sphere = 1000 * std::numbers::pi / 6;
    for (bool const space : {false, true})
        for (bool const single : {false, true}) {
            std::string const z = space ? ", 0.0]" : "]";
            std::string const a = load("force = [100.0, 0.0" + z, 1.0), b = load("force = [300.0, 0.0" + z, 0.2);
            std::string const name = std::string("restart_ramp") + (space ? "_space" : "") + (single ? "_float" : "");
            auto const run = [&](std::string const& first, std::string const& second) {
                return two_stages(name, free_bodies(50, first, space, single), free_bodies(100, second, space, single));
            };
            double const mass = space ? sphere : disc, within = single ? 1e-5 : 1e-12;
            // Forces at the beginning of each step of 0.01 s; 50 N at the restart.
            double first = 0, changed = 0, as_before = 0;
            for (int k = 0; k < 50; ++k) {
                first += k;
                changed += k < 20 ? 50 + 250 * k / 20.0 : 300;
                as_before += 50 + k;
            }
            REQUIRE_THAT(run(a, b).last("velocity.x[0]"), WithinRel(0.01 * (first + changed) / mass, within));
            REQUIRE_THAT(run(a, a).last("velocity.x[0]"), WithinRel(0.01 * (first + as_before) / mass, within));
            REQUIRE_THAT(run(a, "").last("velocity.x[0]"), WithinRel(0.01 * first / mass, within));
            REQUIRE_THAT(run("", b).last("velocity.x[0]"),
                         WithinRel(0.01 * (changed - 50 * 20 + 25 * 19) / mass, within));
        }
}

TEST_CASE("pressures, prescribed velocities, steps and probes changed at a restart take effect", "[restart]") {
    auto const run = [](std::string const& first, std::string const& second) {
        return two_stages("restart_other", free_bodies(50, first), free_bodies(100, second));
    };
    // Pressure on the top acts on pi r^2 of each disc: 1 Pa on a disc of 1000 kg/m^3 gives 1e-3 m/s^2.
    auto const pressed = run(load("pressure = 1000.0\narea = \"disc\"", 0, ""),
                             load("pressure = 3000.0\narea = \"disc\"\nside = \"bottom\"", 0, ""));
    REQUIRE_THAT(pressed.last("velocity.y[1]"), WithinRel(-2.0 + 0.5 * (-1.0 + 3.0), 1e-12));
    // From 0.5 m/s, half way up a ramp to 1 m/s, to 3 m/s within 0.2 s. Released, the disc keeps its velocity and
    // falls.
    std::string const slow = load("velocity = [1.0, 0.0]", 1.0), fast = load("velocity = [3.0, 0.0]", 0.2);
    REQUIRE_THAT(run(slow, fast).last("velocity.x[0]"), WithinRel(3.0, 1e-12));
    REQUIRE_THAT(run(slow, slow).last("velocity.x[0]"), WithinRel(0.995, 1e-12)); // mean over the last step
    auto const let_go = run(slow, "");
    REQUIRE_THAT(let_go.last("velocity.x[0]"), WithinRel(0.495, 1e-12));
    REQUIRE_THAT(let_go.last("velocity.y[0]"), WithinRel(-1.0, 1e-12));
    REQUIRE_THAT(run("", fast).last("velocity.x[0]"), WithinRel(3.0, 1e-12));
    auto const other = two_stages("restart_probes", free_bodies(50, ""),
                                  free_bodies(60, "[[probes]]\nquantity = \"energy.kinetic\"\n"));
    REQUIRE(other.heading.size() == 6);
    REQUIRE(other.column("step").back() == 60);
    REQUIRE_THAT(other.last("velocity.y[0]"), WithinRel(-1.2, 1e-12));
}

TEST_CASE("a third stage continues from the loads of the second, with the same bits as two stages",
          "[restart][checkpoint]") {
    folder const here("restart_thrice");
    std::string const before = load("force = [100.0, 0.0]", 1.0), after = load("force = [300.0, 5.0]", 0.8);
    std::string const every = "[output]\ncheckpoint_every = 10\ndirectory = ";
    here.write("a.toml", free_bodies(50, before) + every + "\"a\"\n");
    here.write("b.toml", free_bodies(80, after) + every + "\"b\"\n");
    here.write("c.toml", free_bodies(120, after) + every + "\"c\"\n");
    here.write("d.toml", free_bodies(120, after) + every + "\"d\"\n");
    REQUIRE(here.run("--quiet a.toml").status == 0);
    REQUIRE(here.run("--quiet --restart a/checkpoint.bin b.toml").status == 0);
    REQUIRE(here.run("--quiet --restart b/checkpoint.bin c.toml").status == 0);
    REQUIRE(here.run("--quiet --restart a/checkpoint.bin d.toml").status == 0);
    auto const c = table(here / "c/probes.csv"), d = table(here / "d/probes.csv");
    REQUIRE(c.rows.back() == d.rows.back());
}

namespace {

std::string const coupled = R"(
[simulation]
steps = 3
dimension = 2
real = "double"
mass = "disc"
contact_law = "frictional_spring"
bond_law = "brittle_spring"
integrator = "symplectic_euler"
time_step = 1e-6
allow_unstable_step = false
thickness = 1.5
gravity = [0.0, -1.0]
fluid_density = 10.0
damping = { local = 0.1, mass = 0.2, viscous = 0.3 }
[materials.a]
density = 1000.0
normal_stiffness = 1e6
shear_stiffness = 5e5
friction = 0.2
[materials.b]
density = 900.0
normal_stiffness = 8e5
shear_stiffness = 4e5
friction = 0.25
[particles]
position = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.875], [1.5, 0.875]]
radius = 0.5
material = ["a", "a", "b", "b"]
velocity = [[0.0, 0.0], [0.0, 0.01], [0.0, 0.0], [0.0, 0.0]]
spin = [0.0, 0.0, 0.125, 0.0]
fix = [{ particles = [0], axes = "xy" }]
[bonds]
pairs = [[0, 1], [1, 2]]
normal_stiffness = [2e6, 3e6]
shear_stiffness = 1.5e6
tensile_force = 1e8
shear_force = 9e7
[[walls]]
point = [0.0, -0.5]
normal = [0.0, 1.0]
normal_stiffness = 1.25e6
shear_stiffness = 6e5
friction = 0.3
[fluid]
bulk_modulus = 1e5
conductivity = 1e-3
aperture = { law = "contact_force", a0 = 1e-2, F0 = 1e4, gap_multiplier = 0.5 }
solver = "explicit"
time_step = "auto"
initial_pressure = 1.0
boundary = "drained"
boundary_pressure = 2.0
reservoirs = [{ near = [0.5, 0.25], pressure = 3.0 }]
sources = [{ pore = 1, flow = 1e-6 }]
merge_conductance = 1e9
mechanical_coupling = true
)";

std::string const bare = R"(
[simulation]
steps = 3
time_step = 1e-4
[fluid]
bulk_modulus = 1e6
conductivity = 1.0
[[fluid.network.pores]]
volume = 1.0
pressure = 8.0
[[fluid.network.pores]]
volume = 2.0
[[fluid.network.pores]]
volume = 3.0
[[fluid.network.throats]]
pores = [0, 1]
aperture = 0.01
length = 0.5
[[fluid.network.throats]]
pores = [1, 2]
aperture = 0.015
length = 0.25
)";

/// One key with another value, and the path that the refusal names.
struct change {
    std::string key, old, replacement, path;
};

void check_refused(std::string const& name, std::string const& deck, std::vector<change> const& changes,
                   std::set<std::string>& seen) {
    folder const here(name);
    here.write("case.toml", deck + "[output]\ncheckpoint_every = 3\n");
    here.write("list.csv", "position.x,position.y,radius,material\n0,0,0.5,a\n1,0,0.5,a\n");
    auto const ran = here.run("--quiet case.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    for (change const& c : changes) {
        here.write("other.toml", with(deck, c.old, c.replacement));
        auto const checked = here.run("--check --restart out/checkpoint.bin other.toml");
        INFO(c.key << ": " << checked.err);
        CHECK(checked.status == 2);
        CHECK(std::count(checked.err.begin(), checked.err.end(), '\n') == 1);
        CHECK_THAT(checked.err, contains_text("checkpoint out/checkpoint.bin: it was made with " + c.path + " = "));
        CHECK_THAT(checked.err, contains_text(", the deck says "));
        seen.insert(c.key);
    }
    here.write("other.toml", deck);
    CHECK(here.run("--check --restart out/checkpoint.bin other.toml").status == 0);
}

std::vector<change> const coupled_changes{
    {"simulation.real", "\"double\"", "\"float\"", "simulation.real"},
    {"simulation.mass", "mass = \"disc\"", "mass = \"sphere\"", "simulation.mass"},
    {"simulation.contact_law", "\"frictional_spring\"", "\"hertz_mindlin\"", "simulation.contact_law"},
    {"simulation.bond_law", "\"brittle_spring\"", "\"parallel_bond\"", "simulation.bond_law"},
    {"simulation.integrator", "\"symplectic_euler\"", "\"velocity_verlet\"", "simulation.integrator"},
    {"simulation.time_step", "time_step = 1e-6", "time_step = 2e-6", "simulation.time_step"},
    {"simulation.time_step", "time_step = 1e-6", "time_step = \"auto\"", "simulation.time_step"},
    {"simulation.allow_unstable_step", "step = false", "step = true", "simulation.allow_unstable_step"},
    {"simulation.thickness", "thickness = 1.5", "thickness = 1.0", "simulation.thickness"},
    {"simulation.gravity", "-1.0]\nfluid", "-9.81]\nfluid", "simulation.gravity[1]"},
    {"simulation.fluid_density", "fluid_density = 10.0", "fluid_density = 11.0", "simulation.fluid_density"},
    {"simulation.damping.local", "local = 0.1", "local = 0.2", "simulation.damping.local"},
    {"simulation.damping.mass", "mass = 0.2", "mass = 0.3", "simulation.damping.mass"},
    {"simulation.damping.viscous", "viscous = 0.3", "viscous = 0.4", "simulation.damping.viscous"},
    {"materials.*.density", "density = 900.0", "density = 901.0", "materials.b.density"},
    {"materials.*.normal_stiffness", "normal_stiffness = 8e5", "normal_stiffness = 9e5",
     "materials.b.normal_stiffness"},
    {"materials.*.shear_stiffness", "shear_stiffness = 4e5", "shear_stiffness = 3e5", "materials.b.shear_stiffness"},
    {"materials.*.friction", "friction = 0.25", "friction = 0.26", "materials.b.friction"},
    {"particles.position", "[1.5, 0.875]]", "[1.5, 0.876]]", "particles.position[3][1]"},
    {"particles.radius", "radius = 0.5", "radius = [0.5, 0.5, 0.49, 0.5]", "particles.radius[2]"},
    {"particles.material", "\"b\", \"b\"]", "\"b\", \"a\"]", "particles.material[3]"},
    {"particles.velocity", "[0.0, 0.01]", "[0.0, 0.02]", "particles.velocity[1][1]"},
    {"particles.spin", "0.125", "0.25", "particles.spin[2][0]"},
    {"particles.fix[].particles", "particles = [0], axes", "particles = [1], axes", "particles.fix of particle 0"},
    {"particles.fix[].axes", "\"xy\"", "\"xyr\"", "particles.fix of particle 0"},
    {"bonds.pairs", "[1, 2]]", "[1, 3]]", "bonds.pairs[1][1]"},
    {"bonds.normal_stiffness", "[2e6, 3e6]", "[2e6, 4e6]", "bonds.normal_stiffness[1]"},
    {"bonds.shear_stiffness", "1.5e6", "1.6e6", "bonds.shear_stiffness[0]"},
    {"bonds.tensile_force", "tensile_force = 1e8\n", "", "bonds.tensile_force[0]"},
    {"bonds.shear_force", "shear_force = 9e7", "shear_force = [9e7, 8e7]", "bonds.shear_force[1]"},
    {"walls[].point", "[0.0, -0.5]", "[0.0, -0.6]", "walls[0].point[1]"},
    {"walls[].normal", "normal = [0.0, 1.0]", "normal = [0.01, 1.0]", "walls[0].normal[0]"},
    {"walls[].normal_stiffness", "1.25e6", "1.3e6", "walls[0].normal_stiffness"},
    {"walls[].shear_stiffness", "shear_stiffness = 6e5", "shear_stiffness = 7e5", "walls[0].shear_stiffness"},
    {"walls[].friction", "friction = 0.3\n", "friction = 0.31\n", "walls[0].friction"},
    {"fluid.bulk_modulus", "bulk_modulus = 1e5", "bulk_modulus = 2e5", "fluid.bulk_modulus"},
    {"fluid.conductivity", "conductivity = 1e-3", "conductivity = 2e-3", "fluid.conductivity"},
    {"fluid.aperture.law", "{ law = \"contact_force\", a0 = 1e-2, F0 = 1e4, gap_multiplier = 0.5 }",
     "{ law = \"constant\", value = 1e-2 }", "fluid.aperture.law"},
    {"fluid.aperture.a0", "a0 = 1e-2", "a0 = 2e-2", "fluid.aperture.a0"},
    {"fluid.aperture.F0", "F0 = 1e4", "F0 = 2e4", "fluid.aperture.F0"},
    {"fluid.aperture.gap_multiplier", "gap_multiplier = 0.5", "gap_multiplier = 0.6", "fluid.aperture.gap_multiplier"},
    {"fluid.solver", "\"explicit\"", "\"implicit\"", "fluid.solver"},
    {"fluid.time_step", "time_step = \"auto\"", "time_step = 1e-6", "fluid.time_step"},
    {"fluid.initial_pressure", "initial_pressure = 1.0", "initial_pressure = 2.0", "fluid.initial_pressure"},
    {"fluid.boundary", "boundary = \"drained\"\nboundary_pressure = 2.0", "boundary = \"sealed\"", "fluid.boundary"},
    {"fluid.boundary_pressure", "boundary_pressure = 2.0", "boundary_pressure = 2.5", "fluid.boundary_pressure"},
    {"fluid.reservoirs[].near", "[0.5, 0.25]", "[0.5, 0.26]", "fluid.reservoirs[0].near[1]"},
    {"fluid.reservoirs[].pore", "near = [0.5, 0.25]", "pore = 0", "fluid.reservoirs[0].near"},
    {"fluid.reservoirs[].pressure", "pressure = 3.0", "pressure = 4.0", "fluid.reservoirs[0].pressure"},
    {"fluid.sources[].pore", "pore = 1,", "pore = 0,", "fluid.sources[0].pore"},
    {"fluid.sources[].near", "pore = 1,", "near = [1.0, 0.5],", "fluid.sources[0].near"},
    {"fluid.sources[].flow", "flow = 1e-6", "flow = 2e-6", "fluid.sources[0].flow"},
    {"fluid.merge_conductance", "merge_conductance = 1e9\n", "", "fluid.merge_conductance"},
    {"fluid.duration", "merge_conductance = 1e9\n", "merge_conductance = 1e9\nduration = 5.0\n", "fluid.duration"},
    {"fluid.minimum_pressure", "merge_conductance = 1e9\n", "merge_conductance = 1e9\nminimum_pressure = -5.0\n",
     "fluid.minimum_pressure"},
};

std::vector<change> const bare_changes{
    {"fluid.network.pores[].volume", "volume = 2.0", "volume = 2.5", "fluid.network.pores[1].volume"},
    {"fluid.network.pores[].pressure", "pressure = 8.0", "pressure = 9.0", "fluid.network.pores[0].pressure"},
    {"fluid.network.throats[].pores", "[1, 2]", "[0, 2]", "fluid.network.throats[1].pores[0]"},
    {"fluid.network.throats[].aperture", "aperture = 0.015", "aperture = 0.016", "fluid.network.throats[1].aperture"},
    {"fluid.network.throats[].length", "length = 0.25", "length = 0.3", "fluid.network.throats[1].length"},
    {"fluid.bulk_modulus", "1e6", "2e6", "fluid.bulk_modulus"},
};

/// Rigid particles, flow alone.
std::string const rigid = R"(
[simulation]
steps = 3
time_step = 1e-6
[materials.m]
density = 1000.0
normal_stiffness = 1e6
shear_stiffness = 5e5
friction = 0.2
[particles]
position = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.875]]
radius = 0.5
material = "m"
[fluid]
bulk_modulus = 1e5
conductivity = 1e-3
aperture = { law = "constant", value = 1e-2 }
mechanical_coupling = false
)";

/// Particles and bonds that a CSV file and a list of bonds can replace.
std::string const from_file = R"(
[simulation]
steps = 3
time_step = 1e-6
[materials.a]
density = 1000.0
normal_stiffness = 1e6
shear_stiffness = 5e5
friction = 0.2
[particles]
position = [[0.0, 0.0], [1.0, 0.0]]
radius = 0.5
material = "a"
velocity = [[0.0, 0.0], [0.0, 0.5]]
[bonds]
touching = true
gap = 1e-5
)";

} // namespace

TEST_CASE("each key changed at a restart is refused by its path, or may change", "[restart][refusal][checkpoint]") {
    std::set<std::string> seen;
    check_refused("restart_coupled", coupled, coupled_changes, seen);
    check_refused("restart_bare", bare, bare_changes, seen);
    // Keys that apply only with time_step = "auto" and strengths of materials.
    auto strong =
        with(with(coupled, "time_step = 1e-6\n", "safety = 0.2\n"), "tensile_force = 1e8\nshear_force = 9e7\n", "");
    strong = with(strong, "friction = 0.2\n", "friction = 0.2\ntensile_strength = 4e8\nshear_strength = 3e8\n");
    check_refused(
        "restart_strong", strong,
        {{"simulation.safety", "safety = 0.2", "safety = 0.3", "simulation.safety"},
         {"materials.*.tensile_strength", "tensile_strength = 4e8\n", "", "materials.a.tensile_strength"},
         {"materials.*.shear_strength", "shear_strength = 3e8", "shear_strength = 2e8", "materials.a.shear_strength"}},
        seen);
    std::string const rule = "rule = \"when_needed\", interval = 50, on_broken_bond = false";
    check_refused("restart_remeshing",
                  with(coupled, "sources = [{ pore = 1, flow = 1e-6 }]\n", "remeshing = { " + rule + " }\n"),
                  {{"fluid.remeshing.rule", rule, "rule = \"never\"", "fluid.remeshing.rule"},
                   {"fluid.remeshing.interval", "interval = 50", "interval = 60", "fluid.remeshing.interval"},
                   {"fluid.remeshing.on_broken_bond", "broken_bond = false", "broken_bond = true",
                    "fluid.remeshing.on_broken_bond"}},
                  seen);
    check_refused("restart_rigid", rigid,
                  {{"fluid.aperture.value", "value = 1e-2", "value = 2e-2", "fluid.aperture.value"},
                   {"fluid.mechanical_coupling", "coupling = false", "coupling = true", "fluid.mechanical_coupling"},
                   {"particles.position", "[0.5, 0.875]]", "[0.5, 0.875], [1.5, 0.875]]", "particles.position"},
                   {"particles.position", "0.875", "0.876", "particles.position[2][1]"}},
                  seen);
    auto hertz = with(with(coupled, "\"frictional_spring\"", "\"hertz_mindlin\""), "friction = 0.25",
                      "friction = 0.25\nyoung_modulus = 1e8\npoisson_ratio = 0.2");
    hertz = with(hertz, "friction = 0.3\n", "friction = 0.3\nyoung_modulus = 2e8\npoisson_ratio = 0.3\n");
    hertz =
        with(with(hertz, "\"brittle_spring\"", "\"parallel_bond\""), "shear_force = 9e7", "bending_stiffness = 7e5");
    check_refused(
        "restart_hertz", hertz,
        {{"materials.*.young_modulus", "young_modulus = 1e8", "young_modulus = 1.5e8", "materials.b.young_modulus"},
         {"materials.*.poisson_ratio", "poisson_ratio = 0.2", "poisson_ratio = 0.25", "materials.b.poisson_ratio"},
         {"walls[].young_modulus", "young_modulus = 2e8", "young_modulus = 1e9", "walls[0].young_modulus"},
         {"walls[].poisson_ratio", "poisson_ratio = 0.3", "poisson_ratio = 0.35", "walls[0].poisson_ratio"},
         {"bonds.bending_stiffness", "7e5", "8e5", "bonds.bending_stiffness[0]"}},
        seen);
    // Keys compared by their effect: a file, the gap of touching particles, the dimension.
    check_refused(
        "restart_file", from_file,
        {{"particles.file",
          "position = [[0.0, 0.0], [1.0, 0.0]]\nradius = 0.5\nmaterial = \"a\"\nvelocity = [[0.0, 0.0], [0.0, 0.5]]",
          "file = \"list.csv\"", "particles.velocity[1][1]"},
         {"bonds.touching", "touching = true\ngap = 1e-5", "pairs = []", "bonds.pairs"},
         {"simulation.dimension", "steps = 3\ntime_step = 1e-6\n", "steps = 3\ntime_step = 1e-6\nreal = \"float\"\n",
          "simulation.real"}},
        seen);
    seen.insert("bonds.gap");            // compared by the pairs, as touching
    seen.insert("simulation.dimension"); // every point changes with it
    for (auto const& row : lacuna_run::keys) {
        std::string const path = row.path;
        bool const group = row.what == lacuna_run::kind::table || row.what == lacuna_run::kind::tables ||
                           row.what == lacuna_run::kind::named;
        bool const may_change = path.rfind("loads[].", 0) == 0 || path.rfind("probes[].", 0) == 0 ||
                                path.rfind("output.", 0) == 0 || path == "simulation.steps" ||
                                path == "simulation.end_time" || path == "simulation.threads" ||
                                path.rfind("simulation.guards.", 0) == 0;
        INFO(path << ": a new key needs a line here");
        CHECK((group || may_change || seen.count(path) == 1));
    }
}

TEST_CASE("the same scenario written in another way continues", "[restart][checkpoint]") {
    folder const here("restart_same");
    here.write("case.toml", coupled + "[output]\ncheckpoint_every = 3\n");
    REQUIRE(here.run("--quiet case.toml").status == 0);
    auto other = with(coupled, "radius = 0.5", "radius = [0.5, 0.5, 0.5, 0.5]");
    other = with(other, "fix = [{ particles = [0], axes = \"xy\" }]",
                 "fix = [{ particles = [0], axes = \"y\" }, { particles = [0], axes = \"x\" }]");
    other = with(other, "steps = 3", "steps = 9\nthreads = 2\nguards = { motion_limit = 0.2 }");
    other = with(other, "shear_force = 9e7", "shear_force = [9e7, 9e7]");
    here.write("other.toml", other + "[output]\ndirectory = \"later\"\n");
    auto const ran = here.run("--quiet --restart out/checkpoint.bin other.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    REQUIRE(nlohmann::json::parse(program::read_file(here / "later/summary.json")).at("steps") == 9);
}
