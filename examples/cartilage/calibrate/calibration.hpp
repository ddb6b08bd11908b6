// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "cartilage/common/choices.hpp"

/// \file
/// The search for the set of choices with the least misfit, whatever that is: numbers by NLopt, words and counts by
/// trying all.

namespace cartilage {

/// Whether the program was built with NLopt.
bool can_calibrate() noexcept;

/// One set that was tried.
struct evaluation {
    choices open;
    double misfit = 0;
};

struct calibration_request {
    choices start;
    std::vector<choice_field const*> free; ///< what may change, each once
    std::size_t evaluations = 40;          ///< sets to try at most, the start included
    double misfit_enough = 0;              ///< to end at
};

/// Tries the start first. Words and counts: all combinations, starting from that of the start, each with an equal share
/// of the evaluations; numbers: within choice_field::fit, by linear models within a shrinking region (COBYLA, M. J. D.
/// Powell 1994) in the field's scale, from the start's value in the first combination, from the best so far in the
/// others. Numbers are rounded to three digits; a set that was tried is not tried again. What is tried depends on the
/// request and the misfits alone.
/// \param misfit of a set; not a number: the set cannot be had. What it throws ends the search and is passed on.
/// \return all that was tried, in order
/// \throws std::invalid_argument for a free choice that is given twice or is stated by the paper;
///         std::runtime_error without NLopt
std::vector<evaluation> calibrate(calibration_request const& request, std::function<double(choices const&)> const& misfit);

/// The evaluation with the least misfit, the first of several. \param all at least one
std::size_t best_of(std::vector<evaluation> const& all);

} // namespace cartilage
