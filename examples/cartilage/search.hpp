// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>

#include "question.hpp"
#include "study_result.hpp"

/// \file
/// The three loads of a packing, by bisection in the logarithm of the load.

namespace cartilage {

/// Where loads are sought: on a grid of equal ratios from the lowest to the highest.
struct load_range {
    double lowest_MPa = 5;
    double highest_MPa = 1000;
    double resolution = 0.02; ///< largest step of the grid, relative
    /// Where the search for each question begins, MPa. A good guess saves runs; far too high costs little, because
    /// runs that answer yes are short.
    std::array<double, 3> first_guess{45, 1000, 1000};

    /// Number of steps of the grid. \throws std::invalid_argument naming the field, the value and the rule
    int steps() const;
    /// Load at a place of the grid, 0 to steps().
    double load(int place) const;
    /// The place whose load is nearest, within the grid.
    int place(double load_MPa) const;
};

/// A run at a load (MPa), as far as a question needs.
using ask_at_load = std::function<probe(double, question)>;

/// Finds the loads of a packing. A load is the upper end of two neighbours on the grid of which the lower one answers
/// no and the upper one yes. More load does not always break more: where the answers change several times, the load is
/// the one that this search meets. A run that does not count answers nothing: the search turns to the loads beside it.
/// The result depends on `range` and the answers only. \throws what `ask` throws
packing_result find_thresholds(load_range const& range, ask_at_load const& ask);

} // namespace cartilage
