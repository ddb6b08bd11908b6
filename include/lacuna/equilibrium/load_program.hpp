// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/equilibrium/energy.hpp>
#include <lacuna/equilibrium/parameters.hpp>

namespace lacuna {

/// One stage of a load program: a value, of a load or of a displacement, that goes from one number to another.
struct load_stage {
    double from = 0, to = 1; ///< in the unit of the program
    int steps = 10;          ///< equilibria on the way, >= 1, besides those at which bonds fail

    /// \throws std::invalid_argument naming field, value and rule
    void validate(std::string const& name) const {
        require_finite(name + ".from", from);
        require_finite(name + ".to", to);
        require_in(name + ".steps", steps, 1, 1e6);
    }
    double at(int step) const noexcept { return step == steps ? to : from + (to - from) * step / steps; }
};

/// One equilibrium of a load program.
struct load_point {
    double value;              ///< of the program
    std::size_t broken;        ///< bonds that failed since the program's start
    double unbalanced;         ///< largest unbalanced force on a freedom, by the exact laws, N
    double largest_force;      ///< largest force of a load, a pair or a pressure, N
    int factorisations;        ///< since the program's start
    equilibrium_energy energy; ///< since the program's start, J
};

/// An observer of load_points that does nothing.
struct ignore_point {
    void operator()(load_point const&) const noexcept {}
};

/// What a stage of a load program found.
struct load_path {
    equilibrium_outcome outcome = equilibrium_outcome::reached;
    /// Value of the program at the end: the last one if all equilibria were reached, that at which the observer ended
    /// the stage, else the value at which there is none, or at which none was found.
    double value = 0;
    std::vector<load_point> points; ///< the equilibria
    equilibrium_result last;        ///< of the last solve
    std::size_t broken = 0;         ///< bonds that failed
    int solves = 0;
    int factorisations = 0;
    equilibrium_energy energy; ///< J

    bool reached() const noexcept { return outcome == equilibrium_outcome::reached; }
};

} // namespace lacuna
