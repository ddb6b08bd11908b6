// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#if __has_include(<cairo/cairo.h>)
#include <cairo/cairo-svg.h>
#include <cairo/cairo.h>
#else
#include <cairo-svg.h>
#include <cairo.h>
#endif

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/core/whole_file.hpp>
#include <lacuna/draw/color_scale.hpp>

/// \file
/// A page to draw on, and its output as a PNG or SVG file. The only header that includes cairo.

namespace lacuna {

/// A rectangle, in metres with y up, or on a page in pixels with y down (`low` is its upper edge there).
struct rectangle {
    double left = 0;
    double low = 0;
    double right = 0;
    double high = 0;

    constexpr double width() const noexcept { return right - left; }
    constexpr double height() const noexcept { return high - low; }
};

/// Horizontal alignment of a text relative to its point. Vertically the point is in the middle of the line.
enum class text_align { left, center, right };

/// Drawing calls for one page. Points are page points, in pixels from the top left corner, y down. `page()` converts
/// world points, in metres with y up, to page points.
class canvas {
public:
    using point = vec<double, 2>;

    /// Draws with `context`, which must outlive the canvas, on a page of width x height pixels.
    canvas(cairo_t* context, double width, double height) noexcept : context_(context), width_(width), height_(height) {
        cairo_set_line_cap(context_, CAIRO_LINE_CAP_ROUND);
        cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
    }
    double width() const noexcept { return width_; }
    double height() const noexcept { return height_; }

    /// Maps the rectangle `world` (m) into `frame` (px), centred, with the same scale in both directions.
    void set_world(rectangle const& world, rectangle const& frame) noexcept {
        scale_ = std::min(frame.width() / world.width(), frame.height() / world.height());
        origin_ = {0.5 * (frame.left + frame.right) - 0.5 * scale_ * (world.left + world.right),
                   0.5 * (frame.low + frame.high) + 0.5 * scale_ * (world.low + world.high)};
    }
    /// Pixels per metre.
    double scale() const noexcept { return scale_; }
    /// The page point of a world point (m).
    point page(point const& world) const noexcept {
        return {origin_[0] + scale_ * world[0], origin_[1] - scale_ * world[1]};
    }

    void clear(color const& c) noexcept {
        set(c);
        cairo_paint(context_);
    }
    /// Clips all later drawing to a rectangle of the page, until `unclip()`.
    void clip(rectangle const& r) noexcept {
        cairo_save(context_);
        cairo_rectangle(context_, r.left, r.low, r.width(), r.height());
        cairo_clip(context_);
    }
    void unclip() noexcept { cairo_restore(context_); }

    /// \name Paths
    /// add_...() collects any number of shapes; fill() or stroke() then draws them all at once.
    /// \{
    void add_disc(point const& centre, double radius) noexcept {
        cairo_new_sub_path(context_);
        cairo_arc(context_, centre[0], centre[1], radius, 0, 6.283185307179586);
        cairo_close_path(context_);
    }
    void add_line(point const& from, point const& to) noexcept {
        cairo_move_to(context_, from[0], from[1]);
        cairo_line_to(context_, to[0], to[1]);
    }
    void add_rectangle(rectangle const& r) noexcept { cairo_rectangle(context_, r.left, r.low, r.width(), r.height()); }
    /// \param corners any range of page points
    template <class Corners>
    void add_polygon(Corners const& corners) noexcept {
        add_path(corners);
        cairo_close_path(context_);
    }
    void add_polygon(std::initializer_list<point> corners) noexcept {
        add_polygon<std::initializer_list<point>>(corners);
    }
    /// Adds a line through all points of a range.
    template <class Points>
    void add_path(Points const& points) noexcept {
        cairo_new_sub_path(context_);
        for (point const& p : points) cairo_line_to(context_, p[0], p[1]);
    }
    void fill(color const& c) noexcept {
        set(c);
        cairo_fill(context_);
    }
    void stroke(color const& c, double line_width, bool butt = false) noexcept {
        set(c);
        cairo_set_line_width(context_, line_width);
        cairo_set_line_cap(context_, butt ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
        cairo_stroke(context_);
    }
    void fill_and_stroke(color const& inside, color const& rim, double line_width) noexcept {
        set(inside);
        cairo_fill_preserve(context_);
        stroke(rim, line_width);
    }
    /// Strokes with dashes of the given length and gap (px).
    void stroke_dashed(color const& c, double line_width, double dash, double gap) noexcept {
        std::array<double, 2> const pattern{dash, gap};
        cairo_set_dash(context_, pattern.data(), 2, 0);
        stroke(c, line_width, true);
        cairo_set_dash(context_, nullptr, 0, 0);
    }
    /// \}

    /// Writes one line of UTF-8 text of font size `size` (px), vertically centred at `at`.
    void text(point const& at, std::string const& line, double size, color const& c = {},
              text_align align = text_align::left, bool bold = false) {
        select_font(size, bold);
        set(c);
        cairo_text_extents_t extents;
        cairo_text_extents(context_, line.c_str(), &extents);
        double const shift = align == text_align::left     ? 0.0
                             : align == text_align::center ? -0.5 * extents.x_advance
                                                           : -extents.x_advance;
        cairo_move_to(context_, at[0] + shift, at[1] + 0.36 * size);
        cairo_show_text(context_, line.c_str());
        cairo_new_path(context_);
    }
    /// Width of a line of text (px).
    double text_width(std::string const& line, double size, bool bold = false) {
        select_font(size, bold);
        cairo_text_extents_t extents;
        cairo_text_extents(context_, line.c_str(), &extents);
        return extents.x_advance;
    }

private:
    void set(color const& c) noexcept { cairo_set_source_rgba(context_, c.red, c.green, c.blue, c.alpha); }
    void select_font(double size, bool bold) noexcept {
        cairo_select_font_face(context_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                               bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(context_, size);
    }

    cairo_t* context_;
    double width_;
    double height_;
    double scale_ = 1;
    point origin_{};
};

namespace detail {
struct cairo_deleter {
    void operator()(cairo_surface_t* surface) const noexcept { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const noexcept { cairo_destroy(context); }
};
using cairo_surface = std::unique_ptr<cairo_surface_t, cairo_deleter>;
using cairo_context = std::unique_ptr<cairo_t, cairo_deleter>;

inline void check_cairo(cairo_status_t status, std::string const& path) {
    if (status != CAIRO_STATUS_SUCCESS)
        throw std::runtime_error("cannot draw " + path + ": " + cairo_status_to_string(status));
}
inline cairo_status_t write_to_text(void* text, unsigned char const* bytes, unsigned int count) {
    static_cast<std::string*>(text)->append(reinterpret_cast<char const*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
}
/// Numbers cairo's surfaces from 1 on. cairo counts them over the life of the program; renumbered, the same drawing has
/// the same bytes.
inline std::string renumber_surfaces(std::string const& svg) {
    constexpr std::string_view mark = "surface";
    std::vector<std::string> known;
    std::string out;
    std::size_t from = 0;
    for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, from)) {
        std::size_t const first = at + mark.size();
        std::size_t const end = std::min(svg.find_first_not_of("0123456789", first), svg.size());
        out.append(svg, from, first - from);
        from = end;
        if (end == first) continue;
        std::string const number = svg.substr(first, end - first);
        std::size_t const index = std::size_t(std::find(known.begin(), known.end(), number) - known.begin());
        if (index == known.size()) known.push_back(number);
        out += std::to_string(index + 1);
    }
    return out.append(svg, from);
}
inline cairo_status_t write_to_file(void* file, unsigned char const* bytes, unsigned int count) {
    return std::fwrite(bytes, 1, count, static_cast<std::FILE*>(file)) == count ? CAIRO_STATUS_SUCCESS
                                                                                : CAIRO_STATUS_WRITE_ERROR;
}
} // namespace detail

/// Draws a page of width x height pixels into a file. The file is written completely or not at all; the same drawing
/// gives the same bytes.
/// \param path ends in ".png" or ".svg", which chooses the format
/// \param draw called with a canvas&
/// \throws std::invalid_argument for another ending, or a size that is not from 1 to 30000
/// \throws std::runtime_error when the file cannot be written
template <class Draw>
void save_canvas(std::string const& path, double width, double height, Draw const& draw) {
    require_in("save_canvas.width", width, 1, 30000);
    require_in("save_canvas.height", height, 1, 30000);
    std::string const ending = path.size() < 4 ? "" : path.substr(path.size() - 4);
    bool const svg = ending == ".svg";
    if (!svg && ending != ".png") refuse("save_canvas.path", path, "a name that ends in .png or .svg");

    whole_file file(path);
    std::string text;
    detail::cairo_surface const surface(
        svg ? cairo_svg_surface_create_for_stream(detail::write_to_text, &text, width, height)
            : cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(std::ceil(width)), int(std::ceil(height))));
    detail::check_cairo(cairo_surface_status(surface.get()), path);
    {
        detail::cairo_context const context(cairo_create(surface.get()));
        canvas page(context.get(), width, height);
        draw(page);
        detail::check_cairo(cairo_status(context.get()), path);
    }
    if (!svg)
        detail::check_cairo(cairo_surface_write_to_png_stream(surface.get(), detail::write_to_file, file.handle()),
                            path);
    cairo_surface_finish(surface.get());
    detail::check_cairo(cairo_surface_status(surface.get()), path);
    if (svg) file.write(detail::renumber_surfaces(text));
    file.commit();
}

/// Draws the same page into stem.png and stem.svg; see save_canvas.
template <class Draw>
void save_canvas_png_svg(std::string const& stem, double width, double height, Draw const& draw) {
    save_canvas(stem + ".png", width, height, draw);
    save_canvas(stem + ".svg", width, height, draw);
}

} // namespace lacuna
