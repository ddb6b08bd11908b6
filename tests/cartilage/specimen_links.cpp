// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cartilage/specimen/cartilage_specimen.hpp"

#include "packings/check.hpp"

using lacuna::cartilage_specimen_parameters;
using lacuna::cartilage_zone;
using lacuna::make_cartilage_specimen;
using lacuna::specimen_preset;

namespace {

cartilage_specimen_parameters parameters(cartilage_zone zone, specimen_preset preset, double height) {
    cartilage_specimen_parameters p;
    p.zone = zone;
    p.preset = preset;
    p.height = height;
    p.seed = 3;
    return p;
}

} // namespace

TEST_CASE("links of a lattice, counted by hand", "[particles][specimen]") {
    auto p = parameters(cartilage_zone::surface, specimen_preset::lattice, 120e-6);
    std::size_t const plain = make_cartilage_specimen(p).discs.bonds.size();
    p.link_matrix = p.link_fibres = true;
    auto const s = make_cartilage_specimen(p);
    // Rows have 34 and 33 discs of 3.5 um in turn; every fifth row is a fibre. Two adjacent rows have 2 * 33 contacts,
    // so that a fibre has 4 * 33 links and the top fibre 2 * 33.
    REQUIRE(s.fibres.size() == 8); // 39 rows, 3.03 um apart from 1.75 to 117 um: fibres in rows 38, 33, ... 3
    REQUIRE(s.fibre_links == 0);
    REQUIRE(s.matrix_links == 2 * 33 + 7 * 4 * 33);
    REQUIRE(s.discs.bonds.size() == plain + s.matrix_links);

    // Columns touch their neighbours: a disc of a deep fibre has two neighbours on each side, its lowest and its
    // highest disc one, because the columns beside it are shorter.
    p = parameters(cartilage_zone::deep, specimen_preset::lattice, 120e-6);
    p.link_matrix = true;
    p.fibre_layers = 1;
    auto const deep = make_cartilage_specimen(p);
    // The centre column has 34 discs, those beside it 33, half a diameter higher: 2 * 33 links on either side.
    REQUIRE(deep.fibres.size() == 1);
    REQUIRE(deep.fibres[0].particles.size() == 34);
    REQUIRE(deep.matrix_links == 2 * 2 * 33);
}

TEST_CASE("links join exactly the touching pairs", "[particles][specimen]") {
    for (auto zone : {cartilage_zone::middle, cartilage_zone::whole}) {
        auto p = parameters(zone, specimen_preset::literal, 150e-6);
        auto const plain = make_cartilage_specimen(p);
        p.link_fibres = p.link_matrix = true;
        auto const s = make_cartilage_specimen(p);
        auto const& d = s.discs;
        REQUIRE(d.position == plain.discs.position);
        std::vector<std::array<std::int32_t, 2>> fibres, matrix;
        for (std::size_t i = 0; i < d.size(); ++i)
            for (std::size_t j = i + 1; j < d.size(); ++j) {
                if (packing_check::gap(d, i, j) > 0.02 * std::min(d.radius[i], d.radius[j])) continue;
                if (s.fibre[i] >= 0 && s.fibre[j] >= 0 && s.fibre[i] != s.fibre[j])
                    fibres.push_back({std::int32_t(i), std::int32_t(j)});
                if ((s.fibre[i] >= 0) != (s.fibre[j] >= 0)) matrix.push_back({std::int32_t(i), std::int32_t(j)});
            }
        REQUIRE(fibres.size() > 0);
        REQUIRE(s.fibre_links == fibres.size());
        REQUIRE(s.matrix_links == matrix.size());
        auto expected = plain.discs.bonds;
        expected.insert(expected.end(), fibres.begin(), fibres.end());
        expected.insert(expected.end(), matrix.begin(), matrix.end());
        REQUIRE(d.bonds == expected);

        p.link_matrix = false;
        auto const some = make_cartilage_specimen(p);
        REQUIRE(some.matrix_links == 0);
        REQUIRE(some.discs.bonds.size() == plain.discs.bonds.size() + fibres.size());
    }
}

TEST_CASE("fibres only in the given number of layers", "[particles][specimen]") {
    for (auto preset : {specimen_preset::literal, specimen_preset::lattice}) {
        CAPTURE(preset == specimen_preset::lattice);
        auto p = parameters(cartilage_zone::surface, preset, 120e-6);
        p.fibre_layers = 3;
        auto const surface = make_cartilage_specimen(p);
        REQUIRE(surface.fibres.size() == 3);
        REQUIRE(surface.top == surface.fibres[0].particles);

        p.zone = cartilage_zone::deep;
        p.fibre_layers = 2;
        auto const deep = make_cartilage_specimen(p);
        REQUIRE(deep.fibres.size() == 3);
        for (auto const& f : deep.fibres) REQUIRE(f.layer <= 1);

        p.zone = cartilage_zone::middle;
        p.fibre_layers = 4;
        auto const middle = make_cartilage_specimen(p);
        REQUIRE(middle.fibres.size() > 5);
        // Four spacings of 14 um from the top row, or 20 of 21.65 rows of the lattice.
        double lowest = 1;
        for (auto const& f : middle.fibres)
            for (auto i : f.particles) lowest = std::min(lowest, middle.discs.position[std::size_t(i)][1]);
        REQUIRE(lowest > 120e-6 - 4 * 15.2e-6 - 4.5e-6);
        REQUIRE(lowest < 120e-6 - 3 * 14e-6);
    }
    cartilage_specimen_parameters p;
    p.fibre_layers = -1;
    REQUIRE_THROWS_WITH(make_cartilage_specimen(p), "specimen.fibre_layers = -1: must be at least 0");
}
