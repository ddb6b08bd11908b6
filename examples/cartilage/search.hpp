// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>

#include "question.hpp"
#include "study_result.hpp"

/// \file
/// The three loads of a packing, each by closing in on it from both sides on a grid in the logarithm of the load.

namespace cartilage {

/// Where loads are sought: on a grid of equal ratios from the lowest to the highest.
struct load_range {
    double lowest_MPa = 5;
    double highest_MPa = 1000;
    double resolution = 0.02; ///< largest step of the grid, relative
    /// Near which each load is likely, MPa. A good guess saves runs.
    std::array<double, 3> first_guess{45, 200, 1000};
    double longest_run = 40e-9; ///< s, what a run that answers no takes

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
/// no and the upper one yes. A run that answers yes stops there, one that answers no takes its whole time: each run is
/// at the load where it is to tell most for its time. More load does not always break more: where the answers change
/// several times, the load is the one that this search meets. A run that does not count answers nothing: the search
/// turns to the loads beside it. The result depends on `range` and the answers only. \throws what `ask` throws
packing_result find_thresholds(load_range const& range, ask_at_load const& ask);

} // namespace cartilage
