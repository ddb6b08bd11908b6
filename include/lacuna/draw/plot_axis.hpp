// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>
#include <lacuna/draw/color_scale.hpp>

namespace lacuna {

enum class axis_scale { linear, logarithmic };

/// A tick on an axis: its value, and its label.
struct plot_tick {
    double at = 0;
    std::string label;
};

/// One axis of a plot.
struct plot_axis {
    double low = 0;
    double high = 1;
    std::string label = {}; ///< quantity, with its unit
    axis_scale scale = axis_scale::linear;
    int most_ticks = 6;
    std::vector<plot_tick> ticks = {}; ///< custom ticks, such as names of categories; if empty, round numbers

    /// Position of a value on the axis: 0 at `low`, 1 at `high`.
    double share(double value) const noexcept {
        return scale == axis_scale::linear ? (value - low) / (high - low)
                                           : std::log(value / low) / std::log(high / low);
    }
    /// \throws std::invalid_argument unless low < high, both finite (and > 0 on a logarithmic axis), and most_ticks >=
    /// 2
    void validate(std::string const& name) const {
        require_finite(name + ".low", low);
        require_finite(name + ".high", high);
        if (!(low < high)) refuse(name + ".high", high, "above low = " + to_text(low));
        if (scale == axis_scale::logarithmic) require_positive(name + ".low", low);
        if (most_ticks < 2) refuse(name + ".most_ticks", double(most_ticks), ">= 2");
    }
};

namespace detail {
/// Ticks at `factors` times powers of ten inside the axis, for every `every`-th power.
inline std::vector<plot_tick> decade_ticks(plot_axis const& axis, std::vector<double> const& factors, int every) {
    std::vector<plot_tick> ticks;
    int const first = int(std::floor(std::log10(axis.low) - 1e-9)), last = int(std::ceil(std::log10(axis.high)));
    for (int power = first; power <= last; ++power) {
        if (((power % every) + every) % every != 0) continue;
        for (double const factor : factors) {
            // Read from its decimal digits: a product of powers could differ from its label by rounding.
            std::string const digits = std::to_string(int(factor)) + "e" + std::to_string(power);
            double const at = number_of(digits).value();
            if (at >= axis.low * (1 - 1e-9) && at <= axis.high * (1 + 1e-9)) ticks.push_back({at, to_text(at)});
        }
    }
    return ticks;
}
} // namespace detail

/// The ticks of an axis: its custom ones, or otherwise at most `most_ticks` round numbers. A logarithmic axis has ticks
/// at 1, 2 and 5 times the powers of ten, at powers only if those are too many, or at equidistant round numbers if they
/// are fewer than three.
inline std::vector<plot_tick> ticks_of(plot_axis const& axis) {
    axis.validate("plot_axis");
    if (!axis.ticks.empty()) return axis.ticks;
    auto const most = std::size_t(axis.most_ticks);
    if (axis.scale == axis_scale::logarithmic) {
        auto ticks = detail::decade_ticks(axis, {1, 2, 5}, 1);
        if (ticks.size() > most) ticks = detail::decade_ticks(axis, {1}, 1);
        for (int every = 2; ticks.size() > most; ++every) ticks = detail::decade_ticks(axis, {1}, every);
        if (ticks.size() > 2) return ticks;
    }
    std::vector<double> const values = nice_ticks(axis.low, axis.high, axis.most_ticks);
    std::vector<std::string> const labels = tick_labels(values);
    std::vector<plot_tick> ticks;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (axis.scale == axis_scale::linear || values[k] > 0) ticks.push_back({values[k], labels[k]});
    return ticks;
}

} // namespace lacuna
