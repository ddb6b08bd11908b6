// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/particles/packing.hpp>
#include <lacuna/packings/dense.hpp>

namespace lacuna {

/// Kind of a side of a packing's rectangle: a hard side keeps whole discs inside, a free side only their centres.
enum class packing_side { hard, free };

/// Parameters of random_packing().
struct random_packing_parameters {
    double width = 120e-6;            ///< of the rectangle, from x = 0, m
    double height = 300e-6;           ///< of the rectangle, from y = 0, m
    double r_min = 1.5e-6;            ///< smallest radius, m
    double r_max = 2e-6;              ///< largest radius, m; at most 4 r_min
    double area_fraction = 0.84;      ///< area of discs and obstacles inside the rectangle over its area, 0 to 0.9069
    double overlap_tolerance = 0.01;  ///< largest overlap of a pair over its smaller radius, 1e-4 to 0.1
    double fraction_tolerance = 0.01; ///< largest shortfall of the area fraction; > 0
    packing_side left_right = packing_side::hard;
    packing_side bottom_top = packing_side::hard;
    int material = 0;                ///< of the new discs
    std::uint64_t seed = 1;

    /// \throws std::invalid_argument naming field, value and rule.
    void validate() const {
        require_positive("random_packing.width", width);
        require_positive("random_packing.height", height);
        require_positive("random_packing.r_min", r_min);
        require_positive("random_packing.r_max", r_max);
        if (r_max < r_min) refuse("random_packing.r_max", r_max, "at least r_min = " + to_text(r_min));
        if (r_max > 4 * r_min) refuse("random_packing.r_max", r_max, "at most 4 r_min = " + to_text(4 * r_min));
        if (width < 2 * r_max) refuse("random_packing.width", width, "at least 2 r_max = " + to_text(2 * r_max));
        if (height < 2 * r_max) refuse("random_packing.height", height, "at least 2 r_max = " + to_text(2 * r_max));
        if (width / r_max > 1e7 / (height / r_max))
            refuse("random_packing.height", height, "such that width * height holds at most 1e7 discs");
        require_in("random_packing.area_fraction", area_fraction, 0.0, 0.9069);
        require_in("random_packing.overlap_tolerance", overlap_tolerance, 1e-4, 0.1);
        require_positive("random_packing.fraction_tolerance", fraction_tolerance);
    }
};

namespace detail {

/// Copies a bed's mobile discs, scaled by `unit`, to the end of a packing.
inline void append_mobile(disc_bed const& bed, double unit, int material, packing<double, 2>& to) {
    for (std::size_t i = bed.fixed; i < bed.x.size(); ++i) to.add(unit * bed.x[i], unit * bed.r[i], material);
}

/// A bed in the rectangle [low, high] (m) with the discs of a packing as obstacles. Its unit of length is `unit` (m).
inline disc_bed make_bed(packing<double, 2> const& obstacles, vec<double, 2> const& low, vec<double, 2> const& high,
                         double unit) {
    disc_bed bed;
    bed.low = low / unit;
    bed.high = high / unit;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        bed.x.push_back(obstacles.position[i] / unit);
        bed.r.push_back(obstacles.radius[i] / unit);
    }
    bed.fixed = bed.x.size();
    return bed;
}

} // namespace detail

/// Random discs in the rectangle [0, width] x [0, height], with radii uniform in [r_min, r_max].
///
/// Scattered discs repel each other until no overlap exceeds the tolerance. Above the density at which they jam,
/// squeezed discs shrink and loose ones grow, at constant covered area; then radii are no longer uniform.
/// \param obstacles discs that stay unchanged, m
/// \return the obstacles with their bonds, then the new discs
/// \throws std::invalid_argument for a bad parameter, or if the area fraction (less its tolerance) cannot be reached
///         without larger overlaps
template <class Real = double>
packing<Real, 2> random_packing(random_packing_parameters const& p, packing<double, 2> const& obstacles = {}) {
    p.validate();
    double const unit = (p.r_min + p.r_max) / 2;
    detail::radius_range const range{p.r_min / unit, p.r_max / unit};
    detail::disc_bed bed = detail::make_bed(obstacles, {0, 0}, {p.width, p.height}, unit);
    bed.hard[0] = p.left_right == packing_side::hard;
    bed.hard[1] = p.bottom_top == packing_side::hard;
    random_source random(p.seed);
    double const box = bed.high[0] * bed.high[1];
    double const wanted = p.area_fraction * box - detail::area_inside(bed, 0, bed.fixed);
    double const enough = 0.5 * p.overlap_tolerance * range.low;

    // Discs at a free side lie partly outside: the rectangle that they cover is a radius wider there.
    double const grow = (bed.high[0] + (bed.hard[0] ? 0.0 : 2.0)) * (bed.high[1] + (bed.hard[1] ? 0.0 : 2.0)) / box;
    detail::scatter(bed, random, range, std::max(0.0, wanted) * grow);
    detail::disc_relaxer relaxer(bed);
    relaxer.run(600, enough);
    relaxer.forces();
    if (relaxer.largest_overlap() > enough) detail::breathe(bed, relaxer, range, -1.0, 60, enough);
    detail::settle(bed, relaxer, range, p.overlap_tolerance);

    double const reached = detail::area_inside(bed, 0, bed.x.size()) / box;
    if (reached < p.area_fraction - p.fraction_tolerance)
        refuse("random_packing.area_fraction", p.area_fraction,
               "reachable without larger overlaps; this seed reached " + to_text(reached));
    packing<double, 2> result = obstacles;
    detail::append_mobile(bed, unit, p.material, result);
    return convert_packing<Real>(result);
}

} // namespace lacuna
