// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "cartilage/common/choices.hpp"

/// \file
/// The search for the set of choices with the least misfit, for any misfit function. NLopt varies numbers; all words
/// and counts are tried.

namespace cartilage {

/// Whether the program was built with NLopt.
bool can_calibrate() noexcept;

/// A set of choices and its misfit.
struct evaluation {
    cartilage::choices choices;
    double misfit = 0;
};

/// What to fit, and when to stop.
struct calibration_request {
    choices start;
    std::vector<choice_field const*> free; ///< choices to fit, without repetition
    std::size_t evaluations = 40;          ///< largest number of sets to try, with the start
    double misfit_enough = 0;              ///< the search ends at this misfit
};

/// Searches for the set with the least misfit. The first set is the start. All combinations of words and counts are
/// tried, that of the start first, each with an equal share of the evaluations. In each combination the numbers vary
/// within choice_field::fit on the field's scale, by linear models in a shrinking region (COBYLA, M. J. D. Powell
/// 1994). The first combination begins at the start's numbers, the others at those of the best set so far. Numbers are
/// rounded to three digits. No set is tried twice. The sets depend only on the request and the misfits.
/// \param misfit of a set; NaN: the set is not possible. Its exceptions end the search and are passed on.
/// \return all sets in the order of their trial
/// \throws std::invalid_argument for a free choice that is given twice or stated by the paper; std::runtime_error
/// without NLopt
std::vector<evaluation> calibrate(calibration_request const& request,
                                  std::function<double(choices const&)> const& misfit);

/// Index of the evaluation with the least misfit; the first of equal ones. \param all at least one
std::size_t best_of(std::vector<evaluation> const& all);

} // namespace cartilage
