// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fuzz {

/// A model that is not compiled into the target: the deck is passed over.
struct other_kind {};

/// Where a run is, in numbers that do not depend on the kind of model.
struct run_facts {
    std::uint64_t hash = 0;                   ///< of the complete state
    std::vector<std::array<double, 9>> state; ///< position, velocity, spin, by the number of the particle
};

/// What was seen in all steps of a run.
struct step_facts {
    std::string message;        ///< of the unstable run; empty: it came to its end
    std::uint64_t hash = 0;     ///< of the complete state after the last step
    bool finite = true;         ///< all numbers of all particles, and the ledger
    double share = 0;           ///< the largest of the step over its bound
    double energy = 0;          ///< the largest term of the ledger, J
    double spent = 0;           ///< what friction and damping took, J
    double residual = 0;        ///< the largest of the ledger, J
    double energy_rounding = 0; ///< what rounding makes of the ledger in a step at most, J, about
    double momentum_change = 0; ///< the largest from the beginning, along an axis, kg m/s
    double momentum_rounding = 0;
};

class watched {
public:
    virtual ~watched() = default;
    /// \param with_hash of a state that can be written: not of an unstable one
    virtual run_facts facts(bool with_hash) const = 0;
    /// Runs a copy and looks at each step.
    virtual step_facts rehearse(long long steps) const = 0;
};

} // namespace fuzz
