// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/draw/plot.hpp>

namespace lacuna {

/// Effect of one changed choice on a quantity.
struct tornado_bar {
    std::string label; ///< the changed value of the choice
    double change = 0; ///< of the quantity; not finite: only the label is drawn
    double low = 0;    ///< ends of the interval of the change; both equal to `change` if there is none
    double high = 0;
};

/// One choice with all its changes.
struct tornado_row {
    std::string name;
    std::vector<tornado_bar> bars;

    /// Largest finite change, by magnitude.
    double reach() const noexcept {
        double most = 0;
        for (tornado_bar const& bar : bars)
            if (std::isfinite(bar.change)) most = std::max(most, std::fabs(bar.change));
        return most;
    }
};

/// Height of the frame of a tornado plot with one line of text for each bar, px.
inline double tornado_height(std::vector<tornado_row> const& rows, plot_style const& style = {}) noexcept {
    double bars = 0;
    for (tornado_row const& row : rows) bars += double(std::max<std::size_t>(row.bars.size(), 1)) + 0.5;
    return std::max(bars, 1.0) * 1.5 * style.text_size;
}

/// Draws bars from zero to each change, with whiskers for intervals. The choice with the largest change is on top.
/// Names of choices are left of the frame, changed values at the ends of the bars. \param change axis of the change
inline void draw_tornado(canvas& page, rectangle const& frame, std::vector<tornado_row> rows, plot_axis change,
                         plot_style const& style = {}) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < rows.size(); ++k) order.emplace_back(-rows[k].reach(), k);
    std::sort(order.begin(), order.end());
    std::vector<tornado_row> sorted;
    for (auto const& [reach, k] : order) sorted.push_back(std::move(rows[k]));
    rows = std::move(sorted);
    double slots = 0;
    std::vector<plot_tick> names;
    for (tornado_row const& row : rows) {
        double const bars = double(std::max<std::size_t>(row.bars.size(), 1)) + 0.5;
        names.push_back({-(slots + 0.5 * bars), row.name});
        slots += bars;
    }
    if (rows.empty()) names.push_back({-0.5, ""});
    plot plane(page, frame, std::move(change), {-std::max(slots, 1.0), 0, "", axis_scale::linear, 6, names}, style);
    plane.draw_axes();
    plane.line({{0, plane.y().low}, {0, 0}}, style.ink, 1.2);
    double y = -0.25;
    for (tornado_row const& row : rows) {
        for (tornado_bar const& bar : row.bars) {
            double const middle = y - 0.5;
            double tip = 0;
            if (std::isfinite(bar.change)) {
                plane.box(0, bar.change, middle - 0.36, middle + 0.36, plot_ink(bar.change < 0 ? 0 : 1));
                if (bar.low < bar.high) {
                    plane.line({{bar.low, middle}, {bar.high, middle}}, style.ink, 1.2);
                    for (double const end : {bar.low, bar.high})
                        plane.line({{end, middle - 0.2}, {end, middle + 0.2}}, style.ink, 1.2);
                }
                tip = bar.change < 0 ? std::min(bar.change, bar.low) : std::max(bar.change, bar.high);
            }
            bool const left = std::isfinite(bar.change) && bar.change < 0;
            double const edge = std::clamp(tip, plane.x().low, plane.x().high);
            canvas::point at = plane.at(edge, middle);
            // If the label does not fit beyond the bar, it is drawn on the other side of zero.
            double const needed = page.text_width(bar.label, 0.85 * style.text_size) + 8;
            bool fits = left ? at[0] - needed > frame.left : at[0] + needed < frame.right;
            bool const to_left = fits ? left : !left;
            if (!fits) at = plane.at(0, middle);
            page.text(at + canvas::point{to_left ? -6.0 : 6.0, 0}, bar.label, 0.85 * style.text_size, style.ink,
                      to_left ? text_align::right : text_align::left);
            y -= 1;
        }
        if (row.bars.empty()) y -= 1;
        y -= 0.5;
    }
}

} // namespace lacuna
