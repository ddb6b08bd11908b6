// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "key_kinds.hpp"

/// \file
/// Table of all keys of a scenario: kind of value, unit, default, and the conditions under which a key applies.
/// Reading, refusals, `--help` and the README's tables follow from it. To add a key, add one row here and one line that
/// reads it, such as `table::number("key")` (toml_table.hpp).

namespace lacuna_run {

inline constexpr key keys[] = {
    {"simulation", kind::table, "", required, any, always, ""},
    {"simulation.dimension", kind::whole, "", "2", {2, 3, false, "2 or 3"}, always, "2: the plane, 3: space"},
    {"simulation.real", kind::word, "", "\"double\"", one_of("double|float"), always, "precision of the numbers"},
    {"simulation.thickness", kind::number, "m", "1.0", positive, in_plane | with_particles | thickness_used, "of the packing, out of the plane"},
    {"simulation.mass", kind::word, "", "\"disc\" (3D: \"sphere\")", one_of("disc|sphere"), moving | with_particles,
     "disc: density pi r^2 thickness, I = m r^2/2; sphere: density 4/3 pi r^3, I = 2/5 m r^2"},
    {"simulation.contact_law", kind::word, "", "\"frictional_spring\"", one_of("none|frictional_spring|hertz_mindlin"), moving | with_particles, ""},
    {"simulation.bond_law", kind::word, "", "\"brittle_spring\"", one_of("none|brittle_spring|parallel_bond"), moving | with_particles | bonds_for_it, ""},
    {"simulation.integrator", kind::word, "", "\"symplectic_euler\"", one_of("symplectic_euler|velocity_verlet"), moving | with_particles,
     "velocity_verlet: positions and velocities belong to the same time"},
    {"simulation.time_step", kind::step, "s", "\"auto\"", positive, own_step,
     "auto: safety times the rigorous stability bound, updated as contacts form or deepen and bonds fail"},
    {"simulation.safety", kind::number, "", "0.2", {0, 1, true, "> 0 and <= 1"}, auto_step, "factor on the stability bound"},
    {"simulation.allow_unstable_step", kind::flag, "", "false", any, bounded_step, "run even if time_step exceeds the stability bound, at the start or later"},
    {"simulation.steps", kind::whole, "", "", {0, 1e15, false, "from 0 to 1e15"}, always, "number of steps; give either steps or end_time"},
    {"simulation.end_time", kind::number, "s", "", positive, no_steps, "time at which the run ends"},
    {"simulation.gravity", kind::vector, "m/s^2", "0", any, moving | with_particles, "acceleration of all particles"},
    {"simulation.fluid_density", kind::number, "kg/m^3", "0", not_negative, moving | with_particles | gravity_given,
     "of a fluid at rest, whose buoyancy reduces the particles' weight; pore pressures exclude the hydrostatic part"},
    {"simulation.threads", kind::whole, "", "1", {1, 1024, false, "from 1 to 1024"}, always, "results do not depend on it"},
    {"simulation.damping", kind::table, "", "", any, moving | with_particles, ""},
    {"simulation.damping.local", kind::number, "", "0", fraction, always, "factor of local damping"},
    {"simulation.damping.mass", kind::number, "1/s", "0", not_negative, always, "drag force divided by momentum"},
    {"simulation.damping.viscous", kind::number, "", "0", not_negative, with_forces, "damping of bonds and contacts divided by critical damping"},
    {"simulation.guards", kind::table, "", "", any, moving | with_particles, "checks that end a broken run; false switches one off"},
    {"simulation.guards.growth", kind::flag, "", "true", any, always,
     "speeds grow fourfold every 16 steps and reverse in nearly every step; off with allow_unstable_step"},
    {"simulation.guards.energy", kind::flag, "", "true", any, always,
     "more than half of the energy has no source; off with allow_unstable_step"},
    {"simulation.guards.overlap", kind::flag, "", "true", any, always, "two particles overlap by more than overlap_limit"},
    {"simulation.guards.overlap_limit", kind::number, "", "1", positive, always, "overlap divided by the smaller radius"},
    {"simulation.guards.motion", kind::flag, "", "true", any, always, "a particle or wall moves by more than motion_limit in one step"},
    {"simulation.guards.motion_limit", kind::number, "", "0.1", positive, always, "displacement divided by the radius; the limit of rotation is ten times this number, in rad"},
    {"simulation.guards.resolution", kind::flag, "", "true", any, always,
     "positions too far from the origin for the precision, or motion lost to rounding"},
    {"simulation.guards.walls", kind::flag, "", "true", any, always, "the centre of a particle is beyond a wall"},
    {"simulation.guards.pores", kind::flag, "", "true", any, always, "a pore is inverted: its corners have passed each other"},

    {"materials", kind::named, "", required, any, materials_named | with_particles, "materials by name"},
    {"materials.*", kind::table, "", "", any, always, ""},
    {"materials.*.density", kind::number, "kg/m^3", required, positive, density_used, ""},
    {"materials.*.normal_stiffness", kind::number, "N/m", required, positive, normal_used | normal_besides_young, "of contacts and bonds"},
    {"materials.*.shear_stiffness", kind::number, "N/m", required, not_negative, shear_used | shear_besides_young, "of contacts and bonds"},
    {"materials.*.friction", kind::number, "", required, not_negative, friction_used, "coefficient of friction"},
    {"materials.*.tensile_strength", kind::number, "Pa", "never breaks", not_negative, tension_used, "of bonds: tensile force divided by the bond's area"},
    {"materials.*.shear_strength", kind::number, "Pa", "never breaks", not_negative, shearing_used, "of bonds: shear force divided by the bond's area"},
    {"materials.*.young_modulus", kind::number, "Pa", "from the stiffnesses", positive, with_hertz, "of the particles"},
    {"materials.*.poisson_ratio", kind::number, "", required, {-1, 0.5, true, "> -1 and <= 0.5"}, young_given, "of the particles"},

    {"particles", kind::table, "", required, any, with_particles, ""},
    {"particles.position", kind::points, "m", required, any, no_file, "list of points"},
    {"particles.radius", kind::each_number, "m", required, positive, no_file, "one for all or one per particle"},
    {"particles.material", kind::each_text, "", required, any, no_file | material_used, "name; one for all or one per particle"},
    {"particles.velocity", kind::points, "m/s", "0", any, no_file | moving, "one per particle"},
    {"particles.spin", kind::rotations, "rad/s", "0", any, no_file | moving, "one per particle"},
    {"particles.fix", kind::tables, "", "none", any, moving, "held particles"},
    {"particles.fix[].particles", kind::numbers, "", required, any, always, "numbers of the held particles"},
    {"particles.fix[].axes", kind::text, "", required, any, always, "held axes: some of the letters \"xyzr\"; r: rotation"},
    {"particles.file", kind::text, "", "", any, always,
     "CSV file instead of the lists, relative to the TOML file; columns position.x, position.y, radius; optional material, "
     "density, velocity.x, ..., spin; files of ParaView, Yade and spreadsheets also work"},

    {"bonds", kind::table, "", "", any, moving | with_particles | with_bonds, ""},
    {"bonds.pairs", kind::pairs, "", required, any, listed_bonds, "list of pairs of particles"},
    {"bonds.touching", kind::flag, "", "false", any, always, "bonds all pairs whose gap is at most gap, sorted by particle numbers"},
    {"bonds.gap", kind::number, "m", required, not_negative, touching_bonds, "largest gap of a bonded pair; rounding may add 1e-9 of the radii; at most ten times the median radius"},
    {"bonds.normal_stiffness", kind::each_number, "N/m", "the material's", positive, always, "one for all or one per pair"},
    {"bonds.shear_stiffness", kind::each_number, "N/m", "the material's", not_negative, always, "one for all or one per pair"},
    {"bonds.bending_stiffness", kind::each_number, "N m/rad", "from the stiffnesses", not_negative, with_parallel_bonds,
     "one for all or one per pair"},
    {"bonds.tensile_force", kind::each_number, "N", "the material's", not_negative, always,
     "breaks the bond in pure tension; one for all or one per pair"},
    {"bonds.shear_force", kind::each_number, "N", "the material's", not_negative, always,
     "breaks the bond in pure shear; one for all or one per pair"},

    {"walls", kind::tables, "", "none", any, moving | with_particles | with_contacts, "infinite rigid planes"},
    {"walls[].point", kind::vector, "m", required, any, always, "a point on the plane"},
    {"walls[].normal", kind::vector, "", required, any, always, "points to the particles' side"},
    {"walls[].normal_stiffness", kind::number, "N/m", required, positive, no_young, "as of a material"},
    {"walls[].shear_stiffness", kind::number, "N/m", required, not_negative, no_young, "as of a material"},
    {"walls[].friction", kind::number, "", required, not_negative, always, "as of a material"},
    {"walls[].young_modulus", kind::number, "Pa", "from the stiffnesses", positive, with_hertz, "as of a material"},
    {"walls[].poisson_ratio", kind::number, "", required, {-1, 0.5, true, "> -1 and <= 0.5"}, young_given, "as of a material"},

    {"loads", kind::tables, "", "none", any, moving | with_particles, "loads on one particle add up and must have the same ramp_time"},
    {"loads[].particles", kind::numbers, "", required, any, no_pressure, "numbers of the loaded particles"},
    {"loads[].force", kind::vector, "N", "0", any, no_pressure | no_velocity, "on each particle"},
    {"loads[].torque", kind::rotation, "N m", "0", any, no_pressure | no_velocity, "on each particle"},
    {"loads[].velocity", kind::vector, "m/s", "", any, no_pressure, "prescribed along all axes, instead of a force"},
    {"loads[].pressure", kind::number, "Pa", "", any, in_plane, "instead of particles: each particle of a row takes pressure times its area"},
    {"loads[].area", kind::word, "", "\"strip\"", one_of("strip|disc"), pressure_given,
     "strip: 2 r thickness, the particle's side; disc: pi r^2, its face"},
    {"loads[].side", kind::word, "", "\"top\"", one_of("top|bottom|left|right"), pressure_given,
     "the row: particles whose centre is visible from this side"},
    {"loads[].margin_diameters", kind::number, "", "0", not_negative, pressure_given,
     "leaves out particles within this many mean diameters of the row's ends"},
    {"loads[].ramp_time", kind::number, "s", "0", not_negative, always, "linear from the previous load or velocity, at the start from zero"},

    {"fluid", kind::table, "", "none", any, in_plane, "pore fluid"},
    {"fluid.bulk_modulus", kind::number, "Pa", required, positive, always, ""},
    {"fluid.conductivity", kind::number, "m/(s Pa)", required, not_negative, always, "k in a throat's conductance C = k a^3 / l"},
    {"fluid.aperture", kind::table, "", required, any, with_particles, "of the throats; with flow alone that of touching particles at zero force"},
    {"fluid.aperture.law", kind::word, "", required, one_of("contact_force|constant"), always, ""},
    {"fluid.aperture.a0", kind::number, "m", required, positive, contact_aperture, "aperture at zero force"},
    {"fluid.aperture.F0", kind::number, "N", required, positive, contact_aperture | moving | with_forces, "compressive force that halves the aperture"},
    {"fluid.aperture.gap_multiplier", kind::number, "", "1", fraction, contact_aperture | moving, "share of an open gap that is added to the aperture"},
    {"fluid.aperture.value", kind::number, "m", required, not_negative, constant_aperture, ""},
    {"fluid.solver", kind::word, "", "\"explicit\"", one_of("explicit|implicit"), always, ""},
    {"fluid.time_step", kind::step, "s", "\"auto\"", positive, always,
     "auto: in a particle step as many explicit steps as stability needs, or one implicit step; with flow alone simulation.time_step"},
    {"fluid.initial_pressure", kind::number, "Pa", "0", any, always, ""},
    {"fluid.boundary", kind::word, "", "\"sealed\"", one_of("sealed|drained"), with_particles, "outer edge of the packing"},
    {"fluid.boundary_pressure", kind::number, "Pa", "0", any, drained, ""},
    {"fluid.reservoirs", kind::tables, "", "none", any, always, "pores with a fixed pressure"},
    {"fluid.reservoirs[].near", kind::vector, "m", "", any, with_particles | no_pore, "the pore nearest to a point"},
    {"fluid.reservoirs[].pore", kind::index, "", "", any, lasting_pores, "number of the pore, as in summary.json"},
    {"fluid.reservoirs[].pressure", kind::number, "Pa", required, any, always, ""},
    {"fluid.sources", kind::tables, "", "none", any, always, "pores into which fluid is injected"},
    {"fluid.sources[].near", kind::vector, "m", "", any, with_particles | no_pore, "the pore nearest to a point"},
    {"fluid.sources[].pore", kind::index, "", "", any, lasting_pores, "number of the pore, as in summary.json"},
    {"fluid.sources[].flow", kind::number, "m^3/s", required, any, always, ""},
    {"fluid.minimum_pressure", kind::number, "Pa", "never", not_positive, explicit_flow, "the fluid tears instead of falling below it"},
    {"fluid.duration", kind::number, "s", "length of the run", positive, with_particles | moving,
     "throats with negligible flow within this time are left out"},
    {"fluid.remeshing", kind::table, "", "", any, moving | with_particles, "rebuilds the pores as particles move"},
    {"fluid.remeshing.rule", kind::word, "", required, one_of("never|when_needed"), always,
     "when_needed: when the mesh no longer fits the particles"},
    {"fluid.remeshing.interval", kind::whole, "", "100", {1, 1e9, false, "from 1 to 1e9"}, remeshed, "steps between two checks of the mesh"},
    {"fluid.remeshing.on_broken_bond", kind::flag, "", "false", any, remeshed | bonds_there, "also when a bond has failed"},
    {"fluid.merge_conductance", kind::number, "m^3/(s Pa)", "never", positive, always, "a throat of higher conductance merges its two pores"},
    {"fluid.mechanical_coupling", kind::flag, "", "true", any, with_particles, "false: particles do not move, flow alone"},
    {"fluid.network", kind::table, "", "", any, always, "pores and throats instead of particles"},
    {"fluid.network.pores", kind::tables, "", required, any, always, ""},
    {"fluid.network.pores[].volume", kind::number, "m^3", required, positive, always, ""},
    {"fluid.network.pores[].pressure", kind::number, "Pa", "0", any, always, "at the start"},
    {"fluid.network.throats", kind::tables, "", required, any, always, ""},
    {"fluid.network.throats[].pores", kind::two, "", required, any, always, "the two pores that it joins"},
    {"fluid.network.throats[].aperture", kind::number, "m", required, positive, always, ""},
    {"fluid.network.throats[].length", kind::number, "m", required, positive, always, ""},

    {"probes", kind::tables, "", "none", any, always, "columns of probes.csv after step and time"},
    {"probes[].quantity", kind::quantity, "", required, any, always, "see the list of quantities"},
    {"probes[].particle", kind::index, "", "", any, always, "number of the particle"},
    {"probes[].bond", kind::index, "", "", any, always, "number of the bond"},
    {"probes[].pair", kind::two, "", "", any, always, "the two particles of a contact"},
    {"probes[].pore", kind::index, "", "", any, no_throat | lasting_pores, "number of the pore; with throat.flow: the total flow into it"},
    {"probes[].near", kind::vector, "m", "", any, with_particles | no_pore | no_throat, "the nearest pore or throat"},
    {"probes[].throat", kind::index, "", "", any, bare_network, "number of the throat"},
    {"probes[].wall", kind::index, "", "", any, always, "number of the wall"},
    {"probes[].every", kind::whole, "", "1", {1, 1e15, false, "from 1 to 1e15 steps"}, always, "cells in between stay empty"},

    {"output", kind::table, "", "", any, always, ""},
    {"output.directory", kind::text, "", "\"out\"", any, always, "created if missing; relative to the working directory"},
    {"output.vtk_every", kind::whole, "", "0", steps_or_none, with_particles,
     "particles.pvd, bonds.pvd (mode: 0 intact, 1 tension, 2 shear), pores.pvd and their frames for ParaView; "
     "compressed in programs built with zlib"},
    {"output.picture_every", kind::whole, "", "0", steps_or_none, in_plane | with_particles, "PNG and SVG"},
    {"output.checkpoint_every", kind::whole, "", "0", steps_or_none, always, "checkpoint.bin, which replaces the last one"},
};

/// The row of the key with this path, or nullptr.
constexpr key const* find_key(std::string_view path) {
    for (key const& k : keys)
        if (path == k.path) return &k;
    return nullptr;
}

/// The text below the options in `--help`: all keys, the quantities of probes, the exit status.
std::string keys_help();
/// The README's table of one section ("simulation", "materials", ...), in Markdown.
std::string keys_markdown(std::string_view section);
/// The README's table of the quantities of probes, in Markdown.
std::string quantities_markdown();
/// Names of the sections, in the order of the help.
inline constexpr char const* sections[] = {"simulation", "materials", "particles", "bonds",  "walls",
                                           "loads",      "fluid",     "probes",    "output"};

} // namespace lacuna_run
