// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <lacuna/core/vec.hpp>

/// \file
/// Whether two particles touch, wherever that decides about bonds and contacts of a packing.

namespace lacuna {

/// What rounding may add to a gap, over the sum of the radii: 1e-9, in single precision 64 roundings.
template <class Real>
inline constexpr Real touching_slack = std::max(Real(1e-9), 64 * std::numeric_limits<Real>::epsilon());

/// A particle's radius with the slack that it adds to a gap: touching_slack, and four roundings of its place, which is
/// seldom exact (a lattice written in decimals). No more: places with six or seven digits need a gap of their own.
template <class Real, int Dim>
Real touching_radius(vec<Real, Dim> const& place, Real radius) noexcept {
    Real farthest = 0;
    for (int axis = 0; axis < Dim; ++axis) farthest = std::max(farthest, std::abs(place[axis]));
    return radius * (1 + touching_slack<Real>) + 4 * std::numeric_limits<Real>::epsilon() * farthest;
}

/// Whether the gap between two particles is at most `gap`, but for rounding. m
template <class Real, int Dim>
bool touches(vec<Real, Dim> const& a, Real radius_a, vec<Real, Dim> const& b, Real radius_b, Real gap = 0) noexcept {
    return norm(b - a) <= (touching_radius(a, radius_a) + touching_radius(b, radius_b)) + gap;
}

} // namespace lacuna
