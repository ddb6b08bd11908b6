// SPDX-License-Identifier: BSD-3-Clause
#include "picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <lacuna/observe/canvas.hpp>
#include <lacuna/observe/canvas_furniture.hpp>

namespace poroelasticity {

namespace {

using lacuna::canvas;
using lacuna::color;
using lacuna::rectangle;

constexpr color ink{0.13, 0.13, 0.15};
constexpr color pale{0.85, 0.85, 0.87};
constexpr std::array<color, 3> inks{{{0.10, 0.35, 0.75}, {0.80, 0.30, 0.10}, {0.15, 0.55, 0.25}}};
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
    // In bands, as contours are drawn, each filled at once: no seams, and small files.
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

/// The plane of a plot: what is at its edges, and where points of it are on the page.
struct plot_plane {
    rectangle frame;
    double left, right, low, high;
    bool logarithmic;

    canvas::point at(double x, double y) const {
        double const share = logarithmic ? std::log(x / left) / std::log(right / left) : (x - left) / (right - left);
        return {frame.left + share * frame.width(), frame.high - (y - low) / (high - low) * frame.height()};
    }
};

void draw_axes(canvas& page, plot_plane const& plane, outcome const& o) {
    auto const labelled_x = [&](double x, std::string const& label) {
        auto const foot = plane.at(x, plane.low);
        page.add_line({foot[0], plane.frame.low}, {foot[0], plane.frame.high});
        page.stroke(pale, 1);
        if (!label.empty()) page.text({foot[0], plane.frame.high + 18}, label, em, ink, lacuna::text_align::center);
    };
    if (plane.logarithmic) {
        for (double decade = 1e-6; decade < 1e6; decade *= 10)
            for (double const factor : {1.0, 2.0, 5.0}) {
                double const x = decade * factor;
                if (x >= plane.left * (1 - 1e-9) && x <= plane.right * (1 + 1e-9))
                    labelled_x(x, lacuna::to_text(std::round(x * 1e6) / 1e6));
            }
    } else {
        auto const ticks = lacuna::nice_ticks(plane.left, plane.right);
        auto const labels = lacuna::tick_labels(ticks);
        for (std::size_t k = 0; k < ticks.size(); ++k) labelled_x(ticks[k], labels[k]);
    }
    auto const ticks = lacuna::nice_ticks(plane.low, plane.high, 8);
    auto const labels = lacuna::tick_labels(ticks);
    for (std::size_t k = 0; k < ticks.size(); ++k) {
        double const y = plane.at(plane.left, ticks[k])[1];
        page.add_line({plane.frame.left, y}, {plane.frame.right, y});
        page.stroke(pale, 1);
        page.text({plane.frame.left - 9, y}, labels[k], em, ink, lacuna::text_align::right);
    }
    page.add_rectangle(plane.frame);
    page.stroke(ink, 1.2);
    page.text({0.5 * (plane.frame.left + plane.frame.right), plane.frame.high + 44}, o.x_label, em, ink,
              lacuna::text_align::center);
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
    plot_plane const plane{frame, left * (1 - 1e-3), right * (1 + 1e-3), low - 0.1 * (high - low) * (low > 0),
                           high + 0.05 * (high - low), o.logarithmic};
    draw_axes(page, plane, o);
    double y = frame.low - 14 - 22 * double(o.curves.size() - 1);
    for (std::size_t c = 0; c < o.curves.size(); ++c, y += 22) {
        auto const& points = o.curves[c].points;
        for (std::size_t k = 1; k < points.size(); ++k)
            page.add_line(plane.at(points[k - 1].x, points[k - 1].reference),
                          plane.at(points[k].x, points[k].reference));
        page.stroke(inks[c % inks.size()], 1.6);
        for (auto const& p : points) page.add_disc(plane.at(p.x, p.value), 2.8);
        page.stroke(inks[c % inks.size()], 1.3);
        page.add_line({frame.left, y}, {frame.left + 26, y});
        page.stroke(inks[c % inks.size()], 1.6);
        page.add_disc({frame.left + 13, y}, 2.8);
        page.stroke(inks[c % inks.size()], 1.3);
        page.text({frame.left + 36, y}, o.curves[c].name, em, ink);
    }
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
