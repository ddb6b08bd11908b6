// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Energy balance of a way to equilibrium, J. An increment counts as the engine counts a step: work is the mean of the
/// forces before and after times the displacement. In a model of springs, contacts with friction and bonds the residual
/// is then rounding, but for turns of the pairs, which add errors of third order in the increment.
struct equilibrium_energy {
    double work = 0;     ///< of loads, weight, own forces, servo walls and what is displaced; loads rise in proportion
    double strain = 0;   ///< change of the elastic energy in bonds, contacts and walls
    double fluid = 0;    ///< work of the particles on the fluid in the pores
    double friction = 0; ///< dissipated by sliding, and by bonds that yield at their compressive limit
    double fracture = 0; ///< lost from springs when bonds fail
    /// Work of the forces that were not in balance: what would set particles in motion after a failure or a sudden
    /// load, and would be damped away.
    double released = 0;

    double residual() const noexcept { return work - strain - fluid - friction - fracture - released; }

    void operator+=(equilibrium_energy const& other) noexcept {
        work += other.work;
        strain += other.strain;
        fluid += other.fluid;
        friction += other.friction;
        fracture += other.fracture;
        released += other.released;
    }
};

} // namespace lacuna
