// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

/// \file
/// Statistics of a few numbers. Numbers that are only known to lie outside a range are infinite.

namespace cartilage {

/// The quantile for `share`, 0 to 1: the first number at 0, the last at 1, linear in between. It is infinite if one of
/// the two numbers beside it is. \param sorted upwards, not empty
double quantile_of_sorted(std::vector<double> const& sorted, double share);

/// \name Quantile and median of numbers in any order. \throws std::invalid_argument if there are none
/// \{
double quantile(std::vector<double> numbers, double share);
double median(std::vector<double> numbers);
/// \}

struct interval {
    double low = 0;
    double high = 0;
};

/// 95 % interval of the median by a percentile bootstrap (Efron and Tibshirani 1993, section 13.3): the middle 95 % of
/// the medians of 10,000 samples. Each sample has as many numbers, drawn with replacement. The seed is fixed, so that
/// the same numbers give the same interval. \throws std::invalid_argument if there are no numbers
interval median_interval(std::vector<double> numbers);

/// Share of the numbers below a value, in %; numbers equal to it count half. \throws std::invalid_argument without
/// numbers
double percentile_of(double value, std::vector<double> const& numbers);

} // namespace cartilage
