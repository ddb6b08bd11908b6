// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

#include <lacuna/core/error.hpp>
#include <lacuna/particles/packing.hpp>
#include <lacuna/particles/touching.hpp>

namespace lacuna {

namespace detail {
inline void require_count(std::string_view field, int value) {
    if (value < 1) refuse(field, double(value), "at least 1");
}

/// Bonds two particles of a packing if they touch.
template <class Real, int Dim>
void bond_touching(packing<Real, Dim>& p, std::int32_t i, std::int32_t j) {
    auto const a = std::size_t(i), b = std::size_t(j);
    if (touches(p.position[a], p.radius[a], p.position[b], p.radius[b])) p.bonds.push_back({i, j});
}
} // namespace detail

/// A row of `count` equal, touching particles along the first axis, the first centre at the origin.
/// \param radius m
/// \param bonded whether neighbours are bonded
/// \throws std::invalid_argument for a count below 1, or a radius that is not > 0
template <class Real, int Dim>
packing<Real, Dim> chain(int count, Real radius, bool bonded = true, int material = 0) {
    detail::require_count("count", count);
    require_positive("radius", double(radius));
    packing<Real, Dim> p;
    for (int i = 0; i < count; ++i) {
        vec<Real, Dim> x{};
        x[0] = Real(2) * radius * Real(i);
        p.add(x, radius, material);
        if (bonded && i > 0) p.bonds.push_back({i - 1, i});
    }
    return p;
}

/// `columns` x `rows` equal particles on a square lattice in the plane of the first two axes. The first centre is at
/// the origin; numbers go row by row from below.
/// \param radius m
/// \param bonded whether neighbours along the axes are bonded
/// \throws std::invalid_argument for columns or rows below 1, or a radius that is not > 0
template <class Real, int Dim>
packing<Real, Dim> square_lattice(int columns, int rows, Real radius, bool bonded = false, int material = 0) {
    detail::require_count("columns", columns);
    detail::require_count("rows", rows);
    require_positive("radius", double(radius));
    packing<Real, Dim> p;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            vec<Real, Dim> x{};
            x[0] = Real(2) * radius * Real(column);
            x[1] = Real(2) * radius * Real(row);
            auto const i = p.add(x, radius, material);
            if (bonded && column > 0) p.bonds.push_back({i - 1, i});
            if (bonded && row > 0) p.bonds.push_back({std::int32_t(i - columns), i});
        }
    return p;
}

/// Equal touching discs on a hexagonal lattice. Numbers go row by row from below.
///
/// The first centre is at the origin. Rows 1, 3, 5, ... (the odd rows) are shifted by one radius.
/// \param columns discs in an even row
/// \param radius m
/// \param bonded whether every touching pair is bonded
/// \param short_odd_rows whether odd rows have columns - 1 discs, so that left and right are symmetric
/// \throws std::invalid_argument for columns or rows below 1, one column with short odd rows, or a radius that is not >
/// 0
template <class Real, int Dim = 2>
packing<Real, Dim> hexagonal_rows(int columns, int rows, Real radius, bool bonded = false,
                                  bool short_odd_rows = false, int material = 0) {
    detail::require_count("columns", columns);
    detail::require_count("rows", rows);
    require_positive("radius", double(radius));
    if (short_odd_rows && columns < 2) refuse("columns", double(columns), "at least 2 with short odd rows");
    packing<Real, Dim> p;
    std::int32_t below = 0, begin = 0;
    for (int row = 0; row < rows; ++row) {
        int const here = columns - (short_odd_rows && row % 2 == 1 ? 1 : 0);
        std::int32_t const first = std::int32_t(p.size());
        for (int column = 0; column < here; ++column) {
            vec<Real, Dim> x{};
            x[0] = radius * Real(2 * column + row % 2);
            x[1] = radius * std::sqrt(Real(3)) * Real(row);
            auto const i = p.add(x, radius, material);
            if (!bonded) continue;
            if (column > 0) p.bonds.push_back({i - 1, i});
            for (std::int32_t j = begin; j < begin + below; ++j)
                if (j >= begin + column - 2 && j <= begin + column + 2) detail::bond_touching(p, j, i);
        }
        begin = first;
        below = here;
    }
    return p;
}

} // namespace lacuna
