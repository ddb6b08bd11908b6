// SPDX-License-Identifier: BSD-3-Clause
#include "probes.hpp"

#include <cstring>

#include "toml_table.hpp"

namespace lacuna_run {

namespace {

/// What a quantity is a quantity of: the key that says which one.
enum class subject { particle, bond, contact, pore, throat, wall, whole };

/// Whether a quantity has a component, written as .x, .y, .z.
enum class parts { none, needed, in_space };

struct entry {
    char const* name;
    quantity what;
    subject of;
    parts axes;
};

constexpr entry entries[] = {
    {"position", quantity::position, subject::particle, parts::needed},
    {"velocity", quantity::velocity, subject::particle, parts::needed},
    {"spin", quantity::spin, subject::particle, parts::in_space},
    {"rotation", quantity::rotation, subject::particle, parts::in_space},
    {"force", quantity::force, subject::particle, parts::needed},
    {"torque", quantity::torque, subject::particle, parts::in_space},
    {"bond.normal_force", quantity::bond_normal_force, subject::bond, parts::none},
    {"bond.shear_force", quantity::bond_shear_force, subject::bond, parts::none},
    {"bond.broken", quantity::bond_broken, subject::bond, parts::none},
    {"contact.normal_force", quantity::contact_normal_force, subject::contact, parts::none},
    {"contact.shear_force", quantity::contact_shear_force, subject::contact, parts::none},
    {"pore.pressure", quantity::pore_pressure, subject::pore, parts::none},
    {"pore.volume", quantity::pore_volume, subject::pore, parts::none},
    {"throat.flow", quantity::throat_flow, subject::throat, parts::none},
    {"wall.force", quantity::wall_force, subject::wall, parts::needed},
    {"energy.kinetic", quantity::kinetic, subject::whole, parts::none},
    {"energy.strain", quantity::strain, subject::whole, parts::none},
    {"energy.friction", quantity::friction, subject::whole, parts::none},
    {"energy.damping", quantity::damping, subject::whole, parts::none},
    {"energy.fracture", quantity::fracture, subject::whole, parts::none},
    {"energy.fluid", quantity::fluid_energy, subject::whole, parts::none},
    {"energy.external", quantity::external, subject::whole, parts::none},
    {"energy.residual", quantity::residual, subject::whole, parts::none},
    {"count.broken_tension", quantity::broken_tension, subject::whole, parts::none},
    {"count.broken_shear", quantity::broken_shear, subject::whole, parts::none},
    {"count.contacts", quantity::contacts, subject::whole, parts::none},
};

std::vector<std::string> names_of(entry const& e, int dimension) {
    std::vector<std::string> names;
    if (e.axes != parts::needed) names.emplace_back(e.name);
    if (e.axes == parts::needed || (e.axes == parts::in_space && dimension == 3))
        for (int axis = 0; axis < dimension; ++axis) names.push_back(std::string(e.name) + "." + "xyz"[axis]);
    return names;
}

entry const& find_entry(value const& from, int dimension, int& axis) {
    std::string const name = from.string();
    std::vector<std::string> known;
    for (entry const& e : entries)
        for (std::string const& one : names_of(e, dimension)) {
            if (one == name) {
                axis = one.size() == std::strlen(e.name) ? -1 : one.back() - 'x';
                return e;
            }
            known.push_back(one);
        }
    std::string const near = nearest_word(name, known);
    from.refuse("a known quantity" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)"));
}

/// Where in the pore network, from `pore` or `near`.
std::string read_pore(table const& t, fluid const& water, pore_place& place) {
    if (water.bare()) t.must_be_left_out("near", "a bare network has no places");
    if (t.has("near")) {
        t.must_be_left_out("pore", "near is given");
        place.near = t["near"].vector(2);
        return lacuna::to_text((*place.near)[0]) + ";" + lacuna::to_text((*place.near)[1]);
    }
    // How many pores a triangulation has is known only when it is made; then the number is checked again.
    place.pore = t["pore"].index(water.bare() ? water.pores.size() : std::size_t(2147483647), "pores");
    return std::to_string(place.pore);
}

} // namespace

probe read_probe(value const& from, scenario const& s) {
    table const t(from, {"quantity", "particle", "bond", "pair", "pore", "near", "throat", "wall", "every"});
    probe p;
    p.name = t["quantity"].string();
    entry const& e = find_entry(t["quantity"], s.simulation.dimension, p.axis);
    p.what = e.what;
    if (t.has("every")) p.every = t["every"].integer(1, 1000000000000000LL, "from 1 to 1e15 steps");

    auto const only = [&](std::initializer_list<char const*> keys) {
        for (char const* key : {"particle", "bond", "pair", "pore", "near", "throat", "wall"}) {
            bool wanted = false;
            for (char const* one : keys) wanted = wanted || std::strcmp(one, key) == 0;
            if (!wanted) t.must_be_left_out(key, p.name + " has none");
        }
    };
    std::string label;
    auto const number = [&](char const* key, std::size_t count, std::string const& of) {
        only({key});
        p.index = t[key].index(count, of);
        label = std::to_string(p.index);
    };
    auto const need_fluid = [&] {
        if (!s.water) t["quantity"].refuse("left out: there is no fluid");
    };
    bool const bare = s.water && s.water->bare();
    if (bare && e.of != subject::pore && e.of != subject::throat)
        t["quantity"].refuse("one of pores or throats: there are no particles");
    switch (e.of) {
    case subject::particle: number("particle", s.bodies.size(), "particles"); break;
    case subject::bond: number("bond", s.joints.pairs.size(), "bonds"); break;
    case subject::wall: number("wall", s.walls.size(), "walls"); break;
    case subject::contact: {
        only({"pair"});
        value const both = t["pair"];
        auto const ends = both.list();
        if (ends.size() != 2) both.refuse("two particles");
        for (std::size_t k = 0; k < 2; ++k) p.particles[k] = ends[k].index(s.bodies.size(), "particles");
        if (p.particles[0] == p.particles[1]) both.refuse("two different particles");
        label = std::to_string(p.particles[0]) + "-" + std::to_string(p.particles[1]);
        break;
    }
    case subject::pore:
        only({"pore", "near"});
        need_fluid();
        label = read_pore(t, *s.water, p.where);
        break;
    case subject::throat:
        only({"pore", "near", "throat"});
        need_fluid();
        if (t.has("throat")) {
            for (char const* key : {"pore", "near"}) t.must_be_left_out(key, "throat is given");
            if (!bare) t["throat"].refuse("left out: give near, throats of a triangulation have no numbers");
            p.throat = t["throat"].index(s.water->throats.size(), "throats");
            label = "throat " + std::to_string(p.throat);
        } else {
            label = read_pore(t, *s.water, p.where);
        }
        break;
    case subject::whole: only({}); break;
    }
    p.column = label.empty() ? p.name : p.name + "[" + label + "]";
    return p;
}

} // namespace lacuna_run
