// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// How a pressure on a row of particles becomes a force on each.
enum class traction_area {
    disc, ///< the disc's face, pi r^2: the cartilage model's default
    strip ///< the strip that the disc covers, 2 r t
};

/// Force that a pressure exerts on one particle of the loaded row, N.
/// \param pressure Pa
/// \param radius m
/// \param thickness m, for traction_area::strip
inline double traction_force(double pressure, double radius, double thickness, traction_area area) {
    require_finite("pressure", pressure);
    require_positive("radius", radius);
    if (area == traction_area::disc) return pressure * std::numbers::pi * radius * radius;
    require_positive("thickness", thickness);
    return pressure * 2 * radius * thickness;
}

} // namespace lacuna
