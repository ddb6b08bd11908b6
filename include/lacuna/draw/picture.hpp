// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/draw/canvas.hpp>
#include <lacuna/draw/canvas_furniture.hpp>
#include <lacuna/draw/color_scale.hpp>
#include <lacuna/draw/picture_scene.hpp>

/// \file
/// Two pictures of a scene: the specimen as in the paper's Figure 9, and its damage as in Figures 10 to 12.

namespace lacuna {

/// Sizes in pixels and colours of a picture.
struct picture_style {
    double longest = 1120;      ///< largest height of the frame
    double widest = 1120;       ///< largest width of the frame
    double text_size = 16;      ///< of captions and ticks; the title is larger
    double side_column = 240;   ///< width of the column with legend, captions and colour bar
    double dash_length = 1.7;   ///< of broken bonds, in mean particle radii
    color ink{0.13, 0.13, 0.15};
    color bond{0.2905, 0.056, 0.0525};
    color tension{0.90, 0.05, 0.05};
    color shear{0.85, 0.05, 0.60};

    /// \throws std::invalid_argument for a size that is not positive, or a colour outside 0 to 1
    void validate() const {
        require_positive("picture_style.longest", longest);
        require_positive("picture_style.widest", widest);
        require_positive("picture_style.text_size", text_size);
        require_positive("picture_style.side_column", side_column);
        require_positive("picture_style.dash_length", dash_length);
        for (auto const& c : {ink, bond, tension, shear})
            for (double const part : {c.red, c.green, c.blue}) require_in("picture_style.color", part, 0, 1);
    }
};

/// Positions of the parts of a picture on its page.
struct picture_layout {
    rectangle world;   ///< part of the world that the frame shows, m
    rectangle frame;   ///< frame on the page, px
    double column = 0; ///< left end of the column with legend, captions and colour bar, px
    double width = 0;  ///< of the page, px
    double height = 0; ///< of the page, px
};

/// Layout of the page for a scene: the specimen and its walls in the frame, with margins for loads above, hatching
/// below and the column beside it.
inline picture_layout layout_of(scene const& s, picture_style const& style) {
    s.validate();
    style.validate();
    rectangle world{s.left, s.bottom, s.right, s.top};
    for (std::vector<scene::wall> const* list : {&s.walls, &s.supports})
        for (scene::wall const& w : *list)
            for (scene::point const& p : {w.from, w.to}) {
                world.left = std::min(world.left, p[0]);
                world.right = std::max(world.right, p[0]);
                world.low = std::min(world.low, p[1]);
                world.high = std::max(world.high, p[1]);
            }
    double const scale = std::min(style.longest / world.height(), style.widest / world.width());
    double const margin = 34;
    double const title = s.title.empty() ? margin : 3.2 * style.text_size + margin;
    double const arrows = s.loads.empty() ? 10 : 64;
    picture_layout page;
    page.world = world;
    page.frame = {margin, title + arrows, margin + scale * world.width(), title + arrows + scale * world.height()};
    page.column = page.frame.right + (s.zones.size() < 2 ? 40 : 115);
    page.width = std::ceil(page.column + style.side_column);
    double const column_height = (16 + 1.5 * double(s.captions.size())) * style.text_size + 150;
    page.height = std::ceil(std::max(page.frame.high + 76, page.frame.low + column_height));
    return page;
}

namespace detail {

inline void add_particles(canvas& page, scene const& s, int kind, double shrink = 1) {
    for (scene::particle const& p : s.particles)
        if (p.kind == kind) page.add_disc(page.page(p.position), shrink * p.radius * page.scale());
}

inline bool has_kind(scene const& s, int kind) {
    return std::any_of(s.particles.begin(), s.particles.end(),
                       [kind](scene::particle const& p) { return p.kind == kind; });
}

inline double mean_radius(scene const& s) {
    double sum = 0;
    for (scene::particle const& p : s.particles) sum += p.radius;
    return s.particles.empty() ? 0.01 * (s.right - s.left) : sum / double(s.particles.size());
}

inline void add_bonds(canvas& page, scene const& s) {
    for (scene::bond const& b : s.bonds) page.add_line(page.page(b.from), page.page(b.to));
}

/// Draws the parts that both pictures share: title, loads, supports, walls, scale bar.
inline void draw_surroundings(canvas& page, scene const& s, picture_style const& style,
                              picture_layout const& layout) {
    double const em = style.text_size;
    if (!s.title.empty()) {
        page.text({layout.frame.left, 30}, s.title, 1.45 * em, style.ink, text_align::left, true);
        page.text({layout.frame.left, 30 + 1.75 * em}, s.subtitle, em, mix(style.ink, {1, 1, 1}, 0.35));
    }
    double last_x = -1e300;
    double top_of_arrows = 1e300;
    for (scene::load const& l : s.loads) {
        canvas::point const at = page.page(l.at);
        if (std::fabs(at[0] - last_x) < 9) continue;
        last_x = at[0];
        canvas::point const direction{l.direction[0], -l.direction[1]};
        // The tip is a radius away from the centre, so that it points at the rim.
        double const off = mean_radius(s) * page.scale() + 2;
        double const size = norm(direction);
        canvas::point const tip = size > 0 ? at - direction * (off / size) : at;
        draw_arrow(page, tip, direction, 36, 10, style.ink, 1.6);
        top_of_arrows = std::min(top_of_arrows, tip[1] - 36);
    }
    if (!s.loads.empty() && !s.load_label.empty())
        page.text({0.5 * (layout.frame.left + layout.frame.right), top_of_arrows - 0.8 * em}, s.load_label, em,
                  style.ink, text_align::center, true);
    for (std::vector<scene::wall> const* list : {&s.supports, &s.walls})
        for (scene::wall const& w : *list) draw_hatched_line(page, page.page(w.from), page.page(w.to), 13, style.ink);
    draw_scale_bar(page, {layout.frame.left, layout.frame.high + 46}, 0.4 * layout.frame.width(), em, style.ink);
}

inline void draw_zones(canvas& page, scene const& s, picture_style const& style, picture_layout const& layout) {
    if (s.zones.size() < 2) return;
    for (scene::zone const& z : s.zones) {
        double const high = page.page({s.left, z.high})[1];
        double const low = page.page({s.left, z.low})[1];
        double const x = layout.frame.right + 22;
        page.add_line({x, high + 3}, {x, low - 3});
        page.stroke(style.ink, 1.2);
        for (double y : {high + 3, low - 3}) page.add_line({x - 5, y}, {x, y});
        page.stroke(style.ink, 1.2);
        page.text({x + 10, 0.5 * (high + low)}, z.name, style.text_size, style.ink);
    }
}

inline double draw_captions(canvas& page, scene const& s, picture_style const& style, canvas::point at) {
    for (std::string const& line : s.captions) {
        page.text(at, line, 0.92 * style.text_size, mix(style.ink, {1, 1, 1}, 0.15));
        at[1] += 1.5 * style.text_size;
    }
    return at[1];
}

} // namespace detail

/// Draws the specimen as in the paper's Figure 9: particles coloured by kind, bonds, loads, supports, walls.
inline void draw_packing(canvas& page, scene const& s, picture_style const& style = {}) {
    picture_layout const layout = layout_of(s, style);
    page.set_world(layout.world, layout.frame);
    page.clear({1, 1, 1});
    std::vector<legend_entry> legend;
    for (int kind = 0; kind < int(s.kinds.size()); ++kind) {
        if (!detail::has_kind(s, kind)) continue;
        auto const& [name, fill, behind] = s.kinds[std::size_t(kind)];
        detail::add_particles(page, s, kind, 0.97);
        page.fill_and_stroke(fill, mix(fill, {0, 0, 0}, 0.45), 0.7);
        legend.push_back({legend_mark::disc, fill, name});
    }
    if (!s.bonds.empty()) {
        detail::add_bonds(page, s);
        page.stroke(style.bond, 1.8);
        legend.push_back({legend_mark::line, style.bond, "bond"});
    }
    detail::draw_surroundings(page, s, style, layout);
    detail::draw_zones(page, s, style, layout);
    double const x = layout.column;
    double const y = draw_legend(page, {x, layout.frame.low + 12}, legend, style.text_size, style.ink);
    detail::draw_captions(page, s, style, {x, y + style.text_size});
}

namespace detail {
/// Draws the broken bonds as dashes, those broken in tension on top.
/// \param radius mean one of the particles, in pixels
/// \return how many were broken in shear, in tension
inline std::array<int, 2> draw_cracks(canvas& page, scene const& s, picture_style const& style, double radius) {
    double const half = std::max(0.5 * style.dash_length * radius, 4.0);
    double const thick = std::clamp(0.55 * radius, 2.5, 6.0);
    auto const add_cracks = [&](scene::break_mode mode) {
        int count = 0;
        for (scene::crack const& c : s.cracks) {
            if (c.mode != mode) continue;
            double const size = norm(c.direction);
            canvas::point const arm{c.direction[0] / size * half, -c.direction[1] / size * half};
            canvas::point const middle = page.page(c.position);
            page.add_line(middle - arm, middle + arm);
            ++count;
        }
        return count;
    };
    for (auto mode : {scene::break_mode::shear, scene::break_mode::tension}) {
        add_cracks(mode);
        page.stroke({1, 1, 1, 0.9}, thick + 2.4);
    }
    int const sheared = add_cracks(scene::break_mode::shear);
    page.stroke(style.shear, thick, true);
    int const torn = add_cracks(scene::break_mode::tension);
    page.stroke(style.tension, thick, true);
    return {sheared, torn};
}
} // namespace detail

/// Draws the damage as in the paper's Figures 10 to 12: pore pressure as coloured dots with a colour bar, broken bonds
/// as dashes, particles and intact bonds in pale colours behind. Anything outside the frame is clipped.
inline void draw_damage(canvas& page, scene const& s, picture_style const& style = {}) {
    picture_layout const layout = layout_of(s, style);
    double const em = style.text_size;
    page.set_world(layout.world, layout.frame);
    page.clear({1, 1, 1});
    page.clip({layout.frame.left - 4, layout.frame.low - 30, layout.frame.right + 4, layout.frame.high + 4});

    for (int kind = 0; kind < int(s.kinds.size()); ++kind) {
        detail::add_particles(page, s, kind, 0.97);
        page.fill_and_stroke(s.kinds[std::size_t(kind)].behind, {0.84, 0.84, 0.85}, 0.5);
    }
    detail::add_bonds(page, s);
    page.stroke({0.58, 0.58, 0.60}, 1.8);

    std::vector<double> pressures;
    for (scene::pore const& p : s.pores) pressures.push_back(p.pressure);
    color_scale const scale = robust_color_scale(pressures);
    double const radius = detail::mean_radius(s) * page.scale();
    double const dot = std::clamp(0.42 * radius, 1.2, 6.0);
    for (scene::pore const& p : s.pores) {
        if (!std::isfinite(p.pressure)) continue;
        page.add_disc(page.page(p.position), dot);
        page.fill(scale(p.pressure));
    }

    auto const [sheared, torn] = detail::draw_cracks(page, s, style, radius);
    page.unclip();

    detail::draw_surroundings(page, s, style, layout);
    detail::draw_zones(page, s, style, layout);
    double const x = layout.column;
    std::vector<legend_entry> legend{{legend_mark::dash, style.tension, "broken in tension: " + std::to_string(torn)},
                                     {legend_mark::dash, style.shear, "broken in shear: " + std::to_string(sheared)},
                                     {legend_mark::line, {0.58, 0.58, 0.60}, "intact bond"}};
    for (int kind = int(s.kinds.size()) - 1; kind >= 0; --kind)
        if (detail::has_kind(s, kind))
            legend.push_back({legend_mark::disc, s.kinds[std::size_t(kind)].behind, s.kinds[std::size_t(kind)].name});
    double y = draw_legend(page, {x, layout.frame.low + 12}, legend, em, style.ink);
    y = detail::draw_captions(page, s, style, {x, y + em}) + 1.6 * em;
    if (!pressures.empty()) {
        auto const range = std::minmax_element(pressures.begin(), pressures.end());
        pressure_unit const unit = pressure_unit_for(std::max(std::fabs(scale.low()), std::fabs(scale.high())));
        page.text({x, y}, std::string("pore pressure (") + unit.name + ")", em, style.ink, text_align::left, true);
        double const top = y + 2.6 * em;
        draw_color_bar(page, {x, top, x + 20, std::max(top + 110, std::min(top + 380, layout.frame.high - 24))}, scale,
                       unit.size, *range.first < scale.low(), *range.second > scale.high(), em, style.ink);
    }
}

/// Writes stem.png and stem.svg of draw_packing. \throws as save_canvas
inline void save_packing(std::string const& stem, scene const& s, picture_style const& style = {}) {
    picture_layout const layout = layout_of(s, style);
    save_canvas_png_svg(stem, layout.width, layout.height, [&](canvas& page) { draw_packing(page, s, style); });
}
/// Writes stem.png and stem.svg of draw_damage. \throws as save_canvas
inline void save_damage(std::string const& stem, scene const& s, picture_style const& style = {}) {
    picture_layout const layout = layout_of(s, style);
    save_canvas_png_svg(stem, layout.width, layout.height, [&](canvas& page) { draw_damage(page, s, style); });
}

} // namespace lacuna
