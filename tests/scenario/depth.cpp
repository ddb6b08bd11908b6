// SPDX-License-Identifier: BSD-3-Clause

#include <string>

#include "catch.hpp"

#include "scenario.hpp"

namespace {

std::string answer(std::string const& text) {
    try {
        lacuna_run::read_scenario(text, "case.toml", "");
    } catch (lacuna_run::refusal const& bad) {
        return bad.what();
    }
    return "accepted";
}

std::string times(std::size_t count, std::string const& part) {
    std::string all;
    for (std::size_t k = 0; k < count; ++k) all += part;
    return all;
}

} // namespace

TEST_CASE("endless nesting is refused before the stack overflows", "[refusal]") {
    std::size_t const many = 150000;
    std::string const parts = "must be keys of at most 64 parts", levels = "must be at most 64 nested lists and tables";
    REQUIRE_THAT(answer("x = 1\n" + times(many, "a.") + "a = 1\n"), contains_text("case.toml:2: " + parts));
    REQUIRE_THAT(answer("[" + times(many, "a.") + "a]\n"), contains_text("case.toml:1: " + parts));
    REQUIRE_THAT(answer("a = " + times(many, "[") + "\n"), contains_text("case.toml:1: " + levels));
    REQUIRE_THAT(answer("a = " + times(many, "{ a = ") + "\n"), contains_text("case.toml:1: " + levels));
    REQUIRE_THAT(answer("a = " + times(many, "[\n")), contains_text(levels));
    REQUIRE_THAT(answer(std::string("a = 25\0" "00\n", 10)), contains_text("case.toml:1: a NUL byte"));
    // Brackets and dots in strings and comments do not count.
    for (std::string const quote : {"\"", "'", "\"\"\"", "'''"})
        REQUIRE_THAT(answer("simulation = " + quote + times(many, "[.") + quote + "\n"),
                     contains_text("simulation = \"[."));
    REQUIRE_THAT(answer("# " + times(many, "[.") + "\n"), contains_text("simulation = (missing)"));
}
