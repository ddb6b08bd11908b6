// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/study_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <lacuna/core/error.hpp>

namespace cartilage {

namespace {

std::vector<double> sorted(std::vector<double> numbers) {
    if (numbers.empty()) lacuna::refuse("statistics.numbers", "none", "at least one");
    for (double const v : numbers)
        if (std::isnan(v)) lacuna::refuse("statistics.numbers", v, "a number or infinite");
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

} // namespace

double quantile_of_sorted(std::vector<double> const& sorted, double share) {
    double const position = share * double(sorted.size() - 1);
    auto const below = std::size_t(position);
    double const fraction = position - double(below);
    // The next number has no weight, even if it is infinite.
    if (fraction == 0) return sorted[below];
    if (!std::isfinite(sorted[below + 1])) return sorted[below + 1];
    if (!std::isfinite(sorted[below])) return sorted[below];
    return sorted[below] + fraction * (sorted[below + 1] - sorted[below]);
}

double quantile(std::vector<double> numbers, double share) {
    lacuna::require_in("quantile.share", share, 0, 1);
    return quantile_of_sorted(sorted(std::move(numbers)), share);
}

double median(std::vector<double> numbers) { return quantile(std::move(numbers), 0.5); }

interval median_interval(std::vector<double> numbers) {
    numbers = sorted(std::move(numbers));
    constexpr int samples = 10000;
    std::mt19937_64 random(20231);
    std::size_t const n = numbers.size();
    std::vector<double> medians(samples), sample(n);
    for (double& m : medians) {
        // The distributions of the standard library differ between implementations, so the upper 32 bits are scaled.
        for (double& v : sample) v = numbers[std::size_t((random() >> 32) * std::uint64_t(n) >> 32)];
        std::sort(sample.begin(), sample.end());
        m = quantile_of_sorted(sample, 0.5);
    }
    std::sort(medians.begin(), medians.end());
    return {quantile_of_sorted(medians, 0.025), quantile_of_sorted(medians, 0.975)};
}

double percentile_of(double value, std::vector<double> const& numbers) {
    double below = 0;
    for (double const v : sorted(numbers)) below += v < value ? 1.0 : v == value ? 0.5 : 0.0;
    return 100 * below / double(numbers.size());
}

} // namespace cartilage
