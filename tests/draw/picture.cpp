// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "scratch_directory.hpp"

#include <lacuna/draw/picture.hpp>

#include <cmath>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

namespace {

/// Four particles in a specimen of 40 x 20 µm: two bonded ones and two free ones.
lacuna::scene small_scene() {
    lacuna::scene s;
    s.right = 40e-6;
    s.top = 20e-6;
    s.kinds = {{"free"}, {"bonded", {0.83, 0.16, 0.15}, {0.86, 0.86, 0.87}}};
    s.particles = {{{5e-6, 5e-6}, 4e-6, 1},
                   {{13e-6, 5e-6}, 4e-6, 1},
                   {{5e-6, 15e-6}, 4e-6, 0},
                   {{30e-6, 12e-6}, 4e-6, 0}};
    s.cracks = {{{9e-6, 5e-6}, {1, 0}, lacuna::scene::break_mode::tension}};
    s.pores = {{{20e-6, 12e-6}, 0}, {{24e-6, 16e-6}, 2e6}};
    return s;
}

/// Draws on an image in memory and reads pixels back.
class drawn {
public:
    template <class Draw>
    drawn(lacuna::scene const& s, Draw const& draw) {
        layout_ = lacuna::layout_of(s, {});
        surface_.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(layout_.width), int(layout_.height)));
        lacuna::detail::cairo_context const context(cairo_create(surface_.get()));
        lacuna::canvas page(context.get(), layout_.width, layout_.height);
        draw(page, s);
        cairo_surface_flush(surface_.get());
        at_ = [page](double x, double y) { return page.page({x, y}); };
    }
    lacuna::picture_layout const& layout() const { return layout_; }
    lacuna::canvas::point page(double x, double y) const { return at_(x, y); }
    /// The colour at a point of the world (m).
    lacuna::color operator()(double x, double y) const { return pixel(at_(x, y)); }
    /// Number of pixels in a part of the page that are darker than a light grey.
    int dark(double left, double right, double low, double high) const {
        int count = 0;
        for (double y = std::floor(low); y < high; ++y)
            for (double x = std::floor(left); x < right; ++x) {
                auto const c = pixel({x, y});
                count += c.red + c.green + c.blue < 2;
            }
        return count;
    }
    /// The colour at a point of the page (px).
    lacuna::color pixel(lacuna::canvas::point const& p) const {
        unsigned char const* row = cairo_image_surface_get_data(surface_.get()) +
                                   int(p[1]) * cairo_image_surface_get_stride(surface_.get());
        unsigned const pixel = reinterpret_cast<unsigned const*>(row)[int(p[0])];
        return {(pixel >> 16 & 255) / 255.0, (pixel >> 8 & 255) / 255.0, (pixel & 255) / 255.0};
    }

private:
    lacuna::picture_layout layout_;
    lacuna::detail::cairo_surface surface_;
    std::function<lacuna::canvas::point(double, double)> at_;
};

bool close(lacuna::color const& a, lacuna::color const& b) {
    return std::fabs(a.red - b.red) < 0.01 && std::fabs(a.green - b.green) < 0.01 && std::fabs(a.blue - b.blue) < 0.01;
}

} // namespace

TEST_CASE("the picture of a packing has each particle in its position and colour") {
    auto const kinds = small_scene().kinds;
    drawn const picture(small_scene(), [](lacuna::canvas& c, lacuna::scene const& s) { lacuna::draw_packing(c, s); });
    CHECK(close(picture(5e-6, 5e-6), kinds[1].fill));
    CHECK(close(picture(13e-6, 7e-6), kinds[1].fill));
    CHECK(close(picture(5e-6, 15e-6), kinds[0].fill));
    CHECK(close(picture(30e-6, 15.5e-6), kinds[0].fill));
    CHECK(close(picture(30e-6, 17e-6), {1, 1, 1}));
    CHECK(close(picture(22e-6, 4e-6), {1, 1, 1}));
}

TEST_CASE("the damage picture shows pressures as colours and a break as a red dash") {
    lacuna::picture_style const style;
    drawn const picture(small_scene(), [](lacuna::canvas& c, lacuna::scene const& s) { lacuna::draw_damage(c, s); });
    CHECK(close(picture(20e-6, 12e-6), {68 / 255.0, 1 / 255.0, 84 / 255.0}));
    CHECK(close(picture(24e-6, 16e-6), {253 / 255.0, 231 / 255.0, 37 / 255.0}));
    CHECK(close(picture(9e-6, 5e-6), style.tension));
    CHECK(close(picture(22e-6, 4e-6), {1, 1, 1}));
}

TEST_CASE("loads, walls, zones and texts are around the specimen, in the margins made for them") {
    lacuna::picture_style const style;
    auto const draw = [](lacuna::canvas& c, lacuna::scene const& s) { lacuna::draw_packing(c, s); };
    auto s = small_scene();
    drawn const plain(s, draw);
    s.title = "Title";
    s.load_label = "60 MPa";
    s.loads = {{{5e-6, 15e-6}, {0, -2}}, {{30e-6, 12e-6}, {0, 0}}};
    s.walls = {{{-2e-6, 20e-6}, {-2e-6, 0}}, {{0, 0}, {0, 0}}};
    s.zones = {{0, 10e-6, "deep"}, {10e-6, 20e-6, "surface"}};
    s.bonds = {{{5e-6, 5e-6}, {13e-6, 5e-6}}};
    drawn const full(s, draw);
    auto const &page = full.layout(), &bare = plain.layout();
    // A title in 1.45 text sizes, and arrows of 36 px above the specimen.
    CHECK(page.frame.low - bare.frame.low > 3 * style.text_size + 36);
    CHECK(full.dark(page.frame.left, page.frame.left + 60, 10, 32) > 20);
    CHECK(plain.dark(bare.frame.left, bare.frame.left + 60, 0, 32) == 0);
    // The arrow's shaft ends 36 px above its tip, which is a mean radius and 2 px above the particle; a load without a
    // direction has none.
    double const scale = page.frame.width() / page.world.width();
    auto const above = [&](double x, double y) { return full.page(x, y) - lacuna::canvas::point{0, 4e-6 * scale + 2}; };
    auto const tip = above(5e-6, 15e-6), none = above(30e-6, 12e-6);
    CHECK(close(full.pixel(tip - lacuna::canvas::point{0, 20}), style.ink));
    CHECK(full.dark(tip[0] - 3, tip[0] + 4, tip[1] - 44, tip[1] - 37) == 0);
    CHECK(full.dark(none[0] - 3, none[0] + 4, none[1] - 30, none[1] - 5) == 0);
    double const middle = 0.5 * (page.frame.left + page.frame.right);
    CHECK(full.dark(middle - 30, middle + 30, tip[1] - 36 - 1.5 * style.text_size, tip[1] - 36) > 20);
    // The wall goes down: its solid side, hatched, is on the left of the page.
    auto const wall = full.page(-2e-6, 10e-6);
    CHECK(close(full.pixel(wall), style.ink));
    CHECK(full.dark(wall[0] - 12, wall[0] - 3, wall[1] - 20, wall[1] + 20) > 10);
    CHECK(full.dark(wall[0] + 4, wall[0] + 13, wall[1] - 20, wall[1] + 20) == 0);
    // A bracket for each zone and its name beside it.
    for (double const y : {5e-6, 15e-6}) {
        auto const at = full.page(40e-6, y);
        CHECK(full.dark(page.frame.right + 20, page.frame.right + 25, at[1] - 2, at[1] + 2) > 0);
        CHECK(full.dark(page.frame.right + 30, page.frame.right + 100, at[1] - 12, at[1] + 12) > 20);
    }
    CHECK_FALSE(close(full(7e-6, 5e-6), small_scene().kinds[1].fill));
    CHECK(close(plain(7e-6, 5e-6), small_scene().kinds[1].fill));
}

TEST_CASE("texts are to the right of their point, centred at it, or to its left") {
    using lacuna::text_align;
    auto const dark = [](text_align align, double left, double right) {
        lacuna::scene s = small_scene();
        drawn const picture(s, [&](lacuna::canvas& c, lacuna::scene const&) {
            c.clear({1, 1, 1});
            c.text({100, 50}, "words", 14, {0, 0, 0}, align);
        });
        return picture.dark(left, right, 30, 60);
    };
    CHECK(dark(text_align::left, 60, 100) == 0);
    CHECK(dark(text_align::left, 100, 160) > 20);
    CHECK(dark(text_align::center, 60, 100) > 10);
    CHECK(dark(text_align::center, 100, 140) > 10);
    CHECK(dark(text_align::right, 40, 99) > 20);
    CHECK(dark(text_align::right, 101, 160) == 0);
}

TEST_CASE("pictures are written whole, as PNG and SVG of the same size") {
    scratch_directory dir;
    lacuna::scene const s = small_scene();
    lacuna::save_damage(dir.file("damage"), s);
    lacuna::picture_layout const layout = lacuna::layout_of(s, {});
    std::string const png = bytes_of(dir.file("damage.png"));
    REQUIRE(png.size() > 1000);
    CHECK(png.substr(1, 3) == "PNG");
    auto const number = [&](std::size_t from) {
        int value = 0;
        for (std::size_t i = from; i < from + 4; ++i) value = 256 * value + int(static_cast<unsigned char>(png[i]));
        return value;
    };
    CHECK(number(16) == int(layout.width));
    CHECK(number(20) == int(layout.height));
    CHECK(png.find("IEND") != std::string::npos);
    std::string const svg = bytes_of(dir.file("damage.svg"));
    CHECK(svg.find("<svg") != std::string::npos);
    CHECK(svg.find("width=\"" + std::to_string(int(layout.width))) != std::string::npos);
    CHECK(svg.find("</svg>") != std::string::npos);
    CHECK(dir.entries() == 2);
}

TEST_CASE("the same drawing gives the same bytes") {
    scratch_directory dir;
    for (char const* stem : {"a", "b"}) lacuna::save_damage(dir.file(stem), small_scene());
    CHECK(bytes_of(dir.file("a.svg")) == bytes_of(dir.file("b.svg")));
    CHECK(bytes_of(dir.file("a.png")) == bytes_of(dir.file("b.png")));
}

TEST_CASE("a drawing that fails leaves no file and an earlier one untouched") {
    scratch_directory dir;
    for (char const* name : {"a.png", "a.svg"}) {
        std::ofstream(dir.file(name)) << "before";
        auto const fail = [](lacuna::canvas&) { throw std::logic_error("x"); };
        CHECK_THROWS_AS(lacuna::save_canvas(dir.file(name), 10, 10, fail), std::logic_error);
        CHECK(bytes_of(dir.file(name)) == "before");
    }
    CHECK(dir.entries() == 2);
    auto const nothing = [](lacuna::canvas&) {};
    CHECK_THROWS_WITH(lacuna::save_canvas(dir.file("a.gif"), 10, 10, nothing), contains_text(".png or .svg"));
    CHECK_THROWS_WITH(lacuna::save_packing(dir.file("none/a"), small_scene()), contains_text("none/a.png"));
}

TEST_CASE("an impossible scene is refused by name") {
    lacuna::scene s = small_scene();
    s.particles[1].radius = 0;
    CHECK_THROWS_WITH(lacuna::layout_of(s, {}), contains_text("scene.particles.radius"));
    s = small_scene();
    s.particles.back().kind = 2;
    CHECK_THROWS_WITH(lacuna::layout_of(s, {}), contains_text("scene.particles.kind"));
    lacuna::scene flat = small_scene();
    flat.top = flat.bottom;
    CHECK_THROWS_WITH(lacuna::layout_of(flat, {}), contains_text("scene.top - bottom"));
}

TEST_CASE("lengths and pressures get a readable unit") {
    CHECK(lacuna::length_label(20e-6) == "20 µm");
    CHECK(lacuna::length_label(1e-3) == "1 mm");
    CHECK(lacuna::length_label(500e-9) == "500 nm");
    CHECK(std::string(lacuna::pressure_unit_for(5e7).name) == "MPa");
    CHECK(std::string(lacuna::pressure_unit_for(300).name) == "kPa");
    CHECK(lacuna::pressure_unit_for(3e11).size == 1e9);
}
