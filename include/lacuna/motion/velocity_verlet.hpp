// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/motion/symplectic_euler.hpp>

namespace lacuna {

/// Velocity Verlet, in its leapfrog form: a velocity that a particle is given is that at the time of its position, so
/// the first kick after it is half a step's. Positions are those of velocity Verlet, of second order in the step.
///
/// In between, velocities stand half a step before positions, as in symplectic_euler: that is where dashpots, slips and
/// the energy ledger need them.
struct velocity_verlet : symplectic_euler {
    static constexpr bool starts_on_time = true;
};

/// Whether velocities given to particles are those at the time of the positions, by an integrator's default.
template <class Integrator>
inline constexpr bool starts_on_time = requires { requires Integrator::starts_on_time; };

} // namespace lacuna
