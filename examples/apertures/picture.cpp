// SPDX-License-Identifier: BSD-3-Clause
#include "picture.hpp"

#include <cmath>
#include <cstdio>

#include <lacuna/observe/canvas.hpp>
#include <lacuna/observe/canvas_furniture.hpp>

using namespace lacuna;

namespace apertures {

namespace {

color const inks[] = {{0.35, 0.35, 0.35}, {0.80, 0.25, 0.15}, {0.15, 0.45, 0.75}, {0.20, 0.60, 0.30}};

/// A quantity over the force: mN to the right, `value` of a sample upwards.
template <class Value>
void draw_plot(canvas& page, rectangle const& frame, std::vector<curve> const& curves, std::string const& title,
               double low, double high, bool powers_of_ten, Value const& value) {
    color const ink{0.2, 0.2, 0.2}, faint{0.85, 0.85, 0.85};
    double const left = -0.3, right = 0.1;
    auto const at = [&](double x, double y) {
        return canvas::point{frame.left + (x - left) / (right - left) * frame.width(),
                             frame.high - (y - low) / (high - low) * frame.height()};
    };
    auto const x_ticks = nice_ticks(left, right, 5), y_ticks = nice_ticks(low, high, 6);
    auto const x_labels = tick_labels(x_ticks);
    auto y_labels = tick_labels(y_ticks);
    for (std::size_t k = 0; k < x_ticks.size(); ++k) {
        page.add_line(at(x_ticks[k], low), at(x_ticks[k], high));
        page.stroke(faint, 1);
        page.text(at(x_ticks[k], low) + canvas::point{0, 16}, x_labels[k], 14, ink, text_align::center);
    }
    for (std::size_t k = 0; k < y_ticks.size(); ++k) {
        page.add_line(at(left, y_ticks[k]), at(right, y_ticks[k]));
        page.stroke(faint, 1);
        std::string const label = powers_of_ten ? "1e" + y_labels[k] : y_labels[k];
        page.text(at(left, y_ticks[k]) - canvas::point{8, 0}, label, 14, ink, text_align::right);
    }
    page.clip(frame);
    for (std::size_t c = 0; c < curves.size(); ++c) {
        auto const& samples = curves[c].samples;
        for (std::size_t k = 1; k < samples.size(); ++k)
            page.add_line(at(1e3 * samples[k - 1].force, value(samples[k - 1])),
                          at(1e3 * samples[k].force, value(samples[k])));
        // Curves that run on top of each other: the first ones are wider.
        page.stroke(inks[c % 4], 6.5 - 1.5 * double(c));
    }
    page.unclip();
    page.add_rectangle(frame);
    page.stroke(ink, 1.2);
    page.text({0.5 * (frame.left + frame.right), frame.high + 40}, "normal force (mN), tension positive", 15, ink,
              text_align::center);
    page.text({frame.left, frame.low - 18}, title, 16, ink, text_align::left, true);
}

} // namespace

void save_picture(std::string const& path, std::vector<curve> const& curves) {
    save_canvas(path, 1120, 470, [&](canvas& page) {
        page.clear({1, 1, 1});
        draw_plot(page, {70, 50, 510, 400}, curves, "aperture (nm)", 0, 21, false,
                  [](sample const& s) { return 1e9 * s.aperture; });
        draw_plot(page, {630, 50, 1070, 400}, curves, "conductance (m³/(Pa s))", -25, -21, true,
                  [](sample const& s) { return std::log10(s.conductance); });
        std::vector<legend_entry> entries;
        for (std::size_t c = 0; c < curves.size(); ++c)
            entries.push_back({legend_mark::dash, inks[c % 4], curves[c].law});
        draw_legend(page, {90, 75}, entries, 15, {0.2, 0.2, 0.2});
    });
}

} // namespace apertures
