// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <lacuna/core/version.hpp>

#include "catch.hpp"
#include "scenario/program.hpp"

using program::folder;

TEST_CASE("the command line: version, help, the option that was meant", "[program]") {
    folder const here("command_line");
    auto const version = here.run("--version");
    CHECK(version.status == 0);
    CHECK_THAT(version.out, contains_text("lacuna-run " + std::to_string(LACUNA_VERSION_MAJOR) + "."));
    auto const help = here.run("--help");
    CHECK(help.status == 0);
    for (char const* word : {"--restart", "--force", "[simulation]", "normal_stiffness", "N/m", "hertz_mindlin"})
        CHECK_THAT(help.out, contains_text(word));
    auto const misspelt = here.run("--forse a.toml");
    CHECK(misspelt.status == 2);
    CHECK_THAT(misspelt.err, contains_text("--forse") && contains_text("(did you mean --force?)"));
    CHECK(misspelt.out.empty());
    CHECK(here.files().empty());
}
