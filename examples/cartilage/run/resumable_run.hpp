// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "cartilage/common/options.hpp"
#include "cartilage/run/criterion.hpp"
#include "cartilage/run/load_run.hpp"
#include "cartilage/specimen/specimen.hpp"

/// \file
/// One packing under one load, followed only until a criterion is met.

namespace cartilage {

/// A run that waits where its last criterion was met, and goes on from there to the next.
class resumable_run {
public:
    virtual ~resumable_run() = default;
    /// Goes on until the criterion is met or the run is over. Where the run turns out not to count, `invalid` says why.
    /// \throws interruption when a signal asks to stop
    virtual load_run run_until(criterion c) = 0;
};

/// Loads a specimen, at rest until run_until(). \param s has to outlive the run \param o load, model and duration
/// \throws std::invalid_argument when the model cannot be built
std::unique_ptr<resumable_run> start_load_run(specimen const& s, options const& o);

} // namespace cartilage
