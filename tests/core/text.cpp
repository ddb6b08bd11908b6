// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <lacuna/core/text.hpp>

#include "catch.hpp"

using namespace lacuna;

namespace {

std::string refusal_of(std::string const& word) {
    try {
        read_number("n", word);
    } catch (std::invalid_argument const& e) {
        return e.what();
    }
    return "accepted";
}

} // namespace

TEST_CASE("numbers have the fewest digits, at least six, that strtod reads back", "[text]") {
    std::mt19937_64 random(7);
    std::vector<double> numbers{0.0, -0.0, 1e-5, 1e5, 1e6, 123456, 1234567, 5e-324, 1.7976931348623157e308, 0.1,
                                1.0 / 3, 5.684341886080802e-14, std::numeric_limits<double>::infinity()};
    for (int k = 0; k < 2000; ++k) {
        auto const bits = random();
        double any = 0;
        std::memcpy(&any, &bits, sizeof any);
        numbers.insert(numbers.end(), {any, double(bits % 1000000) / 1000, std::ldexp(1.0, int(bits % 2000) - 1000)});
    }
    for (double const x : numbers) {
        if (std::isnan(x)) continue;
        char text[40];
        for (int digits = 6; digits <= 17; ++digits) {
            std::snprintf(text, sizeof text, "%.*g", digits, x);
            if (std::strtod(text, nullptr) == x) break;
        }
        REQUIRE(to_text(x) == text);
        REQUIRE(number_of(text).value() == x);
    }
}

TEST_CASE("formatted() writes one number as printf does", "[text]") {
    for (double const x : {0.0, -2.5, 1234.5678, 1e-7, 6.02e23})
        for (char const* format : {"%.0f", "%.3f", "%.3g", "%g", "%e", "t = %.2e s", "%+.1f", "%.1f %%"}) {
            char text[200];
            std::snprintf(text, sizeof text, format, x);
            REQUIRE(formatted(format, x) == text);
        }
    for (char const* format : {"%d", "%", "%.f%f", "%.", "%.2"})
        REQUIRE_THROWS_AS(formatted(format, 1.0), std::invalid_argument);
}

TEST_CASE("numbers in decimal notation are read, to the nearest double", "[text]") {
    double const infinity = std::numeric_limits<double>::infinity();
    for (auto const& [word, value] : {std::pair<std::string, double>{"1", 1}, {"+1", 1}, {"-.5", -0.5}, {"2.", 2},
                                      {"1e3", 1000}, {"1E-3", 0.001}, {"007", 7}, {"1e-400", 0}, {"1000e-400", 0},
                                      {"0e999999999999", 0}, {"0.0000001e-320", 0}, {"1e400", infinity},
                                      {"-1e400", -infinity}, {"0.00001e400", infinity},
                                      {"1e99999999999999999999", infinity}})
        REQUIRE(number_of(word).value() == value);
    for (std::string const word :
         {"", "+", "-", ".", "e5", "+-1", "++1", " 1", "1 ", "1e", "0x10", "1,5", "1.5.2", "one"})
        REQUIRE(!number_of(word));
    REQUIRE(read_whole("n", "3000000000", 1, 9000000000) == 3000000000);
    REQUIRE(read_whole("n", "9007199254740993", 1, 9223372036854775807) ==
            9007199254740993); // a double cannot represent it
    REQUIRE(read_integer("n", "1e3", 0) == 1000);
    REQUIRE(read_integer("n", "+2.0", 0) == 2);
    for (std::string const word : {"0.5", "-1", "2147483648", "1e30"})
        REQUIRE_THROWS_AS(read_integer("n", word, 0), std::invalid_argument);
}

TEST_CASE("the refusal of a word that is not a number says what is wrong with it", "[text]") {
    for (auto const& [word, message] : {
             std::pair<std::string, std::string>{"x", "n = \"x\": must be a number"},
             {"1e400", "n = 1e400: must be finite"},
             {"-inf", "n = -inf: must be finite"},
             {"nan", "n = nan: must be finite"},
             {"0x1p-1", "n = \"0x1p-1\": must be a decimal number, not a hexadecimal one"},
             {"2.5D+03", "n = \"2.5D+03\": must be a number with \"e\" before its exponent, not \"d\""},
             {"1,5", "n = \"1,5\": must be a number with a decimal point, without commas"},
             {"1'000", "n = \"1'000\": must be a number without marks between thousands"},
             {std::string("25\0" "00", 5), "n = \"25\\x0000\": must be a number; it has a NUL byte"},
             {"\xE2\x88\x92" "1",
              "n = \"\xE2\x88\x92" "1\": must be a number; it has a minus sign that is no hyphen, U+2212"},
             {"0.5\xC2\xA0", "n = \"0.5\xC2\xA0\": must be a number; it has a no-break space, U+00A0"},
             {"\xEF\xBC\x91", "n = \"\xEF\xBC\x91\": must be a number; it has the character U+FF11"},
             {"1\xE2", "n = \"1\xE2\": must be a number; it has the byte 0xe2"}})
        REQUIRE(refusal_of(word) == message);
    REQUIRE(refusal_of(std::string(1000, 'x')).size() < 120);
}

TEST_CASE("lines end with LF, CR LF or CR, a byte order mark is no part of a text, NUL bytes and UTF-16 are refused",
          "[text]") {
    std::vector<std::string> lines;
    std::string_view text = "a\nb\r\nc\r\r\nd", line;
    while (take_line(text, line)) lines.emplace_back(line);
    REQUIRE(lines == std::vector<std::string>{"a", "b", "c", "", "d"});
    REQUIRE(plain_text("\xEF\xBB\xBFx", "f") == "x");
    REQUIRE_THROWS_WITH(plain_text("\xFF\xFEx", "f"), "f = UTF-16: must be a text in UTF-8");
    REQUIRE_THROWS_WITH(plain_text(std::string_view("a\nb\0c", 5), "f"), "f:2 = a NUL byte: must be text");
    REQUIRE_THROWS_WITH(plain_text(std::string_view("a\rb\r\0c", 6), "f"), "f:3 = a NUL byte: must be text");
}
