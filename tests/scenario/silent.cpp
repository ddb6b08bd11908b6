// SPDX-License-Identifier: BSD-3-Clause

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "scenario/program.hpp"
#include "scenario/tree.hpp"

#include "key_table.hpp"

/// \file
/// No key is ignored silently. In a run of each kind every key of the table is added or changed alone. Then some byte
/// of the results must differ, or the scenario must be refused by the path of a key.

using namespace lacuna_run;

namespace {

using settings = std::vector<std::pair<char const*, char const*>>;

/// Two allowed values for each key; the one that the deck does not have is tried.
std::map<std::string_view, std::pair<char const*, char const*>> const values{
    {"simulation.dimension", {"3", "2"}},
    {"simulation.real", {"\"float\"", "\"double\""}},
    {"simulation.thickness", {"2.0", "3.0"}},
    {"simulation.mass", {"\"sphere\"", "\"disc\""}},
    {"simulation.contact_law", {"\"none\"", "\"hertz_mindlin\""}},
    {"simulation.bond_law", {"\"parallel_bond\"", "\"brittle_spring\""}},
    {"simulation.integrator", {"\"velocity_verlet\"", "\"symplectic_euler\""}},
    {"simulation.time_step", {"1e-5", "2e-5"}},
    {"simulation.safety", {"0.3", "0.1"}},
    {"simulation.steps", {"7", "8"}},
    {"simulation.end_time", {"1e-3", "2e-3"}},
    {"simulation.gravity", {"[0.0, -9.0]", "[0.0, -3.0]"}},
    {"simulation.fluid_density", {"100.0", "200.0"}},
    {"simulation.damping.local", {"0.25", "0.5"}},
    {"simulation.damping.mass", {"0.25", "0.5"}},
    {"simulation.damping.viscous", {"0.25", "0.5"}},
    {"materials.*.density", {"1100.0", "1200.0"}},
    {"materials.*.normal_stiffness", {"1.1e6", "1.2e6"}},
    {"materials.*.shear_stiffness", {"4e5", "6e5"}},
    {"materials.*.friction", {"1e-4", "2e-4"}},
    {"materials.*.tensile_strength", {"0.0", "1e9"}},
    {"materials.*.shear_strength", {"0.0", "1e9"}},
    {"materials.*.young_modulus", {"1.1e7", "1.2e7"}},
    {"materials.*.poisson_ratio", {"0.1", "0.2"}},
    {"particles.position", {"", ""}},
    {"particles.radius", {"0.51", "0.52"}},
    {"particles.material", {"\"matrix\"", "\"matrx\""}},
    {"particles.velocity", {"", ""}},
    {"particles.spin", {"", ""}},
    {"particles.fix[].particles", {"[1]", "[2]"}},
    {"particles.fix[].axes", {"\"x\"", "\"y\""}},
    {"particles.file", {"\"x.csv\"", "\"y.csv\""}},
    {"bonds.pairs", {"[[0, 1], [1, 2]]", "[[0, 1]]"}},
    {"bonds.touching", {"true", "false"}},
    {"bonds.gap", {"0.01", "0.5"}},
    {"bonds.normal_stiffness", {"2e6", "3e6"}},
    {"bonds.shear_stiffness", {"2e5", "3e5"}},
    {"bonds.bending_stiffness", {"2e4", "3e4"}},
    {"bonds.tensile_force", {"0.0", "1e9"}},
    {"bonds.shear_force", {"0.0", "1e9"}},
    {"walls[].point", {"[0.0, -0.49]", "[0.0, -0.48]"}},
    {"walls[].normal", {"[0.1, 1.0]", "[0.2, 1.0]"}},
    {"walls[].normal_stiffness", {"1.1e6", "1.2e6"}},
    {"walls[].shear_stiffness", {"4e5", "6e5"}},
    {"walls[].friction", {"1e-4", "2e-4"}},
    {"walls[].young_modulus", {"1.1e7", "1.2e7"}},
    {"walls[].poisson_ratio", {"0.1", "0.2"}},
    {"loads[].particles", {"[2]", "[0]"}},
    {"loads[].force", {"[20.0, 0.0]", "[30.0, 0.0]"}},
    {"loads[].torque", {"2.0", "3.0"}},
    {"loads[].velocity", {"[0.1, 0.0]", "[0.2, 0.0]"}},
    {"loads[].pressure", {"10.0", "20.0"}},
    {"loads[].area", {"\"disc\"", "\"strip\""}},
    {"loads[].side", {"\"left\"", "\"top\""}},
    {"loads[].margin_diameters", {"0.25", "0.5"}},
    {"loads[].ramp_time", {"1.0", "2.0"}},
    {"fluid.bulk_modulus", {"1e5", "2e5"}},
    {"fluid.conductivity", {"1e-2", "2e-2"}},
    {"fluid.aperture.law", {"\"constant\"", "\"contact_force\""}},
    {"fluid.aperture.a0", {"0.02", "0.03"}},
    {"fluid.aperture.F0", {"2e3", "3e3"}},
    {"fluid.aperture.gap_multiplier", {"0.5", "0.25"}},
    {"fluid.aperture.value", {"0.02", "0.03"}},
    {"fluid.solver", {"\"implicit\"", "\"explicit\""}},
    {"fluid.time_step", {"1e-6", "2e-6"}},
    {"fluid.initial_pressure", {"5.0", "6.0"}},
    {"fluid.boundary", {"\"drained\"", "\"sealed\""}},
    {"fluid.boundary_pressure", {"5.0", "6.0"}},
    {"fluid.reservoirs[].near", {"[0.5, 0.3]", "[1.0, 0.6]"}},
    {"fluid.reservoirs[].pore", {"0", "1"}},
    {"fluid.reservoirs[].pressure", {"5.0", "6.0"}},
    {"fluid.sources[].near", {"[0.5, 0.3]", "[1.0, 0.6]"}},
    {"fluid.sources[].pore", {"0", "1"}},
    {"fluid.sources[].flow", {"1e-3", "2e-3"}},
    {"fluid.minimum_pressure", {"0.0", "-1.0"}},
    {"fluid.remeshing.rule", {"\"when_needed\"", "\"never\""}},
    {"fluid.remeshing.interval", {"10", "20"}},
    {"fluid.remeshing.on_broken_bond", {"true", "false"}},
    {"fluid.duration", {"1e-30", "2e-30"}},
    {"fluid.merge_conductance", {"1e-15", "2e-15"}},
    {"fluid.mechanical_coupling", {"false", "true"}},
    {"fluid.network.pores", {"[ { volume = 2.0 } ]", "[ { volume = 3.0 } ]"}},
    {"fluid.network.pores[].volume", {"2.0", "3.0"}},
    {"fluid.network.pores[].pressure", {"2.0", "3.0"}},
    {"fluid.network.throats", {"[]", "[]"}},
    {"fluid.network.throats[].pores", {"[0, 2]", "[0, 1]"}},
    {"fluid.network.throats[].aperture", {"0.2", "0.3"}},
    {"fluid.network.throats[].length", {"2.0", "3.0"}},
    {"probes[].quantity", {"\"energy.strain\"", "\"energy.fluid\""}},
    {"probes[].particle", {"0", "1"}},
    {"probes[].bond", {"0", "1"}},
    {"probes[].pair", {"[0, 1]", "[0, 2]"}},
    {"probes[].pore", {"0", "1"}},
    {"probes[].near", {"[0.5, 0.3]", "[1.0, 0.6]"}},
    {"probes[].throat", {"0", "1"}},
    {"probes[].wall", {"0", "1"}},
    {"probes[].every", {"2", "3"}},
    {"output.directory", {"\"elsewhere\"", "\"out\""}},
    {"output.vtk_every", {"5", "10"}},
    {"output.picture_every", {"5", "10"}},
    {"output.checkpoint_every", {"5", "10"}},
};

/// Keys that change no byte of a healthy run: results do not depend on the number of threads, a step that may be
/// unstable can be stable, a fluid that is not pulled does not tear, a mesh that fits stays, and guards do not act.
bool is_exempt(std::string_view path) {
    for (std::string_view const one :
         {"simulation.threads", "simulation.allow_unstable_step", "fluid.minimum_pressure"})
        if (path == one) return true;
    return path.substr(0, 16) == "fluid.remeshing." || path.substr(0, 18) == "simulation.guards.";
}

settings const dry{
    {"simulation.steps", "20"},
    {"materials.*.density", "1000.0"},
    {"materials.*.normal_stiffness", "1e6"},
    {"materials.*.shear_stiffness", "5e5"},
    {"materials.*.friction", "1e-3"},
    {"particles.position", "[[0.0, 0.0], [0.99, 0.0], [0.5, 0.85]]"},
    {"particles.radius", "0.5"},
    {"particles.material", "\"matrix\""},
    {"particles.velocity", "[[0.0, 0.0], [0.0, 0.0], [0.3, -0.5]]"},
    {"particles.spin", "[0.0, 0.0, 0.3]"},
    {"loads[].particles", "[1]"},
    {"loads[].force", "[10.0, 5.0]"},
    {"output.vtk_every", "20"},
    {"probes[].quantity", "\"velocity.x\""},
    {"probes[].particle", "2"},
};
settings const wall{
    {"walls[].point", "[0.0, -0.495]"},
    {"walls[].normal", "[0.0, 1.0]"},
    {"walls[].normal_stiffness", "1e6"},
    {"walls[].shear_stiffness", "5e5"},
    {"walls[].friction", "1e-3"},
};
settings const bonds{
    {"bonds.pairs", "[[0, 1]]"}, {"materials.*.tensile_strength", "1e5"}, {"materials.*.shear_strength", "1e5"}};
settings const water{
    {"fluid.bulk_modulus", "1e4"},
    {"fluid.conductivity", "1.0"},
    {"fluid.aperture.law", "\"contact_force\""},
    {"fluid.aperture.a0", "0.01"},
    {"fluid.aperture.F0", "1e3"},
    {"fluid.initial_pressure", "3.0"},
    {"fluid.boundary", "\"drained\""},
    {"particles.position", "[[0.0, 0.0], [0.99, 0.0], [0.5, 0.85], [1.6, 0.85]]"},
    {"particles.velocity", "[[0.0, 0.0], [0.0, 0.0], [0.3, -0.5], [0.0, 0.0]]"},
    {"particles.spin", "[0.0, 0.0, 0.3, 0.0]"},
};
/// A deck of flow alone.
settings const rigid{
    {"simulation.steps", "20"},
    {"particles.position", "[[0.0, 0.0], [1.1, 0.0], [0.5, 0.95], [1.6, 0.95], [2.2, 0.0]]"},
    {"particles.radius", "0.5"},
    {"fluid.bulk_modulus", "1e4"},
    {"fluid.conductivity", "1e-3"},
    {"fluid.aperture.law", "\"contact_force\""},
    {"fluid.aperture.a0", "0.01"},
    {"fluid.initial_pressure", "3.0"},
    {"fluid.boundary", "\"drained\""},
    {"fluid.mechanical_coupling", "false"},
    {"fluid.sources[].near", "[0.5, 0.3]"},
    {"fluid.sources[].flow", "1.0"},
    {"probes[].quantity", "\"pore.pressure\""},
    {"probes[].near", "[0.5, 0.3]"},
};
settings const network{
    {"simulation.steps", "20"},
    {"fluid.bulk_modulus", "1e4"},
    {"fluid.conductivity", "1e-3"},
    {"fluid.network.pores[].volume", "1.0"},
    {"fluid.network.pores[].pressure", "1.0"},
    {"fluid.network.throats[].pores", "[0, 1]"},
    {"fluid.network.throats[].aperture", "0.1"},
    {"fluid.network.throats[].length", "1.0"},
    {"probes[].quantity", "\"pore.pressure\""},
    {"probes[].pore", "0"},
};

tree deck_of(std::vector<settings> const& parts) {
    tree deck;
    for (settings const& part : parts)
        for (auto const& [path, value] : part)
            deck.set(path, value);
    return deck;
}

struct outcome {
    int status = 0;
    std::string message, files;
};

outcome outcome_of(program::folder const& here, tree const& deck) {
    std::string const text = deck.text();
    here.clear();
    here.write("case.toml", text);
    auto const ran = here.run("--quiet case.toml");
    outcome o{ran.status, ran.err, {}};
    for (std::string const& name : here.files())
        if (name != "case.toml" && name != "out/checkpoint.bin")
            o.files += name + "\n" + program::read_file(here / name);
        else if (name != "case.toml") o.files += name + "\n";
    return o;
}

/// Whether a refusal begins with the path of a key.
bool names_a_key(std::string const& message) {
    for (char const* section : sections)
        if (message.rfind(section, 0) == 0) return true;
    return message.rfind("the pore of probe", 0) == 0;
}

void try_all_keys(std::string const& name, tree const& deck) {
    program::folder const here("silent_" + name);
    outcome const before = outcome_of(here, deck);
    INFO(deck.text());
    INFO(before.message);
    REQUIRE(before.status == 0);
    std::string silent;
    for (key const& row : keys) {
        if (row.what == kind::table || row.what == kind::named || (row.what == kind::tables && !values.count(row.path)))
            continue;
        if (is_exempt(row.path)) continue;
        // A material may have values that this run does not use.
        std::string_view const path = row.path;
        {
            bool soft = false;
            for (condition const& c : conditions) soft = soft || ((row.where & c.what) != 0 && *c.otherwise == '\0');
            if (soft && !deck.find(row.path)) continue;
            if (soft && deck.find("materials.*.young_modulus") != nullptr && path.find("stiffness") != path.npos)
                continue;
        }
        auto const found = values.find(row.path);
        INFO(row.path);
        REQUIRE(found != values.end()); // a new key needs two values here
        tree changed = deck;
        auto const* now = deck.find(row.path);
        if (row.what == kind::tables && now != nullptr && now->list) continue;
        std::string replacement =
            now != nullptr && now->value == found->second.first ? found->second.second : found->second.first;
        // In lists the first number is changed.
        if (replacement.empty())
            replacement = now != nullptr ? "[[0.01" + now->value.substr(now->value.find_first_of(",]")) : "[]";
        if (replacement[1] == '[' && now != nullptr && now->value[1] != '[') replacement.erase(0, 1);
        changed.set(row.path, replacement);
        outcome const after = outcome_of(here, changed);
        bool const heard =
            after.status == 2 ? names_a_key(after.message) : after.status == 0 && after.files != before.files;
        if (!heard)
            silent += std::string(row.path) + ": status " + std::to_string(after.status) + " " + after.message + "\n";
    }
    INFO(silent);
    REQUIRE(silent.empty());
}

} // namespace

TEST_CASE("no key is silent: frictional springs and bonds in the plane", "[keys][program]") {
    try_all_keys("plane", deck_of({dry, wall, bonds, {{"simulation.gravity", "[0.0, -9.0]"}}}));
}
TEST_CASE("no key is silent: contacts alone", "[keys][program]") { try_all_keys("contacts", deck_of({dry})); }
TEST_CASE("no key is silent: bonds alone", "[keys][program]") {
    tree deck = deck_of({dry, bonds, {{"simulation.contact_law", "\"none\""}}});
    deck.below["materials"].below["matrix"].below.erase("friction");
    try_all_keys("bonds", deck);
}
TEST_CASE("no key is silent: parallel bonds with strengths of their own", "[keys][program]") {
    tree deck = deck_of({dry, {{"simulation.bond_law", "\"parallel_bond\""},
                                {"bonds.pairs", "[[0, 1]]"},
                                {"bonds.tensile_force", "1e5"},
                                {"bonds.shear_force", "1e5"}}});
    try_all_keys("parallel", deck);
}
TEST_CASE("no key is silent: a pressure on a row of spheres", "[keys][program]") {
    tree deck = deck_of({dry, {{"simulation.mass", "\"sphere\""}, {"simulation.time_step", "1e-4"}}});
    deck.below.erase("loads");
    deck.set("loads[].pressure", "10.0");
    try_all_keys("pressure", deck);
}
TEST_CASE("no key is silent: Hertzian spheres in space", "[keys][program]") {
    tree deck = deck_of({dry, {{"simulation.dimension", "3"},
                                {"simulation.mass", "\"sphere\""},
                                {"simulation.contact_law", "\"hertz_mindlin\""},
                                {"materials.*.young_modulus", "1e7"},
                                {"materials.*.poisson_ratio", "0.3"},
                                {"particles.position", "[[0.0, 0.0, 0.0], [0.99, 0.0, 0.0], [0.5, 0.85, 0.0]]"},
                                {"particles.velocity", "[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.3, -0.5, 0.0]]"},
                                {"particles.spin", "[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.3]]"},
                                {"loads[].force", "[10.0, 0.0, 0.0]"}}});
    for (char const* key : {"normal_stiffness", "shear_stiffness"})
        deck.below["materials"].below["matrix"].below.erase(key);
    try_all_keys("hertz", deck);
}
TEST_CASE("no key is silent: with fluid, explicit and implicit", "[keys][program]") {
    for (char const* solver : {"\"explicit\"", "\"implicit\""})
        try_all_keys(solver[1] == 'e' ? "wet" : "wet_implicit",
                     deck_of({dry, bonds, water, {{"fluid.solver", solver}}}));
}
TEST_CASE("no key is silent: flow alone between particles", "[keys][program]") {
    try_all_keys("rigid", deck_of({rigid}));
}
TEST_CASE("no key is silent: a bare network", "[keys][program]") {
    tree deck = deck_of({network});
    deck.below["fluid"].below["network"].below["pores"].further = ", { volume = 2.0 }, { volume = 3.0 }";
    try_all_keys("network", deck);
}
