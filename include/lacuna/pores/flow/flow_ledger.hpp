// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Running totals of a flow solver, and the balance of its last step. With E = storage_energy() of the solver, the
/// increments of a step satisfy
///
///   E_new - E_old = reservoir_work - dissipation - pressure_work + vapour_work + prefactor_work
///
/// and each new mesh adds its remesh_energy to E.
template <class Real>
struct flow_ledger {
    Real dissipation = 0;     ///< lost to friction in the throats, J
    Real reservoir_work = 0;  ///< work of reservoirs and sources on the fluid, J
    Real pressure_work = 0;   ///< sum of p dV: work of the fluid on the solid, J
    Real vapour_work = 0;     ///< sum of p dW, W the vapour volume, J
    Real prefactor_work = 0;  ///< sum of p^2 dV / 2 K_f: stored energy due to the change of volume, second order, J
    Real boundary_inflow = 0; ///< volume that has entered from reservoirs and sources, m^3
    Real gross_volume = 0;    ///< sum of |q dt| and |dV| in the last step, m^3: the scale of mass_residual
    /// Last step: sum of (V dp / K_f + dV - dW) over the pores, less the inflow, m^3; due to rounding only.
    Real mass_residual = 0;
    /// \name New meshes (transfer_fluid())
    /// \{
    long long remeshes = 0;   ///< number of new meshes
    Real remesh_energy = 0;   ///< stored energy that new meshes added, J
    Real remesh_volume = 0;   ///< pore volume that new meshes added at the boundary and at pores of least volume, m^3
    Real remesh_residual = 0; ///< last new mesh: fluid content added by rounding, m^3
    Real remesh_content = 0;  ///< last new mesh: sum of the magnitudes of contents, m^3: the scale of remesh_residual
    /// \}
};

} // namespace lacuna
