// SPDX-License-Identifier: BSD-3-Clause
#include "picture.hpp"

#include <lacuna/draw/canvas.hpp>
#include <lacuna/draw/canvas_furniture.hpp>
#include <lacuna/draw/plot.hpp>

using namespace lacuna;

namespace apertures {

namespace {

color const ink{0.2, 0.2, 0.2};
color const inks[] = {{0.35, 0.35, 0.35}, {0.80, 0.25, 0.15}, {0.15, 0.45, 0.75}, {0.20, 0.60, 0.30}};

/// Plots `value` of each sample against the force in mN.
template <class Value>
void draw_curves(canvas& page, rectangle const& frame, std::vector<curve> const& curves, plot_axis const& y,
                 Value const& value) {
    plot plane(page, frame, {-0.3, 0.1, "normal force (mN), tension positive", axis_scale::linear, 5}, y, {14, ink});
    plane.draw_axes();
    for (std::size_t c = 0; c < curves.size(); ++c) {
        plot::points line;
        for (sample const& s : curves[c].samples) line.push_back({1e3 * s.force, value(s)});
        // Earlier curves are wider, so that coinciding curves stay visible.
        plane.line(line, inks[c % 4], 6.5 - 1.5 * double(c));
    }
}

} // namespace

void save_picture(std::string const& path, std::vector<curve> const& curves) {
    save_canvas(path, 1120, 470, [&](canvas& page) {
        page.clear({1, 1, 1});
        draw_curves(page, {70, 50, 510, 400}, curves, {0, 21, "aperture (nm)"},
                    [](sample const& s) { return 1e9 * s.aperture; });
        draw_curves(page, {630, 50, 1070, 400}, curves,
                    {1e-25, 1e-21, "conductance (m³/(Pa s))", axis_scale::logarithmic},
                    [](sample const& s) { return s.conductance; });
        std::vector<legend_entry> entries;
        for (std::size_t c = 0; c < curves.size(); ++c)
            entries.push_back({legend_mark::dash, inks[c % 4], curves[c].law});
        draw_legend(page, {90, 75}, entries, 15, ink);
    });
}

} // namespace apertures
