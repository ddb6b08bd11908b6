// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

namespace lacuna {

/// A colour, each part from 0 to 1.
struct color {
    double red = 0;
    double green = 0;
    double blue = 0;
    double alpha = 1;

    friend constexpr bool operator==(color const&, color const&) noexcept = default;
};

/// Interpolates two colours part by part; share 0 gives a, share 1 gives b.
constexpr color mix(color const& a, color const& b, double share) noexcept {
    return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green),
            a.blue + share * (b.blue - a.blue), a.alpha + share * (b.alpha - a.alpha)};
}

/// Colours of a scale.
enum class color_map {
    viridis,  ///< perceptually uniform, from dark violet over green to yellow: for values of one sign
    diverging ///< from violet over pale grey to green: for values of both signs
};

namespace detail {
inline constexpr std::array<std::array<int, 3>, 17> viridis_points{
    {{68, 1, 84},    {72, 24, 106},  {71, 45, 123},  {66, 64, 134},  {59, 82, 139},  {51, 99, 141},
     {44, 114, 142}, {38, 130, 142}, {33, 145, 140}, {31, 160, 136}, {40, 174, 128}, {63, 188, 115},
     {94, 201, 98},  {132, 212, 75}, {173, 220, 48}, {216, 226, 25}, {253, 231, 37}}};
inline constexpr std::array<std::array<int, 3>, 9> diverging_points{{{64, 0, 75},
                                                                     {118, 42, 131},
                                                                     {153, 112, 171},
                                                                     {194, 165, 207},
                                                                     {216, 216, 216},
                                                                     {166, 219, 160},
                                                                     {90, 174, 97},
                                                                     {27, 120, 55},
                                                                     {0, 68, 27}}};

template <std::size_t N>
constexpr color interpolate(std::array<std::array<int, 3>, N> const& points, double share) noexcept {
    double const position = share * double(N - 1);
    std::size_t const below = std::min(std::size_t(position), N - 2);
    auto const rgb = [&](std::size_t i) {
        return color{points[i][0] / 255.0, points[i][1] / 255.0, points[i][2] / 255.0};
    };
    return mix(rgb(below), rgb(below + 1), position - double(below));
}
} // namespace detail

/// Maps values from `low` to `high` to colours. Values outside get the colour of the nearer end.
class color_scale {
public:
    /// \throws std::invalid_argument unless low < high, both finite
    color_scale(double low, double high, color_map map = color_map::viridis) : low_(low), high_(high), map_(map) {
        require_finite("color_scale.low", low);
        require_finite("color_scale.high", high);
        if (!(low < high)) refuse("color_scale.high", high, "above low = " + to_text(low));
    }
    double low() const noexcept { return low_; }
    double high() const noexcept { return high_; }
    color_map map() const noexcept { return map_; }

    color operator()(double value) const noexcept {
        double const share = (value - low_) / (high_ - low_);
        double const inside = share > 0 ? std::min(share, 1.0) : 0.0;
        return map_ == color_map::viridis ? detail::interpolate(detail::viridis_points, inside)
                                          : detail::interpolate(detail::diverging_points, inside);
    }

private:
    double low_;
    double high_;
    color_map map_;
};

/// A colour scale for measured values. It extends from the 1st to the 99th percentile, so that a few outliers do not
/// wash out the rest, and always includes zero. Values of both signs get the diverging map, symmetric about zero,
/// unless one side is below a twentieth of the other. Without values, or if all are zero, the scale is from 0 to 1.
inline color_scale robust_color_scale(std::vector<double> values) {
    values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
                 values.end());
    if (values.empty()) return {0, 1};
    std::sort(values.begin(), values.end());
    std::size_t const cut = values.size() / 100;
    double low = std::min(values[cut], 0.0);
    double high = std::max(values[values.size() - 1 - cut], 0.0);
    if (low == 0 && high == 0) {
        low = std::min(values.front(), 0.0);
        high = std::max(values.back(), 0.0);
    }
    if (low == 0 && high == 0) return {0, 1};
    if (-low < 0.05 * high) return {0, high};
    if (high < -0.05 * low) return {low, 0};
    double const reach = std::max(-low, high);
    return {-reach, reach, color_map::diverging};
}

/// The largest number 1, 2 or 5 times a power of ten that is not above `value`: the length of a scale bar.
/// \throws std::invalid_argument unless value > 0
inline double nice_below(double value) {
    require_positive("nice_below.value", value);
    double const magnitude = std::pow(10.0, std::floor(std::log10(value)));
    for (double factor : {10.0, 5.0, 2.0})
        if (factor * magnitude <= value * (1 + 1e-12)) return factor * magnitude;
    return magnitude;
}

/// All multiples of a step inside [low, high]. The step is the smallest number 1, 2 or 5 times a power of ten that
/// gives at most `most` (>= 2) multiples.
/// \throws std::invalid_argument unless low < high, both finite, and most >= 2
inline std::vector<double> nice_ticks(double low, double high, int most = 6) {
    require_finite("nice_ticks.low", low);
    require_finite("nice_ticks.high", high);
    if (!(low < high)) refuse("nice_ticks.high", high, "above low = " + to_text(low));
    if (most < 2) refuse("nice_ticks.most", double(most), ">= 2");
    double magnitude = std::pow(10.0, std::floor(std::log10((high - low) / most)));
    for (;; magnitude *= 10) {
        for (double factor : {1.0, 2.0, 5.0}) {
            double const step = factor * magnitude;
            double const first = std::ceil(low / step - 1e-9);
            double const last = std::floor(high / step + 1e-9);
            if (last - first + 1 > most) continue;
            std::vector<double> ticks;
            for (double k = first; k <= last; ++k) ticks.push_back(k * step + 0.0);
            return ticks;
        }
    }
}

/// Labels of equidistant ticks, all with as many decimals as their distance needs.
inline std::vector<std::string> tick_labels(std::vector<double> const& ticks) {
    double const step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
    double const largest = ticks.empty() ? 0 : std::max(std::fabs(ticks.front()), std::fabs(ticks.back()));
    bool const plain = largest < 1e6 && step >= 0.9e-4;
    int const decimals = plain ? std::max(0, int(-std::floor(std::log10(step) + 1e-9))) : 0;
    std::vector<std::string> labels;
    std::string const format = plain ? "%." + std::to_string(decimals) + "f" : "%.1e";
    for (double tick : ticks) labels.push_back(formatted(format, tick));
    return labels;
}

} // namespace lacuna
