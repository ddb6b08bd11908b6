// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cartilage/specimen/specimen_fibres.hpp"
#include "cartilage/specimen/specimen_lattice.hpp"
#include "cartilage/specimen/specimen_links.hpp"
#include "cartilage/specimen/specimen_types.hpp"
#include <lacuna/packings/dense.hpp>
#include <lacuna/packings/random_packing.hpp>

namespace lacuna {

namespace detail {

/// Brings a bed of scattered discs to the dense state. Squeezed discs are removed and holes are filled. Then the radii
/// change within their range: first at constant covered area, so that squeezed discs shrink and loose discs grow, then
/// until all discs touch with small overlaps.
inline void make_dense(disc_bed& bed, random_source& random, radius_range range, double area, double tolerance) {
    double const enough = 0.2 * tolerance * range.low, squeezed = 0.6, light = 1.2 * tolerance;
    disc_relaxer relaxer(bed);
    auto const thin = [&](int rounds) {
        relaxer.run(250, enough);
        for (int round = 0; round < rounds; ++round) {
            relaxer.forces();
            if (remove_squeezed(bed, relaxer.pressure(), squeezed) == 0) return;
            relaxer.reset();
            relaxer.run(200, enough);
        }
    };
    thin(30);
    for (int round = 0; round < 6; ++round) {
        if (fill_holes(bed, random, range, 0.7, area) == 0) break;
        relaxer.reset();
        thin(4);
        breathe(bed, relaxer, range, -1.0, 8, enough);
    }
    breathe(bed, relaxer, range, -1.0, 30, enough);
    // Discs that are still squeezed at their smallest radius are removed now: removed by settle() they would leave
    // holes.
    breathe(bed, relaxer, range, light, 15, 0.0, area);
    for (int round = 0; round < 6 && remove_squeezed(bed, relaxer.pressure(), 12 * light) > 0; ++round) {
        relaxer.reset();
        breathe(bed, relaxer, range, light, 6, 0.0, area);
        relaxer.forces();
    }
    relaxer.reset();
    for (int round = 0; round < 5; ++round) {
        std::size_t const added = fill_holes(bed, random, range, 0.92, area);
        if (round > 0 && added == 0) break;
        relaxer.reset();
        breathe(bed, relaxer, range, light, round == 0 ? 20 : 10, 0.0, area);
        settle(bed, relaxer, range, tolerance);
    }
}

/// Fills the area that rows and fibres leave free with free particles.
inline void fill_specimen(cartilage_specimen_parameters const& p, cartilage_specimen<double>& s,
                          random_source& random) {
    double const unit = p.diameter() / 2;
    disc_bed bed = make_bed(s.discs, {0, 0}, {p.length, p.height}, unit);
    double const box = bed.high[0] * bed.high[1], taken = area_inside(bed, 0, bed.fixed);
    radius_range const range{p.r_min / unit, p.r_max / unit};
    scatter(bed, random, range, std::min(p.fill, 0.84) * box - taken);
    make_dense(bed, random, range, p.fill * box - taken, p.contact_tolerance);
    append_mobile(bed, unit, free_matrix, s.discs);
    s.fibre.resize(s.discs.size(), -1);
}

} // namespace detail

/// Builds a cartilage specimen (Hong, Evans and Mente, Fig. 9). The surface zone has straight horizontal fibres, the
/// middle zone a network of fibres in random directions, the deep zone straight vertical fibres. The whole specimen
/// stacks the three zones. Free particles fill the rest in the dense state.
///
/// Fibres are rows of discs that touch to rounding. Surface fibres reach from side to side; the first one is the top
/// row. Deep fibres stand on the fixed bottom row, which holds their first particle, and reach the top row (zone
/// `whole`: the top of the deep zone). Middle fibres end where they meet others; beyond these they continue as new
/// fibres. In zones without surface fibres the top row is a straight row of free particles.
/// \throws std::invalid_argument for a bad parameter
template <class Real = double>
cartilage_specimen<Real> make_cartilage_specimen(cartilage_specimen_parameters const& p) {
    p.validate();
    double const d = p.diameter();
    cartilage_specimen<double> s;
    s.length = p.length;
    s.height = p.height;
    s.thickness = p.thickness > 0 ? p.thickness : d;
    switch (p.zone) {
    case cartilage_zone::surface: break;
    case cartilage_zone::middle: s.middle_top = p.height; break;
    case cartilage_zone::deep: s.deep_top = s.middle_top = p.height; break;
    case cartilage_zone::whole:
        s.deep_top = p.deep_fraction * p.height;
        s.middle_top = s.deep_top + p.middle_fraction * p.height;
    }
    if (p.preset == specimen_preset::lattice) {
        detail::lattice_architect(p, s).lay();
    } else {
        random_source random(p.seed);
        detail::fibre_architect(p, s, random).lay();
        detail::fill_specimen(p, s, random);
        s.left = 0;
        s.right = p.length;
    }
    s.wall_left = s.left - p.wall_distance * d;
    s.wall_right = s.right + p.wall_distance * d;
    for (auto i : s.top) {
        double const x = s.discs.position[std::size_t(i)][0];
        if (x >= s.left + p.loaded_margin * d && x <= s.right - p.loaded_margin * d) s.loaded.push_back(i);
    }
    link_fibres(s, 2 * p.contact_tolerance, p.link_fibres, p.link_matrix);
    s.statistics = measure_packing(s.discs, (s.right - s.left) * p.height, 2 * p.contact_tolerance);

    cartilage_specimen<Real> result;
    result.discs = convert_packing<Real>(s.discs);
    result.fibre_links = s.fibre_links;
    result.matrix_links = s.matrix_links;
    result.fibre = s.fibre;
    result.fibres = s.fibres;
    result.fixed = s.fixed;
    result.top = s.top;
    result.loaded = s.loaded;
    result.left = Real(s.left);
    result.right = Real(s.right);
    result.wall_left = Real(s.wall_left);
    result.wall_right = Real(s.wall_right);
    result.length = Real(s.length);
    result.height = Real(s.height);
    result.thickness = Real(s.thickness);
    result.deep_top = Real(s.deep_top);
    result.middle_top = Real(s.middle_top);
    result.surface_spacing = Real(s.surface_spacing);
    result.deep_spacing = Real(s.deep_spacing);
    result.statistics = s.statistics;
    return result;
}

} // namespace lacuna
