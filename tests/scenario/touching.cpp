// SPDX-License-Identifier: BSD-3-Clause
// Bonds between all touching particles: rounding is allowed for, and their number is limited.

#include <cmath>
#include <cstdio>
#include <string>

#include "catch.hpp"

#include "scenario.hpp"
#include "touching.hpp"

namespace {

std::string const head = "[simulation]\nsteps = 1\n[materials.m]\ndensity = 2500.0\n"
                         "normal_stiffness = 1e6\nshear_stiffness = 5e5\nfriction = 0.3\n";

/// A hexagonal block of 10 rows of 10 discs of radius 0.001, in decimals.
std::string block(double shift, std::string const& radius = "0.001") {
    std::string text = head + "[particles]\nposition = [";
    for (int row = 0; row < 10; ++row)
        for (int column = 0; column < 10; ++column) {
            char position[80];
            std::snprintf(position, sizeof position, "[%.17g, %.17g], ", shift + 0.002 * column + 0.001 * (row % 2),
                          0.001 * std::sqrt(3.0) * row);
            text += position;
        }
    return text + "]\nradius = " + radius + "\nmaterial = \"m\"\n[bonds]\ntouching = true\n";
}

std::size_t bonds(std::string const& text) {
    return lacuna_run::read_scenario(text, "case.toml", "").bonds.pairs.size();
}

std::string refusal(std::string const& text) {
    try {
        lacuna_run::read_scenario(text, "case.toml", "");
    } catch (lacuna_run::refusal const& bad) {
        return bad.what();
    }
    return "accepted";
}

} // namespace

TEST_CASE("discs of a lattice written in decimals touch without a gap", "[scenario][touching]") {
    // 9 pairs in each of 10 rows, and 10 + 9 pairs between each two of them: 10 * 9 + 9 * 19.
    CHECK(bonds(block(0) + "gap = 0.0\n") == 261);
    CHECK(bonds(block(5.3) + "gap = 0.0\n") == 261); // far from the origin positions are coarser
    CHECK(bonds(block(0) + "gap = 1e-5\n") == 261);
    // A millionth of the diameter is a gap: rounding does not explain it.
    CHECK(bonds(block(0, "0.000999999") + "gap = 0.0\n") == 0);
    CHECK(bonds(block(0, "0.000999999") + "gap = 2e-9\n") == 261);
}

TEST_CASE("a gap that bonds everything to everything is refused before it takes memory",
          "[scenario][touching][refusal]") {
    CHECK_THAT(refusal(block(0) + "gap = 1e30\n"),
               contains_text("bonds.gap = 1e+30: must be at most ten times the median radius, 0.01 m"));
    CHECK_THAT(refusal(block(0) + "gap = 0.0101\n"), contains_text("bonds.gap = 0.0101: must be at most ten times"));
    CHECK(bonds(block(0) + "gap = 0.0099\n") > 1000);
    // Three hundred discs at almost the same position: 44,850 pairs.
    std::string heap = head + "[particles]\nposition = [";
    for (int k = 0; k < 300; ++k) heap += "[" + std::to_string(1e-6 * k) + ", 0.0], ";
    heap += "]\nradius = 0.001\nmaterial = \"m\"\n[bonds]\ntouching = true\ngap = 0.0\n";
    CHECK_THAT(refusal(heap),
               contains_text("must be a gap within which there are at most 100 times as many pairs as particles"));
}

TEST_CASE("a huge disc hides the discs behind it and no others", "[scenario][touching]") {
    lacuna_run::particle_list p;
    for (int k = 0; k < 40; ++k) {
        p.position.push_back({double(k), 0.0, 0.0});
        p.radius.push_back(0.5);
    }
    p.position.push_back({10.0, 5.0, 0.0});
    p.radius.push_back(4.0); // above 6 to 14
    auto const row = lacuna_run::row_on_side(p, lacuna_run::side::top, 0.0);
    std::vector<std::int32_t> by_hand;
    for (int k = 0; k < 41; ++k)
        if (k < 6 || k > 14) by_hand.push_back(k);
    CHECK(row == by_hand);
}
