// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <stdexcept>

#include "options.hpp"
#include "output.hpp"
#include "report.hpp"
#include "specimen.hpp"

namespace cartilage {

/// Work that was ended by a signal (lacuna::stop_signal()) before it had a result.
class interruption : public std::runtime_error {
public:
    interruption() : std::runtime_error("interrupted") {}
};

/// Loads the specimen and follows it to the end, with progress on `progress` (null: silent) and pictures on the way
/// into `out`, as the command line asks, where cracks.csv grows. `damage` receives the scene at the end, which is after the
/// present step once a signal has come.
/// \throws std::invalid_argument before the first step when the model cannot be built
/// \throws lacuna::unstable_run
run_result simulate(specimen const& s, options const& o, lacuna::run_directory& out, std::FILE* progress,
                    lacuna::scene& damage);

} // namespace cartilage
