// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fuzz {

/// Thrown for a model that is not compiled into the target: the deck is skipped.
struct other_kind {};

/// The state of a run, in a form that does not depend on the kind of model.
struct run_facts {
    std::uint64_t hash = 0;                   ///< of the complete state
    std::vector<std::array<double, 9>> state; ///< position, velocity and spin of each particle, by its number
};

/// Summary of all steps of a run.
struct step_facts {
    std::string message;        ///< of an unstable run; empty: the run completed
    std::uint64_t hash = 0;     ///< of the complete state after the last step
    bool finite = true;         ///< all numbers of all particles, and the ledger
    double share = 0;           ///< largest ratio of the step to its bound, 1
    double energy = 0;          ///< largest term of the ledger, J
    double spent = 0;           ///< energy dissipated by friction and damping, J
    double residual = 0;        ///< largest residual of the ledger, J
    double energy_rounding = 0; ///< estimated largest error of the ledger in one step due to rounding, J
    double momentum_change = 0; ///< largest change of momentum since the start, along an axis, kg m/s
    double momentum_rounding = 0; ///< estimated largest error of the momentum in one step due to rounding, kg m/s
};

class watched {
public:
    virtual ~watched() = default;
    /// \param with_hash false for an unstable run, whose state may not be writable
    virtual run_facts facts(bool with_hash) const = 0;
    /// Runs a copy and observes each step.
    virtual step_facts rehearse(long long steps) const = 0;
};

} // namespace fuzz
