// SPDX-License-Identifier: BSD-3-Clause
//
// Guards that end a run: each has a name, and each message names the cause.

#include <algorithm>
#include <string>

#include "catch.hpp"
#include "scenario/program.hpp"

using program::folder;

namespace {

std::string const material = R"([materials.m]
density = 1000.0
normal_stiffness = 1e6
shear_stiffness = 5e5
friction = 0.5
)";
std::string const strengths = "tensile_strength = 1e4\nshear_strength = 1e4\n";

std::string deck(std::string const& settings, std::string const& rest) {
    bool const bonded = rest.find("[bonds]") != rest.npos;
    return "[simulation]\n" + settings + "\n" + material + (bonded ? strengths : "") +
           "[particles]\nradius = 0.5\nmaterial = \"m\"\n" + rest + "\n[output]\ndirectory = \"out\"\n";
}
program::result run(std::string const& text, std::string const& options = "") {
    folder const here("guards");
    here.write("case.toml", text);
    return here.run(options + " --quiet case.toml");
}

} // namespace

TEST_CASE("particles at the same position are named, dry, wet and with --check", "[guards][program]") {
    std::string const places = "position = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.875], [0.5, 0.875], [0.5, -0.875]]\n";
    std::string const fluid =
        "[fluid]\nbulk_modulus = 1e6\nconductivity = 1e-9\naperture = { law = \"constant\", value = 1e-4 }\n";
    for (std::string const bonds : {"", "[bonds]\ntouching = true\ngap = 1e-9\n"})
        for (std::string const& wet :
             {std::string(), fluid, bonds.empty() ? fluid + "mechanical_coupling = false\n" : fluid})
            for (std::string const options : {"", "--check"}) {
                auto const ran = run(deck("steps = 10", places + bonds + wet), options);
                INFO(bonds << wet << options << "\n" << ran.err);
                CHECK(ran.status == 2);
                CHECK_THAT(ran.err,
                           contains_text("particles 2 and 3") && contains_text("at the same position (0.5, 0.875)"));
                CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
            }
    std::string const row = "position = [[0.0, 0.0, 0.0], [3.0, 0.0, 1.0], [3.0, 0.0, 1.0]]\n";
    auto const ran = run(deck("dimension = 3\nsteps = 10", row));
    CHECK(ran.status == 2);
    CHECK_THAT(ran.err, contains_text("particles 1 and 2 are at the same position (3, 0, 1)"));
}

TEST_CASE("an initial overlap of more than a radius is refused, unless its guard is off", "[guards][program]") {
    std::string const row = "position = [[0.0, 0.0], [0.4, 0.0]]\nfix = [{ particles = [0, 1], axes = \"xyr\" }]\n";
    for (std::string const options : {"", "--check"}) {
        auto const ran = run(deck("steps = 10", row), options);
        CHECK(ran.status == 2);
        CHECK_THAT(ran.err,
                   contains_text("initial overlap of particles 0 and 1") && contains_text("1.2 of the smaller radius"));
    }
    for (std::string const guards : {"{ overlap = false }", "{ overlap_limit = 1.5 }"})
        CHECK(run(deck("steps = 10\ntime_step = 1e-4\nguards = " + guards, row)).status == 0);
}

TEST_CASE("a crushed bond is named, with its limit", "[guards][program]") {
    std::string const pair =
        "position = [[0.0, 0.0], [1.0, 0.0]]\nfix = [{ particles = [0], axes = \"xyr\" }]\n"
        "[bonds]\npairs = [[0, 1]]\n[[loads]]\nparticles = [1]\nforce = [-1.5e4, 0.0]\nramp_time = 1.0\n";
    auto const ran = run(deck("steps = 40000\ndamping = { viscous = 0.3 }", pair));
    CHECK(ran.status == 3);
    CHECK_THAT(ran.err, contains_text("bond 0 between them is crushed") && contains_text("10000 N"));
}

TEST_CASE("a row that buckles runs, but not with too long a time step", "[guards][program]") {
    std::string const row =
        "position = [[0.0, 0.0], [0.9, 1e-8], [1.8, -1e-8], [2.7, 1e-8], [3.6, 0.0]]\n"
        "fix = [{ particles = [0, 4], axes = \"xyr\" }]\n[[probes]]\nquantity = \"position.y\"\nparticle = 2\n";
    folder const here("buckling");
    here.write("case.toml", deck("bond_law = \"none\"\nsteps = 300", row));
    auto const ran = here.run("--quiet case.toml");
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    auto const y = program::table(here / "out/probes.csv").column("position.y[2]");
    CHECK(std::abs(*std::max_element(y.begin(), y.end(),
                                     [](double a, double b) { return std::abs(a) < std::abs(b); })) > 1e-3);

    std::string const pair =
        "position = [[0.0, 0.0], [1.0, 0.0]]\nvelocity = [[1e-9, 0.0], [0.0, 0.0]]\n[bonds]\npairs = [[0, 1]]\n";
    std::string unbreakable = deck("steps = 10000\nallow_unstable_step = true\ntime_step = 0.05", pair);
    for (std::string const strength : {"tensile_strength = 1e4\n", "shear_strength = 1e4\n"})
        unbreakable.erase(unbreakable.find(strength), strength.size());
    auto const long_step = run(unbreakable);
    CHECK(long_step.status == 3);
    CHECK_THAT(long_step.err, contains_text("the time step is above the stable one"));
}

TEST_CASE("single precision far from the origin is refused, unless its guard is off", "[guards][program]") {
    std::string const far = "position = [[100.0, 0.0], [102.0, 0.0]]\n";
    std::string small = deck("real = \"float\"\nsteps = 10", far);
    auto const at = small.find("radius = 0.5");
    small.replace(at, 12, "radius = 1e-3");
    auto const ran = run(small);
    CHECK(ran.status == 2);
    CHECK_THAT(ran.err,
               contains_text("particle 1.position = (102, 0) m: must be within 8.19") && contains_text("0.001"));
    small.replace(small.find("steps"), 0, "guards = { resolution = false }\n");
    CHECK(run(small).status == 0);
}
