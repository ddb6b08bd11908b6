// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/version.hpp>

#include "catch.hpp"
#include "scenario/program.hpp"

using program::folder;

TEST_CASE("the command line: version, help, suggestion for a misspelt option", "[program]") {
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

TEST_CASE("files without a scenario are refused in one line", "[program]") {
    folder const here("no_scenario");
    std::filesystem::create_directories(here / "directory");
    here.write("empty.toml", "");
    here.write("blank.toml", " \n\t\n");
    here.write("zeros.toml", std::string(300, '\0'));
    for (auto const& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"nowhere.toml", "nowhere.toml: cannot be read: No such file or directory"},
             {"directory", "directory: cannot be read: it is a directory"},
             {"empty.toml", "empty.toml: is empty, it must be a scenario"},
             {"blank.toml", "blank.toml: is empty, it must be a scenario"},
             {"zeros.toml", "zeros.toml:1: a NUL byte: must be text"}}) {
        auto const before = here.files();
        auto const ran = here.run(name);
        INFO(ran.err);
        CHECK(ran.status == 2);
        CHECK(ran.out.empty());
        CHECK(ran.err == text + "\n");
        CHECK(here.files() == before);
    }
}

TEST_CASE("output that cannot be written to stdout is an error", "[program]") {
    if (!std::filesystem::exists("/dev/full")) return;
    folder const here("full_stdout");
    std::string const command = "cd '" + (here / "").string() + "' && '" LACUNA_RUN_PROGRAM "' ";
    auto const status_of = [&](std::string const& rest) {
        int const status = std::system((command + rest).c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    };
    CHECK(status_of("--help >/dev/full 2>err") == 1);
    CHECK_THAT(program::read_file(here / "err"), contains_text("lacuna-run: cannot write to the standard output"));
    CHECK(status_of("'" LACUNA_RUN_CASES "/beam.toml' >/dev/full 2>err") == 1);
    CHECK_THAT(program::read_file(here / "err"), contains_text("lacuna-run: cannot write to the standard output"));
    CHECK(std::filesystem::exists(here / "out/summary.json"));
}
