// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// Guards: each ends a run whose state is no longer meaningful. Each can be switched off. A state that is not a number
/// always ends a run.
struct guard_parameters {
    /// Speeds grow fourfold in every 16 steps, and the velocities of the fastest particles reverse in nearly every
    /// step: the time step is above the stable limit. Growth alone ends no run. No effect with allow_unstable_step.
    bool growth = true;
    /// More than half of the energy has no source, and more than rounding can make. Works in steps with an energy
    /// ledger. No effect with allow_unstable_step.
    bool energy = true;
    /// Two particles in contact overlap by more than overlap_limit. So do two bonded particles that overlapped less at
    /// the start.
    bool overlap = true;
    double overlap_limit = 1; ///< largest overlap over the smaller radius, 1
    /// A particle or wall moves by more than motion_limit in one step, or a particle rotates by more than ten times
    /// that.
    bool motion = true;
    /// Largest path in a step over the radius (for walls: over the smallest radius), 1. The largest rotation in a step
    /// is ten times this number, rad.
    double motion_limit = 0.1;
    /// A particle is too far from the origin for the precision, or its motion is lost to rounding.
    bool resolution = true;
    /// The centre of a particle is beyond a wall.
    bool walls = true;
    /// The corners of a pore have passed each other.
    bool pores = true;

    /// overlap_limit; infinite if the guard is off.
    double largest_overlap() const noexcept {
        return overlap ? overlap_limit : std::numeric_limits<double>::infinity();
    }
    /// motion_limit; infinite if the guard is off.
    double largest_motion() const noexcept { return motion ? motion_limit : std::numeric_limits<double>::infinity(); }
    /// \throws std::invalid_argument with the part, the field, the value and the rule
    void validate(std::string const& name) const {
        require_positive(name + ".overlap_limit", overlap_limit);
        require_positive(name + ".motion_limit", motion_limit);
    }
};

} // namespace lacuna
