// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <lacuna/core/vec.hpp>

namespace lacuna::detail {

/// A grid for the particles whose reach (radius + half the margin) is within one factor of two.
template <class Real, int Dim>
struct cell_level {
    /// Coordinates of a cell.
    using cell_index = std::array<std::int64_t, std::size_t(Dim)>;

    Real reach = 0;
    Real cells_per_length = 0;
    vec<Real, Dim> origin{};
    vec<Real, Dim> low{}; // bounding box of its particles
    vec<Real, Dim> high{};
    vec<Real, Dim> first{}; // limits of the cell coordinates; points outside go to the outermost cell
    vec<Real, Dim> last{};
    std::uint64_t columns = 1; // cells along the first and second axis of a grid that is not hashed
    std::uint64_t rows = 1;
    std::size_t base = 0; // index of its first cell in starts_
    std::size_t cells = 0;
    std::size_t count = 0;
    bool hashed = false;

    /// Adds a particle.
    void add(vec<Real, Dim> const& x, Real its_reach) noexcept {
        for (int axis = 0; axis < Dim; ++axis) {
            low[axis] = count > 0 ? std::min(low[axis], x[axis]) : x[axis];
            high[axis] = count > 0 ? std::max(high[axis], x[axis]) : x[axis];
        }
        reach = std::max(reach, its_reach);
        ++count;
    }
    /// True if the bounding box excludes particles within `distance` of a point.
    bool away(vec<Real, Dim> const& x, Real distance) const noexcept {
        bool any = false;
        for (int axis = 0; axis < Dim; ++axis)
            any = any || x[axis] + distance < low[axis] || x[axis] - distance > high[axis];
        return any;
    }
    // Monotonic in x in spite of rounding: the cells of an interval's ends enclose the cells of its points.
    std::int64_t cell(Real x, int axis) const noexcept {
        Real const t = (x - origin[axis]) * cells_per_length;
        return std::int64_t(t > first[axis] ? (t < last[axis] ? t : last[axis]) : first[axis]);
    }
    /// Key of the row of cells along the first axis; in a grid that is not hashed, the number of the row.
    std::uint64_t row(cell_index const& c) const noexcept {
        auto r = hashed ? std::uint64_t(c[1]) & 0xffffffffu : std::uint64_t(c[1]);
        if constexpr (Dim == 3) r += std::uint64_t(c[2]) * (hashed ? std::uint64_t(1) << 32 : rows);
        return r;
    }
    /// Index in the table of a row's cell 0, before it is wrapped to the table's size.
    std::size_t row_start(std::uint64_t row) const noexcept {
        if (!hashed) return std::size_t(row * columns);
        row = (row ^ (row >> 30)) * 0xbf58476d1ce4e5b9u; // mixing function of splitmix64
        row = (row ^ (row >> 27)) * 0x94d049bb133111ebu;
        return std::size_t(row ^ (row >> 31));
    }
};

} // namespace lacuna::detail
