// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/particles/packing.hpp>
#include <lacuna/packings/random_numbers.hpp>

namespace lacuna {

/// A fibre: a chain of touching, bonded particles. Entries are numbers of particles and bonds of the packing.
struct fibre_chain {
    std::vector<std::int32_t> particles; ///< in order along the fibre
    std::vector<std::int32_t> bonds;     ///< bond k joins particles k and k + 1
};

/// Radii of a row of discs that fills a length.
struct fitted_row {
    std::vector<double> radius; ///< m, in order
    double rest = 0;            ///< length left over, m; 0 when the row fits to rounding
};

/// Radii of discs whose diameters sum to `length`. They are drawn from [r_min, r_max]; then each is moved towards the
/// same end of the range, by the same fraction of its distance. If no number of discs fits, `rest` is left over.
/// \param length m; a length <= 0 gives an empty row
/// \param r_min,r_max range of radii, m
inline fitted_row fit_radii(double length, double r_min, double r_max, random_source& random) {
    fitted_row row;
    double const slack = 1e-9 * r_min;
    auto const most = static_cast<long long>(std::floor((length + slack) / (2 * r_min)));
    if (most < 1) {
        row.rest = std::max(0.0, length);
        return row;
    }
    auto const fewest = static_cast<long long>(std::ceil((length - slack) / (2 * r_max)));
    bool const exact = fewest <= most;
    long long count = static_cast<long long>(std::llround(length / (r_min + r_max)));
    count = exact ? std::clamp(count, std::max(1LL, fewest), most) : most;
    double sum = 0;
    for (long long i = 0; i < count; ++i) {
        row.radius.push_back(r_min < r_max ? random.uniform(r_min, r_max) : r_min);
        sum += row.radius.back();
    }
    double const goal = exact ? length / 2 : double(count) * r_max;
    if (r_min < r_max) {
        double const end = goal > sum ? r_max : r_min;
        double const room = double(count) * end - sum;
        double const share = room != 0 ? std::clamp((goal - sum) / room, 0.0, 1.0) : 0.0;
        for (double& r : row.radius) r = std::clamp(r + share * (end - r), r_min, r_max);
    }
    row.rest = length;
    for (double r : row.radius) row.rest -= 2 * r;
    if (row.rest < slack) row.rest = 0;
    return row;
}

/// Adds a row of discs of given radii along a line. Neighbours touch and are bonded.
/// \param chain the fibre to continue: empty, or ending with a particle whose far edge is at `edge`
/// \param edge start of the row: the point of the first disc's rim opposite to `direction`, m
/// \param direction unit vector
/// \param radius m
template <class Real, int Dim>
void lay_radii(packing<Real, Dim>& to, fibre_chain& chain, vec<Real, Dim> const& edge,
               vec<Real, Dim> const& direction, std::vector<double> const& radius, int material) {
    double along = 0;
    for (double r : radius) {
        auto const i = to.add(edge + direction * Real(along + r), Real(r), material);
        if (!chain.particles.empty()) {
            chain.bonds.push_back(std::int32_t(to.bonds.size()));
            to.bonds.push_back({chain.particles.back(), i});
        }
        chain.particles.push_back(i);
        along += 2 * r;
    }
}

/// Adds a fibre of touching discs with random radii along a straight line.
/// \param to packing to which particles and bonds are added
/// \param edge start of the fibre: the rim of its first disc, m
/// \param direction any vector except zero
/// \param length largest length of the fibre from rim to rim, m; it ends with the last disc that fits
/// \param r_min,r_max range of radii, m
/// \param random source of the radii
/// \throws std::invalid_argument for a length or radius that is not > 0, r_max < r_min, or a direction of zero length
template <class Real, int Dim>
fibre_chain lay_fibre(packing<Real, Dim>& to, vec<Real, Dim> const& edge, vec<Real, Dim> const& direction,
                      Real length, Real r_min, Real r_max, random_source& random, int material = 1) {
    require_positive("fibre.length", double(length));
    require_positive("fibre.r_min", double(r_min));
    require_positive("fibre.r_max", double(r_max));
    if (r_max < r_min) refuse("fibre.r_max", double(r_max), "at least r_min = " + to_text(double(r_min)));
    Real const size = norm(direction);
    if (!(size > Real(0)) || !std::isfinite(size)) refuse("fibre.direction", double(size), "a vector of length > 0");
    std::vector<double> radius;
    for (double along = 0;;) {
        double const r = r_min < r_max ? random.uniform(double(r_min), double(r_max)) : double(r_min);
        along += 2 * r;
        if (along > double(length) * (1 + 1e-12)) break;
        radius.push_back(r);
    }
    fibre_chain chain;
    lay_radii(to, chain, edge, direction / size, radius, material);
    return chain;
}

/// Length of the ray from `from` along `direction` inside the box [low, high], in units of |direction|; 0 if it starts
/// outside.
template <class Real, int Dim>
Real length_inside(vec<Real, Dim> const& from, vec<Real, Dim> const& direction, vec<Real, Dim> const& low,
                   vec<Real, Dim> const& high) {
    Real length = std::numeric_limits<Real>::infinity();
    for (int axis = 0; axis < Dim; ++axis) {
        if (from[axis] < low[axis] || from[axis] > high[axis]) return Real(0);
        if (direction[axis] > Real(0)) length = std::min(length, (high[axis] - from[axis]) / direction[axis]);
        if (direction[axis] < Real(0)) length = std::min(length, (low[axis] - from[axis]) / direction[axis]);
    }
    return length;
}

/// Adds a fibre that ends before a disc would leave the box [low, high]; see lay_fibre(). The first disc is centred at
/// `centre`. Without any effect if `centre` is closer than r_max to a side of the box.
/// \throws std::invalid_argument for a direction of zero length
template <class Real, int Dim>
fibre_chain lay_fibre_within(packing<Real, Dim>& to, vec<Real, Dim> const& centre, vec<Real, Dim> const& direction,
                             vec<Real, Dim> low, vec<Real, Dim> high, Real r_min, Real r_max,
                             random_source& random, int material = 1) {
    Real const size = norm(direction);
    if (!(size > Real(0)) || !std::isfinite(size)) refuse("fibre.direction", double(size), "a vector of length > 0");
    // A disc is inside the box if its centre is inside the box shrunk by the largest radius.
    for (int axis = 0; axis < Dim; ++axis) {
        low[axis] += r_max;
        high[axis] -= r_max;
    }
    auto const u = direction / size;
    Real const room = length_inside(centre, u, low, high);
    bool inside = true;
    for (int axis = 0; axis < Dim; ++axis) inside = inside && centre[axis] >= low[axis] && centre[axis] <= high[axis];
    if (!inside) return {};
    double const first = r_min < r_max ? random.uniform(double(r_min), double(r_max)) : double(r_min);
    std::vector<double> radius{first};
    for (double at = 0;;) {
        double const r = r_min < r_max ? random.uniform(double(r_min), double(r_max)) : double(r_min);
        at += radius.back() + r;
        if (at > double(room)) break;
        radius.push_back(r);
    }
    fibre_chain chain;
    lay_radii(to, chain, centre - u * Real(first), u, radius, material);
    return chain;
}

} // namespace lacuna
