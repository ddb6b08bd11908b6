// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/draw/canvas.hpp>
#include <lacuna/draw/color_scale.hpp>

/// \file
/// Elements of a drawing: scale bar, colour bar, arrows, hatched supports, legend.

namespace lacuna {

/// A length with a readable unit, m to nm: 2e-5 -> "20 µm".
inline std::string length_label(double metres) {
    struct unit {
        double size;
        char const* name;
    };
    auto const in_unit = [metres](unit const& u) {
        return to_text(std::round(metres / u.size * 1e6) / 1e6) + " " + u.name;
    };
    for (unit const u : {unit{1, "m"}, unit{1e-3, "mm"}, unit{1e-6, "µm"}})
        if (std::fabs(metres) >= 0.999999 * u.size) return in_unit(u);
    return in_unit({1e-9, "nm"});
}

/// A unit of pressure, and its size in Pa.
struct pressure_unit {
    double size = 1e6;
    char const* name = "MPa";
};
/// A readable unit for pressures up to `largest` (Pa): MPa from 10 kPa to 10 GPa.
inline pressure_unit pressure_unit_for(double largest) noexcept {
    double const size = std::fabs(largest);
    if (!(size > 0) || (size >= 1e4 && size < 1e10)) return {};
    if (size >= 1e10) return {1e9, "GPa"};
    return size >= 10 ? pressure_unit{1e3, "kPa"} : pressure_unit{1, "Pa"};
}

/// Draws a bar of a round length, at most `longest_px` px long, with a label; its left end is at `at` (page).
inline void draw_scale_bar(canvas& page, canvas::point const& at, double longest_px, double text_size,
                           color const& ink) {
    double const length = nice_below(longest_px / page.scale());
    double const px = length * page.scale();
    page.add_line(at, {at[0] + px, at[1]});
    page.stroke(ink, 3, true);
    for (double x : {at[0], at[0] + px}) page.add_line({x, at[1] - 6}, {x, at[1] + 6});
    page.stroke(ink, 2, true);
    page.text({at[0] + px + 10, at[1]}, length_label(length), text_size, ink);
}

/// Draws a vertical bar of the scale's colours in `box` (page), with ticks on its right. With `below` or `above` that
/// end is pointed: there are values beyond it. Values are divided by `unit` for the labels.
inline void draw_color_bar(canvas& page, rectangle const& box, color_scale const& scale, double unit, bool below,
                           bool above, double text_size, color const& ink) {
    int const steps = 128;
    double const slice = box.height() / steps;
    for (int i = 0; i < steps; ++i) {
        double const value = scale.high() - (i + 0.5) / steps * (scale.high() - scale.low());
        double const top = box.low + i * slice;
        // Each slice extends below the next one, to hide the seam between two anti-aliased edges.
        page.add_rectangle({box.left, top, box.right, std::min(top + 2 * slice, box.high)});
        page.fill(scale(value));
    }
    double const middle = 0.5 * (box.left + box.right);
    double const point = 0.7 * box.width();
    if (above) {
        page.add_polygon({{box.left, box.low}, {middle, box.low - point}, {box.right, box.low}});
        page.fill(scale(scale.high()));
    }
    if (below) {
        page.add_polygon({{box.left, box.high}, {middle, box.high + point}, {box.right, box.high}});
        page.fill(scale(scale.low()));
    }
    page.add_rectangle(box);
    page.stroke(ink, 1);
    std::vector<double> const ticks = nice_ticks(scale.low() / unit, scale.high() / unit, 9);
    std::vector<std::string> const labels = tick_labels(ticks);
    for (std::size_t k = 0; k < ticks.size(); ++k) {
        double const y =
            box.high - (ticks[k] * unit - scale.low()) / (scale.high() - scale.low()) * box.height();
        page.add_line({box.right, y}, {box.right + 5, y});
        page.stroke(ink, 1);
        page.text({box.right + 9, y}, labels[k], text_size, ink);
    }
}

/// Draws an arrow with its tip at `tip` (page), pointing along `direction` (any length).
/// \param length of the whole arrow, px; \param head length of its head, px
inline void draw_arrow(canvas& page, canvas::point const& tip, canvas::point const& direction, double length,
                       double head, color const& ink, double line_width) {
    double const size = norm(direction);
    if (!(size > 0)) return;
    canvas::point const along = direction * (1 / size);
    canvas::point const side = perpendicular(along) * (0.38 * head);
    canvas::point const neck = tip - along * head;
    page.add_line(tip - along * length, neck);
    page.stroke(ink, line_width, true);
    page.add_polygon({tip, neck + side, neck - side});
    page.fill(ink);
}

/// Draws a line with slanted strokes behind it, the symbol of a fixed support. The strokes are to the right of the
/// line, as seen on the page when going from `from` to `to`.
inline void draw_hatched_line(canvas& page, canvas::point const& from, canvas::point const& to, double depth,
                              color const& ink) {
    canvas::point const line = to - from;
    double const length = norm(line);
    if (!(length > 0)) return;
    canvas::point const along = line * (1 / length);
    canvas::point const behind = perpendicular(along) * depth;
    int const strokes = std::max(1, int(length / (0.9 * depth)));
    for (int k = 0; k <= strokes; ++k) {
        canvas::point const foot = from + line * (double(k) / strokes);
        page.add_line(foot, foot + behind - along * (0.8 * depth));
    }
    page.stroke(mix(ink, {1, 1, 1}, 0.35), 1.3);
    page.add_line(from, to);
    page.stroke(ink, 2.5, true);
}

/// Symbol of a legend entry, drawn in front of its text.
enum class legend_mark { disc, dash, line, ring, diamond, dashes, line_and_ring };
struct legend_entry {
    legend_mark mark = legend_mark::disc;
    color ink;
    std::string text;
};

/// Draws the entries one below the other, from `at` (page) down. \return y below the last entry, px
inline double draw_legend(canvas& page, canvas::point const& at, std::vector<legend_entry> const& entries,
                          double text_size, color const& text_ink) {
    double y = at[1];
    for (legend_entry const& entry : entries) {
        canvas::point const middle{at[0] + 11, y};
        if (entry.mark == legend_mark::disc) {
            page.add_disc(middle, 0.42 * text_size);
            page.fill_and_stroke(entry.ink, mix(entry.ink, {0, 0, 0}, 0.4), 0.8);
        } else if (entry.mark == legend_mark::diamond) {
            double const size = 0.45 * text_size;
            page.add_polygon({middle + canvas::point{-size, 0}, middle + canvas::point{0, -size},
                              middle + canvas::point{size, 0}, middle + canvas::point{0, size}});
            page.fill(entry.ink);
        } else if (entry.mark != legend_mark::ring) {
            page.add_line({middle[0] - 10, y}, {middle[0] + 10, y});
            if (entry.mark == legend_mark::dashes)
                page.stroke_dashed(entry.ink, 1.6, 5, 4);
            else
                page.stroke(entry.ink, entry.mark == legend_mark::dash ? 5 : 2, true);
        }
        if (entry.mark == legend_mark::ring || entry.mark == legend_mark::line_and_ring) {
            page.add_disc(middle, 0.25 * text_size);
            page.stroke(entry.ink, 1.3);
        }
        page.text({at[0] + 30, y}, entry.text, text_size, text_ink);
        y += 1.65 * text_size;
    }
    return y;
}

} // namespace lacuna
