// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/vec.hpp>

namespace lacuna::detail {

/// A grid of square cells over points in the plane, for neighbour searches within generators of packings.
class disc_grid {
public:
    disc_grid() = default;
    /// \param points the points, in the unit of `cell`
    /// \param cell edge of a cell, > 0
    disc_grid(std::vector<vec<double, 2>> const& points, double cell) { build(points, cell); }

    void build(std::vector<vec<double, 2>> const& points, double cell) {
        count_[0] = count_[1] = 0;
        if (points.empty()) return;
        low_ = points[0];
        vec<double, 2> high = points[0];
        for (auto const& p : points)
            for (int a = 0; a < 2; ++a) {
                low_[a] = std::min(low_[a], p[a]);
                high[a] = std::max(high[a], p[a]);
            }
        // Outliers must not make the table of cells larger than the list of points.
        double const span = std::max(high[0] - low_[0], high[1] - low_[1]);
        cell_ = std::max(cell, span / (4 * std::sqrt(double(points.size())) + 64));
        for (int a = 0; a < 2; ++a) count_[a] = std::int64_t((high[a] - low_[a]) / cell_) + 1;
        start_.assign(std::size_t(count_[0] * count_[1]) + 1, 0);
        for (auto const& p : points) ++start_[cell_of(p) + 1];
        for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
        index_.resize(points.size());
        std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
        for (std::size_t i = 0; i < points.size(); ++i) index_[next[cell_of(points[i])]++] = std::uint32_t(i);
    }

    /// Calls visit(i) for every point within `reach` of x, and for some points beyond; always in the same order.
    template <class Visit>
    void for_each_near(vec<double, 2> const& x, double reach, Visit&& visit) const {
        if (count_[0] == 0) return;
        std::int64_t from[2], to[2];
        for (int a = 0; a < 2; ++a) {
            from[a] = std::max<std::int64_t>(0, std::int64_t(std::floor((x[a] - reach - low_[a]) / cell_)));
            to[a] = std::min<std::int64_t>(count_[a] - 1, std::int64_t(std::floor((x[a] + reach - low_[a]) / cell_)));
        }
        if (to[0] < from[0]) return;
        for (std::int64_t row = from[1]; row <= to[1]; ++row) {
            std::size_t const first = std::size_t(row * count_[0] + from[0]);
            std::size_t const last = std::size_t(row * count_[0] + to[0]);
            for (std::uint32_t k = start_[first]; k < start_[last + 1]; ++k) visit(std::size_t(index_[k]));
        }
    }

private:
    std::size_t cell_of(vec<double, 2> const& p) const {
        std::int64_t c[2];
        for (int a = 0; a < 2; ++a)
            c[a] = std::clamp<std::int64_t>(std::int64_t((p[a] - low_[a]) / cell_), 0, count_[a] - 1);
        return std::size_t(c[1] * count_[0] + c[0]);
    }

    vec<double, 2> low_{};
    double cell_ = 1;
    std::int64_t count_[2] = {0, 0};
    std::vector<std::uint32_t> start_;
    std::vector<std::uint32_t> index_;
};

} // namespace lacuna::detail
