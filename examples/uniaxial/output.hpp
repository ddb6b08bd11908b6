// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

#include <lacuna/observe/run_directory.hpp>

#include "uniaxial.hpp"

namespace uniaxial {

/// The request and the outcome as JSON.
std::string to_json(outcome const& o);
/// Prints the results as a table.
void print(std::FILE* out, outcome const& o);
/// Writes uniaxial.png, uniaxial.svg and, last, uniaxial.json.
/// \throws std::runtime_error for a file that cannot be written
void write_files(lacuna::run_directory const& directory, outcome const& o);
/// Writes the picture as PNG and SVG.
/// \param stem path without extension
/// \throws std::runtime_error for a file that cannot be written
void save_picture(std::string const& stem, outcome const& o);

} // namespace uniaxial
