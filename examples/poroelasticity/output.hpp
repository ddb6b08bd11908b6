// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <lacuna/observe/run_directory.hpp>

#include "outcome.hpp"

namespace poroelasticity {

/// The rows as a JSON text: an object with the case, what it took, and the list `rows`.
std::string to_json(outcome const& o);
/// The rows as a table for a person.
void print_rows(std::FILE* out, outcome const& o);

/// Names of the files of a case.
std::vector<std::string> result_names(std::string const& name);

/// Writes <case>.csv (all points of all curves) and <case>.png (the field, and the curves with their closed forms) into
/// a directory, each whole or not at all; of a case that a signal stopped <case>-stopped.json, as to_json(), for the picture.
/// \throws std::runtime_error when a file cannot be written
void write_files(lacuna::run_directory& directory, outcome const& o);

} // namespace poroelasticity
