// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <filesystem>

#include "outcome.hpp"

namespace poroelasticity {

/// The rows as a JSON text: an object with the case, what it took, and the list `rows`.
std::string to_json(outcome const& o);
/// The rows as a table for a person.
void print_rows(std::FILE* out, outcome const& o);

/// Writes <case>.csv (all points of all curves) and <case>.png (the field, and the curves with their closed forms) into
/// a directory, each whole or not at all.
/// \throws std::runtime_error when a file cannot be written
void write_files(std::filesystem::path const& directory, outcome const& o);

} // namespace poroelasticity
