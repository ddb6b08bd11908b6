// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/points.hpp>
#include <lacuna/core/vec.hpp>

namespace lacuna::detail {

/// Groups of particles that are close to each other. Two particles whose centres are at most `reach` apart are in the
/// same group; unite() merges groups. The search uses a grid whose cells are so small that each lies in one group.
template <class Real, int Dim>
class close_groups {
public:
    using point = std::array<double, std::size_t(Dim)>;

    /// \param reach m, > 0 and finite
    close_groups(points_view<Real, Dim> centres, double reach) : points_(centres), reach_(reach) {
        // No two centres in one cell are farther apart than the reach.
        side_ = reach / std::sqrt(double(Dim)) * (1 - 1e-9);
        std::vector<entry> all(centres.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i].particle = std::int32_t(i);
            for (int a = 0; a < Dim; ++a) all[i].cell[std::size_t(a)] = cell_of(double(centres(i, a)));
        }
        std::sort(all.begin(), all.end(), [](entry const& a, entry const& b) {
            return a.cell != b.cell ? a.cell < b.cell : a.particle < b.particle;
        });
        for (auto const& one : all) {
            if (cells_.empty() || cells_.back() != one.cell) {
                cells_.push_back(one.cell);
                first_.push_back(particle_.size());
            }
            particle_.push_back(one.particle);
        }
        first_.push_back(particle_.size());
        root_.resize(cells_.size());
        for (std::size_t c = 0; c < root_.size(); ++c) root_[c] = c;
        link();
        cell_of_particle_.resize(centres.size());
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for (std::size_t k = first_[c]; k < first_[c + 1]; ++k) cell_of_particle_[std::size_t(particle_[k])] = c;
    }

    /// Particles of each group, in ascending order; groups in the order of their first particles.
    std::vector<std::vector<std::int32_t>> list() const {
        std::vector<std::vector<std::int32_t>> groups;
        std::vector<std::size_t> number(cells_.size(), cells_.size());
        for (std::size_t i = 0; i < cell_of_particle_.size(); ++i) {
            auto& n = number[group(std::int32_t(i))];
            if (n == cells_.size()) {
                n = groups.size();
                groups.emplace_back();
            }
            groups[n].push_back(std::int32_t(i));
        }
        return groups;
    }
    std::size_t group(std::int32_t particle) const { return find(cell_of_particle_[std::size_t(particle)]); }
    void unite(std::int32_t one, std::int32_t other) { root_[group(other)] = group(one); }

    /// Calls visit(particle) for the particles in cells that meet a box, except those in the group of particle `own`.
    /// visit may unite groups.
    template <class Visit>
    void for_each_other(std::int32_t own, point const& low, point const& high, Visit const& visit) const {
        point from, to;
        double many = 1;
        for (std::size_t a = 0; a < from.size(); ++a) {
            from[a] = cell_of(low[a]);
            to[a] = cell_of(high[a]);
            many *= to[a] - from[a] + 1;
        }
        auto const look = [&](std::size_t c) {
            if (find(c) == group(own)) return;
            for (std::size_t k = first_[c]; k < first_[c + 1]; ++k) visit(particle_[k]);
        };
        if (!(many <= 64)) {
            for (std::size_t c = 0; c < cells_.size(); ++c) {
                bool meets = true;
                for (std::size_t a = 0; a < from.size(); ++a)
                    meets = meets && cells_[c][a] >= from[a] && cells_[c][a] <= to[a];
                if (meets) look(c);
            }
            return;
        }
        for_each_row(from, to, 0, from, look);
    }

private:
    struct entry {
        point cell;
        std::int32_t particle;
    };

    // A whole number as a double: an integer would overflow for positions far away.
    double cell_of(double x) const noexcept { return std::floor(x / side_); }

    template <class Look>
    void for_each_row(point const& from, point const& to, std::size_t axis, point cell, Look const& look) const {
        if (axis + 1 < cell.size()) {
            for (int k = 0; from[axis] + k <= to[axis] && k < 64; ++k) {
                cell[axis] = from[axis] + k;
                for_each_row(from, to, axis + 1, cell, look);
            }
            return;
        }
        auto c = std::size_t(std::lower_bound(cells_.begin(), cells_.end(), cell) - cells_.begin());
        auto last = cell;
        for (last[axis] = to[axis]; c < cells_.size() && cells_[c] <= last; ++c) look(c);
    }

    void link() {
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            auto from = cells_[c], to = cells_[c];
            for (std::size_t a = 0; a < from.size(); ++a) {
                from[a] -= 2;
                to[a] += 2;
            }
            for_each_row(from, to, 0, from, [&](std::size_t other) {
                if (other < c && find(c) != find(other) && meet(c, other)) root_[find(c)] = find(other);
            });
        }
    }
    bool meet(std::size_t a, std::size_t b) const noexcept {
        for (std::size_t k = first_[a]; k < first_[a + 1]; ++k)
            for (std::size_t l = first_[b]; l < first_[b + 1]; ++l) {
                double squared = 0;
                for (int axis = 0; axis < Dim; ++axis) {
                    double const apart = double(points_(std::size_t(particle_[k]), axis)) -
                                         double(points_(std::size_t(particle_[l]), axis));
                    squared += apart * apart;
                }
                if (squared <= reach_ * reach_) return true;
            }
        return false;
    }
    std::size_t find(std::size_t c) const {
        while (root_[c] != c) c = root_[c] = root_[root_[c]];
        return c;
    }

    points_view<Real, Dim> points_;
    double reach_, side_;
    std::vector<point> cells_;           // cells that contain particles, in ascending order
    std::vector<std::size_t> first_;     // for each cell: index in particle_ of its first particle
    std::vector<std::int32_t> particle_; // particle numbers, cell by cell
    std::vector<std::size_t> cell_of_particle_;
    mutable std::vector<std::size_t> root_; // for each cell: the next cell on the way to the root of its group
};

/// Box that holds the centres of all particles of radius <= largest_radius that may be inside the orthogonal sphere of
/// a simplex. Limits of +-1e300 if the simplex is so flat or small that rounding hides the sphere.
/// \return lower and upper corner, m
template <class Real, int Dim>
std::array<std::array<double, std::size_t(Dim)>, 2>
orthogonal_box(std::array<std::int32_t, std::size_t(Dim) + 1> const& s, points_view<Real, Dim> points,
               Real const* radii, double largest_radius) noexcept {
    using point = vec<double, Dim>;
    auto const at = [&](std::size_t c) {
        point x;
        for (int a = 0; a < Dim; ++a) x[a] = double(points(std::size_t(s[c]), a));
        return x;
    };
    auto const squared_radius = [&](std::size_t c) { return double(radii[s[c]]) * double(radii[s[c]]); };
    point u[std::size_t(Dim)];
    double half[std::size_t(Dim)], lengths = 1;
    for (std::size_t c = 0; c < std::size_t(Dim); ++c) {
        u[c] = at(c + 1) - at(0);
        half[c] = (squared_norm(u[c]) - squared_radius(c + 1) + squared_radius(0)) / 2;
        lengths *= norm(u[c]);
    }
    point centre;
    double size;
    if constexpr (Dim == 2) {
        size = cross(u[0], u[1]);
        centre = perpendicular(u[1] * half[0] - u[0] * half[1]) / -size;
    } else {
        auto const across = cross(u[1], u[2]);
        size = dot(u[0], across);
        centre = (across * half[0] + cross(u[2], u[0]) * half[1] + cross(u[0], u[1]) * half[2]) / size;
    }
    bool const sure = std::fabs(size) > 1e-6 * lengths && lengths > 1e-200; // products of lengths might underflow
    double const middle = norm(centre), power = squared_norm(centre) - squared_radius(0);
    double const reach = (std::sqrt(std::max(power, 0.0)) + largest_radius + middle) * (1 + 1e-6) - middle;
    std::array<std::array<double, std::size_t(Dim)>, 2> box;
    for (int a = 0; a < Dim; ++a) {
        box[0][std::size_t(a)] = sure ? at(0)[a] + centre[a] - reach : -1e300;
        box[1][std::size_t(a)] = sure ? at(0)[a] + centre[a] + reach : 1e300;
    }
    return box;
}

} // namespace lacuna::detail
