// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// Settings of the pair interactions.
struct interaction_parameters {
    /// Verlet skin over the median radius, 1. Two particles outside the candidate list may come this much closer before
    /// the list is rebuilt.
    double skin = 0.1;
    /// Fraction of the smaller radius, 1, from 0 to 0.5. Pairs (and particles at walls) of the initial packing with a
    /// smaller gap or overlap start as touching: their force is zero at that distance. 0: every overlap makes a force.
    double initial_contact_tolerance = 0;

    /// False: particles that are not bonded pass through each other in this run. The contact law no_contact does the
    /// same for a whole model.
    bool contacts = true;

    void validate(std::string const& name) const {
        require_not_negative(name + ".skin", skin);
        require_in(name + ".initial_contact_tolerance", initial_contact_tolerance, 0, 0.5);
    }
};

} // namespace lacuna
