// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <lacuna/pores/mesh/exact_signs.hpp>

namespace lacuna::detail {

/// Regular triangulation by inserting one site after another (A. Bowyer, D. F. Watson, Comput. J. 24 (1981) 162 and 167):
/// a new site takes away the simplices whose orthogonal sphere it is in, and is joined to the sides of the cavity. With
/// exact signs it is right for any sites; it takes several times as long as Qhull.
///
/// The outside is a simplex too, one for each side of the hull, with a corner `far`. Its orientation is that of a simplex
/// with a site beyond the side in that corner's place.
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

    /// Simplices of positive orientation, in no order that means anything; none when all sites lie on a line (plane).
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
        std::int32_t seen; // the last site for which it was asked, and whether it was in conflict
        bool conflict;
    };
    struct open_side {
        std::array<std::int32_t, std::size_t(Dim)> sites;
        std::int32_t cell, corner;
        bool operator<(open_side const& o) const noexcept { return sites < o.sites; }
    };

    /// An order that follows from the places alone: sites come sorted by them.
    static std::vector<std::int32_t> shuffled(std::size_t count) {
        std::vector<std::int32_t> order(count);
        for (std::size_t k = 0; k < count; ++k) order[k] = std::int32_t(k);
        std::uint64_t state = 0x9e3779b97f4a7c15;
        for (std::size_t k = count; k > 1; --k) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            std::swap(order[k - 1], order[std::size_t((state >> 33) % k)]);
        }
        // In rounds, each twice as long as the one before and sorted by place: the way from site to site is short.
        for (std::size_t from = 0, to = 64; from < count; from = to, to *= 2)
            std::sort(order.begin() + std::ptrdiff_t(from), order.begin() + std::ptrdiff_t(std::min(to, count)));
        return order;
    }

    /// The first sites that are not on one line (in one plane), in positive orientation.
    bool choose_first(std::vector<std::int32_t> const& order, simplex& first) const {
        std::size_t have = 0;
        for (auto const p : order) {
            first[have] = p;
            if (have + 1 < corners && !independent(first, have)) continue;
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
    /// Whether first[count] adds a dimension to those before it.
    bool independent(simplex const& first, std::size_t count) const {
        auto const& x = sign_.sites().x;
        auto const apart = [&](std::size_t k, std::size_t axis) {
            return exact_number::difference(x[std::size_t(first[k])][axis], x[std::size_t(first[0])][axis]);
        };
        if (count == 0) return true;
        for (std::size_t a = 0; a < std::size_t(Dim); ++a) {
            if (count == 1) {
                if (apart(1, a).value() != 0) return true;
                continue;
            }
            std::size_t const b = (a + 1) % std::size_t(Dim);
            if ((apart(1, a) * apart(2, b) - apart(1, b) * apart(2, a)).value() != 0) return true;
        }
        return false;
    }

    void begin(simplex const& first) {
        cell_.push_back({first, {}, true, far, false});
        std::vector<open_side> open;
        for (std::size_t c = 0; c < corners; ++c) {
            auto outside = first;
            outside[c] = far;
            // A site beyond this side has the other orientation in this corner.
            std::swap(outside[c == 0 ? 1 : 0], outside[c == corners - 1 ? corners - 2 : corners - 1]);
            cell_.push_back({outside, {}, true, far, false});
        }
        for (std::int32_t t = 0; t < std::int32_t(cell_.size()); ++t)
            for (std::size_t c = 0; c < corners; ++c) open.push_back(side(t, c));
        join(open);
    }

    static std::int32_t far_corner(simplex const& s) noexcept {
        for (std::size_t c = 0; c < corners; ++c)
            if (s[c] == far) return std::int32_t(c);
        return -1;
    }
    open_side side(std::int32_t t, std::size_t corner) const noexcept {
        open_side one{{}, t, std::int32_t(corner)};
        auto const& s = cell_[std::size_t(t)].corner;
        for (std::size_t c = 0; c + 1 < corners; ++c) one.sites[c] = s[c < corner ? c : c + 1];
        std::sort(one.sites.begin(), one.sites.end());
        return one;
    }
    /// Makes neighbours of the cells whose sides have the same sites.
    void join(std::vector<open_side>& open) {
        std::sort(open.begin(), open.end());
        for (std::size_t k = 0; k + 1 < open.size(); k += 2) {
            cell_[std::size_t(open[k].cell)].neighbour[std::size_t(open[k].corner)] = open[k + 1].cell;
            cell_[std::size_t(open[k + 1].cell)].neighbour[std::size_t(open[k + 1].corner)] = open[k].cell;
        }
    }

    bool find_conflict(std::int32_t t, std::int32_t p) const {
        auto const& c = cell_[std::size_t(t)];
        auto const outer = far_corner(c.corner);
        if (outer < 0) return sign_.inside(c.corner, p) > 0;
        auto seen = c.corner;
        seen[std::size_t(outer)] = p;
        double const beyond = sign_.orientation(seen);
        if (beyond != 0) return beyond > 0;
        // In line with the side the simplex within decides.
        return sign_.inside(cell_[std::size_t(c.neighbour[std::size_t(outer)])].corner, p) > 0;
    }
    bool in_conflict(std::int32_t t, std::int32_t p) {
        auto& c = cell_[std::size_t(t)];
        if (c.seen != p) {
            c.conflict = find_conflict(t, p);
            c.seen = p;
        }
        return c.conflict;
    }

    /// The simplex that p is in, or one of the outside that sees it.
    std::int32_t locate(std::int32_t p) const {
        std::int32_t t = start_;
        for (;;) {
            auto const& c = cell_[std::size_t(t)];
            if (far_corner(c.corner) >= 0) return t;
            std::int32_t next = -1;
            for (std::size_t k = 0; k < corners && next < 0; ++k) {
                auto turned = c.corner;
                turned[k] = p;
                if (sign_.orientation(turned) < 0) next = c.neighbour[k];
            }
            if (next < 0) return t;
            t = next;
        }
    }

    void insert(std::int32_t p) {
        auto const at = locate(p);
        if (!in_conflict(at, p)) return; // hidden by the others
        std::vector<std::int32_t> cavity{at};
        cell_[std::size_t(at)].alive = false;
        std::vector<open_side> open;
        for (std::size_t k = 0; k < cavity.size(); ++k)
            for (std::size_t c = 0; c < corners; ++c) {
                auto const t = cavity[k], other = cell_[std::size_t(t)].neighbour[c];
                if (!cell_[std::size_t(other)].alive) continue;
                if (in_conflict(other, p)) {
                    cell_[std::size_t(other)].alive = false;
                    cavity.push_back(other);
                } else {
                    fill(t, c, other, p, open);
                }
            }
        join(open);
        free_.insert(free_.end(), cavity.begin(), cavity.end());
    }

    /// Joins p to the side of cell t opposite corner c, behind which `other` stays.
    void fill(std::int32_t t, std::size_t c, std::int32_t other, std::int32_t p, std::vector<open_side>& open) {
        auto fresh = cell_[std::size_t(t)];
        fresh.corner[c] = p;
        fresh.neighbour[c] = other;
        fresh.alive = true;
        fresh.seen = far;
        std::int32_t place = std::int32_t(cell_.size());
        if (free_.empty()) {
            cell_.push_back(fresh);
        } else {
            place = free_.back();
            free_.pop_back();
            cell_[std::size_t(place)] = fresh;
        }
        auto& back = cell_[std::size_t(other)];
        auto const shared = side(place, c).sites;
        for (std::size_t k = 0; k < corners; ++k)
            if (back.neighbour[k] == t && side(other, k).sites == shared) back.neighbour[k] = place;
        for (std::size_t k = 0; k < corners; ++k)
            if (k != c) open.push_back(side(place, k));
        if (far_corner(fresh.corner) < 0) start_ = place;
    }

    exact_signs<Dim> sign_;
    std::vector<cell> cell_;
    std::vector<std::int32_t> free_;
    std::int32_t start_ = 0;
};

} // namespace lacuna::detail
