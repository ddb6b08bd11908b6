// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#if defined(LACUNA_HAS_CHECKPOINTS) && __has_include(<lacuna/simulation/checkpoint.hpp>)
#define LACUNA_RUN_CHECKPOINTS
#include <lacuna/simulation/checkpoint.hpp>
#endif

#include "journal.hpp"

namespace lacuna_run {

/// \throws refusal for a checkpoint of a run with other probes
inline void check_heading(std::string const& path, journal const& restored, std::string const& heading) {
    if (restored.heading != heading) throw refusal("checkpoint " + path + ": it was made with other probes");
}

} // namespace lacuna_run
