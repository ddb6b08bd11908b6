// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Running totals of a flow solver, and the balance of its last step. With E = flow.storage_energy() every step keeps
///
///   E_new - E_old = reservoir_work - dissipation - pressure_work + vapour_work + prefactor_work   (their increments)
///
/// and each new mesh adds remesh_energy to E.
template <class Real>
struct flow_ledger {
    Real dissipation = 0;     ///< lost to friction in the throats, J
    Real reservoir_work = 0;  ///< done by reservoirs on the fluid, J
    Real pressure_work = 0;   ///< sum of p dV: done by the fluid on the solid, J
    Real vapour_work = 0;     ///< sum of p dW, W the vapour volume, J
    Real prefactor_work = 0;  ///< sum of p^2 dV / 2 K_f: the stored energy's volume changes, second order, J
    Real boundary_inflow = 0; ///< volume that has come in from reservoirs, m^3
    Real gross_volume = 0;    ///< sum of |q dt| and |dV| in the last step, m^3: the scale of mass_residual
    /// Last step: sum of (V dp / K_f + dV - dW) over the pores, less the inflow from reservoirs, m^3; rounding only.
    Real mass_residual = 0;
    /// \name New meshes (transfer_fluid())
    /// \{
    long long remeshes = 0;    ///< how many
    Real remesh_energy = 0;    ///< stored energy that they added, J
    Real remesh_volume = 0;    ///< pore volume that they added, m^3: at the boundary, and at pores of least volume
    Real remesh_residual = 0;  ///< the last one: fluid content that rounding made, m^3
    Real remesh_content = 0;   ///< the last one: sum of the contents' magnitudes, m^3: the scale of remesh_residual
    /// \}
};

} // namespace lacuna
