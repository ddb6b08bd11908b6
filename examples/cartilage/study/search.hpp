// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>

#include "cartilage/run/criterion.hpp"
#include "cartilage/study/study_result.hpp"

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
    double longest_run = 40e-9; ///< s, what a run takes that does not meet its criterion

    /// Number of steps of the grid. \throws std::invalid_argument naming the field, the value and the rule
    int steps() const;
    /// Load at a place of the grid, 0 to steps().
    double load(int place) const;
    /// The place whose load is nearest, within the grid.
    int place(double load_MPa) const;
};

/// A run at a load (MPa), until a criterion is met or its time is over.
using run_at_load = std::function<load_run(double, criterion)>;

/// Finds the loads of a packing. A load is the upper one of two neighbours on the grid: the criterion is met there, and
/// not at the lower one. A run that meets it stops there, one that does not takes its whole time: each run is at the load
/// where it is to tell most for its time. More load does not always break more: where the outcome changes several times,
/// the load is the one that this search comes upon. A run that does not count tells nothing: the search turns to the loads
/// beside it. The result depends on `range` and the runs only. \throws what `run` throws
packing_result find_thresholds(load_range const& range, run_at_load const& run);

} // namespace cartilage
