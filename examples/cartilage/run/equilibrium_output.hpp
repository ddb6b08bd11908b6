// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "cartilage/run/equilibrium_run.hpp"

namespace cartilage {

/// Names of the files that `equilibrium` writes, besides those of run_results().
std::vector<std::string> equilibrium_results();

/// The result as one JSON object. \param request whether the object has the whole request
std::string equilibrium_json(equilibrium_request const& r, equilibrium_run const& found, bool request);

/// The text of cracks.csv.
std::string equilibrium_cracks(equilibrium_run const& found);

/// A short table for the terminal.
void print_equilibrium(std::FILE* out, equilibrium_request const& r, specimen const& s, equilibrium_run const& found);

/// Draws each break by its load and its depth to `stem`.png and .svg. \throws std::runtime_error if a file cannot be
/// written
void draw_layers(std::string const& stem, equilibrium_request const& r, specimen const& s,
                 equilibrium_run const& found);

} // namespace cartilage
