// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/pores/flow/flow_ledger.hpp>

namespace lacuna {

/// Constants of the pass over the pores.
template <class Real>
struct pore_constants {
    Real bulk_modulus;     ///< K_f, Pa
    Real thickness;        ///< out of the plane, m; 1 in space
    Real minimum_pressure; ///< Pa; -infinity for a fluid that never tears
};

/// Contribution of one chunk of pores to the ledger and to the balance of the step.
template <class Real>
struct pore_sums {
    Real content = 0; ///< sum of (V dp / K_f + dV - dW), m^3
    Real changed = 0; ///< sum of |dV|, m^3
    Real pressure_work = 0, vapour_work = 0, prefactor_work = 0; ///< as in flow_ledger, J

    pore_sums& operator+=(pore_sums const& o) noexcept {
        content += o.content;
        changed += o.changed;
        pressure_work += o.pressure_work;
        vapour_work += o.vapour_work;
        prefactor_work += o.prefactor_work;
        return *this;
    }
};

/// Contribution of one chunk of throats to the ledger and to the balance of the step.
template <class Real>
struct throat_sums {
    Real dissipation = 0, reservoir_work = 0; ///< as in flow_ledger, J
    Real inflow = 0;                          ///< volume that entered from reservoirs and sources, m^3
    Real gross = 0;                           ///< sum of |q dt|, m^3

    throat_sums& operator+=(throat_sums const& o) noexcept {
        dissipation += o.dissipation;
        reservoir_work += o.reservoir_work;
        inflow += o.inflow;
        gross += o.gross;
        return *this;
    }
};

/// Books one step or substep. Mass residual and gross volume accumulate until open_step().
template <class Real>
void book(flow_ledger<Real>& ledger, pore_sums<Real> const& pores, throat_sums<Real> const& throats) noexcept {
    ledger.dissipation += throats.dissipation;
    ledger.reservoir_work += throats.reservoir_work;
    ledger.boundary_inflow += throats.inflow;
    ledger.pressure_work += pores.pressure_work;
    ledger.vapour_work += pores.vapour_work;
    ledger.prefactor_work += pores.prefactor_work;
    ledger.mass_residual += pores.content - throats.inflow;
    ledger.gross_volume += pores.changed + throats.gross;
}

/// Resets mass residual and gross volume for a new step.
template <class Real>
void open_step(flow_ledger<Real>& ledger) noexcept {
    ledger.mass_residual = ledger.gross_volume = Real(0);
}

} // namespace lacuna
