// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#if defined(LACUNA_HAS_CHECKPOINTS) && __has_include(<lacuna/simulation/checkpoint.hpp>)
#define LACUNA_RUN_CHECKPOINTS
#include <lacuna/simulation/checkpoint.hpp>
#endif

#include "journal.hpp"

namespace lacuna_run {

/// Starts a new probes.csv in the journal if a resumed run has other probes.
inline void begin_other_probes(journal& restored, std::string const& heading) {
    if (restored.heading == heading) return;
    restored.heading = heading;
    restored.probes = {};
}

} // namespace lacuna_run
