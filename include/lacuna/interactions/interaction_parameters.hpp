// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// Settings of the pair interactions.
struct interaction_parameters {
    /// Verlet skin over the median radius, 1: how much closer two particles come that are no candidates before these are sought
    /// anew.
    double skin = 0.1;
    /// Pairs, and particles at walls, whose gap or overlap in the initial packing is below this fraction of the (smaller)
    /// radius start as touching at zero force, at the distance they have; 0: every overlap is a force.
    double initial_contact_tolerance = 0;

    /// False: particles pass through each other, bonds apart. What no_contact settles for a model, for one run.
    bool contacts = true;

    void validate(std::string const& name) const {
        require_not_negative(name + ".skin", skin);
        require_in(name + ".initial_contact_tolerance", initial_contact_tolerance, 0, 0.5);
    }
};

} // namespace lacuna
