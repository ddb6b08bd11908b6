// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

/// \file
/// Statistics of a few numbers, some of which may be known only to lie beyond a range: these are infinite.

namespace cartilage {

/// The value below which `share` (0 to 1) of the numbers lie: between two of them linearly, the first at 0, the last at
/// 1. Infinite where it falls on or beside an infinite number. \param sorted upwards, not empty
double quantile_of_sorted(std::vector<double> const& sorted, double share);

/// \name The same of numbers in any order. \throws std::invalid_argument without numbers
/// \{
double quantile(std::vector<double> numbers, double share);
double median(std::vector<double> numbers);
/// \}

struct interval {
    double low = 0;
    double high = 0;
};

/// 95 % interval of the median: the middle 95 % of the medians of 10,000 samples drawn from the numbers with
/// replacement, as many as there are numbers (percentile bootstrap; Efron and Tibshirani 1993, section 13.3). The draws
/// come from a fixed seed: the same numbers have the same interval. \throws std::invalid_argument without numbers
interval median_interval(std::vector<double> numbers);

/// Share of the numbers below a value, in %; numbers equal to it count half. \throws std::invalid_argument without numbers
double percentile_of(double value, std::vector<double> const& numbers);

} // namespace cartilage
