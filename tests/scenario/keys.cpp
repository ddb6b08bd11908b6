// SPDX-License-Identifier: BSD-3-Clause

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "catch.hpp"
#include "scenario/program.hpp"
#include "scenario/tree.hpp"

#include "key_table.hpp"
#include "scenario.hpp"

/// \file
/// Every row of the table of keys is tried alone, in a file that holds only this key and the keys that it requires.

using namespace lacuna_run;

namespace {

std::string answer(tree const& file) {
    try {
        read_scenario(file.text(), "case.toml", "");
    } catch (lacuna_run::refusal const& bad) {
        return bad.what();
    }
    return "accepted";
}

/// Another key and its value. A path that begins with a dot belongs to the table of the key under test.
struct setting {
    char const* path;
    std::string value;
};
struct condition_settings {
    std::vector<setting> satisfied, violated;
};

/// Settings that satisfy a condition, and settings that violate it.
condition_settings settings_of(needs what) {
    std::string const pores = "[ { volume = 1.0 } ]";
    std::vector<setting> const rigid{{"fluid.mechanical_coupling", "false"}}, bonds{{"bonds.touching", "true"}};
    std::vector<setting> const young{{"simulation.contact_law", "\"hertz_mindlin\""}, {".young_modulus", "1e9"}};
    switch (what) {
    case in_plane: return {{}, {{"simulation.dimension", "3"}}};
    case with_particles: return {{}, {{"fluid.network.pores", pores}}};
    case materials_named: return {{{"particles.file", "\"x.csv\""}}, rigid};
    case bounded_step:
    case density_used:
    case material_used:
    case moving: return {{}, rigid};
    case with_contacts: return {{}, {{"simulation.contact_law", "\"none\""}}};
    case with_hertz: return {{{"simulation.contact_law", "\"hertz_mindlin\""}}, {}};
    case with_bonds: return {{}, {{"simulation.bond_law", "\"none\""}}};
    case with_parallel_bonds: return {{{"simulation.bond_law", "\"parallel_bond\""}}, {}};
    case bonds_for_it:
    case bonds_there:
    case tension_used:
    case shearing_used: return {bonds, {}};
    case friction_used:
    case normal_used:
    case shear_used:
    case with_forces: return {{}, {{"simulation.contact_law", "\"none\""}}};
    case normal_besides_young:
    case shear_besides_young:
    case no_young: return {{}, young};
    case young_given: return {young, {}};
    case thickness_used: return {{}, {{"simulation.mass", "\"sphere\""}}};
    case gravity_given: return {{{"simulation.gravity", "[0.0, -1.0]"}}, {{"simulation.gravity", "[0.0, 0.0]"}}};
    case own_step: return {{}, {{"fluid.mechanical_coupling", "false"}, {"fluid.time_step", "1.0"}}};
    case auto_step: return {{}, {{"simulation.time_step", "1.0"}}};
    case explicit_flow: return {{}, {{"fluid.solver", "\"implicit\""}}};
    case remeshed: return {{{".rule", "\"when_needed\""}}, {{".rule", "\"never\""}}};
    case lasting_pores: return {{}, {{"fluid.remeshing.rule", "\"when_needed\""}}};
    case bare_network: return {{{"fluid.network.pores", pores}}, {}};
    default: break;
    }
    // Conditions on the same table.
    switch (what) {
    case no_steps: return {{}, {{".steps", "1"}}};
    case no_file: return {{}, {{".file", "\"x.csv\""}}};
    case touching_bonds: return {{{".touching", "true"}}, {}};
    case listed_bonds: return {{}, {{".touching", "true"}}};
    case no_velocity: return {{}, {{".velocity", "[0.0, 0.0]"}}};
    case no_pressure: return {{}, {{".pressure", "1.0"}}};
    case pressure_given: return {{{".pressure", "1.0"}}, {}};
    case drained: return {{{".boundary", "\"drained\""}}, {{".boundary", "\"sealed\""}}};
    case no_pore: return {{}, {{".pore", "0"}}};
    case no_throat: return {{}, {{".throat", "0"}}};
    case constant_aperture: return {{{".law", "\"constant\""}}, {{".law", "\"contact_force\""}}};
    case contact_aperture: return {{{".law", "\"contact_force\""}}, {{".law", "\"constant\""}}};
    default: throw std::logic_error("a condition that this test does not know: " + std::to_string(what));
    }
}

void put(tree& file, key const& row, setting const& s) {
    std::string path = s.path;
    if (path[0] == '.') path = std::string(row.path).substr(0, std::string_view(row.path).rfind('.')) + path;
    file.set(path, s.value);
}

/// A file in which the key has that value and applies, but for the violated condition.
tree file_with(key const& row, std::string const& value, std::uint64_t violated = 0) {
    tree file;
    // Conditions of the tables above the key.
    std::uint64_t asked = row.where;
    std::string_view const path = row.path;
    for (std::size_t at = path.find_first_of(".["); at != path.npos; at = path.find_first_of(".[", at + 1))
        if (auto const* above = find_key(path.substr(0, at))) asked |= above->where;
    // The message names the first violated condition, so later ones may fail, too.
    for (condition const& c : conditions)
        if ((asked & c.what) != 0 && (violated == 0 || c.what <= violated || (row.where & c.what) == 0)) {
            condition_settings const one = settings_of(c.what);
            for (setting const& s : (violated & c.what) != 0 ? one.violated : one.satisfied) put(file, row, s);
        }
    file.set(path, value);
    return file;
}

std::string number_text(double x) {
    return lacuna::to_text(x).find_first_of(".en") == std::string::npos ? lacuna::to_text(x) + ".0"
                                                                        : lacuna::to_text(x);
}

/// An allowed value.
std::string sample(key const& row) {
    rule const& r = row.good;
    double const inside = std::isfinite(r.least) && std::isfinite(r.most) ? 0.5 * (r.least + r.most)
                          : std::isfinite(r.most)                         ? r.most - 1
                                                                          : 1;
    switch (row.what) {
    case kind::table: return "{}";
    case kind::tables: return "[]";
    case kind::named: return "{}";
    case kind::number:
    case kind::step:
    case kind::each_number: return number_text(inside);
    case kind::whole: return std::to_string((long long)(inside));
    case kind::flag: return "true";
    case kind::word: return "\"" + std::string(r.choices).substr(std::string_view(r.choices).rfind('|') + 1) + "\"";
    case kind::text:
    case kind::each_text: return "\"x\"";
    case kind::vector: return "[0.0, 0.0]";
    case kind::rotation: return "0.0";
    case kind::points: return "[[0.0, 0.0]]";
    case kind::rotations: return "[0.0]";
    case kind::numbers: return "[0]";
    case kind::pairs: return "[[0, 1]]";
    case kind::two: return "[0, 1]";
    case kind::index: return "0";
    case kind::quantity: return "\"energy.kinetic\"";
    }
    return {};
}

} // namespace

TEST_CASE("each key is read as its row says", "[keys]") {
    for (key const& row : keys) {
        std::string const path = refused_path(row.path);
        INFO(path << "\n" << file_with(row, sample(row)).text());
        auto const refused = [&](std::string const& value, std::string const& message) {
            INFO(value);
            REQUIRE_THAT(answer(file_with(row, value)), contains_text(message));
        };
        // An allowed value: a refusal, if any, names another key.
        auto const good = answer(file_with(row, sample(row)));
        if (std::string_view(row.path).find('.') != std::string_view::npos && row.what != kind::tables &&
            row.what != kind::table) {
            REQUIRE(good.rfind(path + " = ", 0) == std::string::npos);
            REQUIRE(good.rfind(path + "[", 0) == std::string::npos);
        }
        // A wrong type.
        if (std::string_view(row.path) != "materials.*") refused("1979-05-27", path + " = a date or time: must be ");
        // A misspelt key.
        tree misspelt = file_with(row, sample(row));
        misspelt.set(std::string(row.path) + (row.what == kind::named ? "q.q" : "q"), sample(row));
        if (std::string_view(row.path).back() != '*')
            REQUIRE_THAT(answer(misspelt),
                         contains_text(path + "q = ") && contains_text("must be a known key (did you mean"));
        // Numbers outside the range.
        if (row.what == kind::number || row.what == kind::each_number || row.what == kind::step) {
            if (std::isfinite(row.good.least))
                refused(number_text(row.good.least - 1), "must be " + std::string(row.good.text));
            if (row.good.above_least)
                refused(number_text(row.good.least), path + " = " + lacuna::to_text(row.good.least) + ": must be");
            if (std::isfinite(row.good.most))
                refused(number_text(row.good.most + 1), "must be " + std::string(row.good.text));
            refused("nan", path + " = nan: must be finite");
        }
        if (row.what == kind::whole) {
            refused(std::to_string((long long)(row.good.least) - 1), "must be " + std::string(row.good.text));
            refused(std::to_string((long long)(row.good.most) + 1), "must be " + std::string(row.good.text));
            refused("1.5", path + " = 1.5: must be a whole number");
        }
        if (row.what == kind::word) refused("\"qqqqqqqqqq\"", path + " = \"qqqqqqqqqq\": must be one of ");
        // Each condition violated.
        for (condition const& c : conditions)
            if ((row.where & c.what) != 0 && *c.otherwise != '\0') {
                auto const message = answer(file_with(row, sample(row), c.what));
                INFO(c.otherwise << ": " << message);
                REQUIRE_THAT(message, contains_text(path + " = ") && contains_text(c.otherwise));
            }
    }
}

TEST_CASE("the README and --help show all keys", "[keys]") {
    std::string const readme = program::read_file(std::string(LACUNA_RUN_CASES) + "/../README.md");
    std::string const help = keys_help();
    std::string all;
    for (char const* section : sections) all += keys_markdown(section) + "\n";
    all += quantities_markdown();
    std::ofstream(std::string(LACUNA_RUN_SCRATCH) + "_keys.md") << all;
    INFO("the tables as they should be: " LACUNA_RUN_SCRATCH "_keys.md");
    for (char const* section : sections) REQUIRE_THAT(readme, contains_text(keys_markdown(section)));
    REQUIRE_THAT(readme, contains_text(quantities_markdown()));
    std::size_t tables = 0;
    for (auto at = readme.find("\n| `["); at != readme.npos; at = readme.find("\n| `[", at + 1)) ++tables;
    REQUIRE(tables == std::size(sections));
    for (key const& row : keys) {
        std::string_view const path = row.path;
        auto const dot = path.find('.');
        if (dot == path.npos || path == "materials.*" || *row.meaning == '\0') continue;
        std::string name(path.substr(dot + 1));
        if (name.rfind("*.", 0) == 0) name = name.substr(2);
        REQUIRE_THAT(help, contains_text("\n  " + name));
    }
    std::size_t column = 0;
    for (char const c : help) {
        column = c == '\n' ? 0 : column + 1;
        REQUIRE(column <= 120);
    }
}
