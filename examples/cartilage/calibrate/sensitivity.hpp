// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "cartilage/calibrate/comparison.hpp"
#include "cartilage/study/study_options.hpp"

namespace cartilage {

/// The request to `cartilage sensitivity`.
struct sensitivity_options {
    study_options study;                      ///< zones, seeds, loads, base model, output
    std::vector<choice_field const*> choices; ///< choices to vary; empty: all that have an effect
};

/// One choice at another value; the other choices are those of the base.
struct variation {
    choice_field const* field = nullptr;
    double value = 0;
    std::vector<change_of_load> changes;
};

/// Reads the command line after the word `sensitivity`. \copydetails parse_command_line
std::optional<sensitivity_options> parse_sensitivity_command_line(int argc, char const* const* argv);

/// Runs the base and every variation on the same packings. Writes sensitivity.csv, sensitivity.html and a tornado plot
/// for each zone and load.
/// \return the exit status \throws usage_error, std::invalid_argument, interruption
int sensitivity(sensitivity_options const& o);

} // namespace cartilage
