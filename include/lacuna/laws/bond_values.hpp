// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// Values of a single bond that replace those of its materials. A bond law that accepts such values has
/// `with_values<Dim>(parameters<double>, bond_values, radius_i, radius_j) -> parameters<double>`. It refuses values
/// that the law does not use.
struct bond_values {
    std::optional<double> normal_stiffness{};  ///< N/m, > 0
    std::optional<double> shear_stiffness{};   ///< N/m, >= 0
    std::optional<double> bending_stiffness{}; ///< N m/rad, >= 0; only for bonds with moments
    std::optional<double> tensile_force{};     ///< force that breaks the bond in pure tension, N, >= 0
    std::optional<double> shear_force{};       ///< force that breaks the bond in pure shear, N, >= 0
    std::optional<double> strength_factor{};   ///< multiplies the strengths of its materials, 1, >= 0

    bool empty() const noexcept {
        return !normal_stiffness && !shear_stiffness && !bending_stiffness && !tensile_force && !shear_force &&
               !strength_factor;
    }
    /// Replaces the strengths of the materials by those of the bond.
    /// \param area of the bond's cross-section, m^2
    /// \param tensile, shear strengths, Pa; capped at 1e30, which stands for "never breaks"
    void set_strengths(double area, double& tensile, double& shear) const noexcept {
        double const factor = strength_factor.value_or(1.0);
        tensile = std::min(tensile_force ? *tensile_force / area : tensile * factor, 1e30);
        shear = std::min(shear_force ? *shear_force / area : shear * factor, 1e30);
    }
    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name) const {
        if (normal_stiffness) require_positive(name + ".normal_stiffness", *normal_stiffness);
        if (shear_stiffness) require_not_negative(name + ".shear_stiffness", *shear_stiffness);
        if (bending_stiffness) require_not_negative(name + ".bending_stiffness", *bending_stiffness);
        if (tensile_force) require_limit(name + ".tensile_force", *tensile_force);
        if (shear_force) require_limit(name + ".shear_force", *shear_force);
        if (strength_factor) require_not_negative(name + ".strength_factor", *strength_factor);
    }
};

/// True if a bond law accepts values of single bonds.
template <class Law, int Dim>
inline constexpr bool takes_bond_values = requires(typename Law::template parameters<double> const& p,
                                                   bond_values const& v) {
    Law::template with_values<Dim>(p, v, 1.0, 1.0);
};

} // namespace lacuna
