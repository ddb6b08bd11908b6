// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Pressure of a pore that no fluid leaves, and its change with the volume.
struct sealed_response {
    double pressure;  ///< Pa
    double stiffness; ///< - dp/dV, Pa/m^3; 0 while the liquid is torn
    double vapour;    ///< volume that the liquid does not fill, m^3
};

/// Fluid of constant bulk modulus at a new volume: dp = -K_f dV / V, the paper's eq. 15 without flow, integrated
/// exactly: p = p_0 + K_f ln(V_0 / V). The liquid tears at the least pressure; what it does not fill is vapour.
/// \param p flow_parameters
/// \param pressure, volume, vapour before; Pa, m^3
/// \param now new volume, m^3, > 0
template <class Parameters>
sealed_response sealed_pressure(Parameters const& p, double pressure, double volume, double vapour,
                                double now) noexcept {
    double const liquid = volume - vapour;
    double const wanted = pressure + p.bulk_modulus * std::log(liquid / now);
    if (wanted >= p.minimum_pressure) return {wanted, p.bulk_modulus / now, 0};
    return {p.minimum_pressure, 0,
            std::max(now - liquid * std::exp((pressure - p.minimum_pressure) / p.bulk_modulus), 0.0)};
}

/// Volume at the pressure `before` of the liquid that fills the volume `now` at `pressure`: the inverse of
/// sealed_pressure(). Below the least pressure, `pressure` is the one that a liquid without vapour would have.
/// \param p flow_parameters
template <class Parameters>
double volume_before(Parameters const& p, double before, double pressure, double now) noexcept {
    return now * std::exp((pressure - before) / p.bulk_modulus);
}

} // namespace lacuna
