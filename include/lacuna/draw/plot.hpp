// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/draw/canvas.hpp>
#include <lacuna/draw/canvas_furniture.hpp>
#include <lacuna/draw/plot_axis.hpp>

/// \file
/// Plots of one quantity over another: axes, lines, markers, bands, a legend. They are drawn on a canvas;
/// save_canvas_png_svg() writes it as PNG and SVG.

namespace lacuna {

/// Sizes in pixels and colours of a plot.
struct plot_style {
    double text_size = 13;
    color ink{0.13, 0.13, 0.15};
    color grid{0.87, 0.87, 0.89};
};

/// Colours of the curves of one plot. They differ in lightness too; after six they repeat.
inline color plot_ink(std::size_t curve) noexcept {
    constexpr std::array<color, 6> inks{{{0.10, 0.35, 0.75},
                                         {0.80, 0.30, 0.10},
                                         {0.15, 0.55, 0.25},
                                         {0.45, 0.25, 0.60},
                                         {0.75, 0.55, 0.05},
                                         {0.35, 0.35, 0.38}}};
    return inks[curve % inks.size()];
}

enum class plot_mark { disc, ring, diamond, cross };

/// A plot inside `frame` (page): maps pairs of values to page points and draws them. Lines and areas are clipped at the
/// frame; markers outside it are omitted. A value that is not finite interrupts a line, and has no marker.
class plot {
public:
    using point = canvas::point;
    using points = std::vector<vec<double, 2>>;

    /// \throws std::invalid_argument for an axis that plot_axis::validate() refuses
    plot(canvas& page, rectangle const& frame, plot_axis x, plot_axis y, plot_style const& style = {})
        : page_(page), frame_(frame), x_(std::move(x)), y_(std::move(y)), style_(style) {
        x_.validate("plot.x");
        y_.validate("plot.y");
    }
    rectangle const& frame() const noexcept { return frame_; }
    plot_axis const& x() const noexcept { return x_; }
    plot_axis const& y() const noexcept { return y_; }

    /// Page point of a pair of values.
    point at(double x, double y) const noexcept {
        return {frame_.left + x_.share(x) * frame_.width(), frame_.high - y_.share(y) * frame_.height()};
    }

    /// Draws grid, ticks and frame, the label of x below the frame, and the label of y above its left end.
    void draw_axes() {
        double const em = style_.text_size;
        for (plot_tick const& tick : ticks_of(x_)) {
            double const x = frame_.left + x_.share(tick.at) * frame_.width();
            page_.add_line({x, frame_.low}, {x, frame_.high});
            page_.stroke(style_.grid, 1);
            page_.text({x, frame_.high + 1.2 * em}, tick.label, em, style_.ink, text_align::center);
        }
        for (plot_tick const& tick : ticks_of(y_)) {
            double const y = frame_.high - y_.share(tick.at) * frame_.height();
            page_.add_line({frame_.left, y}, {frame_.right, y});
            page_.stroke(style_.grid, 1);
            page_.text({frame_.left - 0.6 * em, y}, tick.label, em, style_.ink, text_align::right);
        }
        page_.add_rectangle(frame_);
        page_.stroke(style_.ink, 1.2);
        page_.text({0.5 * (frame_.left + frame_.right), frame_.high + 2.8 * em}, x_.label, em, style_.ink,
                   text_align::center);
        page_.text({frame_.left, frame_.low - 1.1 * em}, y_.label, em, style_.ink);
    }

    void line(points const& values, color const& ink, double width = 1.6) {
        within([&] {
            add_line(values);
            page_.stroke(ink, width);
        });
    }
    void dashed_line(points const& values, color const& ink, double width = 1.6) {
        within([&] {
            add_line(values);
            page_.stroke_dashed(ink, width, 5, 4);
        });
    }
    /// Draws a dashed line across the plot at a value of x or of y.
    void rule_x(double x, color const& ink, double width = 1.2) {
        dashed_line({{x, y_.low}, {x, y_.high}}, ink, width);
    }
    void rule_y(double y, color const& ink, double width = 1.2) {
        dashed_line({{x_.low, y}, {x_.high, y}}, ink, width);
    }

    /// Fills the area between two lines.
    void band(points const& lower, points const& upper, color const& ink) {
        std::vector<point> rim;
        for (auto const& p : lower) rim.push_back(at(p[0], p[1]));
        for (auto p = upper.rbegin(); p != upper.rend(); ++p) rim.push_back(at((*p)[0], (*p)[1]));
        within([&] {
            page_.add_polygon(rim);
            page_.fill(ink);
        });
    }
    /// Fills the rectangle from x1 to x2 and from y1 to y2.
    void box(double x1, double x2, double y1, double y2, color const& ink) {
        band({{x1, y1}, {x2, y1}}, {{x1, y2}, {x2, y2}}, ink);
    }

    void markers(points const& values, plot_mark mark, color const& ink, double size = 3) {
        for (auto const& p : values) {
            if (!contains(p)) continue;
            point const middle = at(p[0], p[1]);
            switch (mark) {
            case plot_mark::diamond:
                page_.add_polygon({middle + point{-size, 0}, middle + point{0, -size}, middle + point{size, 0},
                                   middle + point{0, size}});
                break;
            case plot_mark::cross:
                page_.add_line(middle + point{-size, -size}, middle + point{size, size});
                page_.add_line(middle + point{-size, size}, middle + point{size, -size});
                break;
            default: page_.add_disc(middle, size);
            }
        }
        if (mark == plot_mark::disc || mark == plot_mark::diamond)
            page_.fill(ink);
        else
            page_.stroke(ink, 1.3);
    }
    /// Writes a text at the page point of (x, y).
    void word(double x, double y, std::string const& text, color const& ink, text_align align = text_align::left) {
        page_.text(at(x, y), text, style_.text_size, ink, align);
    }

private:
    bool contains(vec<double, 2> const& p) const noexcept {
        double const x = x_.share(p[0]), y = y_.share(p[1]), slack = 1e-9;
        return x >= -slack && x <= 1 + slack && y >= -slack && y <= 1 + slack;
    }
    template <class Draw>
    void within(Draw const& draw) {
        page_.clip(frame_);
        draw();
        page_.unclip();
    }
    void add_line(points const& values) {
        std::vector<point> part;
        auto const end_part = [&] {
            if (part.size() > 1) page_.add_path(part);
            part.clear();
        };
        for (auto const& p : values) {
            point const position = at(p[0], p[1]);
            if (std::isfinite(position[0]) && std::isfinite(position[1]))
                part.push_back(position);
            else
                end_part();
        }
        end_part();
    }

    canvas& page_;
    rectangle frame_;
    plot_axis x_, y_;
    plot_style style_;
};

/// Draws legend entries side by side from `at` (page) on, in as many rows as fit the entries into `width` (px).
/// \return y below the last row, px
inline double draw_legend_row(canvas& page, canvas::point const& at, double width,
                              std::vector<legend_entry> const& entries, double text_size, color const& text_ink) {
    canvas::point next = at;
    for (legend_entry const& entry : entries) {
        double const needed = 30 + page.text_width(entry.text, text_size);
        if (next[0] > at[0] && next[0] + needed > at[0] + width) next = {at[0], next[1] + 1.65 * text_size};
        draw_legend(page, next, {entry}, text_size, text_ink);
        next[0] += needed + 1.4 * text_size;
    }
    return next[1] + 1.65 * text_size;
}

} // namespace lacuna
