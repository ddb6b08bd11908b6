// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>

#include <lacuna/neighbors/cell_level.hpp>
#include <lacuna/neighbors/search.hpp>

namespace lacuna {

/// Search by cells, the default: cost and memory are proportional to the number of particles, whatever their extent.
///
/// A counting sort puts particles into cells as wide as the reach of two of them. So the partners of a particle are in
/// its own cell and the adjacent ones. There is a grid for each factor of two of the reach that occurs. It covers the
/// particles of that size alone, so that a huge particle makes neither the cells nor the grids of others larger. If a
/// grid would have far more cells than particles (one has flown away), rows of cells share a table by their hash.
/// Buffers are reused: a call of the same size allocates nothing.
template <class Real, int Dim>
class cell_grid {
    static_assert(Dim == 2 || Dim == 3);

public:
    using real_type = Real;
    static constexpr int dim = Dim;

    /// See neighbor_search.
    void build(points_view<Real, Dim> const& points, Real cutoff) {
        detail::require_finite_points(points);
        detail::require_length("cutoff", cutoff);
        sort_into_cells(points, {}, Real(0), cutoff);
    }
    void pairs(std::vector<neighbor_pair>& out) const {
        out.resize(out.capacity());
        out.resize(pairs_of(0, slot_of_.size(), out));
    }
    void touching_pairs(points_view<Real, Dim> const& points, std::span<Real const> radii, Real margin,
                        std::vector<neighbor_pair>& out) {
        detail::require_finite_points(points);
        sort_into_cells(points, radii, detail::require_radii(radii, points.size(), margin), margin);
        if (threads_ == 1 || points.size() < 10000) return pairs(out);
        detail::join_pairs(points.size(), threads_, parts_, out, [&](std::size_t first, std::size_t last, auto& part) {
            return pairs_of(first, last, part);
        });
    }
    /// touching_pairs() uses this many threads; the pairs are the same for any number.
    void set_threads(int threads) noexcept { threads_ = threads; }

private:
    using cell_index = typename detail::cell_level<Real, Dim>::cell_index;

    using level = detail::cell_level<Real, Dim>;
    static constexpr int max_levels = 32;
    static constexpr Real far_cell = Real(1 << 30);

    void sort_into_cells(points_view<Real, Dim> const& points, std::span<Real const> radii, Real largest, Real margin) {
        std::size_t const n = points.size();
        margin_ = margin;
        levels_.clear();
        slot_of_.resize(n);
        index_.resize(n);
        radius_.resize(n);
        for (auto& column : position_) column.resize(n);
        if (n == 0) return;

        lay_grids(points, radii, largest);
        bool any_hashed = false;
        for (level const& grid : levels_) any_hashed = any_hashed || grid.hashed;
        row_.resize(any_hashed ? n : 0);
        row_of_.resize(any_hashed ? n : 0);

        // Counts are stored one index ahead: while a cell fills, its start moves to its end, the start of the next.
        starts_.assign(levels_.back().base + levels_.back().cells + 2, 0);
        for (std::size_t i = 0; i < n; ++i) {
            level const& grid = levels_[levels_.size() == 1 ? 0 : level_number_[level_of(radii[i])]];
            cell_index c;
            for (int axis = 0; axis < Dim; ++axis) c[std::size_t(axis)] = grid.cell(points(i, axis), axis);
            std::uint64_t const row = grid.row(c);
            std::size_t cell = grid.row_start(row) + std::size_t(c[0]);
            if (grid.hashed) cell &= grid.cells - 1;
            if (any_hashed) row_of_[i] = row;
            slot_of_[i] = std::uint32_t(grid.base + cell);
            ++starts_[grid.base + cell + 2];
        }
        for (std::size_t c = 2; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
        for (std::size_t i = 0; i < n; ++i) {
            std::size_t const slot = starts_[slot_of_[i] + 1]++;
            slot_of_[i] = std::uint32_t(slot);
            index_[slot] = std::int32_t(i);
            radius_[slot] = radii.empty() ? Real(0) : radii[i];
            for (int axis = 0; axis < Dim; ++axis) position_[std::size_t(axis)][slot] = points(i, axis);
            if (any_hashed) row_[slot] = row_of_[i];
        }
    }

    /// Factors of two between the largest reach and a particle's. The last level also has all smaller reaches.
    std::size_t level_of(Real radius) const noexcept {
        Real const reach = radius + margin_ / 2;
        if (reach > largest_reach_ / 2 || !(reach > 0)) return reach > 0 || !(largest_reach_ > 0) ? 0 : max_levels - 1;
        int const octave = std::ilogb(largest_reach_ / reach);
        return octave >= 0 && octave < max_levels ? std::size_t(octave) : max_levels - 1;
    }

    void lay_grids(points_view<Real, Dim> const& points, std::span<Real const> radii, Real largest) {
        largest_reach_ = largest + margin_ / 2;
        std::array<level, max_levels> grids;
        for (std::size_t i = 0; i < points.size(); ++i) {
            Real const radius = radii.empty() ? Real(0) : radii[i];
            grids[level_of(radius)].add(points[i], radius + margin_ / 2);
        }
        std::size_t base = 0;
        for (std::size_t l = 0; l < max_levels; ++l) {
            level& grid = grids[l];
            if (grid.count == 0) continue;
            grid.base = base;
            Real width = 2 * grid.reach;
            if (!(width > std::numeric_limits<Real>::min() * 4))
                width = width_of_points(grid.low, grid.high, grid.count);
            grid.cells_per_length = 1 / width;
            fit(grid, points);
            base += grid.cells;
            level_number_[l] = levels_.size();
            levels_.push_back(grid);
        }
    }

    /// Width of cells for points without extent, which touch only if they coincide: about one point per cell.
    static Real width_of_points(vec<Real, Dim> const& low, vec<Real, Dim> const& high, std::size_t count) {
        Real extent = 0;
        for (int axis = 0; axis < Dim; ++axis) extent = std::max(extent, high[axis] - low[axis]);
        Real const width = extent / std::pow(Real(count), Real(1) / Real(Dim));
        return width > std::numeric_limits<Real>::min() * 4 && std::isfinite(width) ? width : Real(1);
    }

    void fit(level& grid, points_view<Real, Dim> const& points) {
        double const most = 4.0 * double(grid.count) + 64;
        double cells = 1;
        for (int axis = 0; axis < Dim; ++axis) {
            double const last = std::floor((grid.high[axis] - grid.low[axis]) * grid.cells_per_length);
            cells *= last + 1;
            // Beyond 2^23 a float cannot distinguish adjacent cells.
            if (!(cells <= most) || last > 8e6) {
                hash(grid, points);
                return;
            }
            grid.origin[axis] = grid.low[axis];
            grid.first[axis] = 0;
            grid.last[axis] = Real(last);
            if (axis < 2) (axis == 0 ? grid.columns : grid.rows) = std::uint64_t(last) + 1;
        }
        grid.cells = std::size_t(cells);
    }

    void hash(level& grid, points_view<Real, Dim> const& points) {
        grid.hashed = true;
        grid.cells = std::bit_ceil(2 * grid.count);
        for (int axis = 0; axis < Dim; ++axis) {
            // The origin is a sample's median: a float has too few digits to count cells from one that has flown away.
            std::array<Real, 63> sample;
            std::size_t const taken = std::min(sample.size(), points.size());
            for (std::size_t k = 0; k < taken; ++k) sample[k] = points(k * points.size() / taken, axis);
            auto const middle = sample.begin() + std::ptrdiff_t(taken / 2);
            std::nth_element(sample.begin(), middle, sample.begin() + std::ptrdiff_t(taken));
            grid.origin[axis] = *middle;
            grid.first[axis] = -far_cell;
            grid.last[axis] = far_cell;
        }
    }

    /// Writes the pairs whose first particle is in [first, last) to `out`, which may grow. Returns their number.
    std::size_t pairs_of(std::size_t first, std::size_t last, std::vector<neighbor_pair>& out) const {
        std::size_t found = 0;
        for (std::size_t i = first; i < last; ++i) {
            std::size_t const row = found;
            for (level const& grid : levels_)
                found = grid.hashed ? collect<true>(grid, i, found, out) : collect<false>(grid, i, found, out);
            detail::sort_row(out.data() + row, out.data() + found);
        }
        return found;
    }

    /// Appends the partners of particle i in one grid to out[found...]; returns the new number of pairs.
    template <bool Hashed>
    std::size_t collect(level const& grid, std::size_t i, std::size_t found, std::vector<neighbor_pair>& out) const {
        std::size_t const own = slot_of_[i];
        Real const reach = ((radius_[own] + margin_ / 2) + grid.reach) * (1 + detail::rounding_slack<Real>);
        cell_index low;
        cell_index high;
        vec<Real, Dim> x;
        for (int axis = 0; axis < Dim; ++axis) {
            x[axis] = position_[std::size_t(axis)][own];
            low[std::size_t(axis)] = grid.cell(x[axis] - reach, axis);
            high[std::size_t(axis)] = grid.cell(x[axis] + reach, axis);
        }
        if (levels_.size() > 1 && grid.away(x, reach)) return found;
        auto const width = std::size_t(high[0] - low[0]) + 1;
        if constexpr (Hashed) {
            // A huge particle among small ones reaches more cells than the table has.
            double rows = double(high[1] - low[1]) + 1;
            if constexpr (Dim == 3) rows *= double(high[2] - low[2]) + 1;
            if (rows * double(width) > double(grid.cells))
                return scan<false>(grid.base, grid.cells, i, own, x, 0, found, out);
        }
        cell_index c = low;
        for (;;) {
            std::uint64_t const row = grid.row(c);
            std::size_t first = grid.row_start(row) + std::size_t(low[0]);
            if constexpr (Hashed) {
                first &= grid.cells - 1;
                std::size_t const taken = std::min(width, grid.cells);
                std::size_t const ahead = std::min(taken, grid.cells - first);
                found = scan<Hashed>(grid.base + first, ahead, i, own, x, row, found, out);
                found = scan<Hashed>(grid.base, taken - ahead, i, own, x, row, found, out);
            } else {
                found = scan<Hashed>(grid.base + first, width, i, own, x, row, found, out);
            }
            if (++c[1] <= high[1]) continue;
            if constexpr (Dim == 3) {
                c[1] = low[1];
                if (++c[2] <= high[2]) continue;
            }
            return found;
        }
    }

    template <bool Hashed>
    std::size_t scan(std::size_t first_cell, std::size_t cells, std::size_t i, std::size_t own, vec<Real, Dim> const& x,
                     std::uint64_t row, std::size_t found, std::vector<neighbor_pair>& out) const {
        std::size_t const first = starts_[first_cell];
        std::size_t const last = starts_[first_cell + cells];
        if (found + (last - first) > out.size()) out.resize(found + found / 4 + (last - first) + 64);
        neighbor_pair* const to = out.data();
        auto const self = std::int32_t(i);
        Real const radius = radius_[own];
        for (std::size_t s = first; s < last; ++s) {
            Real d2 = 0;
            for (int axis = 0; axis < Dim; ++axis)
                d2 = detail::add_square(d2, x[axis] - position_[std::size_t(axis)][s]);
            // Always written, but counted only if it is a pair: a branch here would be mispredicted.
            to[found] = {self, index_[s]};
            unsigned hit = unsigned(index_[s] > self) & unsigned(detail::in_reach(d2, radius, radius_[s], margin_));
            // Rows that share cells of the table would otherwise give their pairs twice.
            if constexpr (Hashed) hit &= unsigned(row_[s] == row);
            found += hit;
        }
        return found;
    }

    std::vector<level> levels_;
    std::array<std::size_t, max_levels> level_number_{};
    Real margin_ = 0;
    Real largest_reach_ = 0;
    int threads_ = 1;
    std::vector<std::vector<neighbor_pair>> parts_;
    // By slot: particles in the order of their cells, and within a cell by their index.
    std::array<std::vector<Real>, std::size_t(Dim)> position_;
    std::vector<Real> radius_;
    std::vector<std::int32_t> index_;
    std::vector<std::uint64_t> row_;
    std::vector<std::uint32_t> starts_; // first slot of each cell
    // By particle.
    std::vector<std::uint32_t> slot_of_; // its cell, until it has a slot
    std::vector<std::uint64_t> row_of_;
};

} // namespace lacuna
