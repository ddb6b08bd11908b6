// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// The area of a particle on which a pressure on a row of particles acts.
enum class traction_area {
    disc, ///< the disc's face, pi r^2: the cartilage model's default
    strip ///< the strip that the disc covers, 2 r t (t: thickness)
};

/// Force that a pressure exerts on one particle of the loaded row, N.
/// \param pressure Pa
/// \param radius m
/// \param thickness m, used by traction_area::strip
/// \throws std::invalid_argument naming field, value and rule
inline double traction_force(double pressure, double radius, double thickness, traction_area area) {
    require_finite("pressure", pressure);
    require_positive("radius", radius);
    if (area == traction_area::disc) return pressure * std::numbers::pi * radius * radius;
    require_positive("thickness", thickness);
    return pressure * 2 * radius * thickness;
}

} // namespace lacuna
