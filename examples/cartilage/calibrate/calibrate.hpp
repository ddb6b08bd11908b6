// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "cartilage/calibrate/calibration.hpp"
#include "cartilage/calibrate/comparison.hpp"
#include "cartilage/study/study_options.hpp"

namespace cartilage {

/// What is asked of `cartilage calibrate`.
struct calibrate_options {
    study_options study; ///< zones, seeds, loads, start, output
    std::vector<choice_field const*> free;
    std::size_t evaluations = 40;
};

/// One set and what it came to.
struct calibrated_set {
    choices open;
    double misfit = 0; ///< see misfit_of(); not a number: the set cannot be had
    std::string why;   ///< of a set that cannot be had
    std::vector<target_result> targets;
    std::vector<first_layer_count> first_layers;
};

/// Reads the command line after the word `calibrate`. \copydetails parse_command_line
std::optional<calibrate_options> parse_calibrate_command_line(int argc, char const* const* argv);

/// Fits the free choices, one set for all zones, and writes calibration.csv (all that was tried), calibration.json,
/// best.choices for --choices, and calibration.html: how near one set comes to each number.
/// \return the exit status \throws usage_error, std::invalid_argument, interruption
int calibrate(calibrate_options const& o);

} // namespace cartilage
