// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "scratch_directory.hpp"

#include <lacuna/core/whole_file.hpp>
#include <lacuna/draw/color_scale.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace fs = std::filesystem;

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

TEST_CASE("the scale for measured values excludes outliers and includes zero") {
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
