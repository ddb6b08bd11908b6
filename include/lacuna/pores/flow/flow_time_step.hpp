// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// Largest safe step of the explicit flow, s: min over the pores of V_i / (K_f sum_j C_ij). The sum includes drained
/// throats, but not skipped ones. Infinity if nothing flows.
///
/// For dt up to this limit every new pressure is a mean, with weights >= 0, of old pressures and those of reservoirs.
/// So no pressure leaves their range. Stability alone requires less: Gershgorin's circles of the matrix K_f/V_i C_ij
/// give lambda <= max K_f/V_i (2 sum C_interior + sum C_drained) and dt <= 2 / lambda. That is the same limit without
/// reservoirs, and up to twice as long for a pore with drained throats only.
/// \param bulk_modulus K_f, Pa
template <class Real, int Dim>
Real flow_critical_time_step(pore_network<Real, Dim> const& net, double bulk_modulus) noexcept {
    double limit = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < net.pores(); ++i) {
        double conductance = 0;
        net.throats_of.for_each(i, [&](std::size_t t, int) {
            if (!net.inactive[t]) conductance += double(net.conductance[t]);
        });
        if (conductance > 0) limit = std::min(limit, double(net.volume[i]) / (bulk_modulus * conductance));
    }
    return Real(limit);
}

/// Largest stable step of a single throat, s: 2 / (K_f C (1/V_1 + 1/V_2)), without the second volume for a drained one;
/// infinity for C = 0.
/// \param bulk_modulus K_f, Pa
template <class Real, int Dim>
double throat_time_step(pore_network<Real, Dim> const& net, std::size_t throat, double bulk_modulus) noexcept {
    auto const other = net.throat_pore[1][throat];
    Real rate = Real(1) / net.volume[std::size_t(net.throat_pore[0][throat])];
    if (other >= 0) rate += Real(1) / net.volume[std::size_t(other)];
    return 2 / (bulk_modulus * double(net.conductance[throat]) * double(rate));
}

/// The paper's eq. 19 as printed, s: the least over the pores of dt = 2 R V_p / (N K_f k a^3). R is the mean radius of
/// the particles around the pore, N the number of its interior and drained throats (skipped ones included), a their
/// mean aperture. Where apertures differ, it is up to nearly twice too long; flow_critical_time_step() is safe.
/// \param bulk_modulus K_f, Pa; \param conductivity k, m/(s Pa)
template <class Real, int Dim>
Real mean_throat_limit(pore_network<Real, Dim> const& net, double bulk_modulus, double conductivity) noexcept {
    double limit = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < net.pores(); ++i) {
        double aperture = 0, diameter = 0;
        int passable = 0, all = 0;
        net.throats_of.for_each(i, [&](std::size_t t, int) {
            ++all;
            diameter += double(net.length[t]);
            if (t >= net.open_throats()) return;
            ++passable;
            aperture += double(net.aperture[t]);
        });
        if (!(passable > 0) || !(conductivity > 0)) continue;
        // The length of a throat is the sum of two radii: the mean length is 2 R.
        diameter /= all;
        aperture /= passable;
        limit = std::min(limit, diameter * double(net.volume[i]) /
                                    (passable * bulk_modulus * conductivity * aperture * aperture * aperture));
    }
    return Real(limit);
}

} // namespace lacuna
