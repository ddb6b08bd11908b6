// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenario.hpp"

/// \file
/// The statement of a scenario: its content as stored in a checkpoint, compared when a run is resumed. Loads, probes,
/// output, and simulation.steps, end_time, threads and guards may change; new values take effect. Everything else must
/// have the same content. The order of `fix` and of materials, explicit defaults, and a file in place of lists do not
/// matter.

namespace lacuna_run {

/// The content of a scenario as bytes.
std::string statement_of(scenario const& s);

/// The scenario with which a run was started or last resumed. `now` may differ from it only where changes are allowed.
/// \param path of the checkpoint, for messages
/// \param earlier statement in the checkpoint
/// \throws refusal that names the differing key and both values; also for a checkpoint that was not made by a scenario
scenario earlier_scenario(std::string const& path, std::string const& earlier, scenario const& now);

} // namespace lacuna_run
