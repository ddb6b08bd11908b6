// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "cartilage/calibrate/calibration.hpp"
#include "cartilage/calibrate/comparison.hpp"
#include "cartilage/study/study_options.hpp"

namespace cartilage {

/// The request to `cartilage calibrate`.
struct calibrate_options {
    study_options study; ///< zones, seeds, loads, start, output
    std::vector<choice_field const*> free; ///< choices to fit
    std::size_t evaluations = 40;          ///< largest number of sets to try
};

/// A set of choices and its results.
struct calibrated_set {
    cartilage::choices choices;
    double misfit = 0; ///< see misfit_of(); NaN: the set is not possible
    std::string why;   ///< why the set is not possible; else empty
    std::vector<target_result> targets;
    std::vector<first_layer_count> first_layers;
};

/// Reads the command line after the word `calibrate`. \copydetails parse_command_line
std::optional<calibrate_options> parse_calibrate_command_line(int argc, char const* const* argv);

/// Fits the free choices: one set for all zones. Writes calibration.csv and calibration.json with all sets,
/// best.choices for --choices, and calibration.html, which compares the best set with each load of the paper.
/// \return the exit status \throws usage_error, std::invalid_argument, interruption
int calibrate(calibrate_options const& o);

} // namespace cartilage
