// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

/// \file
/// Effective medium of a bonded triangular lattice of discs with fluid in its pores. README.md derives it.

namespace poroelasticity {

/// Equal touching discs on a triangular lattice, all neighbours bonded. The thickness is 1 m, so stresses of the plane
/// in N/m and pressures in Pa have the same values.
struct lattice_medium {
    double radius = 0.5;            ///< of a disc, m
    double normal_stiffness = 1e6;  ///< k_n, N/m
    double shear_stiffness = 5e5;   ///< k_s, N/m
    double bulk_modulus = 1e6;      ///< K_f of the fluid, Pa
    double conductance = 1e-6;      ///< C of a throat, m^3/(s Pa)
    double disc_mass = 1;           ///< kg

    double layer() const { return std::sqrt(3.0) * radius; } ///< distance between two rows, m
    /// Drained bulk modulus of the plane, K = sqrt(3)/2 k_n, N/m.
    double bulk() const { return std::sqrt(3.0) / 2 * normal_stiffness; }
    /// Shear modulus G = sqrt(3)/4 (k_n + k_s), N/m.
    double shear() const { return std::sqrt(3.0) / 4 * (normal_stiffness + shear_stiffness); }
    /// Modulus of confined compression M = K + G, N/m.
    double oedometric() const { return bulk() + shear(); }
    /// Plane-strain Poisson's ratio (K - G) / 2K.
    double poisson() const { return (bulk() - shear()) / (2 * bulk()); }
    /// Share of the area between the discs, 1 - pi / (2 sqrt 3).
    static double porosity() { return 1 - std::numbers::pi / (2 * std::sqrt(3.0)); }
    /// Volume of fluid stored per pressure and volume at constant pore volume, phi / K_f, 1/Pa.
    double storage() const { return porosity() / bulk_modulus; }
    /// Darcy's permeability divided by viscosity, C / sqrt 3, m^2/(s Pa).
    double permeability() const { return conductance / std::sqrt(3.0); }
    /// Coefficient of consolidation, m^2/s.
    double diffusivity() const { return permeability() / (storage() + 1 / oedometric()); }
    /// Pressure divided by load after undrained confined compression, 1 / (1 + phi M / K_f).
    double confined_share() const { return 1 / (1 + storage() * oedometric()); }
    /// Skempton's B in the plane, 1 / (1 + phi K / K_f).
    double skempton() const { return 1 / (1 + storage() * bulk()); }
    /// Coupling h of the local to the mean pressure in Mandel's and Cryer's problems: see consolidation.
    double mean_coupling() const { return confined_share() * shear() / bulk(); }
    /// Speed of a wave of confined compression in the drained lattice, m/s.
    double wave_speed() const {
        return std::sqrt(oedometric() / (disc_mass / (2 * std::sqrt(3.0) * radius * radius)));
    }
    /// Sets the conductance so that length^2 / c_v is the given time, s. \param length m
    void set_consolidation_time(double time, double length) {
        conductance = 1;
        conductance = length * length / time / diffusivity();
    }
};

} // namespace poroelasticity
