// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string>

#include <lacuna/draw/canvas.hpp>
#include <lacuna/draw/plot.hpp>

#include "output.hpp"

namespace uniaxial {

namespace {

using lacuna::canvas;
using lacuna::color;
using lacuna::rectangle;

constexpr color ink{0.13, 0.13, 0.15}, tension{0.90, 0.05, 0.05}, shear{0.10, 0.30, 0.85};
constexpr double em = 13;

void draw_specimen(canvas& page, lacuna::scene const& s, rectangle const& frame) {
    page.set_world({s.left, s.bottom, s.right, s.top}, frame);
    double mean = 0;
    for (auto const& p : s.particles) {
        page.add_disc(page.page(p.position), p.radius * page.scale());
        mean += p.radius / double(s.particles.size());
    }
    page.fill({0.80, 0.81, 0.84});
    for (auto mode : {lacuna::scene::break_mode::tension, lacuna::scene::break_mode::shear}) {
        bool const pulled = mode == lacuna::scene::break_mode::tension;
        for (auto const& c : s.cracks)
            if (c.mode == mode) {
                // A crack opens across the bond that it broke.
                auto const along = perpendicular(c.direction) * (0.9 * mean / norm(c.direction));
                page.add_line(page.page(c.position - along), page.page(c.position + along));
            }
        page.stroke(pulled ? tension : shear, 1.6);
    }
}

void draw_curves(canvas& page, outcome const& o, rectangle const& stress_frame, rectangle const& crack_frame) {
    double strain = 1e-9, stress = 0, cracks = 1;
    lacuna::plot::points stresses, pulled, sheared;
    for (auto const& s : o.curve) {
        strain = std::max(strain, s.strain);
        stress = std::max(stress, s.stress);
        cracks = std::max({cracks, double(s.tension_cracks), double(s.shear_cracks)});
        stresses.push_back({100 * s.strain, s.stress / 1e6});
        pulled.push_back({100 * s.strain, double(s.tension_cracks)});
        sheared.push_back({100 * s.strain, double(s.shear_cracks)});
    }
    lacuna::plot_axis const x{0, 104 * strain, "axial strain, %"};
    lacuna::plot above(page, stress_frame, x, {0, 1.08 * std::max(stress / 1e6, 1e-9), "axial stress, MPa"}, {em, ink});
    above.draw_axes();
    above.line(stresses, lacuna::plot_ink(0), 2);
    auto const& peak = o.curve[o.peak];
    if (!o.asked.elastic)
        above.markers({{100 * peak.strain, peak.stress / 1e6}}, lacuna::plot_mark::disc, lacuna::plot_ink(0), 4);
    lacuna::plot below(page, crack_frame, x, {0, 1.08 * cracks, "broken bonds"}, {em, ink});
    below.draw_axes();
    below.line(pulled, tension, 2);
    below.line(sheared, shear, 2);
    lacuna::draw_legend(
        page, {crack_frame.left + 14, crack_frame.low + 18},
        {{lacuna::legend_mark::line, tension, "in tension"}, {lacuna::legend_mark::line, shear, "in shear"}}, em, ink);
}

} // namespace

void save_picture(std::string const& stem, outcome const& o) {
    double const height = 560, top = 70, width = std::clamp(height * o.asked.width / o.asked.height, 80.0, 560.0);
    double const left = 30 + width + 90;
    lacuna::save_canvas_png_svg(stem, left + 420, top + height + 60, [&](canvas& page) {
        page.clear({1, 1, 1});
        page.text({30, 30}, "Uniaxial compression of a bonded specimen", 1.25 * em, ink, lacuna::text_align::left,
                  true);
        draw_specimen(page, o.end, {30, top, 30 + width, top + height});
        draw_curves(page, o, {left, top, left + 390, top + 0.56 * height},
                    {left, top + 0.72 * height, left + 390, top + height});
    });
}

} // namespace uniaxial
