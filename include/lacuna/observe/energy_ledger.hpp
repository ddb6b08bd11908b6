// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Where the energy of a run is, and where it went. All in J, all at the positions of the last forces.
///
/// Consistent with the integrator: kinetic energy from the product of the velocities half a step before and
/// after the positions, work as the mean of two forces times the displacement between them. In a linear system
/// without friction the residual is then rounding; friction, opening contacts and large rotations add errors of
/// the order of the time step.
struct energy_ledger {
    double kinetic = 0;       ///< translation and rotation
    double strain = 0;        ///< elastic, in bonds, contacts and walls
    double friction = 0;      ///< dissipated by sliding and by bonds crushed at their compressive limit
    double damping = 0;       ///< taken out by damping policies
    double fracture = 0;      ///< taken out of the springs by failing bonds
    double fluid_storage = 0; ///< compressed fluid
    double fluid_viscous = 0; ///< dissipated in throats
    double fluid_outflow = 0; ///< carried out through drained boundaries and cut off by limits of the fluid
    double fluid_remesh = 0;  ///< taken out of the compressed fluid where pores were triangulated anew
    double external = 0;      ///< work of loads, gravity, and prescribed motion
    double initial = 0;       ///< energy in the system at the start

    double rotation = 0;       ///< of kinetic: of spins
    double bond_strain = 0;    ///< of strain: in bonds
    double shear_fracture = 0; ///< of fracture: by bonds that failed in shear
    double prescribed = 0;     ///< of external: by prescribed motion, velocities given included
    double fluid_work = 0;     ///< exchanged within: done by the fluid's pressure on the particles

    /// What does not add up: energy that is there or was spent, less energy that came in.
    double residual() const noexcept {
        return kinetic + strain + friction + damping + fracture + fluid_storage + fluid_viscous + fluid_outflow +
               fluid_remesh - external - initial;
    }
    /// The largest term, to which a residual is to be compared.
    double largest() const noexcept {
        double m = 0;
        for (double const term : {kinetic, strain, friction, damping, fracture, fluid_storage, fluid_viscous,
                                  fluid_outflow, fluid_remesh, external, initial})
            m = std::max(m, std::fabs(term));
        return m;
    }
};

} // namespace lacuna
