// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include <lacuna/core/vec.hpp>

namespace lacuna {

/// Whether a bond is intact, or how it failed.
enum class bond_state : std::int8_t { intact, broken_in_tension, broken_in_shear };

/// The failure of one bond.
template <int Dim>
struct break_event {
    long long step = 0;                      ///< number of the step in which it failed
    double time = 0;                         ///< time of the state whose forces exceeded the limit, s
    std::int32_t bond = 0;                   ///< number of the bond in the input
    std::array<std::int32_t, 2> particles{}; ///< stable ids, as given in the input
    bond_state mode = bond_state::intact;
    vec<double, Dim> position{};             ///< contact point, m
    double normal_force = 0;                 ///< just before the failure, positive in tension, N
    double shear_force = 0;                  ///< just before the failure, N; signed in 2D, magnitude in 3D
    double energy = 0;                       ///< elastic energy of the bond just before the failure, J
};

} // namespace lacuna
