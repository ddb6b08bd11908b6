// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

#include <lacuna/observe/run_directory.hpp>

#include "uniaxial.hpp"

namespace uniaxial {

/// What was asked for and what came out, as JSON.
std::string to_json(outcome const& o);
/// The figures as a table.
void print(std::FILE* out, outcome const& o);
/// Writes uniaxial.png and uniaxial.svg, and last uniaxial.json. \throws std::runtime_error
void write_files(lacuna::run_directory const& directory, outcome const& o);
/// Writes the picture, as PNG and SVG. \param stem path without ending \throws std::runtime_error
void save_picture(std::string const& stem, outcome const& o);

} // namespace uniaxial
