// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// \file
/// One include for Catch2 of both generations: 2.x has a single header, 3.x has many.

#if __has_include(<catch2/catch_test_macros.hpp>)
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_all.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#else
#include <catch2/catch.hpp>
#endif

#include <string>

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

/// Matches a string, or the message of an exception through REQUIRE_THROWS_WITH, that contains `text`.
inline auto contains_text(std::string const& text) {
#if __has_include(<catch2/catch_test_macros.hpp>)
    return Catch::Matchers::ContainsSubstring(text);
#else
    return Catch::Matchers::Contains(text);
#endif
}
