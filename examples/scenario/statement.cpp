// SPDX-License-Identifier: BSD-3-Clause
#include "statement.hpp"

#include "checkpoints.hpp"
#include "key_table.hpp"

#ifdef LACUNA_RUN_CHECKPOINTS

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <lacuna/core/difference.hpp>
#include <lacuna/observe/state_archive.hpp>

namespace lacuna_run {

std::string word_of(contact_law law) {
    return std::array{"\"none\"", "\"frictional_spring\"", "\"hertz_mindlin\""}[std::size_t(law)];
}
std::string word_of(bond_law law) {
    return std::array{"\"none\"", "\"brittle_spring\"", "\"parallel_bond\""}[std::size_t(law)];
}

namespace {

/// A scenario in a form that does not depend on how its file was written.
struct statement {
    std::uint64_t keys = 0; ///< hash of the paths of all keys
    scenario stated;
    std::vector<std::uint8_t> held; ///< of each particle: bits x, y, z, r
};

std::uint64_t hash_of_keys() {
    lacuna::checksum sum;
    for (key const& row : keys) sum.add(row.path, std::strlen(row.path) + 1);
    return sum.value();
}

std::vector<std::uint8_t> held_axes(particle_list const& p) {
    std::vector<std::uint8_t> held(p.size(), 0);
    for (fixed const& f : p.fix)
        for (auto const id : f.particles)
            held[std::size_t(id)] =
                std::uint8_t(held[std::size_t(id)] | (f.x * 1 + f.y * 2 + f.z * 4 + f.rotation * 8));
    return held;
}

/// Calls visit(list, length) for each list with one entry per particle or per bond.
template <class Visit>
void for_each_list(statement& s, Visit const& visit) {
    std::size_t const n = s.stated.particles.size();
    visit(s.stated.particles.velocity, n);
    visit(s.stated.particles.spin, n);
    visit(s.stated.particles.radius, n);
    visit(s.stated.particles.material, n);
    visit(s.stated.bonds.values, s.stated.bonds.pairs.size());
    visit(s.held, n);
}
/// Keeps one entry of a list whose entries are all equal.
template <class T>
void shorten(std::vector<T>& list) {
    for (T const& value : list)
        if (lacuna::first_difference(list.front(), value, "")) return;
    if (list.size() > 1) list.erase(list.begin() + 1, list.end());
}

/// Whether bonds have their own values instead of their material's.
bool has_values(scenario const& s) { return !s.bonds.values.empty(); }

std::string held_text(std::uint8_t held) {
    std::string text = "\"";
    for (int k = 0; k < 4; ++k)
        if (held >> k & 1) text += "xyzr"[k];
    return text + "\"";
}
std::string names_text(std::vector<material> const& materials) {
    std::string text;
    for (material const& m : materials) text += (text.empty() ? "" : ", ") + m.name;
    return text;
}

/// A member of scenario whose key has another name. Only whole parts of a path match; the first matching entry counts.
struct renamed {
    std::string_view member, key;
};
constexpr renamed renames[] = {
    {"simulation.single_precision", "simulation.real"}, {"simulation.spheres", "simulation.mass"},
    {"simulation.contact", "simulation.contact_law"},   {"simulation.bond", "simulation.bond_law"},
    {"simulation.velocity_verlet", "simulation.integrator"},
    {"simulation.local_damping", "simulation.damping.local"},
    {"simulation.mass_damping", "simulation.damping.mass"},
    {"simulation.viscous_damping", "simulation.damping.viscous"},
    {"fluid.constant_aperture", "fluid.aperture.law"},
    {"fluid.half_force", "fluid.aperture.F0"},
    {"fluid.gap_factor", "fluid.aperture.gap_multiplier"},
    {"fluid.implicit", "fluid.solver"},
    {"fluid.drained", "fluid.boundary"},
    {"fluid.remeshing_interval", "fluid.remeshing.interval"},
    {"fluid.remeshing_on_broken_bond", "fluid.remeshing.on_broken_bond"},
    {"fluid.remeshing", "fluid.remeshing.rule"},
    {"fluid.pores", "fluid.network.pores"},
    {"fluid.throats", "fluid.network.throats"},
};
/// The words that stand for a flag's values false and true.
struct flag_words {
    std::string_view key, no, yes;
};
constexpr flag_words words[] = {
    {"simulation.real", "\"double\"", "\"float\""},
    {"simulation.mass", "\"disc\"", "\"sphere\""},
    {"simulation.integrator", "\"symplectic_euler\"", "\"velocity_verlet\""},
    {"fluid.aperture.law", "\"contact_force\"", "\"constant\""},
    {"fluid.solver", "\"explicit\"", "\"implicit\""},
    {"fluid.boundary", "\"sealed\"", "\"drained\""},
    {"fluid.remeshing.rule", "\"never\"", "\"when_needed\""},
};

void replace(std::string& text, std::string_view old, std::string_view replacement) {
    if (auto const at = text.find(old); at != std::string::npos) text.replace(at, old.size(), replacement);
}

/// Translates the names of members to keys, and numbers to the words of the file.
lacuna::difference as_keys(lacuna::difference d, scenario const& now) {
    std::string& path = d.path;
    if (path.rfind("walls[", 0) == 0) replace(path, "].position", "].point");
    if (path.rfind("materials[", 0) == 0) {
        auto const end = path.find(']');
        auto const number = std::size_t(std::stoul(path.substr(10, end - 10)));
        path = "materials." + now.materials.at(number).name + path.substr(end + 1);
    }
    if (path.rfind("bonds.values[", 0) == 0) { // bonds.values[3].shear_force: bonds.shear_force[3]
        auto const end = path.find(']');
        path = "bonds" + path.substr(end + 1) + path.substr(12, end - 11);
    }
    bool const constant = now.fluid && now.fluid->constant_aperture;
    if (path == "fluid.aperture") path = constant ? "fluid.aperture.value" : "fluid.aperture.a0";
    for (auto const& [member, key] : renames) {
        char const next = path.size() > member.size() ? path[member.size()] : '.';
        if (path.compare(0, member.size(), member) != 0 || (next != '.' && next != '[')) continue;
        path = std::string(key) + path.substr(member.size());
        break;
    }
    replace(path, ".where.", ".");
    for (auto const& one : words)
        if (path == one.key)
            for (std::string* text : {&d.first, &d.second}) *text = *text == "true" ? one.yes : one.no;
    for (std::string* text : {&d.first, &d.second}) {
        if (path.rfind("particles.material[", 0) == 0)
            *text = "\"" + now.materials.at(std::size_t(std::stoul(*text))).name + "\"";
        if ((path == "simulation.time_step" || path == "fluid.time_step") && *text == "0") *text = "\"auto\"";
    }
    return d;
}

/// Removes everything that may change at a restart.
void forget_changeable(scenario& s) {
    s.simulation.steps.reset();
    s.simulation.end_time.reset();
    s.simulation.threads = 1;
    s.simulation.guards = {};
    s.loads.clear();
    s.probes.clear();
    s.output = {};
    s.particles.fix.clear(); // compared as axes held
}

std::optional<lacuna::difference> first_difference(scenario before, scenario now,
                                                   std::vector<std::uint8_t> const& held_before) {
    auto const held_now = held_axes(now.particles);
    auto const names_before = names_text(before.materials), names_now = names_text(now.materials);
    if (names_before != names_now) return lacuna::difference{"materials", names_before, names_now};
    forget_changeable(before);
    forget_changeable(now);
    std::string_view const none = "left out";
    // Pairs before values: values of different lists of bonds cannot be compared.
    if (auto d = lacuna::first_difference(before.bonds.pairs, now.bonds.pairs, "bonds.pairs", none))
        return as_keys(*d, now);
    for (scenario* one : {&before, &now})
        if (!has_values(*one)) one->bonds.values.resize(one->bonds.pairs.size());
    if (auto d = lacuna::first_difference(before, now, "", none)) return as_keys(*d, now);
    for (std::size_t k = 0; k < held_now.size() && k < held_before.size(); ++k)
        if (held_before[k] != held_now[k])
            return lacuna::difference{"particles.fix of particle " + std::to_string(k), held_text(held_before[k]),
                                      held_text(held_now[k])};
    return {};
}

} // namespace

std::string statement_of(scenario const& s) {
    statement one{hash_of_keys(), s, held_axes(s.particles)};
    one.stated.particles.fix.clear();
    one.stated.simulation.threads = 1; // the statement is the same for any number of threads
    for_each_list(one, [](auto& list, std::size_t) { shorten(list); });
    lacuna::state_writer bytes;
    bytes(one);
    return bytes.bytes();
}

scenario earlier_scenario(std::string const& path, std::string const& bytes_before, scenario const& now) {
    statement before;
    auto const refuse_file = [&](std::string const& why) { throw refusal("checkpoint " + path + ": " + why); };
    try {
        std::uint64_t keys_then = 0;
        if (!bytes_before.empty()) lacuna::state_reader{bytes_before}(keys_then);
        if (keys_then != hash_of_keys()) refuse_file("it was not made by a scenario of this version of lacuna-run");
        lacuna::state_reader bytes(bytes_before);
        bytes(before);
        lacuna::require_state(bytes.left() == 0, "it has extra bytes at its end");
    } catch (refusal const&) {
        throw;
    } catch (std::exception const& bad) {
        refuse_file(bad.what());
    }
    for_each_list(before, [](auto& list, std::size_t count) {
        if (list.size() == 1) list.resize(count, typename std::remove_cvref_t<decltype(list)>::value_type(list[0]));
    });
    // The statement has no list `fix`, only the held axes of each particle.
    for (std::size_t k = 0; k < before.held.size(); ++k) {
        auto const held = before.held[k];
        before.stated.particles.fix.push_back(
            {{std::int32_t(k)}, (held & 1) != 0, (held & 2) != 0, (held & 4) != 0, (held & 8) != 0});
    }
    if (auto const d = first_difference(before.stated, now, before.held))
        refuse_file("it was made with " + d->path + " = " + d->first + ", the deck says " + d->second);
    return before.stated;
}

} // namespace lacuna_run

#else

namespace lacuna_run {

std::string statement_of(scenario const&) { return {}; }
scenario earlier_scenario(std::string const&, std::string const&, scenario const& now) { return now; }

} // namespace lacuna_run

#endif
