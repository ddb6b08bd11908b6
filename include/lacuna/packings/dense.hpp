// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <lacuna/packings/random_numbers.hpp>
#include <lacuna/packings/relax.hpp>

namespace lacuna::detail {

inline constexpr double pi = 3.14159265358979323846;

/// Area of the part of a disc of radius r around x that lies inside a rectangle. Near a corner, where two sides cut the
/// disc, both segments are subtracted in full.
inline double area_inside(vec<double, 2> const& x, double r, vec<double, 2> const& low, vec<double, 2> const& high) {
    double area = pi * r * r;
    for (int axis = 0; axis < 2; ++axis)
        for (double const inside : {x[axis] - low[axis], high[axis] - x[axis]}) {
            double const h = std::clamp(inside / r, -1.0, 1.0);
            area -= r * r * (std::acos(h) - h * std::sqrt(1 - h * h));
        }
    return std::max(area, 0.0);
}

inline double area_inside(disc_bed const& bed, std::size_t from, std::size_t to) {
    double area = 0;
    for (std::size_t i = from; i < to; ++i) area += area_inside(bed.x[i], bed.r[i], bed.low, bed.high);
    return area;
}

/// Range of radii of the discs of a bed.
struct radius_range {
    double low, high;
    double draw(random_source& random) const { return low < high ? random.uniform(low, high) : low; }
};

/// Scatters discs of total area `area` over the rectangle outside the obstacles. Their positions are points of a
/// lattice, displaced at random: even on the scale of a few discs, random below it.
inline void scatter(disc_bed& bed, random_source& random, radius_range range, double area) {
    std::vector<double> radius;
    for (double filled = 0; filled < area;) {
        double const r = range.draw(random);
        if (filled + 0.5 * pi * r * r > area) break;
        radius.push_back(r);
        filled += pi * r * r;
    }
    std::size_t const n = radius.size();
    if (n == 0) return;
    vec<double, 2> const size = bed.high - bed.low;
    disc_grid const obstacles(bed.x, 4.0);
    std::vector<vec<double, 2>> candidate;
    for (double spacing = std::sqrt(size[0] * size[1] / double(n)); candidate.size() < n; spacing *= 0.985) {
        candidate.clear();
        for (double y = bed.low[1] + spacing / 2; y < bed.high[1]; y += spacing)
            for (double x = bed.low[0] + spacing / 2; x < bed.high[0]; x += spacing) {
                vec<double, 2> const p{x + spacing * random.uniform(-0.45, 0.45),
                                       y + spacing * random.uniform(-0.45, 0.45)};
                bool free = true;
                obstacles.for_each_near(p, 2.5, [&](std::size_t j) {
                    double const keep = bed.r[j] + 0.4;
                    free = free && squared_norm(p - bed.x[j]) > keep * keep;
                });
                if (free) candidate.push_back(p);
            }
        if (spacing < 0.05) return;
    }
    // Selects n of the candidates in one pass, all with equal probability.
    std::size_t left = candidate.size(), wanted = n;
    for (auto const& p : candidate) {
        if (random.uniform() * double(left--) >= double(wanted)) continue;
        bed.x.push_back(p);
        bed.r.push_back(radius[--wanted]);
    }
}

/// Removes the mobile discs for which remove(i) is true.
template <class Remove>
void remove_discs(disc_bed& bed, Remove&& remove) {
    std::size_t count = bed.fixed;
    for (std::size_t i = bed.fixed; i < bed.x.size(); ++i)
        if (!remove(i)) {
            bed.x[count] = bed.x[i];
            bed.r[count++] = bed.r[i];
        }
    bed.x.resize(count);
    bed.r.resize(count);
}

/// Removes discs whose sum of overlaps over radius exceeds `limit`, at most one within a distance of 6.
/// \return number of discs removed
inline std::size_t remove_squeezed(disc_bed& bed, std::vector<double> const& pressure, double limit) {
    std::vector<std::size_t> order;
    for (std::size_t i = bed.fixed; i < bed.x.size(); ++i)
        if (pressure[i] > limit * bed.r[i]) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return pressure[a] != pressure[b] ? pressure[a] > pressure[b] : a < b;
    });
    disc_grid const grid(bed.x, 4.0);
    std::vector<char> removed(bed.x.size(), 0), near(bed.x.size(), 0);
    std::size_t count = 0;
    for (std::size_t i : order) {
        if (near[i]) continue;
        removed[i] = 1;
        ++count;
        grid.for_each_near(bed.x[i], 6.0, [&](std::size_t j) {
            if (squared_norm(bed.x[j] - bed.x[i]) < 36.0) near[j] = 1;
        });
    }
    remove_discs(bed, [&](std::size_t i) { return removed[i] != 0; });
    return count;
}

/// Adds discs in holes with a clearance of at least `least` times the smallest radius, widest holes first, until the
/// mobile discs cover `area`.
/// \return number of discs added
inline std::size_t fill_holes(disc_bed& bed, random_source& random, radius_range range, double least, double area) {
    struct hole {
        vec<double, 2> x;
        double clearance;
    };
    double const step = 0.2 * range.low;
    disc_grid const grid(bed.x, 2.0);
    std::vector<hole> holes;
    vec<double, 2> const size = bed.high - bed.low;
    auto const columns = std::size_t(size[0] / step), rows = std::size_t(size[1] / step);
    for (std::size_t row = 0; row <= rows; ++row)
        for (std::size_t column = 0; column <= columns; ++column) {
            vec<double, 2> const p{bed.low[0] + step * double(column), bed.low[1] + step * double(row)};
            double clearance = 2.0;
            for (int axis = 0; axis < 2; ++axis)
                if (bed.hard[axis])
                    clearance = std::min({clearance, p[axis] - bed.low[axis], bed.high[axis] - p[axis]});
            if (clearance < least * range.low) continue;
            grid.for_each_near(p, 4.0, [&](std::size_t j) {
                if (clearance < least * range.low) return;
                clearance = std::min(clearance, norm(p - bed.x[j]) - bed.r[j]);
            });
            if (clearance >= least * range.low) holes.push_back({p, clearance});
        }
    std::sort(holes.begin(), holes.end(), [](hole const& a, hole const& b) {
        if (a.clearance != b.clearance) return a.clearance > b.clearance;
        return a.x[1] != b.x[1] ? a.x[1] < b.x[1] : a.x[0] < b.x[0];
    });
    double filled = 0;
    for (std::size_t i = bed.fixed; i < bed.x.size(); ++i) filled += pi * bed.r[i] * bed.r[i];
    std::size_t const before = bed.x.size();
    for (auto const& h : holes) {
        double const r = std::clamp(range.draw(random), range.low, std::max(range.low, 1.1 * h.clearance));
        if (filled + pi * r * r > area) break;
        bool free = true;
        for (std::size_t j = before; j < bed.x.size() && free; ++j)
            free = squared_norm(h.x - bed.x[j]) > (bed.r[j] + r) * (bed.r[j] + r);
        if (!free) continue;
        bed.x.push_back(h.x);
        bed.r.push_back(r);
        filled += pi * r * r;
    }
    return bed.x.size() - before;
}

/// Changes radii within their range while the discs relax: squeezed discs shrink and loose ones grow, until each disc's
/// sum of overlaps is about `target` times its radius. A negative target means the present mean, and keeps the covered
/// area constant (a simple form of Brito, Lerner and Wyart, Phys. Rev. X 8, 031050 (2018)). No disc grows while the
/// mobile discs cover `most` or more.
inline void breathe(disc_bed& bed, disc_relaxer& relaxer, radius_range range, double target, int rounds,
                    double enough, double most = 1e300) {
    for (int round = 0; round < rounds; ++round) {
        relaxer.run(40, enough);
        auto const& pressure = relaxer.pressure();
        double goal = target, area = 0, after = 0;
        if (target < 0) {
            if (relaxer.largest_overlap() <= enough) return;
            double sum = 0;
            for (std::size_t i = bed.fixed; i < bed.x.size(); ++i) sum += pressure[i] / bed.r[i];
            goal = sum / double(std::max<std::size_t>(1, bed.x.size() - bed.fixed));
        }
        for (std::size_t i = bed.fixed; i < bed.x.size(); ++i) area += bed.r[i] * bed.r[i];
        double const growth = pi * area < most ? 0.003 : 0.0;
        for (std::size_t i = bed.fixed; i < bed.x.size(); ++i) {
            double const change = std::clamp((goal - pressure[i] / bed.r[i]) / 12, -0.005, growth);
            bed.r[i] = std::clamp(bed.r[i] * (1 + change), range.low, range.high);
            after += bed.r[i] * bed.r[i];
        }
        if (target < 0 && after > 0) {
            double const back = std::sqrt(area / after);
            for (std::size_t i = bed.fixed; i < bed.x.size(); ++i)
                bed.r[i] = std::clamp(bed.r[i] * back, range.low, range.high);
        }
        relaxer.reset();
    }
}

/// Ensures that no overlap exceeds `tolerance` times the smaller radius. It relaxes the bed, then shrinks discs within
/// their range, then removes discs that still overlap too much, and repeats that until no disc has to be removed.
inline void settle(disc_bed& bed, disc_relaxer& relaxer, radius_range range, double tolerance) {
    relaxer.run(400, 0.2 * tolerance * range.low);
    double const margin = 1 - 1e-6; // keeps rounding from raising an overlap above the tolerance again
    for (;;) {
        std::vector<char> removed(bed.x.size(), 0);
        bool again = false;
        auto const ease = [&](std::size_t i, double excess) {
            if (i < bed.fixed) return excess;
            double const smaller = std::max(range.low, bed.r[i] - excess);
            double const eased = bed.r[i] - smaller;
            bed.r[i] = smaller;
            return excess - eased;
        };
        relaxer.for_each_pair([&](std::size_t i, std::size_t j) {
            if (removed[i] || removed[j]) return;
            double const d = norm(bed.x[j] - bed.x[i]);
            double const allowed = tolerance * margin * std::min(bed.r[i], bed.r[j]);
            double const excess = bed.r[i] + bed.r[j] - d - allowed;
            if (excess <= 0) return;
            // Each disc shrinks by half of it, or takes over what the other cannot. The factor is due to `allowed`,
            // which shrinks with the radii.
            double const need = excess * (1 + 2 * tolerance);
            double left = j < bed.fixed ? need : ease(j, need / 2) + need / 2;
            left = ease(i, left);
            if (left > 0) left = ease(j, left);
            if (left > 1e-9) {
                removed[i] = 1;
                again = true;
            }
        });
        for (std::size_t i = bed.fixed; i < bed.x.size(); ++i)
            for (int axis = 0; axis < 2; ++axis) {
                double const excess = std::fabs(bed.side_overlap(i, axis)) - tolerance * margin * bed.r[i];
                if (!removed[i] && excess > 0 && ease(i, excess * (1 + 2 * tolerance)) > 1e-9) {
                    removed[i] = 1;
                    again = true;
                }
            }
        if (!again) return;
        remove_discs(bed, [&](std::size_t i) { return removed[i] != 0; });
        relaxer.reset();
        relaxer.run(200, 0.2 * tolerance * range.low);
    }
}

} // namespace lacuna::detail
