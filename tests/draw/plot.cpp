// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "draw/drawn.hpp"
#include "scratch_directory.hpp"

#include <lacuna/draw/plot.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

using lacuna::axis_scale;
using lacuna::canvas;
using lacuna::color;
using lacuna::plot;

namespace {

constexpr lacuna::rectangle frame{50, 40, 350, 240};
constexpr color red{1, 0, 0}, blue{0, 0, 1}, white{1, 1, 1};
constexpr double never = std::numeric_limits<double>::infinity();

std::vector<std::string> labels_of(lacuna::plot_axis const& axis) {
    std::vector<std::string> labels;
    for (auto const& tick : lacuna::ticks_of(axis)) labels.push_back(tick.label);
    return labels;
}

} // namespace

TEST_CASE("a plot maps values linearly and logarithmically") {
    drawn const picture([](canvas& page) {
        plot linear(page, frame, {0, 10}, {-1, 1});
        CHECK(linear.at(0, -1)[0] == 50);
        CHECK(linear.at(0, -1)[1] == 240);
        CHECK(linear.at(5, 0.5)[0] == 200);
        CHECK(linear.at(5, 0.5)[1] == 90);
        plot logarithmic(page, frame, {1, 1000, "", axis_scale::logarithmic}, {0, 1});
        CHECK_THAT(logarithmic.at(10, 0)[0], WithinAbs(150, 1e-9));
        CHECK_THAT(logarithmic.at(1000, 0)[0], WithinAbs(350, 1e-9));
    });
}

TEST_CASE("lines, bands, rules and markers are where their values are, and nothing outside the frame") {
    drawn const picture([](canvas& page) {
        plot plane(page, frame, {0, 10}, {0, 10});
        plane.band({{0, 2}, {10, 2}}, {{0, 4}, {10, 4}}, blue);
        plane.line({{-5, 8}, {15, 8}}, red, 6);
        plane.line({{2, 6}, {4, never}, {6, 6}, {8, 6}}, red, 6);
        plane.markers({{1, 1}, {11, 1}}, lacuna::plot_mark::disc, red, 5);
        plane.markers({{5, 1}}, lacuna::plot_mark::diamond, red, 6);
    });
    auto const at = [](double x, double y) { return canvas::point{50 + 30 * x, 240 - 20 * y}; };
    CHECK(picture.has(at(5, 3), blue));
    CHECK(picture.has(at(5, 4.4), white));
    CHECK(picture.has(at(5, 8), red));
    CHECK(picture.has({45, 80}, white));
    CHECK(picture.has({355, 80}, white));
    CHECK(picture.has(at(7, 6), red));
    CHECK(picture.has(at(5, 6), white)); // interrupted
    CHECK(picture.has(at(1, 1), red));
    CHECK(picture.has(at(11, 1), white)); // left out
    CHECK(picture.has(at(5, 1), red));
}

TEST_CASE("ticks are round numbers, or custom ones") {
    using labels = std::vector<std::string>;
    CHECK(labels_of({0, 1}) == labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"});
    CHECK(labels_of({5, 100, "", axis_scale::logarithmic}) == labels{"5", "10", "20", "50", "100"});
    CHECK(labels_of({1e-25, 1e-21, "", axis_scale::logarithmic}) ==
          labels{"1e-25", "1e-24", "1e-23", "1e-22", "1e-21"});
    CHECK(labels_of({1, 1e8, "", axis_scale::logarithmic}) == labels{"1", "100", "10000", "1e+06", "1e+08"});
    // Too narrow for 1, 2 and 5 times powers of ten: equidistant.
    CHECK(labels_of({45, 60, "", axis_scale::logarithmic}) == labels{"45", "50", "55", "60"});
    CHECK(labels_of({0, 2, "", axis_scale::linear, 6, {{0.5, "a"}, {1.5, "b"}}}) == labels{"a", "b"});
}

TEST_CASE("axes that cannot be drawn are refused by name") {
    drawn const picture([](canvas& page) {
        CHECK_THROWS_WITH(plot(page, frame, {1, 1}, {0, 1}), contains_text("plot.x.high"));
        CHECK_THROWS_WITH(plot(page, frame, {0, 1}, {0, never}), contains_text("plot.y.high"));
        CHECK_THROWS_WITH(plot(page, frame, {0, 1, "", axis_scale::logarithmic}, {0, 1}), contains_text("plot.x.low"));
        CHECK_THROWS_WITH(lacuna::ticks_of({0, 1, "", axis_scale::linear, 1}), contains_text("most_ticks"));
    });
}
