// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "cartilage/calibrate/calibrate.hpp"

namespace cartilage {

/// All sets as CSV, in the order in which they were tried: misfit, the free choices, the medians.
std::string calibration_csv(calibrate_options const& o, std::vector<calibrated_set> const& sets);

/// Writes calibration.csv, .json, .html and best.choices. \param best of the sets
/// \throws std::runtime_error when a file cannot be written
void write_calibration(std::string const& directory, calibrate_options const& o,
                       std::vector<calibrated_set> const& sets, std::size_t best);

/// One line: number, misfit, the free choices, the medians.
void print_set(std::FILE* out, std::size_t number, std::size_t of, calibrated_set const& set,
               std::vector<choice_field const*> const& free);
/// How near a set comes to each number.
void print_best(std::FILE* out, calibrated_set const& set);

} // namespace cartilage
