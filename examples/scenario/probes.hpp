// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenario.hpp"

namespace lacuna_run {

struct value;

/// The kind of object that a quantity belongs to. A key selects the object.
enum class subject { particle, bond, contact, pore, throat, wall, whole };

/// Whether the name of a quantity has a component .x, .y or .z.
enum class parts {
    none,    ///< never
    needed,  ///< always
    in_space ///< optional in space: without it the magnitude; never in the plane
};

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
    {"force", quantity::force, subject::particle, parts::needed, "N",
     "total force at the last evaluation, with loads and gravity"},
    {"torque", quantity::torque, subject::particle, parts::in_space, "N m", "in 3D the magnitude, or a component"},
    {"bond.normal_force", quantity::bond_normal_force, subject::bond, parts::none, "N",
     "positive in tension; 0 once broken"},
    {"bond.shear_force", quantity::bond_shear_force, subject::bond, parts::none, "N", "0 once broken"},
    {"bond.broken", quantity::bond_broken, subject::bond, parts::none, "", "0 or 1"},
    {"contact.normal_force", quantity::contact_normal_force, subject::contact, parts::none, "N",
     "negative in compression"},
    {"contact.shear_force", quantity::contact_shear_force, subject::contact, parts::none, "N", ""},
    {"pore.pressure", quantity::pore_pressure, subject::pore, parts::none, "Pa", ""},
    {"pore.volume", quantity::pore_volume, subject::pore, parts::none, "m^3", ""},
    {"throat.flow", quantity::throat_flow, subject::throat, parts::none, "m^3/s",
     "of the throat nearest to a point; the total into a pore; of a throat of a bare network"},
    {"wall.force", quantity::wall_force, subject::wall, parts::needed, "N", "total force of the particles on the wall"},
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
    {"count.contacts", quantity::contacts, subject::whole, parts::none, "", "contacts with a force"},
};

/// The keys that select the object: "particle", "pore or near", ...; "" for quantities of the whole simulation.
char const* key_of(subject of);

/// Reads a probe. All other parts of the scenario must have been read before. \throws refusal
probe read_probe(value const& from, scenario const& s);

} // namespace lacuna_run
