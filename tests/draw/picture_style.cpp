// SPDX-License-Identifier: BSD-3-Clause

#include <limits>

#include <lacuna/core/aggregate.hpp>
#include <lacuna/draw/picture.hpp>

#include "catch.hpp"

TEST_CASE("each number of a picture's style is checked", "[refusal]") {
    constexpr double never = std::numeric_limits<double>::infinity();
    int numbers = 0;
    lacuna::picture_style style;
    lacuna::for_each_member(style, [&](auto& member) {
        auto const attempt = [&](double& number) {
            ++numbers;
            double const before = number;
            for (double const bad : {std::numeric_limits<double>::quiet_NaN(), never, -never, -1.0}) {
                number = bad;
                INFO("number " << numbers << " = " << bad);
                CHECK_THROWS_AS(style.validate(), std::invalid_argument);
            }
            number = before;
        };
        if constexpr (std::is_same_v<decltype(member), double&>)
            attempt(member);
        else
            for (double* part : {&member.red, &member.green, &member.blue}) attempt(*part);
    });
    REQUIRE(numbers == 5 + 4 * 3);
    REQUIRE_NOTHROW(style.validate());
}
