// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// Guards: what ends a run whose state means nothing any more. Each can be turned off by its name; a state that is not a
/// number always ends a run.
struct guard_parameters {
    /// Speeds that grow fourfold in every 16 steps while the fastest particles turn round in nearly every step: a time
    /// step above the stable one. Growth alone ends no run. Without effect under allow_unstable_step.
    bool growth = true;
    /// More than half of the energy has come from nowhere, and more than rounding makes; where a ledger is kept. Without
    /// effect under allow_unstable_step.
    bool energy = true;
    /// Two particles that overlap by more than overlap_limit: contacts, and bonds that were made at less.
    bool overlap = true;
    double overlap_limit = 1; ///< over the smaller radius, 1
    /// Particles and walls that move by more than motion_limit in one step, particles that turn by more than ten times that.
    bool motion = true;
    double motion_limit = 0.1; ///< path over the radius, of walls the smallest, 1; a tenth of an angle, rad
    /// Places too far from the origin for the precision in use, and motion that is lost to rounding.
    bool resolution = true;
    /// The centre of a particle beyond a wall.
    bool walls = true;
    /// Pores whose corners have passed each other.
    bool pores = true;

    /// The limits that are in force, infinite where switched off.
    double largest_overlap() const noexcept { return overlap ? overlap_limit : std::numeric_limits<double>::infinity(); }
    double largest_motion() const noexcept { return motion ? motion_limit : std::numeric_limits<double>::infinity(); }
    /// \throws std::invalid_argument naming the part, the field, the value and the rule.
    void validate(std::string const& name) const {
        require_positive(name + ".overlap_limit", overlap_limit);
        require_positive(name + ".motion_limit", motion_limit);
    }
};

} // namespace lacuna
