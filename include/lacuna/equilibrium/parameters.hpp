// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/equilibrium/energy.hpp>

namespace lacuna {

/// What the fluid does while a model goes to equilibrium.
enum class pore_condition {
    sealed, ///< no fluid leaves a pore: its pressure follows its volume
    drained ///< pressures stay as they are: fluid flows in and out until then
};

/// Which bonds fail at once where a load is too high.
enum class failure_choice {
    first,          ///< the bond that fails first
    worst_of_groups ///< it, and in each other group of bonds that one that fails first
};

/// Parameters of an equilibrium.
struct equilibrium_parameters {
    /// Largest unbalanced force on a particle, as a share of the largest force that acts on a particle, 1; > 0, at most
    /// 0.1. Forces between contacts are exact to the same share.
    double tolerance = 1e-6;
    /// Least stiffness that is added to each freedom, as a share of the median normal stiffness of the pairs, 1; > 0.
    /// It acts on the motion since the last committed state, so that the forces that it adds go to zero.
    double regularisation = 1e-9;
    /// A model whose particles move further than this at constant load, without coming to rest, is a mechanism; as a
    /// share of the median radius, 1; > 0.
    double largest_motion = 4;
    int iterations = 200; ///< largest number of iterations of one solve; >= 1
    int solves = 200;     ///< largest number of solves at one load; >= 1
    pore_condition pores = pore_condition::sealed;
    failure_choice failures = failure_choice::first;

    /// \throws std::invalid_argument naming field, value and rule
    void validate(std::string const& name) const {
        if (!(tolerance > 0 && tolerance <= 0.1)) refuse(name + ".tolerance", tolerance, "> 0 and <= 0.1");
        if (!(regularisation > 0 && regularisation <= 1e-3))
            refuse(name + ".regularisation", regularisation, "> 0 and <= 1e-3");
        require_positive(name + ".largest_motion", largest_motion);
        require_in(name + ".iterations", iterations, 1, 1e6);
        require_in(name + ".solves", solves, 1, 1e6);
    }
};

/// How a search for an equilibrium ended.
enum class equilibrium_outcome {
    reached,      ///< the model is in equilibrium
    mechanism,    ///< there is none: displacements grow as the regularisation falls
    not_converged ///< neither was shown within the given numbers of iterations and solves
};

/// Displacement that one regularisation allowed, at constant load.
struct regularisation_trial {
    double regularisation; ///< share of the median normal stiffness, 1
    double displacement;   ///< largest displacement of a freedom in that solve, m
};

/// What a search for an equilibrium found.
struct equilibrium_result {
    equilibrium_outcome outcome = equilibrium_outcome::not_converged;
    /// Largest unbalanced force on a freedom at the end, by the exact laws and without regularisation, N.
    double unbalanced = 0;
    /// Largest force that acts on a particle: of a load, a pair or a pressure, N.
    double largest_force = 0;
    /// Largest product of a contact's force and its gap, over the largest force and overlap, 1.
    double complementarity = 0;
    /// Share of the first increment at which the first bond failed, 1: the load of the failure lies as far between the
    /// loads before and after; 1 if none failed then.
    double first_failure = 1;
    double displacement = 0;   ///< largest displacement of a freedom since the call, m
    double regularisation = 0; ///< least regularisation that was solved with, 1
    /// Regularisations of the solves and their displacements; in a mechanism they grow as 1 / regularisation.
    std::vector<regularisation_trial> trials;
    int solves = 0;
    int factorisations = 0;
    std::size_t fill = 0;   ///< numbers in the factors of the last matrix
    std::size_t broken = 0; ///< bonds that failed
    equilibrium_energy energy; ///< since the call, J

    bool reached() const noexcept { return outcome == equilibrium_outcome::reached; }
};

} // namespace lacuna
