// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <lacuna/observe/run_directory.hpp>

#include "outcome.hpp"

namespace poroelasticity {

/// The outcome as JSON: case, numbers of particles, pores and steps, and the list `rows`.
std::string to_json(outcome const& o);
/// Prints the rows as a table.
void print_rows(std::FILE* out, outcome const& o);

/// Names of all files that a case may write.
std::vector<std::string> result_names(std::string const& name);

/// Writes <case>.csv (all points of all curves) and <case>.png (the field, and the curves with their closed forms).
/// Each file is complete as soon as it appears. A case that a signal stopped gets <case>-stopped.json instead of the
/// picture.
/// \throws std::runtime_error for a file that cannot be written
void write_files(lacuna::run_directory& directory, outcome const& o);

} // namespace poroelasticity
