// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <lacuna/particles/packing.hpp>

/// Properties of packings, found by brute force over all pairs.
namespace packing_check {

template <class Real>
double gap(lacuna::packing<Real, 2> const& p, std::size_t i, std::size_t j) {
    double const dx = double(p.position[i][0]) - double(p.position[j][0]);
    double const dy = double(p.position[i][1]) - double(p.position[j][1]);
    return std::sqrt(dx * dx + dy * dy) - double(p.radius[i]) - double(p.radius[j]);
}

/// Largest overlap of any pair over the smaller radius; 0 when none overlap.
template <class Real>
double largest_overlap(lacuna::packing<Real, 2> const& p) {
    double worst = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            worst = std::max(worst, -gap(p, i, j) / double(std::min(p.radius[i], p.radius[j])));
    return worst;
}

/// Mean number of neighbours with a gap of at most `tolerance` smaller radii.
template <class Real>
double coordination(lacuna::packing<Real, 2> const& p, double tolerance) {
    double touching = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (gap(p, i, j) <= tolerance * double(std::min(p.radius[i], p.radius[j]))) touching += 2;
    return touching / double(p.size());
}

/// Largest distance, over its radius, by which a disc extends beyond the rectangle; negative if all are inside.
template <class Real>
double largest_escape(lacuna::packing<Real, 2> const& p, double width, double height) {
    double worst = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < p.size(); ++i) {
        double const x = double(p.position[i][0]), y = double(p.position[i][1]), r = double(p.radius[i]);
        worst = std::max({worst, (r - x) / r, (r - y) / r, (x + r - width) / r, (y + r - height) / r});
    }
    return worst;
}

template <class Real>
double disc_area(lacuna::packing<Real, 2> const& p) {
    double sum = 0;
    for (Real r : p.radius) sum += std::acos(-1.0) * double(r) * double(r);
    return sum;
}

template <class Real>
bool same_bits(lacuna::packing<Real, 2> const& a, lacuna::packing<Real, 2> const& b) {
    return a.position == b.position && a.radius == b.radius && a.material == b.material && a.bonds == b.bonds;
}

} // namespace packing_check
