// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/motion/symplectic_euler.hpp>

namespace lacuna {

/// Velocity Verlet in its leapfrog form. A velocity that the caller sets is the velocity at the time of the position,
/// so the first change of velocity after it covers half a step. Positions are those of velocity Verlet, of second order
/// in the step.
///
/// Between such calls, velocities belong to the time half a step before the positions, as in symplectic_euler:
/// dashpots, slips and the energy ledger need them at that time.
struct velocity_verlet : symplectic_euler {
    static constexpr bool starts_on_time = true;
};

/// True if, by the integrator's default, velocities that the caller sets are those at the time of the positions.
template <class Integrator>
inline constexpr bool starts_on_time = requires { requires Integrator::starts_on_time; };

} // namespace lacuna
