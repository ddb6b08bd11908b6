// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <string>

#include "catch.hpp"
#include "scenario/program.hpp"

/// \file
/// The time step of a run that starts without contacts.

using program::folder;
using program::table;

namespace {

/// Two spheres of radius 1 cm and E = 1 GPa meet, 0.1 m/s each.
std::string two_spheres(std::string const& simulation, std::string const& stiffness) {
    return "[simulation]\ndimension = 3\ncontact_law = \"hertz_mindlin\"\nbond_law = \"none\"\nend_time = 0.1\n" +
           simulation + "[materials.steel]\ndensity = 2500.0\n" + stiffness +
           "friction = 0.0\nyoung_modulus = 1e9\npoisson_ratio = 0.3\n"
           "[particles]\nposition = [[0.0, 0.0, 0.0], [0.03, 0.0, 0.0]]\nradius = 0.01\nmaterial = \"steel\"\n"
           "velocity = [[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]]\n"
           "[[probes]]\nquantity = \"velocity.x\"\nparticle = 1\n"
           "[[probes]]\nquantity = \"contact.normal_force\"\npair = [0, 1]\n"
           "[output]\ndirectory = \"out\"\n";
}

} // namespace

TEST_CASE("stiffnesses that no contact uses do not affect the time step", "[step]") {
    // Hertz: k = 4/3 E* sqrt(R), largest overlap (1.25 m v^2 / k)^0.4, with E* = 1e9 / 1.82, R = 5 mm, half of 2500
    // kg/m^3 times the volume.
    double const k = 4.0 / 3 * 1e9 / 1.82 * std::sqrt(0.005), mass = 2500 * 4.0 / 3 * std::acos(-1.0) * 1e-6 / 2;
    double const force = k * std::pow(1.25 * mass * 0.04 / k, 0.6);
    std::string same;
    for (std::string const stiffness : {"", "1e3", "3e3", "5e3", "1e5", "1e12"}) {
        folder const here("step_" + stiffness);
        here.write(
            "a.toml",
            two_spheres("", stiffness.empty() ? "" : "normal_stiffness = " + stiffness + "\nshear_stiffness = 0.0\n"));
        auto const ran = here.run("--quiet a.toml");
        INFO(stiffness << ": " << ran.err);
        REQUIRE(ran.status == 0);
        table const t(here / "out/probes.csv");
        auto const v = t.column("velocity.x[1]"), f = t.column("contact.normal_force[0-1]");
        CHECK_THAT(v.back() / 0.1, WithinAbs(1, 1e-3));
        CHECK_THAT(-*std::min_element(f.begin(), f.end()), WithinRel(force, 5e-3));
        auto const bytes = program::read_file(here / "out/probes.csv");
        if (same.empty()) same = bytes;
        CHECK(bytes == same);
    }
}

TEST_CASE("without any stiffness there is no automatic time step", "[step][refusal]") {
    folder const here("step_none");
    here.write("a.toml",
               "[simulation]\ncontact_law = \"none\"\nbond_law = \"none\"\nsteps = 1\n[materials.m]\ndensity = 1.0\n"
               "normal_stiffness = 1.0\nshear_stiffness = 1.0\nfriction = 0.0\n[particles]\nposition = [[0.0, 0.0]]\n"
               "radius = 1.0\nmaterial = \"m\"\n[output]\ndirectory = \"out\"\n");
    auto const ran = here.run("--quiet a.toml");
    CHECK(ran.status == 2);
    CHECK_THAT(ran.err, contains_text("simulation.time_step = \"auto\": must be a number of seconds"));
}

TEST_CASE("a given step that a contact makes unstable ends the run with both numbers", "[step][refusal]") {
    folder const here("step_given");
    here.write("a.toml", two_spheres("time_step = 1e-3\n", ""));
    auto const ran = here.run("--quiet a.toml");
    CHECK(ran.status == 3);
    CHECK_THAT(ran.err, contains_text("time step of 0.001 s is above the stable limit, which is "));
}
