// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "cartilage/specimen/cartilage_specimen.hpp"

#include "packings/check.hpp"

using lacuna::cartilage_specimen;
using lacuna::cartilage_specimen_parameters;
using lacuna::cartilage_zone;
using lacuna::make_cartilage_specimen;
using lacuna::specimen_preset;

namespace {

constexpr cartilage_zone all_zones[] = {cartilage_zone::surface, cartilage_zone::middle, cartilage_zone::deep,
                                        cartilage_zone::whole};

cartilage_specimen_parameters parameters(cartilage_zone zone, std::uint64_t seed,
                                         specimen_preset preset = specimen_preset::literal) {
    cartilage_specimen_parameters p;
    p.zone = zone;
    p.seed = seed;
    p.preset = preset;
    return p;
}

int collagen_of(cartilage_zone zone) {
    return zone == cartilage_zone::surface ? 1 : zone == cartilage_zone::middle ? 2 : 3;
}

/// Checks what holds for every specimen: consistent indices, straight touching fibres, no overlap.
void is_consistent(cartilage_specimen<double> const& s, cartilage_specimen_parameters const& p) {
    auto const& d = s.discs;
    REQUIRE(s.fibre.size() == d.size());
    REQUIRE(d.radius.size() == d.size());
    REQUIRE(d.material.size() == d.size());

    std::size_t bonds = 0, members = 0;
    for (std::size_t f = 0; f < s.fibres.size(); ++f) {
        auto const& fibre = s.fibres[f];
        REQUIRE(fibre.particles.size() >= 2);
        REQUIRE(fibre.bonds.size() == fibre.particles.size() - 1);
        bonds += fibre.bonds.size();
        members += fibre.particles.size();
        auto const first = std::size_t(fibre.particles.front()), last = std::size_t(fibre.particles.back());
        auto const along = (d.position[last] - d.position[first]) / norm(d.position[last] - d.position[first]);
        for (std::size_t k = 0; k < fibre.particles.size(); ++k) {
            auto const i = std::size_t(fibre.particles[k]);
            REQUIRE(s.fibre[i] == int(f));
            REQUIRE(d.material[i] == collagen_of(fibre.zone));
            REQUIRE(std::fabs(cross(along, d.position[i] - d.position[first])) < 1e-12 * p.height);
            if (k == 0) continue;
            auto const before = std::size_t(fibre.particles[k - 1]);
            auto const bond = d.bonds[std::size_t(fibre.bonds[k - 1])];
            REQUIRE(std::minmax(bond[0], bond[1]) == std::minmax(fibre.particles[k - 1], fibre.particles[k]));
            REQUIRE_THAT(norm(d.position[i] - d.position[before]), WithinRel(d.radius[i] + d.radius[before], 1e-12));
        }
    }
    REQUIRE(d.bonds.size() == bonds);
    REQUIRE(std::size_t(std::count_if(s.fibre.begin(), s.fibre.end(), [](int f) { return f >= 0; })) == members);
    for (std::size_t i = 0; i < d.size(); ++i)
        if (s.fibre[i] < 0) REQUIRE(d.material[i] == 0);
    for (double r : d.radius) {
        REQUIRE(r >= p.r_min * (1 - 1e-12));
        REQUIRE(r <= p.r_max * (1 + 1e-12));
    }

    double const overlap = packing_check::largest_overlap(d);
    REQUIRE(overlap <= p.contact_tolerance);
    REQUIRE_THAT(s.statistics.max_overlap, WithinAbs(overlap, 1e-12));
    REQUIRE(packing_check::largest_escape(d, p.length, p.height) <= p.contact_tolerance);
    REQUIRE(s.statistics.particles == d.size());
    REQUIRE(s.statistics.bonded == members);
    REQUIRE(s.statistics.bonds == bonds);
    REQUIRE_THAT(s.statistics.mean_coordination,
                 WithinRel(packing_check::coordination(d, 2 * p.contact_tolerance), 1e-12));
    REQUIRE_THAT(s.statistics.area_fraction,
                 WithinRel(packing_check::disc_area(d) / ((s.right - s.left) * p.height), 1e-12));

    REQUIRE_THAT(s.wall_left, WithinAbs(s.left - 7e-6, 1e-18));
    REQUIRE_THAT(s.wall_right, WithinAbs(s.right + 7e-6, 1e-18));
    REQUIRE_THAT(s.thickness, WithinRel(3.5e-6, 1e-12));
    std::vector<std::int32_t> expected;
    for (auto i : s.top) {
        double const x = d.position[std::size_t(i)][0];
        if (x >= s.left + 24.5e-6 && x <= s.right - 24.5e-6) expected.push_back(i);
    }
    REQUIRE(s.loaded == expected);
    REQUIRE(s.loaded.size() >= 15); // 71 um of discs of 3.5 um: 20, less gaps beside pinned discs
    for (auto i : s.fixed) REQUIRE(std::find(s.top.begin(), s.top.end(), i) == s.top.end());
}

/// The discs connected to the loaded row by contacts with gaps up to `tolerance` smaller radii.
std::vector<char> reached_from_top(cartilage_specimen<double> const& s, double tolerance) {
    auto const& d = s.discs;
    std::vector<char> reached(d.size(), 0);
    std::vector<std::int32_t> next = s.loaded;
    for (auto i : next) reached[std::size_t(i)] = 1;
    while (!next.empty()) {
        auto const i = std::size_t(next.back());
        next.pop_back();
        for (std::size_t j = 0; j < d.size(); ++j) {
            if (reached[j] || std::fabs(d.position[j][1] - d.position[i][1]) > 5e-6) continue;
            if (packing_check::gap(d, i, j) > tolerance * std::min(d.radius[i], d.radius[j])) continue;
            reached[j] = 1;
            next.push_back(std::int32_t(j));
        }
    }
    return reached;
}

/// Radius of the largest disc that fits between the others, m, with its centre on a grid of 0.4 um.
double largest_hole(cartilage_specimen<double> const& s) {
    double largest = 0;
    for (double y = 0; y <= s.height; y += 0.4e-6)
        for (double x = 0; x <= s.length; x += 0.4e-6) {
            double room = std::min(std::min(x, s.length - x), std::min(y, s.height - y));
            for (std::size_t j = 0; j < s.discs.size() && room > largest; ++j) {
                double const dx = s.discs.position[j][0] - x, dy = s.discs.position[j][1] - y;
                double const reach = room + s.discs.radius[j];
                if (dx * dx + dy * dy < reach * reach) room = std::sqrt(dx * dx + dy * dy) - s.discs.radius[j];
            }
            largest = std::max(largest, room);
        }
    return largest;
}

int fibres_of(cartilage_specimen<double> const& s, cartilage_zone zone) {
    return int(std::count_if(s.fibres.begin(), s.fibres.end(), [&](auto const& f) { return f.zone == zone; }));
}

} // namespace

TEST_CASE("every zone is dense and consistent, and contacts connect its top and bottom", "[particles][specimen]") {
    for (auto zone : all_zones)
        for (std::uint64_t seed : {1u, 5u, 42u}) {
            auto p = parameters(zone, seed);
            if (seed != 1) p.height = 120e-6;
            auto const s = make_cartilage_specimen(p);
            CAPTURE(to_string(zone), seed);
            is_consistent(s, p);
            // Discs of mean area 9.687 um^2 (3716 in 36000 um^2); a jammed packing fills 0.82 to 0.86.
            double const full = p.length * p.height / 9.687e-12;
            REQUIRE(double(s.discs.size()) > full * 0.81);
            REQUIRE(double(s.discs.size()) < full * 0.87);
            REQUIRE(s.statistics.area_fraction > 0.81);
            // Jammed discs without friction have 4 contacts each, except for a few loose ones.
            REQUIRE(s.statistics.mean_coordination > 3.95);
            REQUIRE(s.statistics.loose < 30);
            // A quarter of the discs at a spacing of four diameters.
            REQUIRE(double(s.statistics.bonded) / double(s.statistics.particles) > 0.20);
            REQUIRE(double(s.statistics.bonded) / double(s.statistics.particles) < 0.27);

            auto const reached = reached_from_top(s, 0.02);
            for (auto i : s.fixed) REQUIRE(reached[std::size_t(i)] == 1);
            REQUIRE(std::count(reached.begin(), reached.end(), char(0)) < 30);
            // No void below the loaded row: most of its discs touch a lower disc.
            int hanging = 0;
            for (auto i : s.loaded) {
                bool rests = false;
                for (std::size_t j = 0; j < s.discs.size(); ++j)
                    rests = rests || (s.discs.position[j][1] < s.discs.position[std::size_t(i)][1] - 1e-6 &&
                                      packing_check::gap(s.discs, std::size_t(i), j) < 0.02 * p.r_min);
                hanging += rests ? 0 : 1;
            }
            REQUIRE(hanging <= int(s.loaded.size()) * 2 / 5);
            REQUIRE(largest_hole(s) < 1.05 * p.r_min);
            // Straight rows from side to side.
            for (auto const* row : {&s.fixed, &s.top})
                for (auto i : *row)
                    REQUIRE(s.discs.position[std::size_t(i)][1] ==
                            s.discs.position[std::size_t(row->front())][1]);
            REQUIRE_THAT(s.discs.position[std::size_t(s.top[0])][1], WithinRel(p.height - 2e-6, 1e-12));
            REQUIRE_THAT(s.discs.position[std::size_t(s.fixed[0])][1], WithinRel(2e-6, 1e-12));
        }
}

TEST_CASE("a specimen depends on its seed alone", "[particles][specimen]") {
    for (auto zone : all_zones) {
        auto p = parameters(zone, 9);
        p.height = 75e-6;
        auto const a = make_cartilage_specimen(p);
        auto const b = make_cartilage_specimen(p);
        p.seed = 10;
        auto const c = make_cartilage_specimen(p);
        REQUIRE(packing_check::same_bits(a.discs, b.discs));
        REQUIRE(a.fibre == b.fibre);
        REQUIRE_FALSE(packing_check::same_bits(a.discs, c.discs));
    }
}

TEST_CASE("surface fibres are level, evenly spaced, from side to side", "[particles][specimen]") {
    auto const s = make_cartilage_specimen(parameters(cartilage_zone::surface, 3));
    // 296 um between the rows, at 14 um: 21 spacings of 296/21, the fixed row below the last.
    REQUIRE(s.fibres.size() == 21);
    REQUIRE_THAT(s.surface_spacing, WithinRel(296e-6 / 21, 1e-12));
    REQUIRE(s.top == s.fibres[0].particles);
    for (int k = 0; k < 21; ++k) {
        auto const& f = s.fibres[std::size_t(k)];
        REQUIRE(f.layer == k);
        REQUIRE(f.order == k);
        double sum = 0;
        for (auto i : f.particles) {
            REQUIRE_THAT(s.discs.position[std::size_t(i)][1], WithinRel(298e-6 - k * 296e-6 / 21, 1e-12));
            sum += 2 * s.discs.radius[std::size_t(i)];
        }
        REQUIRE_THAT(sum, WithinRel(120e-6, 1e-12));
    }
    for (auto i : s.fixed) REQUIRE(s.fibre[std::size_t(i)] == -1);
}

TEST_CASE("deep fibres stand upright on the fixed row and reach the top row", "[particles][specimen]") {
    auto const s = make_cartilage_specimen(parameters(cartilage_zone::deep, 3));
    // 60 um less one and a half diameters, in four: 13.6875 um, the nearest to 14 of all that leave whole diameters.
    REQUIRE(s.fibres.size() == 9);
    REQUIRE_THAT(s.deep_spacing, WithinRel(13.6875e-6, 1e-12));
    for (std::size_t n = 0; n < 9; ++n) {
        auto const& f = s.fibres[n];
        REQUIRE(f.order == int(n) - 4);
        REQUIRE(f.layer == std::abs(int(n) - 4));
        auto const foot = f.particles.front(), head = f.particles.back();
        REQUIRE(std::find(s.fixed.begin(), s.fixed.end(), foot) != s.fixed.end());
        REQUIRE_THAT(s.discs.position[std::size_t(head)][0], WithinRel(60e-6 + f.order * 13.6875e-6, 1e-12));
        double nearest = 1;
        for (auto i : s.top)
            nearest = std::min(nearest, std::fabs(packing_check::gap(s.discs, std::size_t(i), std::size_t(head))));
        REQUIRE(nearest < 1e-12 * 300e-6);
    }
    for (auto i : s.top) REQUIRE(s.fibre[std::size_t(i)] == -1);
}

TEST_CASE("middle fibres form a network in all directions", "[particles][specimen]") {
    int steep = 0, level = 0, fibres = 0;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        auto const s = make_cartilage_specimen(parameters(cartilage_zone::middle, seed));
        auto const& d = s.discs;
        double length = 0;
        int meeting = 0;
        for (auto const& f : s.fibres) {
            REQUIRE(f.zone == cartilage_zone::middle);
            REQUIRE(f.particles.size() >= 4);
            double y = 0;
            for (auto i : f.particles) {
                length += 2 * d.radius[std::size_t(i)];
                y += d.position[std::size_t(i)][1] / double(f.particles.size());
                REQUIRE(std::find(s.fixed.begin(), s.fixed.end(), i) == s.fixed.end());
            }
            // Rows at 2 and 298 um bound the network: fifths of 59.2 um, counted from the top.
            REQUIRE(f.layer == std::min(4, int((298e-6 - y) / 59.2e-6)));
            auto const first = d.position[std::size_t(f.particles.front())];
            auto const u = (d.position[std::size_t(f.particles.back())] - first);
            (std::fabs(u[1]) > std::fabs(u[0]) ? steep : level) += 1;
            ++fibres;
            for (auto end : {f.particles.front(), f.particles.back()})
                for (std::size_t j = 0; j < d.size(); ++j)
                    if (s.fibre[j] >= 0 && s.fibre[j] != s.fibre[std::size_t(end)] &&
                        packing_check::gap(d, std::size_t(end), j) < 1e-9 * 1.5e-6)
                        ++meeting;
        }
        // Total length of parallel fibres at 14 um, less pieces that did not fit, and at most one fibre more.
        REQUIRE(length > 0.9 * 120e-6 * 296e-6 / 14e-6);
        REQUIRE(length < 120e-6 * 296e-6 / 14e-6 + 60e-6);
        REQUIRE(meeting > 10);
        for (int fifth = 0; fifth < 5; ++fifth)
            REQUIRE(std::any_of(s.fibres.begin(), s.fibres.end(), [&](auto const& f) { return f.layer == fifth; }));
    }
    // Random directions: half of them steep; the bound is four standard deviations of a fair coin.
    CAPTURE(steep, level);
    REQUIRE(std::abs(steep - level) < 4 * std::sqrt(double(fibres)));
}

TEST_CASE("the whole specimen stacks the zones", "[particles][specimen]") {
    auto const s = make_cartilage_specimen(parameters(cartilage_zone::whole, 4));
    REQUIRE_THAT(s.deep_top, WithinRel(100e-6, 1e-12));
    REQUIRE_THAT(s.middle_top, WithinRel(200e-6, 1e-12));
    REQUIRE(fibres_of(s, cartilage_zone::surface) == 7); // at 298, 284, ... 214 um
    REQUIRE(fibres_of(s, cartilage_zone::deep) == 9);
    REQUIRE(fibres_of(s, cartilage_zone::middle) > 10);
    for (auto const& f : s.fibres)
        for (auto i : f.particles) {
            double const y = s.discs.position[std::size_t(i)][1], r = s.discs.radius[std::size_t(i)];
            if (f.zone == cartilage_zone::deep) REQUIRE(y + r <= 100e-6 * (1 + 1e-12));
            if (f.zone == cartilage_zone::middle) {
                REQUIRE(y - r >= 100e-6 * (1 - 1e-12));
                REQUIRE(y + r <= 200e-6 * (1 + 1e-12));
            }
            if (f.zone == cartilage_zone::surface) REQUIRE(y >= 200e-6);
        }
    REQUIRE(s.fibre[std::size_t(s.top[3])] >= 0);
    REQUIRE(s.fibres[std::size_t(s.fibre[std::size_t(s.top[3])])].layer == 0);

    auto p = parameters(cartilage_zone::whole, 4);
    p.surface_fraction = 0.2;
    p.middle_fraction = 0.3;
    p.deep_fraction = 0.5;
    auto const other = make_cartilage_specimen(p);
    REQUIRE_THAT(other.deep_top, WithinRel(150e-6, 1e-12));
    REQUIRE_THAT(other.middle_top, WithinRel(240e-6, 1e-12));
    is_consistent(other, p);
}

TEST_CASE("the lattice preset is symmetric and needs no seed", "[particles][specimen]") {
    for (auto zone : all_zones) {
        auto const p = parameters(zone, 1, specimen_preset::lattice);
        auto const s = make_cartilage_specimen(p);
        CAPTURE(to_string(zone));
        is_consistent(s, p);
        REQUIRE(packing_check::same_bits(
            s.discs, make_cartilage_specimen(parameters(zone, 2, specimen_preset::lattice)).discs));
        auto const& d = s.discs;
        std::vector<std::size_t> mirror(d.size());
        for (std::size_t i = 0; i < d.size(); ++i) {
            REQUIRE_THAT(d.radius[i], WithinRel(1.75e-6, 1e-12));
            std::size_t found = d.size();
            for (std::size_t j = 0; j < d.size() && found == d.size(); ++j)
                if (std::fabs(d.position[i][0] + d.position[j][0] - 120e-6) < 1e-15 &&
                    std::fabs(d.position[i][1] - d.position[j][1]) < 1e-15)
                    found = j;
            REQUIRE(found < d.size());
            REQUIRE(d.material[found] == d.material[i]);
            mirror[i] = found;
        }
        std::vector<std::array<std::int32_t, 2>> there, back;
        for (auto const& b : d.bonds) {
            auto const m0 = std::int32_t(mirror[std::size_t(b[0])]), m1 = std::int32_t(mirror[std::size_t(b[1])]);
            there.push_back({std::min(b[0], b[1]), std::max(b[0], b[1])});
            back.push_back({std::min(m0, m1), std::max(m0, m1)});
        }
        std::sort(there.begin(), there.end());
        std::sort(back.begin(), back.end());
        REQUIRE(there == back);
        REQUIRE(s.statistics.mean_coordination > 5.7); // 6 inside a hexagonal lattice
        auto const reached = reached_from_top(s, 1e-6);
        REQUIRE(std::count(reached.begin(), reached.end(), char(0)) == 0);
    }
}

TEST_CASE("other sizes and spacings", "[particles][specimen]") {
    for (auto preset : {specimen_preset::literal, specimen_preset::lattice})
        for (auto zone : all_zones) {
            CAPTURE(to_string(zone), preset == specimen_preset::lattice);
            auto p = parameters(zone, 6, preset);
            p.length = 120e-6;
            p.height = 75e-6;
            is_consistent(make_cartilage_specimen(p), p);
            p.fibre_spacing = 2.5;
            is_consistent(make_cartilage_specimen(p), p);
            p.length = 300e-6;
            p.height = 120e-6;
            p.fibre_spacing = 6;
            is_consistent(make_cartilage_specimen(p), p);
        }
    auto p = parameters(cartilage_zone::deep, 1);
    p.height = 60e-6;
    p.r_min = p.r_max = 1.75e-6;
    is_consistent(make_cartilage_specimen(p), p);
    p.r_min = 1.5e-6;
    p.r_max = 2e-6;
    p.fill = 0.6;
    auto const sparse = make_cartilage_specimen(p);
    is_consistent(sparse, p);
    REQUIRE_THAT(sparse.statistics.area_fraction, WithinAbs(0.6, 0.01));
    auto const single = make_cartilage_specimen<float>(p);
    REQUIRE(single.discs.size() == sparse.discs.size());
    REQUIRE(single.loaded == sparse.loaded);
}

TEST_CASE("bad specimens are refused by name", "[particles][specimen]") {
    auto const refused = [](auto change, char const* words) {
        cartilage_specimen_parameters p;
        change(p);
        CAPTURE(words);
        REQUIRE_THROWS_AS(make_cartilage_specimen(p), std::invalid_argument);
        REQUIRE_THROWS_WITH(make_cartilage_specimen(p), contains_text(words));
    };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    refused([](auto& p) { p.height = 13e-6; }, "specimen.height = 1.3e-05: must be at least one fibre spacing");
    refused([](auto& p) { p.height = 50e-6, p.zone = cartilage_zone::whole; }, "specimen.height = 5e-05");
    refused([](auto& p) { p.height = 300; }, "specimen.height = 300");
    refused([=](auto& p) { p.height = nan; }, "specimen.height = nan");
    refused([](auto& p) { p.length = 0; }, "specimen.length = 0");
    refused([](auto& p) { p.length = 50e-6; }, "specimen.length = 5e-05: must be more than twice loaded_margin");
    refused([](auto& p) { p.r_min = 0; }, "specimen.r_min = 0");
    refused([](auto& p) { p.r_max = 1e-6; }, "specimen.r_max = 1e-06");
    refused([](auto& p) { p.r_max = 4e-6; }, "specimen.r_max = 4e-06");
    refused([](auto& p) { p.fibre_spacing = 1; }, "specimen.fibre_spacing = 1");
    refused([=](auto& p) { p.fibre_spacing = nan; }, "specimen.fibre_spacing = nan");
    refused([](auto& p) { p.fill = 1.2; }, "specimen.fill = 1.2");
    refused([](auto& p) { p.contact_tolerance = 0; }, "specimen.contact_tolerance = 0");
    refused([](auto& p) { p.thickness = -1; }, "specimen.thickness = -1");
    refused([](auto& p) { p.loaded_margin = -1; }, "specimen.loaded_margin = -1");
    refused([](auto& p) { p.wall_distance = -1; }, "specimen.wall_distance = -1");
    refused([](auto& p) { p.minimum_fibre_particles = 1; }, "specimen.minimum_fibre_particles = 1");
    refused([](auto& p) { p.middle_fibre_length = 1e-6; }, "specimen.middle_fibre_length = 1e-06");
    refused([](auto& p) { p.zone = cartilage_zone::whole, p.deep_fraction = 0.5; }, "surface_fraction = 1.1666");
    REQUIRE_THROWS_WITH(lacuna::parse_cartilage_zone("bone"), contains_text("zone = bone"));
    for (auto zone : all_zones) REQUIRE(lacuna::parse_cartilage_zone(to_string(zone)) == zone);
}
