// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/core/records.hpp>

namespace lacuna {

/// The two kinds of pairs; a table holds pairs of one kind.
enum class pair_kind { bond, contact };

/// Forces of pairs on their first particles, N. In 2D one record per pair: F_x, F_y, torque per radius, normal force.
/// In 3D two records per pair: force and normal force; torque per radius and 0.
template <class Real, int Dim>
struct pair_forces {
    static constexpr std::size_t records_per_pair = Dim == 2 ? 1 : 2;
    record_column<Real> column;
    Real* of(std::size_t slot) noexcept { return column.data() + 4 * records_per_pair * slot; }
    Real const* of(std::size_t slot) const noexcept { return column.data() + 4 * records_per_pair * slot; }
};

} // namespace lacuna
