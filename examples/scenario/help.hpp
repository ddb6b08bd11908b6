// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lacuna_run {

/// Every key of a scenario, for --help.
inline constexpr char const* keys_text = R"(
A scenario is one TOML file in SI units. Keys with a default may be left out.

[simulation]
  dimension = 2               2 or 3
  real = "double"             or "float"
  thickness = 1.0             m, out of the plane (dimension 2)
  mass                        "disc" (default in 2D): density pi r^2 thickness; "sphere" (default in 3D)
  contact_law = "frictional_spring"   "none", "frictional_spring", "hertz_mindlin"
  bond_law = "brittle_spring"         "none", "brittle_spring", "parallel_bond"
  integrator = "symplectic_euler"     or "velocity_verlet"
  time_step = "auto"          or s; auto: safety times the rigorous bound, found again when bonds or contacts change
  safety = 0.2                above 0, at most 1
  allow_unstable_step = false run even with a time_step above the bound
  steps or end_time           exactly one: a number of steps, or s
  gravity = [0, 0]            m/s^2
  fluid_density = 0           kg/m^3, of a fluid at rest that takes its share of the weights
  threads = 1
  damping = { local = 0, mass = 0, viscous = 0 }   factor 0 to 1; 1/s; ratio of critical damping
[materials.NAME]              any number
  density                     kg/m^3
  normal_stiffness, shear_stiffness   N/m
  friction
  tensile_strength, shear_strength    Pa, of bonds; left out: never breaks
  young_modulus, poisson_ratio        Pa, of hertz_mindlin; left out: two mean particles have the stiffnesses above at
                              an overlap of 1 % of a radius
[particles]                   (or file = "NAME.csv" with columns position.x, position.y, radius, material, ...)
  position = [[x, y], ...]    m
  radius, material            one for all or one per particle
  velocity, spin              m/s, rad/s, one per particle; default 0
  fix = [ { particles = [0], axes = "xyr" } ]      r: rotation
[bonds]
  pairs = [[0, 1], ...]       or touching = true with gap (m): all pairs up to that gap
  normal_stiffness, shear_stiffness (N/m), bending_stiffness (N m/rad, parallel_bond), tensile_force, shear_force (N):
                              one for all or one per pair, in place of the materials'
[[walls]]                     rigid, infinite; particles are where the normal points
  point, normal               m
  normal_stiffness, shear_stiffness, friction (young_modulus, poisson_ratio)
[[loads]]
  particles = [1]             with force (N), torque (N m), or velocity (m/s, prescribed)
  pressure                    Pa, on a row of particles (pi r^2 each): side = "top" | "bottom" | "left" | "right",
                              margin_diameters = 0: not so near to the row's ends
  ramp_time = 0               s, linear from zero
[fluid]                       dimension 2
  bulk_modulus                Pa
  conductivity                k of C = k a^3 / l
  aperture                    { law = "contact_force", a0 (m), F0 (N), gap_multiplier = 1 } or { law = "constant", value }
  solver = "explicit"         or "implicit"
  time_step = "auto"          or s
  initial_pressure = 0        Pa
  boundary = "sealed"         or "drained", at boundary_pressure = 0
  reservoirs = [ { near = [x, y] or pore = i, pressure } ]
  sources = [ { near = [x, y] or pore = i, flow (m^3/s) } ]
  merge_conductance           a throat above it merges its two pores
  mechanical_coupling = true  false: rigid particles, flow only
  network = { pores = [ { volume, pressure } ], throats = [ { pores = [0, 1], aperture, length } ] }   without particles
[[probes]]                    columns of probes.csv after step and time
  quantity                    position.x|y|z velocity.x|y|z spin rotation force.x|y|z torque (particle = i)
                              bond.normal_force bond.shear_force bond.broken (bond = i)
                              contact.normal_force contact.shear_force (pair = [i, j])
                              pore.pressure pore.volume (pore = i or near = [x, y])
                              throat.flow (near; pore = i: all that flows into it; throat = i of a bare network)
                              wall.force.x|y (wall = i)
                              energy.kinetic|strain|friction|damping|fracture|fluid|external|residual
                              count.broken_tension|broken_shear|contacts
  every = 1                   steps
[output]
  directory = "out"           probes.csv, events.csv (each bond break), summary.json
  vtk_every = 0, picture_every = 0, checkpoint_every = 0    steps; 0: none

Exit status: 0 done, 1 a file could not be written, 2 the scenario is refused (nothing is written), 3 the run went unstable
(what it had told so far is written).
)";

} // namespace lacuna_run
