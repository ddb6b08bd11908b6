// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenario.hpp"

namespace lacuna_run {

struct value;

/// What a quantity is a quantity of: the key that says which one.
enum class subject { particle, bond, contact, pore, throat, wall, whole };

/// Whether a quantity has a component, written as .x, .y, .z.
enum class parts { none, needed, in_space };

/// One quantity that a probe can read.
struct quantity_row {
    char const* name;
    quantity what;
    subject of;
    parts axes;
    char const* unit;
    char const* meaning;
};

inline constexpr quantity_row quantities[] = {
    {"position", quantity::position, subject::particle, parts::needed, "m", ""},
    {"velocity", quantity::velocity, subject::particle, parts::needed, "m/s", ""},
    {"spin", quantity::spin, subject::particle, parts::in_space, "rad/s", "in 3D the magnitude, or a component"},
    {"rotation", quantity::rotation, subject::particle, parts::in_space, "rad", "in 3D the magnitude, or a component"},
    {"force", quantity::force, subject::particle, parts::needed, "N", "sum of all at the last evaluation, loads and gravity too"},
    {"torque", quantity::torque, subject::particle, parts::in_space, "N m", "in 3D the magnitude, or a component"},
    {"bond.normal_force", quantity::bond_normal_force, subject::bond, parts::none, "N", "positive in tension; 0 once broken"},
    {"bond.shear_force", quantity::bond_shear_force, subject::bond, parts::none, "N", "0 once broken"},
    {"bond.broken", quantity::bond_broken, subject::bond, parts::none, "", "0 or 1"},
    {"contact.normal_force", quantity::contact_normal_force, subject::contact, parts::none, "N", "negative in compression"},
    {"contact.shear_force", quantity::contact_shear_force, subject::contact, parts::none, "N", ""},
    {"pore.pressure", quantity::pore_pressure, subject::pore, parts::none, "Pa", ""},
    {"pore.volume", quantity::pore_volume, subject::pore, parts::none, "m^3", ""},
    {"throat.flow", quantity::throat_flow, subject::throat, parts::none, "m^3/s",
     "the throat nearest to a point; the sum into a pore; a throat of a bare network"},
    {"wall.force", quantity::wall_force, subject::wall, parts::needed, "N", "of the particles on the wall"},
    {"energy.kinetic", quantity::kinetic, subject::whole, parts::none, "J", ""},
    {"energy.strain", quantity::strain, subject::whole, parts::none, "J", ""},
    {"energy.friction", quantity::friction, subject::whole, parts::none, "J", ""},
    {"energy.damping", quantity::damping, subject::whole, parts::none, "J", ""},
    {"energy.fracture", quantity::fracture, subject::whole, parts::none, "J", ""},
    {"energy.fluid", quantity::fluid_energy, subject::whole, parts::none, "J", ""},
    {"energy.external", quantity::external, subject::whole, parts::none, "J", ""},
    {"energy.residual", quantity::residual, subject::whole, parts::none, "J", ""},
    {"count.broken_tension", quantity::broken_tension, subject::whole, parts::none, "", ""},
    {"count.broken_shear", quantity::broken_shear, subject::whole, parts::none, "", ""},
    {"count.contacts", quantity::contacts, subject::whole, parts::none, "", "those with a force"},
};

/// The keys that say of which one: "particle", "pore or near", ...; "" of the whole.
char const* key_of(subject of);

/// A probe of a scenario whose other parts have been read. \throws refusal
probe read_probe(value const& from, scenario const& s);

} // namespace lacuna_run
