// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <cmath>
#include <stdexcept>

#include <lacuna/packings/fibres.hpp>
#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/packings/random_packing.hpp>

#include "check.hpp"

using lacuna::vec;

TEST_CASE("random numbers come from the standard's generator, with our own mapping", "[particles]") {
    // The standard fixes the 10000th output of mt19937_64 with its default seed 5489: 9981545732273789042.
    lacuna::random_source random(5489);
    for (int k = 0; k < 9999; ++k) random.uniform();
    REQUIRE_THAT(random.uniform(), WithinRel(9981545732273789042.0 / 18446744073709551616.0, 1e-15));
}

TEST_CASE("lattices have the bonds and positions counted by hand", "[particles]") {
    auto const line = lacuna::chain<double, 3>(5, 2.0);
    REQUIRE(line.size() == 5);
    REQUIRE(line.bonds.size() == 4);
    REQUIRE(line.position[4] == vec<double, 3>{16.0, 0.0, 0.0});

    auto const square = lacuna::square_lattice<double, 2>(4, 3, 0.5, true);
    REQUIRE(square.size() == 12);
    REQUIRE(square.bonds.size() == 3 * 3 + 4 * 2);
    REQUIRE(square.position[11] == vec<double, 2>{3.0, 2.0});

    // 5 x 4 rows: 4 * 4 bonds within rows, 5 + 4 between each of 3 pairs of rows.
    auto const sheet = lacuna::hexagonal_rows(5, 4, 1.5, true);
    REQUIRE(sheet.size() == 20);
    REQUIRE(sheet.bonds.size() == 43);
    for (auto const& b : sheet.bonds)
        REQUIRE_THAT(packing_check::gap(sheet, std::size_t(b[0]), std::size_t(b[1])), WithinAbs(0.0, 1e-14));
    REQUIRE(packing_check::largest_overlap(sheet) < 1e-14);

    // Rows of 5, 4, 5: 4 + 3 + 4 within, 8 between each of 2 pairs.
    auto const symmetric = lacuna::hexagonal_rows<double>(5, 3, 1.0, true, true);
    REQUIRE(symmetric.size() == 14);
    REQUIRE(symmetric.bonds.size() == 27);
    REQUIRE(lacuna::hexagonal_rows(5, 4, 1.0).bonds.empty());

    REQUIRE_THROWS_AS((lacuna::hexagonal_rows(0, 4, 1.0)), std::invalid_argument);
    REQUIRE_THROWS_AS((lacuna::square_lattice<double, 2>(2, 2, -1.0)), std::invalid_argument);
    REQUIRE_THROWS_WITH((lacuna::chain<double, 2>(0, 1.0)), contains_text("count = 0"));
}

TEST_CASE("measured statistics agree with hand numbers and brute force", "[particles]") {
    lacuna::packing<double, 2> p;
    p.add({0, 0}, 1.0);
    p.add({1.9, 0}, 1.0);    // overlap 0.1 of radius 1
    p.add({1.9, 1.45}, 0.5); // gap -0.05, 0.1 of radius 0.5
    p.add({10, 10}, 2.0);
    p.bonds.push_back({0, 1});
    auto const s = lacuna::measure_packing(p, 100.0, 0.02);
    REQUIRE(s.particles == 4);
    REQUIRE(s.bonded == 2);
    REQUIRE(s.bonds == 1);
    REQUIRE(s.loose == 3);
    REQUIRE_THAT(s.max_overlap, WithinRel(0.1, 1e-12));
    REQUIRE_THAT(s.mean_coordination, WithinRel(1.0, 1e-15));
    REQUIRE_THAT(s.area_fraction, WithinRel(0.19634954084936207, 1e-14)); // 6.25 pi / 100
    REQUIRE(lacuna::measure_packing(lacuna::packing<double, 2>{}, 1.0, 0.01).particles == 0);
}

TEST_CASE("a random packing has the requested properties", "[particles]") {
    lacuna::random_packing_parameters p;
    p.width = p.height = 120e-6;
    for (double fraction : {0.5, 0.80, 0.84, 0.86})
        for (std::uint64_t seed : {1u, 2u}) {
            p.area_fraction = fraction;
            p.seed = seed;
            auto const discs = lacuna::random_packing(p);
            CAPTURE(fraction, seed);
            REQUIRE(packing_check::largest_overlap(discs) <= p.overlap_tolerance);
            REQUIRE(packing_check::largest_escape(discs, p.width, p.height) <= p.overlap_tolerance);
            REQUIRE_THAT(packing_check::disc_area(discs) / (p.width * p.height), WithinAbs(fraction, 0.01));
            for (double r : discs.radius) {
                REQUIRE(r >= p.r_min * (1 - 1e-12));
                REQUIRE(r <= p.r_max * (1 + 1e-12));
            }
            REQUIRE(packing_check::same_bits(discs, lacuna::random_packing(p)));
        }
    p.seed = 1;
    auto const one = lacuna::random_packing(p);
    p.seed = 3;
    REQUIRE_FALSE(packing_check::same_bits(one, lacuna::random_packing(p)));
}

TEST_CASE("below jamming the radii stay uniform", "[particles]") {
    lacuna::random_packing_parameters p;
    p.area_fraction = 0.80;
    auto const discs = lacuna::random_packing(p);
    // Uniform in [1.5, 2]: mean 1.75, standard deviation 0.5/sqrt(12); the mean of n = 2970 has 1/sqrt(n) of that.
    double mean = 0, square = 0;
    for (double r : discs.radius) mean += r / double(discs.size());
    for (double r : discs.radius) square += (r - mean) * (r - mean) / double(discs.size());
    REQUIRE_THAT(mean, WithinAbs(1.75e-6, 4 * 0.1443e-6 / std::sqrt(2970.0)));
    REQUIRE_THAT(std::sqrt(square), WithinRel(0.14434e-6, 0.05));
}

TEST_CASE("free sides keep centres inside, hard sides whole discs", "[particles]") {
    lacuna::random_packing_parameters p;
    p.width = p.height = 90e-6;
    p.area_fraction = 0.83;
    p.left_right = lacuna::packing_side::free;
    auto const discs = lacuna::random_packing(p);
    bool beyond = false;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        double const x = discs.position[i][0], y = discs.position[i][1], r = discs.radius[i];
        REQUIRE(x >= -p.overlap_tolerance * r);
        REQUIRE(x <= p.width + p.overlap_tolerance * r);
        REQUIRE(y >= r * (1 - p.overlap_tolerance));
        beyond = beyond || x < 0.5 * r;
    }
    REQUIRE(beyond);
    REQUIRE(packing_check::largest_overlap(discs) <= p.overlap_tolerance);
}

TEST_CASE("obstacles stay in place and count for the area fraction", "[particles]") {
    lacuna::packing<double, 2> wall;
    lacuna::random_source random(4);
    lacuna::lay_fibre<double, 2>(wall, {0, 50e-6}, {1, 0}, 100e-6, 1.5e-6, 2e-6, random);
    lacuna::random_packing_parameters p;
    p.width = p.height = 100e-6;
    p.area_fraction = 0.8;
    auto const discs = lacuna::random_packing(p, wall);
    REQUIRE(discs.bonds == wall.bonds);
    for (std::size_t i = 0; i < wall.size(); ++i) {
        REQUIRE(discs.position[i] == wall.position[i]);
        REQUIRE(discs.radius[i] == wall.radius[i]);
    }
    REQUIRE(packing_check::largest_overlap(discs) <= p.overlap_tolerance);
    REQUIRE_THAT(packing_check::disc_area(discs) / 1e-8, WithinAbs(0.8, 0.01));
}

TEST_CASE("equal radii and single precision work", "[particles]") {
    lacuna::random_packing_parameters p;
    p.width = p.height = 60e-6;
    p.r_min = p.r_max = 1.5e-6;
    p.area_fraction = 0.75;
    auto const discs = lacuna::random_packing<float>(p);
    REQUIRE(packing_check::largest_overlap(discs) <= p.overlap_tolerance + 1e-4);
    for (float r : discs.radius) REQUIRE_THAT(double(r), WithinRel(1.5e-6, 1e-6));
}

TEST_CASE("bad random packings are refused by name", "[particles]") {
    auto const refused = [](auto change, char const* words) {
        lacuna::random_packing_parameters p;
        p.width = p.height = 60e-6;
        change(p);
        REQUIRE_THROWS_AS(lacuna::random_packing(p), std::invalid_argument);
        REQUIRE_THROWS_WITH(lacuna::random_packing(p), contains_text(words));
    };
    refused([](auto& p) { p.width = 0; }, "random_packing.width = 0");
    refused([](auto& p) { p.r_min = -1e-6; }, "random_packing.r_min");
    refused([](auto& p) { p.r_max = 1e-6; }, "random_packing.r_max");
    refused([](auto& p) { p.area_fraction = std::nan(""); }, "random_packing.area_fraction");
    refused([](auto& p) { p.area_fraction = 0.95; }, "random_packing.area_fraction");
    refused([](auto& p) { p.overlap_tolerance = 0; }, "random_packing.overlap_tolerance");
    // Denser than any packing that was ever found for this spread of radii with overlaps of 0.1 %.
    refused([](auto& p) { p.area_fraction = 0.905, p.overlap_tolerance = 1e-3, p.fraction_tolerance = 1e-3; },
            "reachable");
}

TEST_CASE("fibres are straight and touch to rounding in every direction", "[particles]") {
    lacuna::random_source random(11);
    for (double angle : {0.0, 0.3, 1.5707963267948966, 2.5, 4.0}) {
        lacuna::packing<double, 2> p;
        p.add({5e-3, 5e-3}, 1e-6); // numbers of particles and bonds must continue from here
        vec<double, 2> const u{std::cos(angle), std::sin(angle)}, edge{40e-6, 30e-6};
        auto const f = lacuna::lay_fibre<double, 2>(p, edge, 3.0 * u, 100e-6, 1.5e-6, 2e-6, random, 2);
        double total = 0;
        REQUIRE(f.bonds.size() == f.particles.size() - 1);
        for (std::size_t k = 0; k < f.particles.size(); ++k) {
            auto const i = std::size_t(f.particles[k]);
            REQUIRE(i == k + 1);
            REQUIRE(p.material[i] == 2);
            REQUIRE(p.radius[i] >= 1.5e-6);
            REQUIRE(p.radius[i] <= 2e-6);
            REQUIRE_THAT(cross(u, p.position[i] - edge), WithinAbs(0.0, 1e-18));
            total += 2 * p.radius[i];
            if (k == 0) continue;
            auto const before = std::size_t(f.particles[k - 1]);
            double const reach = p.radius[i] + p.radius[before];
            REQUIRE_THAT(norm(p.position[i] - p.position[before]), WithinRel(reach, 1e-12));
            REQUIRE(p.bonds[std::size_t(f.bonds[k - 1])] ==
                    std::array<std::int32_t, 2>{f.particles[k - 1], f.particles[k]});
        }
        REQUIRE(total <= 100e-6);
        REQUIRE(total > 96e-6); // one more of at most 4 um would not have fitted
    }
}

TEST_CASE("a fibre within a rectangle ends at its side", "[particles]") {
    lacuna::random_source random(3);
    lacuna::packing<double, 2> p;
    auto const f = lacuna::lay_fibre_within<double, 2>(p, {10e-6, 10e-6}, {1, 1}, {0, 0}, {100e-6, 50e-6}, 1.5e-6,
                                                       2e-6, random);
    REQUIRE(p.position[0] == vec<double, 2>{10e-6, 10e-6});
    REQUIRE(packing_check::largest_escape(p, 100e-6, 50e-6) <= 0);
    REQUIRE(p.position[std::size_t(f.particles.back())][1] > 50e-6 - 2e-6 - 4e-6 * std::sqrt(0.5));
    auto const none = lacuna::lay_fibre_within<double, 2>(p, {0, 10e-6}, {1, 1}, {0, 0}, {100e-6, 50e-6}, 1.5e-6,
                                                          2e-6, random);
    REQUIRE(none.particles.empty());
}

TEST_CASE("rows fit a length exactly if any number of discs can", "[particles]") {
    lacuna::random_source random(5);
    for (double length : {3e-6, 3.7e-6, 7e-6, 10.5e-6, 120e-6, 296e-6}) {
        auto const row = lacuna::fit_radii(length, 1.5e-6, 2e-6, random);
        double sum = 0;
        for (double r : row.radius) {
            REQUIRE(r >= 1.5e-6);
            REQUIRE(r <= 2e-6);
            sum += 2 * r;
        }
        CAPTURE(length);
        REQUIRE_THAT(sum, WithinRel(length, 1e-12));
        REQUIRE(row.rest == 0.0);
    }
    // One disc takes 3 to 4, two take 6 to 8: 5 leaves 1 at least.
    auto const short_row = lacuna::fit_radii(5e-6, 1.5e-6, 2e-6, random);
    REQUIRE(short_row.radius.size() == 1);
    REQUIRE_THAT(short_row.rest, WithinRel(1e-6, 1e-9));
    REQUIRE(lacuna::fit_radii(2e-6, 1.5e-6, 2e-6, random).radius.empty());
    REQUIRE(lacuna::fit_radii(-1.0, 1.5e-6, 2e-6, random).rest == 0.0);
    // Ten equal discs of radius 1 in 21: one half of a disc is left.
    auto const equal = lacuna::fit_radii(21.0, 1.0, 1.0, random);
    REQUIRE(equal.radius.size() == 10);
    REQUIRE_THAT(equal.rest, WithinRel(1.0, 1e-12));
}

TEST_CASE("bad fibres are refused", "[particles]") {
    lacuna::random_source random(1);
    lacuna::packing<double, 2> p;
    vec<double, 2> const x{0, 0}, right{1, 0};
    REQUIRE_THROWS_WITH((lacuna::lay_fibre<double, 2>(p, x, right, -1.0, 1.0, 2.0, random)),
                        contains_text("fibre.length"));
    REQUIRE_THROWS_WITH((lacuna::lay_fibre<double, 2>(p, x, x, 1.0, 1.0, 2.0, random)),
                        contains_text("fibre.direction"));
    REQUIRE_THROWS_WITH((lacuna::lay_fibre<double, 2>(p, x, right, 9.0, 2.0, 1.0, random)),
                        contains_text("fibre.r_max"));
    REQUIRE(p.size() == 0);
}
