// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "key_kinds.hpp"

/// \file
/// Every key of a scenario, in one table: what may stand there, in which unit, what holds without it, and where it means
/// something. Reading, refusals, `--help` and the README's tables follow from it. A new key is one row here and one line
/// where it is used (`table::number("key")` and the like, toml_table.hpp).

namespace lacuna_run {

inline constexpr key keys[] = {
    {"simulation", kind::table, "", required, any, always, ""},
    {"simulation.dimension", kind::whole, "", "2", {2, 3, false, "2 or 3"}, always, "2: the plane, 3: space"},
    {"simulation.real", kind::word, "", "\"double\"", one_of("double|float"), always, "precision of the numbers"},
    {"simulation.thickness", kind::number, "m", "1.0", positive, in_plane | with_particles | thickness_used, "out of the plane"},
    {"simulation.mass", kind::word, "", "\"disc\" (3D: \"sphere\")", one_of("disc|sphere"), moving | with_particles,
     "disc: density pi r^2 thickness, I = m r^2/2; sphere: density 4/3 pi r^3, I = 2/5 m r^2"},
    {"simulation.contact_law", kind::word, "", "\"frictional_spring\"", one_of("none|frictional_spring|hertz_mindlin"), moving | with_particles, ""},
    {"simulation.bond_law", kind::word, "", "\"brittle_spring\"", one_of("none|brittle_spring|parallel_bond"), moving | with_particles | bonds_for_it, ""},
    {"simulation.integrator", kind::word, "", "\"symplectic_euler\"", one_of("symplectic_euler|velocity_verlet"), moving | with_particles,
     "velocity_verlet: velocities are those at the time of the positions"},
    {"simulation.time_step", kind::step, "s", "\"auto\"", positive, own_step,
     "auto: safety times the rigorous bound, found again as contacts form or get deeper and bonds fail"},
    {"simulation.safety", kind::number, "", "0.2", {0, 1, true, "> 0 and <= 1"}, auto_step, "times the bound is the step of \"auto\""},
    {"simulation.allow_unstable_step", kind::flag, "", "false", any, bounded_step, "run even with a time_step that is above the bound or comes to be so"},
    {"simulation.steps", kind::whole, "", "", {0, 1e15, false, "from 0 to 1e15"}, always, "of these or end_time exactly one is given"},
    {"simulation.end_time", kind::number, "s", "", positive, no_steps, "the time at which the run ends"},
    {"simulation.gravity", kind::vector, "m/s^2", "0", any, moving | with_particles, "acceleration of all particles"},
    {"simulation.fluid_density", kind::number, "kg/m^3", "0", not_negative, moving | with_particles | gravity_given,
     "a fluid at rest takes the weight of what the particles displace; pressures are those above hydrostatic"},
    {"simulation.threads", kind::whole, "", "1", {1, 1024, false, "from 1 to 1024"}, always, "results do not depend on it"},
    {"simulation.damping", kind::table, "", "", any, moving | with_particles, ""},
    {"simulation.damping.local", kind::number, "", "0", fraction, always, "factor of local damping"},
    {"simulation.damping.mass", kind::number, "1/s", "0", not_negative, always, "drag over momentum"},
    {"simulation.damping.viscous", kind::number, "", "0", not_negative, with_forces, "ratio of critical damping of bonds and contacts"},
    {"simulation.guards", kind::table, "", "", any, moving | with_particles, ""},
    {"simulation.guards.growth", kind::flag, "", "true", any, always,
     "speeds grow fourfold in every 16 steps and turn round in nearly every step; never with allow_unstable_step"},
    {"simulation.guards.energy", kind::flag, "", "true", any, always,
     "more than half of the energy has come from nowhere; never with allow_unstable_step"},
    {"simulation.guards.overlap", kind::flag, "", "true", any, always, "two particles overlap by more than overlap_limit"},
    {"simulation.guards.overlap_limit", kind::number, "", "1", positive, always, "over the smaller radius"},
    {"simulation.guards.motion", kind::flag, "", "true", any, always, "a particle or a wall moves by more than motion_limit in a step"},
    {"simulation.guards.motion_limit", kind::number, "", "0.1", positive, always, "over the radius; a turn by ten times that, rad"},
    {"simulation.guards.resolution", kind::flag, "", "true", any, always,
     "places too far from the origin for the precision, motion that is lost to rounding"},
    {"simulation.guards.walls", kind::flag, "", "true", any, always, "the centre of a particle is beyond a wall"},
    {"simulation.guards.pores", kind::flag, "", "true", any, always, "a pore is turned over"},

    {"materials", kind::named, "", required, any, materials_named | with_particles, "materials by name"},
    {"materials.*", kind::table, "", "", any, always, ""},
    {"materials.*.density", kind::number, "kg/m^3", required, positive, density_used, ""},
    {"materials.*.normal_stiffness", kind::number, "N/m", required, positive, normal_used | normal_besides_young, "of contacts and bonds"},
    {"materials.*.shear_stiffness", kind::number, "N/m", required, not_negative, shear_used | shear_besides_young, "of contacts and bonds"},
    {"materials.*.friction", kind::number, "", required, not_negative, friction_used, "coefficient"},
    {"materials.*.tensile_strength", kind::number, "Pa", "never breaks", not_negative, tension_used, "times the bond's area"},
    {"materials.*.shear_strength", kind::number, "Pa", "never breaks", not_negative, shearing_used, "times the bond's area"},
    {"materials.*.young_modulus", kind::number, "Pa", "from the stiffnesses", positive, with_hertz, "of the particles"},
    {"materials.*.poisson_ratio", kind::number, "", required, {-1, 0.5, true, "> -1 and <= 0.5"}, young_given, "of young_modulus"},

    {"particles", kind::table, "", required, any, with_particles, ""},
    {"particles.position", kind::points, "m", required, any, no_file, "list of points"},
    {"particles.radius", kind::each_number, "m", required, positive, no_file, "one for all or one per particle"},
    {"particles.material", kind::each_text, "", required, any, no_file | material_used, "name; one for all or one per particle"},
    {"particles.velocity", kind::points, "m/s", "0", any, no_file | moving, "one per particle"},
    {"particles.spin", kind::turns, "rad/s", "0", any, no_file | moving, "one per particle"},
    {"particles.fix", kind::tables, "", "none", any, moving, "particles that are held"},
    {"particles.fix[].particles", kind::numbers, "", required, any, always, "their numbers"},
    {"particles.fix[].axes", kind::text, "", required, any, always, "some of the letters \"xyzr\"; r: rotation"},
    {"particles.file", kind::text, "", "", any, always,
     "CSV in place of the lists (relative to the TOML file), columns position.x, position.y, radius, and if wanted material, "
     "density, velocity.x, ..., spin, or as ParaView, Yade and spreadsheets write them"},

    {"bonds", kind::table, "", "", any, moving | with_particles | with_bonds, ""},
    {"bonds.pairs", kind::pairs, "", required, any, listed_bonds, "list of pairs of particles"},
    {"bonds.touching", kind::flag, "", "false", any, always, "all pairs whose gap is at most gap, numbered by particles"},
    {"bonds.gap", kind::number, "m", required, not_negative, touching_bonds, "the largest of bonded pairs, but for rounding (1e-9 of the radii); at most ten times the median radius"},
    {"bonds.normal_stiffness", kind::each_number, "N/m", "the material's", positive, always, "one or one per pair"},
    {"bonds.shear_stiffness", kind::each_number, "N/m", "the material's", not_negative, always, "one or one per pair"},
    {"bonds.bending_stiffness", kind::each_number, "N m/rad", "from the stiffnesses", not_negative, with_parallel_bonds,
     "one or one per pair"},
    {"bonds.tensile_force", kind::each_number, "N", "the material's", not_negative, always,
     "at which a bond breaks in pure tension; one or one per pair"},
    {"bonds.shear_force", kind::each_number, "N", "the material's", not_negative, always,
     "at which a bond breaks in pure shear; one or one per pair"},

    {"walls", kind::tables, "", "none", any, moving | with_particles | with_contacts, "rigid planes without end"},
    {"walls[].point", kind::vector, "m", required, any, always, "on the plane"},
    {"walls[].normal", kind::vector, "", required, any, always, "to the side where the particles are"},
    {"walls[].normal_stiffness", kind::number, "N/m", required, positive, no_young, "as a material's"},
    {"walls[].shear_stiffness", kind::number, "N/m", required, not_negative, no_young, "as a material's"},
    {"walls[].friction", kind::number, "", required, not_negative, always, "as a material's"},
    {"walls[].young_modulus", kind::number, "Pa", "from the stiffnesses", positive, with_hertz, "as a material's"},
    {"walls[].poisson_ratio", kind::number, "", required, {-1, 0.5, true, "> -1 and <= 0.5"}, young_given, "of young_modulus"},

    {"loads", kind::tables, "", "none", any, moving | with_particles, "loads on one particle add up and must rise together"},
    {"loads[].particles", kind::numbers, "", required, any, no_pressure, "numbers of the loaded particles"},
    {"loads[].force", kind::vector, "N", "0", any, no_pressure | no_velocity, "on each"},
    {"loads[].torque", kind::turn, "N m", "0", any, no_pressure | no_velocity, "on each"},
    {"loads[].velocity", kind::vector, "m/s", "", any, no_pressure, "prescribed, in place of a force; all axes"},
    {"loads[].pressure", kind::number, "Pa", "", any, in_plane, "in place of particles: on each of a row, times its area"},
    {"loads[].area", kind::word, "", "\"strip\"", one_of("strip|disc"), pressure_given,
     "strip: 2 r thickness of the particle's side; disc: pi r^2, its face"},
    {"loads[].side", kind::word, "", "\"top\"", one_of("top|bottom|left|right"), pressure_given,
     "the row of particles whose centre is seen from there"},
    {"loads[].margin_diameters", kind::number, "", "0", not_negative, pressure_given,
     "leaves out those nearer than that many mean diameters to the row's ends"},
    {"loads[].ramp_time", kind::number, "s", "0", not_negative, always, "linear from the load or velocity that acts before, at first none"},

    {"fluid", kind::table, "", "none", any, in_plane, "pore fluid"},
    {"fluid.bulk_modulus", kind::number, "Pa", required, positive, always, ""},
    {"fluid.conductivity", kind::number, "", required, not_negative, always, "k of C = k a^3 / l"},
    {"fluid.aperture", kind::table, "", required, any, with_particles, "of the throats; of flow alone that of touching particles without a force"},
    {"fluid.aperture.law", kind::word, "", required, one_of("contact_force|constant"), always, ""},
    {"fluid.aperture.a0", kind::number, "m", required, positive, contact_aperture, "without a force"},
    {"fluid.aperture.F0", kind::number, "N", required, positive, contact_aperture | moving | with_forces, "that halves the aperture"},
    {"fluid.aperture.gap_multiplier", kind::number, "", "1", fraction, contact_aperture | moving, "part of the gap that opens the throat"},
    {"fluid.aperture.value", kind::number, "m", required, not_negative, constant_aperture, ""},
    {"fluid.solver", kind::word, "", "\"explicit\"", one_of("explicit|implicit"), always, ""},
    {"fluid.time_step", kind::step, "s", "\"auto\"", positive, always,
     "auto: explicit as many flow steps in one of the particles as are safe, implicit one"},
    {"fluid.initial_pressure", kind::number, "Pa", "0", any, always, ""},
    {"fluid.boundary", kind::word, "", "\"sealed\"", one_of("sealed|drained"), with_particles, "the outer edge"},
    {"fluid.boundary_pressure", kind::number, "Pa", "0", any, drained, ""},
    {"fluid.reservoirs", kind::tables, "", "none", any, always, "pores whose pressure is kept"},
    {"fluid.reservoirs[].near", kind::vector, "m", "", any, with_particles | no_pore, "the pore nearest to a point"},
    {"fluid.reservoirs[].pore", kind::index, "", "", any, lasting_pores, "numbered as in summary.json"},
    {"fluid.reservoirs[].pressure", kind::number, "Pa", required, any, always, ""},
    {"fluid.sources", kind::tables, "", "none", any, always, "pores into which fluid is pumped"},
    {"fluid.sources[].near", kind::vector, "m", "", any, with_particles | no_pore, "the pore nearest to a point"},
    {"fluid.sources[].pore", kind::index, "", "", any, lasting_pores, "numbered as in summary.json"},
    {"fluid.sources[].flow", kind::number, "m^3/s", required, any, always, ""},
    {"fluid.minimum_pressure", kind::number, "Pa", "never", not_positive, explicit_flow, "below it the fluid tears"},
    {"fluid.duration", kind::number, "s", "that of the run", positive, with_particles | moving,
     "throats through which practically nothing passes within it are left out"},
    {"fluid.remeshing", kind::table, "", "", any, moving | with_particles, "pores made anew as particles move"},
    {"fluid.remeshing.rule", kind::word, "", required, one_of("never|when_needed"), always,
     "when_needed: where the mesh does not fit the particles any more"},
    {"fluid.remeshing.interval", kind::whole, "", "100", {1, 1e9, false, "from 1 to 1e9"}, remeshed, "steps between two looks at the mesh"},
    {"fluid.remeshing.on_broken_bond", kind::flag, "", "false", any, remeshed | bonds_there, "also where a bond has failed"},
    {"fluid.merge_conductance", kind::number, "m^3/(s Pa)", "never", positive, always, "a throat above it merges its two pores"},
    {"fluid.mechanical_coupling", kind::flag, "", "true", any, with_particles, "false: rigid particles, flow only"},
    {"fluid.network", kind::table, "", "", any, always, "pores and throats in place of particles"},
    {"fluid.network.pores", kind::tables, "", required, any, always, ""},
    {"fluid.network.pores[].volume", kind::number, "m^3", required, positive, always, ""},
    {"fluid.network.pores[].pressure", kind::number, "Pa", "0", any, always, "at the start"},
    {"fluid.network.throats", kind::tables, "", required, any, always, ""},
    {"fluid.network.throats[].pores", kind::two, "", required, any, always, "the two that it joins"},
    {"fluid.network.throats[].aperture", kind::number, "m", required, positive, always, ""},
    {"fluid.network.throats[].length", kind::number, "m", required, positive, always, ""},

    {"probes", kind::tables, "", "none", any, always, "columns of probes.csv after step and time"},
    {"probes[].quantity", kind::quantity, "", required, any, always, "one of those below"},
    {"probes[].particle", kind::index, "", "", any, always, "number of the particle"},
    {"probes[].bond", kind::index, "", "", any, always, "number of the bond"},
    {"probes[].pair", kind::two, "", "", any, always, "the two particles of a contact"},
    {"probes[].pore", kind::index, "", "", any, no_throat | lasting_pores, "number of the pore; of throat.flow: all that flows into it"},
    {"probes[].near", kind::vector, "m", "", any, with_particles | no_pore | no_throat, "the nearest pore or throat"},
    {"probes[].throat", kind::index, "", "", any, bare_network, "number of the throat"},
    {"probes[].wall", kind::index, "", "", any, always, "number of the wall"},
    {"probes[].every", kind::whole, "", "1", {1, 1e15, false, "from 1 to 1e15 steps"}, always, "cells in between are empty"},

    {"output", kind::table, "", "", any, always, ""},
    {"output.directory", kind::text, "", "\"out\"", any, always, "made where needed, relative to where the program runs"},
    {"output.vtk_every", kind::whole, "", "0", steps_or_none, with_particles,
     "steps; particles.pvd, bonds.pvd (mode: 0 intact, 1 tension, 2 shear), pores.pvd and their frames, for ParaView; "
     "compressed in programs built with zlib"},
    {"output.picture_every", kind::whole, "", "0", steps_or_none, in_plane | with_particles, "steps; PNG and SVG"},
    {"output.checkpoint_every", kind::whole, "", "0", steps_or_none, always, "steps; checkpoint.bin, the last one"},
};

/// The key of that path, or none.
constexpr key const* find_key(std::string_view path) {
    for (key const& k : keys)
        if (path == k.path) return &k;
    return nullptr;
}

/// The keys as `--help` shows them, with the quantities of probes and the exit status.
std::string keys_help();
/// The table of one section ("simulation", "materials", ...) as the README shows it.
std::string keys_markdown(std::string_view section);
/// The same of what probes read.
std::string quantities_markdown();
/// Names of the sections, in order.
inline constexpr char const* sections[] = {"simulation", "materials", "particles", "bonds",  "walls",
                                           "loads",      "fluid",     "probes",    "output"};

} // namespace lacuna_run
