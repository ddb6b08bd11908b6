// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "cartilage/common/options.hpp"
#include "cartilage/run/criterion.hpp"
#include "cartilage/run/load_run.hpp"
#include "cartilage/specimen/specimen.hpp"

/// \file
/// A run of one packing at one load that stops at a criterion and can be continued.

namespace cartilage {

/// A run that stops where a criterion is met and can continue from there to the next one.
class resumable_run {
public:
    virtual ~resumable_run() = default;
    /// Continues until the criterion is met or the run is over. If the run does not count, load_run::invalid says why.
    /// \throws interruption if a signal asks to stop
    virtual load_run run_until(criterion c) = 0;
};

/// Loads a specimen; it is at rest until run_until(). \param s has to outlive the run \param o load, model and duration
/// \throws std::invalid_argument if the model cannot be built
std::unique_ptr<resumable_run> start_load_run(specimen const& s, options const& o);

} // namespace cartilage
