// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <lacuna/observe/canvas_file.hpp>
#include <lacuna/observe/color_scale.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#ifdef LACUNA_HAS_PICTURES
#include <lacuna/observe/picture.hpp>
#endif

namespace fs = std::filesystem;

namespace {

/// A fresh directory that goes away with the test.
struct scratch_directory {
    fs::path path;
    scratch_directory() {
        std::string pattern = (fs::temp_directory_path() / "lacuna_picture_XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch directory");
        path = pattern;
    }
    ~scratch_directory() { fs::remove_all(path); }
    std::string file(char const* name) const { return (path / name).string(); }
    std::size_t entries() const { return std::size_t(std::distance(fs::directory_iterator(path), {})); }
};

std::string bytes_of(std::string const& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

TEST_CASE("a file appears whole or not at all") {
    scratch_directory dir;
    std::string const name = dir.file("data.csv");
    {
        lacuna::whole_file file(name);
        file.write("first");
        CHECK(!fs::exists(name));
        file.commit();
    }
    CHECK(bytes_of(name) == "first");
    {
        lacuna::whole_file file(name);
        file.write("never finished");
    }
    CHECK(bytes_of(name) == "first");
    CHECK(dir.entries() == 1);
    CHECK_THROWS_WITH(lacuna::whole_file(dir.file("missing/data.csv")), contains_text("missing/data.csv"));
}

TEST_CASE("colours: ends, middle and clamping") {
    lacuna::color_scale const scale(-2, 6);
    // The first, middle and last colour of the published viridis table.
    CHECK(scale(-2) == lacuna::color{68 / 255.0, 1 / 255.0, 84 / 255.0});
    CHECK(scale(2) == lacuna::color{33 / 255.0, 145 / 255.0, 140 / 255.0});
    CHECK(scale(6) == lacuna::color{253 / 255.0, 231 / 255.0, 37 / 255.0});
    CHECK(scale(-100) == scale(-2));
    CHECK(scale(100) == scale(6));
    auto const brightness = [](lacuna::color const& c) { return 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue; };
    for (double v = -2; v < 5.9; v += 0.1) CHECK(brightness(scale(v)) < brightness(scale(v + 0.1)));
    CHECK_THROWS_WITH(lacuna::color_scale(1, 1), contains_text("color_scale.high"));
    CHECK_THROWS_WITH(lacuna::color_scale(0, INFINITY), contains_text("color_scale.high"));
}

TEST_CASE("the scale for measured values leaves outliers out and keeps zero in") {
    std::vector<double> values(1000, 2.0);
    values[17] = 1e9;
    lacuna::color_scale const positive = lacuna::robust_color_scale(values);
    CHECK(positive.low() == 0);
    CHECK(positive.high() == 2);
    CHECK(positive.map() == lacuna::color_map::viridis);
    for (std::size_t i = 0; i < 500; ++i) values[2 * i] = -3.0;
    lacuna::color_scale const both = lacuna::robust_color_scale(values);
    CHECK(both.low() == -3);
    CHECK(both.high() == 3);
    CHECK(both.map() == lacuna::color_map::diverging);
    lacuna::color_scale const negative = lacuna::robust_color_scale({-4, -1, -2});
    CHECK(negative.low() == -4);
    CHECK(negative.high() == 0);
    for (auto const& nothing : {std::vector<double>{}, std::vector<double>{0, 0}, std::vector<double>{NAN}}) {
        CHECK(lacuna::robust_color_scale(nothing).low() == 0);
        CHECK(lacuna::robust_color_scale(nothing).high() == 1);
    }
}

TEST_CASE("ticks and lengths are round numbers") {
    CHECK(lacuna::nice_ticks(0, 10, 6) == std::vector<double>{0, 2, 4, 6, 8, 10});
    CHECK(lacuna::nice_ticks(-1.2, 1.2, 5) == std::vector<double>{-1, -0.5, 0, 0.5, 1});
    std::vector<std::string> const fifths{"0.0", "0.2", "0.4", "0.6", "0.8"};
    CHECK(lacuna::tick_labels(lacuna::nice_ticks(0, 0.9, 5)) == fifths);
    CHECK(lacuna::tick_labels({0, 5, 10}) == std::vector<std::string>{"0", "5", "10"});
    CHECK(lacuna::nice_ticks(-0.5, 3, 4).front() == 0);
    for (double high : {1e-9, 3.3e-4, 0.77, 12.0, 4.1e7}) {
        std::vector<double> const ticks = lacuna::nice_ticks(0, high);
        CHECK(ticks.size() >= 3);
        CHECK(ticks.size() <= 6);
        CHECK(ticks.back() <= high * (1 + 1e-9));
    }
    CHECK_THROWS_WITH(lacuna::nice_ticks(2, 1), contains_text("nice_ticks.high"));
    CHECK_THAT(lacuna::nice_below(47e-6), WithinRel(20e-6, 1e-12));
    CHECK_THAT(lacuna::nice_below(50e-6), WithinRel(50e-6, 1e-12));
    CHECK_THAT(lacuna::nice_below(9.99), WithinRel(5.0, 1e-12));
    CHECK_THAT(lacuna::nice_below(0.1), WithinRel(0.1, 1e-12));
}

#ifdef LACUNA_HAS_PICTURES

namespace {

/// Four particles on a 40 x 20 µm body: two bonded ones and two free ones.
lacuna::scene small_scene() {
    lacuna::scene s;
    s.right = 40e-6;
    s.top = 20e-6;
    using kind = lacuna::scene::particle_kind;
    s.particles = {{{5e-6, 5e-6}, 4e-6, kind::fibre},
                   {{13e-6, 5e-6}, 4e-6, kind::fibre},
                   {{5e-6, 15e-6}, 4e-6, kind::free},
                   {{30e-6, 12e-6}, 4e-6, kind::free}};
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
    /// The colour at a point of the world (m).
    lacuna::color operator()(double x, double y) const {
        auto const p = at_(x, y);
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

TEST_CASE("the packing picture has each particle in its place and colour") {
    lacuna::picture_style const style;
    drawn const picture(small_scene(), [](lacuna::canvas& c, lacuna::scene const& s) { lacuna::draw_packing(c, s); });
    CHECK(close(picture(5e-6, 5e-6), style.fibre));
    CHECK(close(picture(13e-6, 7e-6), style.fibre));
    CHECK(close(picture(5e-6, 15e-6), style.free));
    CHECK(close(picture(30e-6, 15.5e-6), style.free));
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
    lacuna::scene flat = small_scene();
    flat.top = flat.bottom;
    CHECK_THROWS_WITH(lacuna::layout_of(flat, {}), contains_text("scene.top - bottom"));
}

TEST_CASE("lengths and pressures get the unit a person would choose") {
    CHECK(lacuna::length_label(20e-6) == "20 µm");
    CHECK(lacuna::length_label(1e-3) == "1 mm");
    CHECK(lacuna::length_label(500e-9) == "500 nm");
    CHECK(std::string(lacuna::pressure_unit_for(5e7).name) == "MPa");
    CHECK(std::string(lacuna::pressure_unit_for(300).name) == "kPa");
    CHECK(lacuna::pressure_unit_for(3e11).size == 1e9);
}

#endif
