// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Energy balance of a simulation. All terms in J, at the positions of the last forces.
///
/// The terms are consistent with the integrator. Kinetic energy uses the product of the velocities half a step before
/// and after the positions. Work is the mean of two forces times the displacement between them. So in a linear system
/// without friction the residual is rounding. Friction, opening contacts and large rotations add errors of the order of
/// the time step.
struct energy_ledger {
    double kinetic = 0;       ///< kinetic energy of translation and rotation
    double strain = 0;        ///< elastic energy in bonds, contacts and walls
    double friction = 0;      ///< dissipated by sliding, and by bonds that yield at their compressive limit
    double damping = 0;       ///< dissipated by damping policies
    double fracture = 0;      ///< lost from springs when bonds fail
    double fluid_storage = 0; ///< energy of the compressed fluid
    double fluid_viscous = 0; ///< dissipated in throats
    double fluid_outflow = 0; ///< lost through drained boundaries and by limits of the fluid
    double fluid_remesh = 0;  ///< lost from the compressed fluid when pores are triangulated again
    double external = 0;      ///< work of loads, gravity, and prescribed motion
    double initial = 0;       ///< energy in the system at the start

    double rotation = 0;       ///< part of kinetic: energy of spins
    double bond_strain = 0;    ///< part of strain: energy in bonds
    double shear_fracture = 0; ///< part of fracture: lost by bonds that failed in shear
    double prescribed = 0;     ///< part of external: work of prescribed motion, including velocities set by the caller
    double fluid_work = 0;     ///< internal exchange: work of the fluid's pressure on the particles

    /// False: a law of the model states no energies, so that strain and friction lack its part.
    bool complete = true;

    /// The error of the balance: energy present or spent, minus energy supplied; not a number for an incomplete ledger.
    double residual() const noexcept {
        if (!complete) return std::numeric_limits<double>::quiet_NaN();
        return kinetic + strain + friction + damping + fracture + fluid_storage + fluid_viscous + fluid_outflow +
               fluid_remesh - external - initial;
    }
    /// The largest magnitude of a term, the scale of the residual.
    double largest() const noexcept {
        double m = 0;
        for (double const term : {kinetic, strain, friction, damping, fracture, fluid_storage, fluid_viscous,
                                  fluid_outflow, fluid_remesh, external, initial})
            m = std::max(m, std::fabs(term));
        return m;
    }
};

} // namespace lacuna
