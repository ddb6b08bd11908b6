// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

/// \file
/// What a row of the table of keys (key_table.hpp) is made of.

namespace lacuna_run {

/// What may stand at a key.
enum class kind {
    table,      ///< a table
    tables,     ///< a list of tables
    named,      ///< tables by names of the user's own
    number,
    step,       ///< "auto", or a number of seconds > 0
    whole,      ///< a whole number
    flag,       ///< true or false
    word,       ///< one of the choices
    text,
    vector,     ///< as many numbers as there are dimensions
    turn,       ///< a number in the plane, three in space
    points,     ///< a list of vectors
    turns,      ///< a list of turns
    each_number, ///< one number for all, or a list of them
    each_text,  ///< one string for all, or a list of them
    numbers,    ///< a list of particles' numbers
    pairs,      ///< a list of pairs of particles' numbers
    two,        ///< a list of two numbers
    index,      ///< the number of a particle, bond, ...
    quantity    ///< one of the quantities of probes.hpp
};

/// Which numbers, or which words, are good.
struct rule {
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    bool above_least = false; ///< the least is not good itself
    char const* text = "";    ///< as messages and help state it
    char const* choices = ""; ///< of a word, parted by '|'
};
inline constexpr rule any{};
inline constexpr rule positive{0, std::numeric_limits<double>::infinity(), true, "> 0"};
inline constexpr rule not_negative{0, std::numeric_limits<double>::infinity(), false, ">= 0"};
inline constexpr rule not_positive{-std::numeric_limits<double>::infinity(), 0, false, "<= 0"};
inline constexpr rule fraction{0, 1, false, "from 0 to 1"};
inline constexpr rule steps_or_none{0, 1e15, false, "from 0 (none) to 1e15 steps"};
constexpr rule one_of(char const* choices) { return {0, 0, false, "", choices}; }

/// What must hold for a key to mean something; several may be asked together.
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

/// One condition of these.
struct condition {
    needs what;
    char const* where;     ///< as --help tells it
    char const* otherwise; ///< why the key must be left out where it does not hold; empty: it may stand there, but need not
};
inline constexpr condition conditions[] = {
    {in_plane, "only with dimension = 2", "it belongs to dimension = 2"},
    {with_particles, "not with fluid.network", "fluid.network replaces the particles"},
    {moving, "only where particles move", "fluid.mechanical_coupling is false: particles do not move"},
    {with_contacts, "not with contact_law = \"none\"", "contact_law is \"none\""},
    {with_hertz, "only with contact_law = \"hertz_mindlin\"", "it belongs to contact_law = \"hertz_mindlin\""},
    {with_bonds, "not with bond_law = \"none\"", "bond_law is \"none\""},
    {with_parallel_bonds, "only with bond_law = \"parallel_bond\"", "it belongs to bond_law = \"parallel_bond\""},
    {bonds_for_it, "other than \"none\" only with [bonds]", "there are no [bonds]"},
    {with_forces, "only with contacts or bonds", "there are neither contacts nor bonds"},
    {thickness_used, "not where spheres have neither fluid, strengths nor pressures", "nothing here depends on it: spheres have none"},
    {gravity_given, "only with gravity", "there is no gravity"},
    {own_step, "not with fluid.time_step of flow alone", "fluid.time_step is the step of flow alone"},
    {auto_step, "only with time_step = \"auto\"", "time_step is given"},
    {bounded_step, "with implicit or automatic flow alone there is nothing to allow", "no step is given here that could be unstable"},
    {no_steps, "not with steps", "steps is given"},
    {normal_used, "needed where a contact or a bond takes it", ""},
    {shear_used, "needed where a contact or a bond takes it", ""},
    {tension_used, "only where a bond takes it", "no bond takes it"},
    {shearing_used, "only where a bond takes it", "no bond takes it"},
    {no_young, "not needed with young_modulus", ""},
    {young_given, "only with young_modulus", "young_modulus is not given"},
    {no_file, "not with file", "the file has it"},
    {touching_bonds, "only with touching = true", "touching is not true"},
    {listed_bonds, "not with touching = true", "touching is true"},
    {no_velocity, "not with velocity", "velocity is given"},
    {no_pressure, "not with pressure", "pressure is given"},
    {pressure_given, "only with pressure", "it belongs to a pressure"},
    {drained, "only with boundary = \"drained\"", "boundary is not \"drained\""},
    {explicit_flow, "only with solver = \"explicit\"", "solver is \"implicit\""},
    {bare_network, "only with fluid.network", "throats of a triangulation have no numbers: give near"},
    {no_pore, "not with pore", "pore is given"},
    {no_throat, "not with throat", "throat is given"},
    {constant_aperture, "only with law = \"constant\"", "it belongs to law = \"constant\""},
    {contact_aperture, "only with law = \"contact_force\"", "it belongs to law = \"contact_force\""},
    {remeshed, "only with rule = \"when_needed\"", "rule is not \"when_needed\""},
    {bonds_there, "only with [bonds]", "there are no [bonds]"},
    {lasting_pores, "not with remeshing", "remeshing numbers pores anew: give near"},
    {materials_named, "not needed of flow alone but for the names in particles.file", ""},
    {density_used, "needed where particles move", ""},
    {friction_used, "needed of contacts", ""},
    {material_used, "needed where particles move", ""},
    {normal_besides_young, "with young_modulus needed of bonds alone", ""},
    {shear_besides_young, "with young_modulus needed of bonds alone", ""},
};

inline constexpr char const* required = "-"; ///< as standard: the key must be given

/// One key. Its path says where it stands: `*` is a name of the user's own, `[]` an entry of a list.
struct key {
    char const* path;
    kind what;
    char const* unit;
    char const* standard; ///< what holds without it, as TOML; `required`; or in words, "" for nothing
    rule good;
    std::uint64_t where; ///< `needs`, together
    char const* meaning;
};

} // namespace lacuna_run
