// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "cartilage/study/study_statistics.hpp"

using cartilage::median;
using cartilage::median_interval;
using cartilage::percentile_of;
using cartilage::quantile;

namespace {
constexpr double never = std::numeric_limits<double>::infinity();

std::vector<double> ten_to(int count) {
    std::vector<double> v(std::size_t(count), 0.0);
    std::iota(v.begin(), v.end(), 10.0);
    return v;
}
} // namespace

TEST_CASE("quantiles lie between numbers in proportion") {
    // Positions 0.75 and 2.25 of 0..3 among 2, 4, 8, 20.
    CHECK_THAT(quantile({20, 2, 8, 4}, 0.25), WithinAbs(2 + 0.75 * 2, 1e-12));
    CHECK_THAT(quantile({20, 2, 8, 4}, 0.75), WithinAbs(8 + 0.25 * 12, 1e-12));
    CHECK(median({20, 2, 8, 4}) == 6);
    CHECK(median({7, 1, 3}) == 3);
    CHECK(quantile({5}, 0.25) == 5);
    CHECK(quantile({3, 1, 2}, 0) == 1);
    CHECK(quantile({3, 1, 2}, 1) == 3);
}

TEST_CASE("infinite numbers are above or below all others") {
    CHECK(median({10, never, 20}) == 20);
    CHECK(median({10, never, never}) == never);
    // Between 20 and an unknown number above the range: above the range.
    CHECK(median({10, 20, never, never}) == never);
    CHECK(quantile({10, 20, 30, never, never}, 0.25) == 20);
    CHECK(median({-never, 10, 20}) == 10);
    CHECK(median({-never, -never, 10, 20}) == -never);
}

TEST_CASE("the bootstrap's interval of the median is the exact one") {
    // The median of n draws from n numbers is at most the k-th where (n + 1) / 2 draws or more are among the lowest k:
    // a binomial. n = 5: k = 1 0.0579. n = 11: k = 2 0.0072, k = 3 0.0513. n = 13: k = 3 0.0157, k = 4 0.0707.
    auto const five = median_interval(ten_to(5)), eleven = median_interval(ten_to(11)),
               more = median_interval(ten_to(13));
    CHECK(five.low == 10);
    CHECK(five.high == 14);
    CHECK(eleven.low == 12);
    CHECK(eleven.high == 18);
    CHECK(more.low == 13);
    CHECK(more.high == 19);
    // The upper end is above the range, the lower end is not.
    auto const unbounded = median_interval({10, 11, 12, 13, 14, 15, 16, 17, never, never, never});
    CHECK(unbounded.low == 12);
    CHECK(unbounded.high == never);
    auto const again = median_interval({14, 10, 13, 11, 12});
    CHECK(again.low == five.low);
    CHECK(again.high == five.high);
}

TEST_CASE("a percentile is the share of smaller numbers and half of the equal ones") {
    CHECK(percentile_of(45, {10, 20, 50, 60}) == 50);
    CHECK(percentile_of(20, {10, 20, 50, never}) == 37.5);
    CHECK(percentile_of(5, {10, 20}) == 0);
    CHECK(percentile_of(500, {10, never}) == 50);
}

TEST_CASE("statistics without numbers are refused") {
    CHECK_THROWS_AS(median({}), std::invalid_argument);
    CHECK_THROWS_AS(median_interval({}), std::invalid_argument);
    CHECK_THROWS_AS(percentile_of(1, {}), std::invalid_argument);
    CHECK_THROWS_AS(median({1, std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
    CHECK_THROWS_AS(quantile({1, 2}, 1.5), std::invalid_argument);
}
