// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <lacuna/core/vec.hpp>

/// \file
/// The test whether two particles touch. All parts of the library use it to find bonds and contacts of a packing.

namespace lacuna {

/// The gap that rounding may cause, over the sum of the radii: 1e-9, in single precision 64 roundings.
template <class Real>
inline constexpr Real touching_slack = std::max(Real(1e-9), 64 * std::numeric_limits<Real>::epsilon());

/// A particle's radius plus its share of the slack: touching_slack, and four roundings of its coordinates, which are
/// seldom exact (a lattice written in decimals). Coordinates with only six or seven digits need more: pass a `gap` to
/// touches().
template <class Real, int Dim>
Real touching_radius(vec<Real, Dim> const& position, Real radius) noexcept {
    Real farthest = 0;
    for (int axis = 0; axis < Dim; ++axis) farthest = std::max(farthest, std::abs(position[axis]));
    return radius * (1 + touching_slack<Real>) + 4 * std::numeric_limits<Real>::epsilon() * farthest;
}

/// True if the gap between two particles is at most `gap`, apart from rounding. Lengths in m.
template <class Real, int Dim>
bool touches(vec<Real, Dim> const& a, Real radius_a, vec<Real, Dim> const& b, Real radius_b, Real gap = 0) noexcept {
    return norm(b - a) <= (touching_radius(a, radius_a) + touching_radius(b, radius_b)) + gap;
}

} // namespace lacuna
