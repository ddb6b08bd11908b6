// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "draw/drawn.hpp"

#include "cartilage/report/tornado.hpp"

#include <limits>
#include <vector>

using lacuna::canvas;
using lacuna::color;

namespace {

constexpr lacuna::rectangle frame{50, 40, 350, 240};
constexpr color white{1, 1, 1};
constexpr double never = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("a tornado has its largest change on top, bars from zero") {
    std::vector<lacuna::tornado_row> const rows{{"small", {{"a", 1, 1, 1}}},
                                                {"large", {{"b", -8, -9, -7}, {"c", never, 0, 0}}}};
    drawn const picture([&](canvas& page) { lacuna::draw_tornado(page, frame, rows, {-10, 10, "change"}); });
    // Slots: large 2.5, small 1.5 of 4 over 200 pixels; x: 15 pixels a unit about 200.
    color const below = lacuna::plot_ink(0), above = lacuna::plot_ink(1);
    CHECK(picture.has({200 - 15 * 4, 40 + 50 * 0.75 - 6}, below));
    CHECK(picture.has({200 + 15 * 0.5, 40 + 50 * 3.25 - 6}, above));
    CHECK(picture.has({200 - 15 * 0.5, 40 + 50 * 3.25 - 6}, white));
    CHECK(lacuna::tornado_height(rows) == 4 * 1.5 * 13);
}
