// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>

#include "options.hpp"
#include "output.hpp"
#include "report.hpp"
#include "specimen.hpp"

namespace cartilage {

/// Asks a run to end after its current step; safe to call from a signal handler.
void request_stop() noexcept;

/// Loads the specimen and follows it to the end, with progress on `progress` (null: silent) and pictures on the way
/// into `out`, as the command line asks. `damage` receives the scene at the end.
/// \throws std::invalid_argument before the first step when the model cannot be built
/// \throws lacuna::unstable_run
run_result simulate(specimen const& s, options const& o, output_directory& out, std::FILE* progress,
                    lacuna::scene& damage);

} // namespace cartilage
