// SPDX-License-Identifier: BSD-3-Clause
//
// Decks whose particles enclose no pores, or whose fluid is too fast for its solver. They are refused with status 2 and
// the deck's own particle numbers, and nothing is written.

#include <algorithm>
#include <string>

#include "catch.hpp"
#include "scenario/program.hpp"

using program::folder;

namespace {

enum class motion { coupled, rigid };

/// \param fluid further keys of it
std::string deck(std::string const& places, motion how, std::string const& fluid = "",
                 std::string const& settings = "") {
    bool const rigid = how == motion::rigid;
    return "[simulation]\nsteps = 400\ntime_step = 1e-3\n" + settings + "[materials.m]\n" +
           (rigid ? "" : "density = 1000.0\nnormal_stiffness = 1e5\nshear_stiffness = 5e4\nfriction = 0.2\n") +
           "[particles]\nradius = 0.5\nmaterial = \"m\"\nposition = " + places + "\n[fluid]\nbulk_modulus = 1e6\n" +
           (fluid.find("conductivity") == fluid.npos ? "conductivity = 1e-9\n" : "") +
           (fluid.find("aperture") == fluid.npos ? "aperture = { law = \"constant\", value = 1e-3 }\n" : "") + fluid +
           (rigid ? "mechanical_coupling = false\n" : "") + "[output]\ndirectory = \"out\"\n";
}

void require_refused(program::result const& ran, folder const& here) {
    INFO(ran.err);
    CHECK(ran.status == 2);
    CHECK(ran.out.empty());
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
    CHECK(here.files() == std::vector<std::string>{"case.toml"});
}

} // namespace

TEST_CASE("particles without pores are named as the deck numbers them", "[fluid][program]") {
    folder const here("pore_refusals");
    struct one {
        std::string places;
        std::vector<std::string> says;
    };
    // In another order than the one in which the simulation stores them.
    for (one const& c :
         {one{"[[4.0, 0.0], [3.0, 0.0], [2.0, 0.0], [1.0, 0.0], [0.0, 0.0]]",
              {"fluid: number of pores = 0: must be at least 1", "on one line", "particle 0 at (4, 0) m",
               "particle 4 at (0, 0) m"}},
          one{"[[90.0, 9.0], [50.0, 40.0], [50.0, 0.0], [1.0, 0.0], [0.0, 0.0]]",
              {"fluid: number of pores = 0", "too far from each other", "particle 0 at (90, 9) m",
               "particle 4 at (0, 0) m"}},
          one{"[[1.0, 0.0], [0.0, 0.0]]", {"fluid: number of pores = 0", "3 particles around it, and there are 2"}},
          one{"[[9.0, 0.0], [0.5, 0.875], [1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]",
              {"particles 2 and 4 are at the same position (1, 0)"}}})
        for (motion const how : {motion::coupled, motion::rigid})
            for (std::string const options : {"--quiet ", "--check "}) {
                here.clear();
                here.write("case.toml", deck(c.places, how));
                auto const ran = here.run(options + "case.toml");
                require_refused(ran, here);
                for (auto const& text : c.says) CHECK_THAT(ran.err, contains_text(text));
            }
    here.clear();
    here.write("case.toml", deck("[[3.0, 0.0], [1e75, 0.0], [0.0, 0.0], [1.0, 0.0], [0.5, 0.8]]", motion::coupled, "",
                                 "guards = { resolution = false }\n"));
    auto const ran = here.run("--quiet case.toml");
    require_refused(ran, here);
    CHECK_THAT(ran.err, contains_text("position of particle 1 = 1e+75: must be from -1e70 to 1e70 m"));
}

TEST_CASE("explicit flow that needs too many steps is refused as an error of the deck", "[fluid][program]") {
    folder const here("too_many_flow_steps");
    std::string const body = "[[0.0, 0.0], [1.0, 0.0], [0.5, 0.8660254], [1.5, 0.8660254]]";
    // V / (K_f C): the void of a triangle of discs, and C = k a^3 / l of the only throat.
    double const limit = (0.4330127 - 0.3926991) / (1e6 * 1e12 * 1e-9 / 1.0);
    for (std::string const options : {"--quiet ", "--check "}) {
        here.clear();
        here.write("case.toml", deck(body, motion::coupled, "conductivity = 1e12\n"));
        auto const ran = here.run(options + "case.toml");
        require_refused(ran, here);
        CHECK_THAT(ran.err, contains_text("fluid.solver = \"explicit\": must be \"implicit\"") &&
                                contains_text("step of 0.001"));
        std::string const before = "explicit flow is ";
        auto const at = ran.err.find(before);
        REQUIRE(at != ran.err.npos);
        CHECK_THAT(std::stod(ran.err.substr(at + before.size())), WithinRel(limit, 1e-5));
    }
    // With merging pores the limit is known only after the first step.
    here.clear();
    here.write("case.toml", deck(body, motion::coupled, "conductivity = 1e12\nmerge_conductance = 1e30\n"));
    auto const ran = here.run("--quiet case.toml");
    require_refused(ran, here);
    CHECK_THAT(ran.err, contains_text("time_step = 0.001 s: must be at most ") &&
                            contains_text("100000 substeps of explicit flow"));
}

TEST_CASE("a run whose throats open too far for explicit flow ends as unstable and keeps its results",
          "[fluid][program]") {
    folder const here("throats_that_open");
    here.write(
        "case.toml",
        deck(
            "[[0.0, 0.0], [1.0, 0.0], [0.5, 0.8660254], [1.5, 0.8660254]]", motion::coupled,
            "conductivity = 5e4\naperture = { law = \"contact_force\", a0 = 1e-4, F0 = 1e3, gap_multiplier = 1.0 }\n") +
            "[[loads]]\nparticles = [0, 1]\nvelocity = [0.0, -1.0]\n[[loads]]\nparticles = [2, 3]\n"
            "velocity = [0.0, 0.0]\n"
            "[[probes]]\nquantity = \"position.y\"\nparticle = 0\n");
    auto const ran = here.run("--quiet case.toml");
    INFO(ran.err);
    CHECK(ran.status == 3);
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
    CHECK_THAT(ran.err,
               contains_text("unstable run at step ") && contains_text("time_step = 0.001 s: must be at most "));
    auto const summary = nlohmann::json::parse(program::read_file(here / "out/summary.json"));
    CHECK(summary["ended"] == "unstable");
    CHECK(summary["steps"].get<int>() > 10);
    CHECK(program::table(here / "out/probes.csv").rows.size() == summary["steps"].get<std::size_t>() + 1);
}
