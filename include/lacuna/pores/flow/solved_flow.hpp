// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/pores/flow/flow_sums.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// Result of a flow step that was solved together with the motion of the particles.
struct solved_flow {
    std::vector<double> before, pressure; ///< of the pores, at the start and the end of the step, Pa
    std::vector<double> vapour;           ///< volume that the liquid of each pore does not fill at the end, m^3
    std::vector<double> flow;             ///< of the open throats, as in pore_network, m^3/s
    std::vector<double> fed;              ///< volume that each of source_exchange::pores() gets from its source, m^3

    /// Mean pressure of a pore in the step, Pa: flows and volumes do their work against it.
    double middle_pressure(std::size_t pore) const noexcept { return 0.5 * (before[pore] + pressure[pore]); }
};

/// Writes the pores' new volumes, pressures and vapour into the network.
///
/// A liquid of constant bulk modulus stores V (exp(dp / K_f) - 1) in a step, where the ledger's balance of energy has
/// V dp / K_f. The work of the difference, of second order, goes to prefactor_work.
/// \param volume callable: pore -> its new volume, m^3
/// \return energies and fluid content
template <class Real, int Dim, class Volume>
pore_sums<Real> take_pores(pore_network<Real, Dim>& net, solved_flow const& next, double bulk_modulus,
                           Volume const& volume) {
    pore_sums<double> sums;
    for (std::size_t p = 0; p < net.pores(); ++p) {
        double const before = net.old_volume[p], now = volume(p), grown = now - before;
        double const old = net.pressure[p], pressure = next.pressure[p], middle = next.middle_pressure(p);
        double const torn = next.vapour[p] - double(net.vapour_of(p)), strain = (pressure - old) / bulk_modulus;
        double const stored = (now - next.vapour[p]) * std::expm1(strain);
        sums.content += stored + grown - torn;
        sums.changed += std::fabs(grown);
        sums.pressure_work += middle * grown;
        sums.vapour_work += middle * torn;
        sums.prefactor_work += old * old * grown / (2 * bulk_modulus) - middle * (stored - now * strain);
        net.pressure[p] = Real(pressure);
        if (!net.vapour.empty()) net.vapour[p] = Real(next.vapour[p]);
        net.volume[p] = net.old_volume[p] = Real(now);
    }
    return {Real(sums.content), Real(sums.changed), Real(sums.pressure_work), Real(sums.vapour_work),
            Real(sums.prefactor_work)};
}

} // namespace lacuna
