// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenario.hpp"

/// \file
/// What a scenario states, as a checkpoint holds it, and how it is compared when a run goes on. These may be others then,
/// and act: loads, probes, output, simulation.steps, end_time, threads and guards. All else has to be the same, by its content: the
/// order of `fix` and of materials, defaults that are written out, a file in place of lists make no difference.

namespace lacuna_run {

/// Bytes that tell all that a scenario states.
std::string statement_of(scenario const& s);

/// The scenario that a run was begun or last resumed with, if `now` differs from it in nothing but what may change.
/// \param path of the checkpoint, for messages; \param told its statement
/// \throws refusal with the key that differs and both values; for a checkpoint that is not of a scenario
scenario earlier_scenario(std::string const& path, std::string const& told, scenario const& now);

} // namespace lacuna_run
