// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/particle_refusal.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh/exact_signs.hpp>

namespace lacuna::detail {

/// Coordinates of a point in the scaled frame of a triangulation.
template <int Dim>
using scaled_point = std::array<double, std::size_t(Dim)>;

/// Key that orders points along a slanted line. Along an axis, rounding would decide on the order within a row.
template <int Dim>
double along(scaled_point<Dim> const& x) noexcept {
    double sum = x[0] + 0.6180339887498949 * x[1];
    if constexpr (Dim == 3) sum += 0.3819660112501051 * x[2];
    return sum;
}

/// A coordinate or radius as a triangulation uses it: 0 if it is under 1e-290 m.
template <class Real>
double length_of(Real length) noexcept {
    return std::fabs(double(length)) < 1e-290 ? 0 : double(length);
}

/// Pseudorandom number from -1 to 1 for each k (the hash of SplitMix64).
inline double scatter(std::uint64_t k) noexcept {
    k = (k + 1) * 0x9e3779b97f4a7c15;
    k = (k ^ (k >> 30)) * 0xbf58476d1ce4e5b9;
    k = (k ^ (k >> 27)) * 0x94d049bb133111eb;
    return double((k ^ (k >> 31)) >> 11) * 0x1p-52 - 1;
}

/// Distinct particles of a triangulation, moved and scaled to fit into a box of side 1 around the origin.
template <int Dim>
struct scaled_particles {
    std::vector<std::int32_t> particle; ///< particle numbers
    std::vector<scaled_point<Dim>> x;   ///< centres, sorted by along()
    std::vector<double> radius;
    double scale = 0; ///< 1 / m
    /// Length scale of tolerances: the extent, but at most 64 times the largest radius. One particle far away must not
    /// widen the tolerances for all others.
    double reach = 1;
    double reach_in_metres = 0; ///< the same, m: `reach` underflows if a particle is very far away

    /// Shift of the height |x|^2 - r^2 of particle k.
    ///
    /// In space Qhull divides more than four points on one sphere such that flat tetrahedra lie between the others.
    /// Shifted heights are in general position and avoid that.
    double shift(std::size_t k) const noexcept {
        if constexpr (Dim == 2) return 0;
        // Of a particle without radius among others: by the largest. The extent may exceed their distances by far.
        double const own = radius[k] > 0 ? radius[k] : largest;
        return std::min(nudge, 64e-7 * own * own) * scatter(k);
    }
    double nudge = 0;   ///< largest shift: 1e-7 N^(-2/3) for N particles in space
    double largest = 0; ///< largest radius; infinity if all are 0
};

/// Deviation of points from one line (in space: from one plane), as a share of their extent. It is the height of a
/// simplex whose corners are chosen one by one, each as far as possible from the span of those before it.
template <int Dim>
double flatness(std::vector<scaled_point<Dim>> const& points) {
    std::vector<scaled_point<Dim>> rest(points);
    for (auto& x : rest)
        for (std::size_t axis = 0; axis < std::size_t(Dim); ++axis) x[axis] -= points[0][axis];
    double height = 0;
    for (int direction = 0; direction < Dim; ++direction) {
        auto const squared = [](auto const& x) {
            double sum = 0;
            for (double const c : x) sum += c * c;
            return sum;
        };
        auto const far = *std::max_element(rest.begin(), rest.end(),
                                           [&](auto const& a, auto const& b) { return squared(a) < squared(b); });
        height = std::sqrt(squared(far));
        if (!(height > 0)) return 0;
        for (auto& x : rest) {
            double share = 0;
            for (std::size_t axis = 0; axis < std::size_t(Dim); ++axis) share += x[axis] * far[axis] / height / height;
            for (std::size_t axis = 0; axis < std::size_t(Dim); ++axis) x[axis] -= share * far[axis];
        }
    }
    return height;
}

/// Scales particles for a triangulation. Of several whose centres coincide (up to 1e-10 of the reach) only the largest
/// is included.
template <class Real, int Dim>
scaled_particles<Dim> scale_particles(points_view<Real, Dim> points, Real const* radii) {
    constexpr auto dim = std::size_t(Dim);
    auto const at = [&](std::int32_t i, std::size_t axis) { return length_of(points(std::size_t(i), int(axis))); };
    auto const count = std::int32_t(points.size());
    scaled_point<Dim> middle{};
    double extent = 0, largest = 0;
    for (std::size_t axis = 0; axis < dim; ++axis) {
        double low = at(0, axis), high = low;
        for (std::int32_t i = 0; i < count; ++i) {
            low = std::min(low, at(i, axis));
            high = std::max(high, at(i, axis));
            largest = std::max(largest, length_of(radii[i]));
        }
        middle[axis] = low / 2 + high / 2;
        extent = std::max(extent, high - low);
    }
    scaled_particles<Dim> all;
    double const scale = all.scale = extent > 0 ? 1 / extent : 0;
    auto const scaled_radius = [&](double r) { return std::min(r * scale, 1e70); }; // its square is finite
    all.largest = largest > 0 ? scaled_radius(largest) : std::numeric_limits<double>::infinity();
    all.reach = largest > 0 ? std::min(1.0, 64 * largest * scale) : 1.0;
    all.reach_in_metres = largest > 0 ? std::min(extent, 64 * largest) : extent;
    auto const scaled_position = [&](std::int32_t i) {
        scaled_point<Dim> x;
        for (std::size_t axis = 0; axis < dim; ++axis) x[axis] = (at(i, axis) - middle[axis]) * scale;
        return x;
    };
    auto const apart = [&](std::int32_t i, std::int32_t j) {
        double most = 0;
        for (std::size_t axis = 0; axis < dim; ++axis) most = std::max(most, std::fabs(at(i, axis) - at(j, axis)));
        return most;
    };

    std::vector<std::pair<double, std::int32_t>> order;
    for (std::int32_t i = 0; i < count; ++i) order.push_back({along<Dim>(scaled_position(i)), i});
    std::sort(order.begin(), order.end());
    double const same = 1e-10 * all.reach, rounding = 1e-15;
    for (auto const& [key, i] : order) {
        double const radius = scaled_radius(length_of(radii[i]));
        bool distinct = true;
        for (std::size_t k = all.x.size(); distinct && k-- > 0 && key - along<Dim>(all.x[k]) <= 2 * same + rounding;) {
            if (apart(i, all.particle[k]) > 1e-10 * all.reach_in_metres) continue;
            distinct = false;
            if (radii[i] > radii[all.particle[k]]) {
                all.particle[k] = i;
                all.radius[k] = radius;
            }
        }
        if (!distinct) continue;
        all.particle.push_back(i);
        all.x.push_back(scaled_position(i));
        all.radius.push_back(radius);
    }
    if (Dim == 3) all.nudge = 1e-7 * std::pow(double(all.x.size()), -2.0 / 3.0);
    return all;
}

/// Particles as exact_signs uses them. Scaling by a power of two does not round their positions.
template <class Real, int Dim>
weighted_sites<Dim> make_sites(std::vector<std::int32_t> const& list, points_view<Real, Dim> points,
                               Real const* radii) {
    using sites_type = weighted_sites<Dim>;
    double largest = 0;
    for (auto const i : list) {
        for (int axis = 0; axis < Dim; ++axis)
            largest = std::max(largest, std::fabs(double(points(std::size_t(i), axis))));
        largest = std::max(largest, double(radii[i]));
    }
    largest = length_of(largest);
    sites_type sites;
    if (largest > 0) sites.scale = std::ldexp(1.0, std::min(sites_type::most_exponent - 1 - std::ilogb(largest), 1023));
    auto const scaled = [&](Real given) {
        double const length = length_of(given);
        sites.wide = sites.wide || (length != 0 && std::fabs(length) * sites.scale < sites_type::least);
        return length * sites.scale;
    };
    for (auto const i : list) {
        scaled_point<Dim> x;
        for (int axis = 0; axis < Dim; ++axis) x[std::size_t(axis)] = scaled(points(std::size_t(i), axis));
        sites.x.push_back(x);
        sites.radius.push_back(scaled(radii[i]));
    }
    sites.shift.assign(list.size(), 0);
    return sites;
}

/// The same for scaled particles, with their shifts and reach.
template <class Real, int Dim>
weighted_sites<Dim> make_sites(scaled_particles<Dim> const& all, points_view<Real, Dim> points, Real const* radii) {
    auto sites = make_sites(all.particle, points, radii);
    double const ratio = all.scale / sites.scale, squared_extent = 1 / (ratio * ratio);
    for (std::size_t k = 0; k < sites.size(); ++k) {
        double const shift = sites.shift[k] = -(all.shift(k) * squared_extent);
        sites.wide = sites.wide || (shift != 0 && std::fabs(shift) < sites.least * sites.least);
    }
    sites.reach = all.reach_in_metres * sites.scale;
    return sites;
}

/// Whether particles are too few for a simplex, or lie on one line (in space: in one plane). False if a particle is so
/// far away that scaled positions do not resolve the others: exact signs decide in that case.
template <int Dim>
bool lie_flat(scaled_particles<Dim> const& all) {
    return all.x.size() < std::size_t(Dim) + 1 || (all.reach > 1e-5 && flatness<Dim>(all.x) < 1e-9 * all.reach);
}

/// Refuses positions and radii for which the fourth power of a length might overflow.
/// \throws particle_refusal for a position outside -1e70 to 1e70 m, or a radius outside 0 to 1e70 m.
template <class Real, int Dim>
void require_particles(points_view<Real, Dim> points, Real const* radii) {
    constexpr double most = 1e70;
    auto const refuse_it = [](char const* field, std::size_t i, double value, char const* rule) {
        throw particle_refusal(std::string(field) + " of particle #", value, rule, {std::int32_t(i)});
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int axis = 0; axis < Dim; ++axis) {
            double const x = double(points(i, axis));
            if (!(std::fabs(x) <= most))
                refuse_it("position", i, x, std::isfinite(x) ? "from -1e70 to 1e70 m" : "finite");
        }
        double const r = double(radii[i]);
        if (!(r >= 0 && r <= most))
            refuse_it("radius", i, r, std::isfinite(r) && r > 0 ? "at most 1e70 m" : ">= 0 and finite");
    }
}

} // namespace lacuna::detail
