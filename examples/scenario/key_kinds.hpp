// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

/// \file
/// The parts of a row in the table of keys, key_table.hpp.

namespace lacuna_run {

/// Kind of a key's value.
enum class kind {
    table,      ///< a table
    tables,     ///< a list of tables
    named,      ///< tables whose names the user chooses
    number,
    step,       ///< "auto", or a number of seconds > 0
    whole,      ///< a whole number
    flag,       ///< true or false
    word,       ///< one of the choices
    text,
    vector,     ///< as many numbers as there are dimensions
    rotation,   ///< one number in the plane, three in space
    points,     ///< a list of vectors
    rotations,  ///< a list of rotations
    each_number, ///< one number for all, or a list of them
    each_text,  ///< one string for all, or a list of them
    numbers,    ///< a list of particle numbers
    pairs,      ///< a list of pairs of particle numbers
    two,        ///< a list of two numbers
    index,      ///< the number of one particle, bond, ...
    quantity    ///< one of the quantities of probes.hpp
};

/// Allowed numbers or words.
struct rule {
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    bool above_least = false; ///< `least` itself is refused
    char const* text = "";    ///< the range, for messages and help
    char const* choices = ""; ///< allowed words, separated by '|'
};
inline constexpr rule any{};
inline constexpr rule positive{0, std::numeric_limits<double>::infinity(), true, "> 0"};
inline constexpr rule not_negative{0, std::numeric_limits<double>::infinity(), false, ">= 0"};
inline constexpr rule not_positive{-std::numeric_limits<double>::infinity(), 0, false, "<= 0"};
inline constexpr rule fraction{0, 1, false, "from 0 to 1"};
inline constexpr rule steps_or_none{0, 1e15, false, "from 0 (none) to 1e15 steps"};
constexpr rule one_of(char const* choices) { return {0, 0, false, "", choices}; }

/// Conditions under which a key applies; a key may combine several.
enum needs : std::uint64_t {
    always = 0,
    in_plane = 1ull << 0,
    with_particles = 1ull << 1,
    moving = 1ull << 2,
    with_contacts = 1ull << 3,
    with_hertz = 1ull << 4,
    with_bonds = 1ull << 5,
    with_parallel_bonds = 1ull << 6,
    bonds_for_it = 1ull << 7,
    with_forces = 1ull << 8,
    thickness_used = 1ull << 9,
    gravity_given = 1ull << 10,
    own_step = 1ull << 11,
    auto_step = 1ull << 12,
    bounded_step = 1ull << 13,
    no_steps = 1ull << 14,
    normal_used = 1ull << 15,
    shear_used = 1ull << 16,
    tension_used = 1ull << 17,
    shearing_used = 1ull << 18,
    no_young = 1ull << 19,
    young_given = 1ull << 20,
    no_file = 1ull << 21,
    touching_bonds = 1ull << 22,
    listed_bonds = 1ull << 23,
    no_velocity = 1ull << 24,
    no_pressure = 1ull << 25,
    pressure_given = 1ull << 26,
    drained = 1ull << 27,
    explicit_flow = 1ull << 28,
    bare_network = 1ull << 29,
    no_pore = 1ull << 30,
    no_throat = 1ull << 31,
    constant_aperture = 1ull << 32,
    contact_aperture = 1ull << 33,
    remeshed = 1ull << 34,
    bonds_there = 1ull << 35,
    lasting_pores = 1ull << 36,
    materials_named = 1ull << 37,
    normal_besides_young = 1ull << 38,
    shear_besides_young = 1ull << 39,
    density_used = 1ull << 40,
    friction_used = 1ull << 41,
    material_used = 1ull << 42
};

/// The texts of one condition.
struct condition {
    needs what;
    char const* where;     ///< for --help and the README
    char const* otherwise; ///< why the key must be left out if the condition fails; empty: the key is then optional
};
inline constexpr condition conditions[] = {
    {in_plane, "only with dimension = 2", "it needs dimension = 2"},
    {with_particles, "not with fluid.network", "fluid.network replaces the particles"},
    {moving, "only if particles move", "fluid.mechanical_coupling is false: particles do not move"},
    {with_contacts, "not with contact_law = \"none\"", "contact_law is \"none\""},
    {with_hertz, "only with contact_law = \"hertz_mindlin\"", "it needs contact_law = \"hertz_mindlin\""},
    {with_bonds, "not with bond_law = \"none\"", "bond_law is \"none\""},
    {with_parallel_bonds, "only with bond_law = \"parallel_bond\"", "it needs bond_law = \"parallel_bond\""},
    {bonds_for_it, "other than \"none\" only with [bonds]", "there are no [bonds]"},
    {with_forces, "only with contacts or bonds", "there are neither contacts nor bonds"},
    {thickness_used, "for spheres only with fluid, strengths or pressures",
     "nothing here depends on it: spheres have no thickness"},
    {gravity_given, "only with gravity", "there is no gravity"},
    {own_step, "not if flow alone has fluid.time_step", "with flow alone fluid.time_step is the step"},
    {auto_step, "only with time_step = \"auto\"", "time_step is given"},
    {bounded_step, "not with flow alone that is implicit or chooses its step",
     "no time step is given here that could be unstable"},
    {no_steps, "not with steps", "steps is given"},
    {normal_used, "needed if a contact or bond uses it", ""},
    {shear_used, "needed if a contact or bond uses it", ""},
    {tension_used, "only if a bond uses it", "no bond uses it"},
    {shearing_used, "only if a bond uses it", "no bond uses it"},
    {no_young, "not needed with young_modulus", ""},
    {young_given, "only with young_modulus", "young_modulus is not given"},
    {no_file, "not with file", "particles.file contains it"},
    {touching_bonds, "only with touching = true", "touching is not true"},
    {listed_bonds, "not with touching = true", "touching is true"},
    {no_velocity, "not with velocity", "velocity is given"},
    {no_pressure, "not with pressure", "pressure is given"},
    {pressure_given, "only with pressure", "it needs a pressure"},
    {drained, "only with boundary = \"drained\"", "boundary is not \"drained\""},
    {explicit_flow, "only with solver = \"explicit\"", "solver is \"implicit\""},
    {bare_network, "only with fluid.network", "throats of a triangulation have no numbers: give near"},
    {no_pore, "not with pore", "pore is given"},
    {no_throat, "not with throat", "throat is given"},
    {constant_aperture, "only with law = \"constant\"", "it needs law = \"constant\""},
    {contact_aperture, "only with law = \"contact_force\"", "it needs law = \"contact_force\""},
    {remeshed, "only with rule = \"when_needed\"", "rule is not \"when_needed\""},
    {bonds_there, "only with [bonds]", "there are no [bonds]"},
    {lasting_pores, "not with remeshing", "remeshing renumbers the pores: give near"},
    {materials_named, "with flow alone only for the names in particles.file", ""},
    {density_used, "needed if particles move", ""},
    {friction_used, "needed for contacts", ""},
    {material_used, "needed if particles move", ""},
    {normal_besides_young, "with young_modulus needed only for bonds", ""},
    {shear_besides_young, "with young_modulus needed only for bonds", ""},
};

inline constexpr char const* required = "-"; ///< as default_value: the key must be given

/// One key. In its path `*` is a name that the user chooses, and `[]` is an entry of a list.
struct key {
    char const* path;
    kind what;
    char const* unit;
    char const* default_value; ///< as TOML or in words; `required`; or "" for none
    rule good;
    std::uint64_t where; ///< combined `needs`
    char const* meaning;
};

} // namespace lacuna_run
