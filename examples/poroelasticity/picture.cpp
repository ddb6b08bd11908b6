// SPDX-License-Identifier: BSD-3-Clause
#include "picture.hpp"

#include <algorithm>
#include <vector>

#include <lacuna/draw/canvas.hpp>
#include <lacuna/draw/canvas_furniture.hpp>
#include <lacuna/draw/plot.hpp>

namespace poroelasticity {

namespace {

using lacuna::canvas;
using lacuna::color;
using lacuna::rectangle;

constexpr color ink{0.13, 0.13, 0.15};
constexpr double em = 12;

rectangle extent_of(pressure_field const& f) {
    rectangle r{1e300, 1e300, -1e300, -1e300};
    for (auto const& d : f.discs) {
        r.left = std::min(r.left, d.middle[0] - d.radius);
        r.low = std::min(r.low, d.middle[1] - d.radius);
        r.right = std::max(r.right, d.middle[0] + d.radius);
        r.high = std::max(r.high, d.middle[1] + d.radius);
    }
    return r;
}

void draw_field(canvas& page, pressure_field const& f, rectangle const& frame) {
    double highest = 0;
    for (auto const& p : f.pores) highest = std::max(highest, p.pressure);
    lacuna::color_scale const scale(0, highest > 0 ? highest : 1);
    page.set_world(extent_of(f), frame);
    // Fill all pores of one pressure band at once: no seams, and small files.
    int const bands = 24;
    for (int band = 0; band < bands; ++band) {
        for (auto const& p : f.pores)
            if (std::clamp(int(p.pressure / scale.high() * bands), 0, bands - 1) == band)
                page.add_polygon({page.page(p.corners[0]), page.page(p.corners[1]), page.page(p.corners[2])});
        color const c = scale((band + 0.5) / bands * scale.high());
        page.fill_and_stroke(c, c, 0.6);
    }
    for (auto const& d : f.discs) page.add_disc(page.page(d.middle), d.radius * page.scale());
    page.stroke({0.92, 0.92, 0.92}, 0.7);
    double const x = frame.right + 26;
    auto const unit = lacuna::pressure_unit_for(scale.high());
    page.text({x, frame.low - 22}, std::string("pressure, ") + unit.name, em, ink);
    lacuna::draw_color_bar(page, {x, frame.low + 10, x + 16, frame.low + 190}, scale, unit.size, false, false, em, ink);
    double const foot = page.page({0, extent_of(f).low})[1];
    page.text({0.5 * (frame.left + frame.right), foot + 20}, f.moment, em, ink, lacuna::text_align::center);
}

void draw_plot(canvas& page, outcome const& o, rectangle const& frame) {
    double high = 0, low = 1e300;
    for (auto const& curve : o.curves)
        for (auto const& p : curve.points) {
            high = std::max({high, p.value, p.reference});
            low = std::min({low, p.value, p.reference});
        }
    if (low < 0.5 * high) low = 0;
    double const left = o.logarithmic ? o.curves.front().points.front().x : 0;
    double const right = o.logarithmic ? o.curves.front().points.back().x : 1;
    auto const scale = o.logarithmic ? lacuna::axis_scale::logarithmic : lacuna::axis_scale::linear;
    lacuna::plot plane(
        page, frame, {left * (1 - 1e-3), right * (1 + 1e-3), o.x_label, scale, 12},
        {low - 0.1 * (high - low) * (low > 0), high + 0.05 * (high - low), "", lacuna::axis_scale::linear, 8},
        {em, ink});
    plane.draw_axes();
    std::vector<lacuna::legend_entry> legend;
    for (std::size_t c = 0; c < o.curves.size(); ++c) {
        lacuna::plot::points lines, circles;
        for (auto const& p : o.curves[c].points) {
            lines.push_back({p.x, p.reference});
            circles.push_back({p.x, p.value});
        }
        plane.line(lines, lacuna::plot_ink(c));
        plane.markers(circles, lacuna::plot_mark::ring, lacuna::plot_ink(c), 2.8);
        legend.push_back({lacuna::legend_mark::line_and_ring, lacuna::plot_ink(c), o.curves[c].name});
    }
    lacuna::draw_legend(page, {frame.left, frame.low - 14 - 1.65 * em * double(o.curves.size() - 1)}, legend, em, ink);
}

} // namespace

void save_picture(std::string const& path, outcome const& o) {
    rectangle const body = extent_of(o.field);
    double const height = 240, top = 106;
    double const widest = 300, width = std::clamp(height * body.width() / body.height(), 60.0, widest);
    double const plot = 30 + width + 165;
    lacuna::save_canvas(path, plot + 360, top + height + 80, [&](canvas& page) {
        page.clear({1, 1, 1});
        page.text({30, 30}, o.title, 1.25 * em, ink, lacuna::text_align::left, true);
        draw_field(page, o.field, {30, top, 30 + width, top + height});
        draw_plot(page, o, {plot, top, plot + 330, top + height});
        page.text({plot + 330, top + height + 64}, "line: reference, circles: run", 0.9 * em, ink,
                  lacuna::text_align::right);
    });
}

} // namespace poroelasticity
