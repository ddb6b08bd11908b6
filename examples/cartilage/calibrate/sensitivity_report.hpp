// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "cartilage/calibrate/sensitivity.hpp"

namespace cartilage {

/// The changes as CSV, one row for each variation, zone and load.
std::string sensitivity_csv(std::vector<variation> const& variations, choices const& base);

/// File name of a tornado plot, without its ending.
std::string tornado_stem(lacuna::cartilage_zone zone, threshold what);

/// Writes sensitivity.csv, sensitivity-<zone>-<load>.png and .svg, and sensitivity.html, which embeds the plots.
/// \param plain packings of the base \throws std::runtime_error if a file cannot be written
void write_sensitivity(std::string const& directory, study_options const& o, std::vector<packing_result> const& plain,
                       std::vector<variation> const& variations);

/// Prints the largest changes of each load.
void print_sensitivity(std::FILE* out, std::vector<variation> const& variations);

} // namespace cartilage
