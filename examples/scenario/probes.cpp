// SPDX-License-Identifier: BSD-3-Clause
#include "probes.hpp"

#include <cstring>

#include "toml_table.hpp"

namespace lacuna_run {

namespace {

std::vector<std::string> names_of(quantity_row const& e, int dimension) {
    std::vector<std::string> names;
    if (e.axes != parts::needed) names.emplace_back(e.name);
    if (e.axes == parts::needed || (e.axes == parts::in_space && dimension == 3))
        for (int axis = 0; axis < dimension; ++axis) names.push_back(std::string(e.name) + "." + "xyz"[axis]);
    return names;
}

quantity_row const& find_entry(value const& from, int dimension, int& axis) {
    std::string const name = from.string();
    std::vector<std::string> known;
    for (quantity_row const& e : quantities)
        for (std::string const& one : names_of(e, dimension)) {
            if (one == name) {
                axis = one.size() == std::strlen(e.name) ? -1 : one.back() - 'x';
                return e;
            }
            known.push_back(one);
        }
    from.refuse("a known quantity" + did_you_mean(name, known));
}

/// Reads a pore from `pore` or `near`. \return its label in the column's heading
std::string read_pore(table const& t, fluid_settings const& fluid, pore_location& location) {
    if (t.has("near")) {
        location.near = t["near"].vector(2);
        return lacuna::to_text((*location.near)[0]) + ";" + lacuna::to_text((*location.near)[1]);
    }
    // The number of pores is known only after the triangulation; the index is checked again then.
    location.pore = t["pore"].index(fluid.bare() ? fluid.pores.size() : std::size_t(2147483647), "pores");
    return std::to_string(location.pore);
}

/// \throws refusal for a quantity that does not exist in this kind of run
void require_available(quantity_row const& e, value const& from, scenario const& s) {
    bool const flow = e.of == subject::pore || e.of == subject::throat || e.what == quantity::fluid_energy;
    if (s.flow_alone() && s.fluid->bare() && !flow)
        from.refuse("one of pores, throats or energy.fluid: there are no particles");
    if (s.flow_alone() && !flow && e.what != quantity::position)
        from.refuse("left out: fluid.mechanical_coupling is false, particles do not move");
    if (!s.fluid && flow) from.refuse("left out: there is no fluid");
    bool const of_contacts = e.of == subject::contact || e.what == quantity::contacts || e.what == quantity::friction;
    if (of_contacts && s.simulation.contact == contact_law::none) from.refuse("left out: contact_law is \"none\"");
    bool const of_failure =
        e.what == quantity::broken_tension || e.what == quantity::broken_shear || e.what == quantity::fracture;
    if (of_failure && s.bonds.pairs.empty()) from.refuse("left out: there are no bonds");
}

} // namespace

char const* key_of(subject of) {
    switch (of) {
    case subject::particle: return "particle";
    case subject::bond: return "bond";
    case subject::contact: return "pair";
    case subject::pore: return "pore or near";
    case subject::throat: return "near, pore or throat";
    case subject::wall: return "wall";
    case subject::whole: break;
    }
    return "";
}

probe read_probe(value const& from, scenario const& s) {
    table const t(from, "probes[]");
    probe p;
    p.name = t["quantity"].string();
    quantity_row const& e = find_entry(t["quantity"], s.simulation.dimension, p.axis);
    p.what = e.what;
    p.every = t.whole("every");

    auto const only = [&](std::initializer_list<char const*> wanted_keys) {
        for (char const* key : {"particle", "bond", "pair", "pore", "near", "throat", "wall"}) {
            bool wanted = false;
            for (char const* one : wanted_keys) wanted = wanted || std::strcmp(one, key) == 0;
            if (!wanted) t.must_be_left_out(key, "it does not apply to " + p.name);
        }
    };
    std::string label;
    auto const number = [&](char const* key, std::size_t count, std::string const& of) {
        only({key});
        p.index = t[key].index(count, of);
        label = std::to_string(p.index);
    };
    require_available(e, t["quantity"], s);
    switch (e.of) {
    case subject::particle: number("particle", s.particles.size(), "particles"); break;
    case subject::bond: number("bond", s.bonds.pairs.size(), "bonds"); break;
    case subject::wall: number("wall", s.walls.size(), "walls"); break;
    case subject::contact: {
        only({"pair"});
        value const both = t["pair"];
        auto const ends = both.list();
        if (ends.size() != 2) both.refuse("two particles");
        for (std::size_t k = 0; k < 2; ++k) p.particles[k] = ends[k].index(s.particles.size(), "particles");
        if (p.particles[0] == p.particles[1]) both.refuse("two different particles");
        label = std::to_string(p.particles[0]) + "-" + std::to_string(p.particles[1]);
        break;
    }
    case subject::pore:
        only({"pore", "near"});
        label = read_pore(t, *s.fluid, p.where);
        break;
    case subject::throat:
        only({"pore", "near", "throat"});
        if (t.has("throat")) {
            p.throat = t["throat"].index(s.fluid->throats.size(), "throats");
            label = "throat " + std::to_string(p.throat);
        } else {
            label = read_pore(t, *s.fluid, p.where);
        }
        break;
    case subject::whole: only({}); break;
    }
    p.column = label.empty() ? p.name : p.name + "[" + label + "]";
    return p;
}

} // namespace lacuna_run
