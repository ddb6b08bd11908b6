// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/interactions/break_event.hpp>

namespace lacuna {

/// A bond that failed on the way to equilibrium.
template <int Dim>
struct equilibrium_event : break_event<Dim> {
    /// Value of the load program at which it failed. In equilibrium::solve() the share of the change of the loads, 1
    /// for bonds that fail after others at constant load.
    double load = 1;
};

} // namespace lacuna
