// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "cartilage/calibrate/calibrate.hpp"

namespace cartilage {

/// All sets as CSV, in the order of their trial: misfit, free choices and medians.
std::string calibration_csv(calibrate_options const& o, std::vector<calibrated_set> const& sets);

/// Writes calibration.csv, .json, .html and best.choices. \param best index of the best set
/// \throws std::runtime_error if a file cannot be written
void write_calibration(std::string const& directory, calibrate_options const& o,
                       std::vector<calibrated_set> const& sets, std::size_t best);

/// Prints one line: number, misfit, free choices and medians.
void print_set(std::FILE* out, std::size_t number, std::size_t of, calibrated_set const& set,
               std::vector<choice_field const*> const& free);
/// Prints each load of the paper beside the median of a set.
void print_best(std::FILE* out, calibrated_set const& set);

} // namespace cartilage
