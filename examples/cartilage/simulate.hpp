// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <stdexcept>

#include "options.hpp"
#include "output.hpp"
#include "report.hpp"
#include "specimen.hpp"

namespace cartilage {

/// Asks all runs to end after their current step; safe to call from a signal handler.
void request_stop() noexcept;
bool stop_is_requested() noexcept;

/// Work that was ended by request_stop() before it had a result.
class interruption : public std::runtime_error {
public:
    interruption() : std::runtime_error("interrupted") {}
};

/// Loads the specimen and follows it to the end, with progress on `progress` (null: silent) and pictures on the way
/// into `out`, as the command line asks. `damage` receives the scene at the end.
/// \throws std::invalid_argument before the first step when the model cannot be built
/// \throws lacuna::unstable_run
run_result simulate(specimen const& s, options const& o, output_directory& out, std::FILE* progress,
                    lacuna::scene& damage);

} // namespace cartilage
