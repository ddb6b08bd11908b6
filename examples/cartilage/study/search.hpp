// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>

#include "cartilage/run/criterion.hpp"
#include "cartilage/study/study_result.hpp"

/// \file
/// Finds the three loads of a packing by bracketing each on a logarithmic grid of loads.

namespace cartilage {

/// The grid of loads, with equal ratios from the lowest to the highest.
struct load_range {
    double lowest_MPa = 5;
    double highest_MPa = 1000;
    double resolution = 0.02; ///< largest relative step of the grid
    /// Likely values of the three loads, MPa. A good guess saves runs.
    std::array<double, 3> first_guess{45, 200, 1000};
    double longest_run = 40e-9; ///< s, duration of a run that does not meet its criterion

    /// Number of steps of the grid. \throws std::invalid_argument naming the field, the value and the rule
    int steps() const;
    /// The load at an index of the grid, 0 to steps(), MPa. \throws as steps()
    double load(int index) const;
    /// The index of the nearest load of the grid. \throws as steps()
    int nearest_index(double load_MPa) const;
};

/// A run at a load (MPa), until a criterion is met or its time is over.
using run_at_load = std::function<load_run(double, criterion)>;

/// Finds the loads of a packing. The criterion is met at the load found, and not met at the next lower load of the
/// grid. A run that meets its criterion stops early; one that does not takes its full duration. So the next load is the
/// one with the largest expected information for the expected duration of its run. A higher load does not always break
/// more bonds. If the outcome changes several times along the grid, the search returns one of these changes. An invalid
/// run gives no information; the search continues at neighbouring loads. The result depends only on `range` and the
/// runs.
/// \throws the exceptions of `run`
packing_result find_thresholds(load_range const& range, run_at_load const& run);

} // namespace cartilage
