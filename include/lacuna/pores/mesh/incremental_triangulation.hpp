// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <lacuna/pores/mesh/exact_signs.hpp>
#include <lacuna/pores/mesh/mesh.hpp>

namespace lacuna::detail {

/// Regular triangulation by inserting one site after another (A. Bowyer, D. F. Watson, Comput. J. 24 (1981) 162, 167).
/// A new site removes the simplices whose orthogonal sphere it is inside, and is joined to the sides of the cavity.
/// Signs are exact, so the result is right for any sites. It takes several times as long as Qhull.
///
/// Each side of the hull has an outer cell with a corner `far` that stands for a point at infinity. An outer cell is
/// oriented as if `far` were a site beyond that side.
template <int Dim>
class incremental_triangulation {
public:
    using simplex = typename exact_signs<Dim>::simplex;

    explicit incremental_triangulation(weighted_sites<Dim> const& sites) : sign_(sites) {
        auto const order = shuffled(sites.size());
        simplex first;
        if (!choose_first(order, first)) return;
        begin(first);
        for (auto const p : order)
            if (std::find(first.begin(), first.end(), p) == first.end()) insert(p);
    }

    /// Simplices of positive orientation, in unspecified order; none if all sites lie on a line (in space: in a plane).
    std::vector<simplex> simplices() const {
        std::vector<simplex> all;
        for (auto const& c : cell_)
            if (c.alive && far_corner(c.corner) < 0) all.push_back(c.corner);
        return all;
    }

private:
    static constexpr auto corners = std::size_t(Dim) + 1;
    static constexpr std::int32_t far = -1;
    struct cell {
        simplex corner, neighbour;
        bool alive;
        std::int32_t tested; // last site tested against this cell
        bool conflict;       // result of that test
    };
    /// A side of a cell whose neighbour is not known yet.
    struct unmatched_side {
        std::array<std::int32_t, std::size_t(Dim)> sites;
        std::int32_t cell, corner;
        bool operator<(unmatched_side const& o) const noexcept { return sites < o.sites; }
    };

    /// Pseudorandom order of insertion. Sites come sorted by position, so it depends on the positions alone.
    static std::vector<std::int32_t> shuffled(std::size_t count) {
        std::vector<std::int32_t> order(count);
        for (std::size_t k = 0; k < count; ++k) order[k] = std::int32_t(k);
        std::uint64_t state = 0x9e3779b97f4a7c15;
        for (std::size_t k = count; k > 1; --k) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            std::swap(order[k - 1], order[std::size_t((state >> 33) % k)]);
        }
        // Rounds of doubling length, each sorted by position: successive sites are near each other, and found quickly.
        for (std::size_t from = 0, to = 64; from < count; from = to, to *= 2)
            std::sort(order.begin() + std::ptrdiff_t(from), order.begin() + std::ptrdiff_t(std::min(to, count)));
        return order;
    }

    /// Chooses the first sites in `order` that are not on one line (in space: in one plane), in positive orientation.
    bool choose_first(std::vector<std::int32_t> const& order, simplex& first) const {
        std::size_t have = 0;
        for (auto const p : order) {
            first[have] = p;
            if (have > 0 && have + 1 < corners && !sign_.independent(first, have)) continue;
            if (have + 1 == corners) {
                double const size = sign_.orientation(first);
                if (size == 0) continue;
                if (size < 0) std::swap(first[0], first[1]);
                return true;
            }
            ++have;
        }
        return false;
    }
    void begin(simplex const& first) {
        cell_.push_back({first, {}, true, far, false});
        std::vector<unmatched_side> sides;
        for (std::size_t c = 0; c < corners; ++c) {
            auto outside = first;
            outside[c] = far;
            // With a site beyond this side in corner c the simplex is inverted: swap two other corners.
            std::swap(outside[c == 0 ? 1 : 0], outside[c == corners - 1 ? corners - 2 : corners - 1]);
            cell_.push_back({outside, {}, true, far, false});
        }
        for (std::int32_t t = 0; t < std::int32_t(cell_.size()); ++t)
            for (std::size_t c = 0; c < corners; ++c) sides.push_back(side(t, c));
        join(sides);
    }

    static std::int32_t far_corner(simplex const& s) noexcept {
        for (std::size_t c = 0; c < corners; ++c)
            if (s[c] == far) return std::int32_t(c);
        return -1;
    }
    unmatched_side side(std::int32_t t, std::size_t corner) const noexcept {
        unmatched_side one{{}, t, std::int32_t(corner)};
        auto const& s = cell_[std::size_t(t)].corner;
        for (std::size_t c = 0; c + 1 < corners; ++c) one.sites[c] = s[c < corner ? c : c + 1];
        sort_corners(one.sites);
        return one;
    }
    /// Makes neighbours of the cells whose sides have the same sites.
    void join(std::vector<unmatched_side>& sides) {
        std::sort(sides.begin(), sides.end());
        for (std::size_t k = 0; k + 1 < sides.size(); k += 2) {
            cell_[std::size_t(sides[k].cell)].neighbour[std::size_t(sides[k].corner)] = sides[k + 1].cell;
            cell_[std::size_t(sides[k + 1].cell)].neighbour[std::size_t(sides[k + 1].corner)] = sides[k].cell;
        }
    }

    bool find_conflict(std::int32_t t, std::int32_t p) const {
        auto const& c = cell_[std::size_t(t)];
        auto const outer = far_corner(c.corner);
        if (outer < 0) return sign_.inside(c.corner, p) > 0;
        auto replaced = c.corner;
        replaced[std::size_t(outer)] = p;
        double const beyond = sign_.orientation(replaced);
        if (beyond != 0) return beyond > 0;
        // p lies in line with the side: the simplex on its inner side decides.
        return sign_.inside(cell_[std::size_t(c.neighbour[std::size_t(outer)])].corner, p) > 0;
    }
    bool in_conflict(std::int32_t t, std::int32_t p) {
        auto& c = cell_[std::size_t(t)];
        if (c.tested != p) {
            c.conflict = find_conflict(t, p);
            c.tested = p;
        }
        return c.conflict;
    }

    /// The simplex that contains p, or an outer cell whose side p lies beyond.
    std::int32_t locate(std::int32_t p) const {
        std::int32_t t = start_;
        for (;;) {
            auto const& c = cell_[std::size_t(t)];
            if (far_corner(c.corner) >= 0) return t;
            std::int32_t next = -1;
            for (std::size_t k = 0; k < corners && next < 0; ++k) {
                auto replaced = c.corner;
                replaced[k] = p;
                if (sign_.orientation(replaced) < 0) next = c.neighbour[k];
            }
            if (next < 0) return t;
            t = next;
        }
    }

    void insert(std::int32_t p) {
        auto const at = locate(p);
        if (!in_conflict(at, p)) return; // hidden: its power cell is empty
        std::vector<std::int32_t> cavity{at};
        cell_[std::size_t(at)].alive = false;
        std::vector<unmatched_side> sides;
        for (std::size_t k = 0; k < cavity.size(); ++k)
            for (std::size_t c = 0; c < corners; ++c) {
                auto const t = cavity[k], other = cell_[std::size_t(t)].neighbour[c];
                if (!cell_[std::size_t(other)].alive) continue;
                if (in_conflict(other, p)) {
                    cell_[std::size_t(other)].alive = false;
                    cavity.push_back(other);
                } else {
                    fill(t, c, other, p, sides);
                }
            }
        join(sides);
        free_.insert(free_.end(), cavity.begin(), cavity.end());
    }

    /// Creates the cell between p and the side of cell t opposite corner c. The cell `other` lies beyond that side, and
    /// stays.
    void fill(std::int32_t t, std::size_t c, std::int32_t other, std::int32_t p, std::vector<unmatched_side>& sides) {
        auto created = cell_[std::size_t(t)];
        created.corner[c] = p;
        created.neighbour[c] = other;
        created.alive = true;
        created.tested = far;
        std::int32_t index = std::int32_t(cell_.size());
        if (free_.empty()) {
            cell_.push_back(created);
        } else {
            index = free_.back();
            free_.pop_back();
            cell_[std::size_t(index)] = created;
        }
        auto& back = cell_[std::size_t(other)];
        auto const shared = side(index, c).sites;
        for (std::size_t k = 0; k < corners; ++k)
            if (back.neighbour[k] == t && side(other, k).sites == shared) back.neighbour[k] = index;
        for (std::size_t k = 0; k < corners; ++k)
            if (k != c) sides.push_back(side(index, k));
        if (far_corner(created.corner) < 0) start_ = index;
    }

    exact_signs<Dim> sign_;
    std::vector<cell> cell_;
    std::vector<std::int32_t> free_;
    std::int32_t start_ = 0;
};

} // namespace lacuna::detail
