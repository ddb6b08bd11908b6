// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh/geometry.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// Report of transfer_fluid(). The fluid content of a pore is V p / K_f - W, where W is its vapour: the volume in
/// excess of a pore filled at zero pressure, as in the paper's eq. 15.
struct transferred_fluid {
    std::size_t kept = 0;    ///< number of pores in both meshes
    std::size_t changed = 0; ///< number of pores in the new mesh only
    std::size_t regions = 0; ///< number of regions of changed pores
    double content = 0;      ///< sum of |V p / K_f| + W of the old pores, m^3: the scale of `residual`
    double residual = 0;     ///< content added (or removed, if negative) by rounding, m^3
    double lost = 0;         ///< content of pores that were removed with all their neighbours, m^3
    /// Volume of the new pores less that of the old ones, m^3. It is due to rounding, unless the boundary has moved or
    /// pores were at their least volume, which exceeds their void.
    double volume = 0;
};

namespace detail {

/// Area that two counter-clockwise triangles have in common, m^2. One is clipped at the sides of the other
/// (I. E. Sutherland, G. W. Hodgman, Reentrant polygon clipping, Comm. ACM 17 (1974) 32).
template <class Real>
Real common_area(std::array<vec<Real, 2>, 3> const& one, std::array<vec<Real, 2>, 3> const& other) noexcept {
    std::array<vec<Real, 2>, 9> polygon, next;
    // Relative to a corner: far from the origin, coordinates would lose digits to rounding.
    auto const origin = other[0];
    std::size_t count = 3;
    for (std::size_t c = 0; c < 3; ++c) polygon[c] = one[c] - origin;
    for (std::size_t side = 0; side < 3; ++side) {
        auto const from = other[side] - origin, along = other[(side + 1) % 3] - other[side];
        std::size_t clipped = 0;
        for (std::size_t k = 0; k < count; ++k) {
            auto const &p = polygon[k], &q = polygon[(k + 1) % count];
            Real const at_p = cross(along, p - from), at_q = cross(along, q - from);
            if (at_p >= Real(0)) next[clipped++] = p;
            if ((at_p >= Real(0)) != (at_q >= Real(0))) next[clipped++] = p + (q - p) * (at_p / (at_p - at_q));
        }
        polygon = next;
        count = clipped;
        if (count < 3) return Real(0);
    }
    Real twice(0);
    for (std::size_t k = 1; k + 1 < count; ++k) twice += cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    return max(twice / Real(2), Real(0));
}

/// Particles at the corners of a pore. The pores of a network are sorted by them.
template <class Real>
std::array<std::int32_t, 3> corners(pore_network<Real, 2> const& net, std::size_t pore) noexcept {
    return {net.corner[0][pore], net.corner[1][pore], net.corner[2][pore]};
}

/// A changed pore as a counter-clockwise triangle (inverted ones are flipped), with its extent in x, m, and area, m^2.
template <class Real>
struct changed_pore {
    std::size_t pore;
    std::array<vec<Real, 2>, 3> x;
    Real low, high, area;
};

template <class Real>
changed_pore<Real> changed_pore_at(pore_network<Real, 2> const& net, std::size_t pore, points_view<Real, 2> points) {
    auto const at = [&](std::size_t c) { return points[std::size_t(net.corner[c][pore])]; };
    changed_pore<Real> p{pore, {at(0), at(1), at(2)}, 0, 0, triangle_area(at(0), at(1), at(2))};
    if (p.area < Real(0)) {
        std::swap(p.x[1], p.x[2]);
        p.area = -p.area;
    }
    p.low = min(p.x[0][0], min(p.x[1][0], p.x[2][0]));
    p.high = max(p.x[0][0], max(p.x[1][0], p.x[2][0]));
    return p;
}

inline std::size_t find_root(std::vector<std::size_t>& up, std::size_t k) noexcept {
    while (up[k] != k) k = up[k] = up[up[k]];
    return k;
}
inline void unite(std::vector<std::size_t>& up, std::size_t a, std::size_t b) noexcept {
    a = find_root(up, a);
    b = find_root(up, b);
    up[std::max(a, b)] = std::min(a, b);
}

/// Copies the flows of throats between the same particles, and the state of sources of the same name: value, volume and
/// rate.
template <class Real>
void transfer_throats(pore_network<Real, 2> const& from, pore_network<Real, 2>& to) {
    struct throat_key {
        std::int32_t low, high;
        std::size_t throat;
        bool operator<(throat_key const& o) const noexcept { return low != o.low ? low < o.low : high < o.high; }
    };
    auto const key_of = [](pore_network<Real, 2> const& net, std::size_t t) {
        auto const i = net.throat_particle[0][t], j = net.throat_particle[1][t];
        return throat_key{std::min(i, j), std::max(i, j), t};
    };
    std::vector<throat_key> known;
    for (std::size_t t = 0; t < from.open_throats(); ++t) known.push_back(key_of(from, t));
    std::sort(known.begin(), known.end());
    for (std::size_t t = 0; t < to.open_throats(); ++t) {
        auto const wanted = key_of(to, t);
        auto const found = std::lower_bound(known.begin(), known.end(), wanted);
        if (found == known.end() || wanted < *found) continue;
        bool const same_direction = from.throat_particle[0][found->throat] == to.throat_particle[0][t];
        to.flow[t] = same_direction ? from.flow[found->throat] : -from.flow[found->throat];
    }
    for (std::size_t s = 0; s < to.sources.size(); ++s)
        for (auto const& old : from.sources) {
            auto& now = to.sources[s];
            if (old.name != now.name || old.kind != now.kind) continue;
            now.volume = old.volume;
            now.rate = old.rate;
            if (now.value == old.value) continue;
            now.value = old.value;
            for (std::size_t t = to.interior_throats; now.kind == flow_source_kind::pressure && t < to.open_throats();
                 ++t)
                if (to.throat_source(t) == std::int32_t(s))
                    to.drained_pressure[t - to.interior_throats] = Real(now.value);
        }
}

} // namespace detail

/// Copies pore_network::size, the reference for the least volume, for pores that are in both networks.
template <class Real>
void keep_sizes(pore_network<Real, 2> const& from, pore_network<Real, 2>& to) {
    std::size_t a = 0;
    for (std::size_t b = 0; b < to.pores(); ++b) {
        auto const wanted = detail::corners(to, b);
        while (a < from.pores() && detail::corners(from, a) < wanted) ++a;
        if (a < from.pores() && detail::corners(from, a) == wanted) to.size[b] = from.size[a];
    }
}

namespace detail {
/// The work of transfer_fluid(): regions of old and new pores that overlap, and what each contains.
template <class Real>
class fluid_transfer {
public:
    fluid_transfer(pore_network<Real, 2> const& from, pore_network<Real, 2>& to, points_view<Real, 2> points,
                   double bulk_modulus, double minimum_pressure)
        : from_(from), to_(to), points_(points), bulk_modulus_(bulk_modulus), minimum_pressure_(minimum_pressure) {}

    transferred_fluid run() {
        match_pores();
        unite_overlapping();
        unite_lone_regions();
        find_contents();
        share_out();
        for (std::size_t p = 0; p < from_.pores(); ++p)
            report_.content += std::fabs(double(from_.old_volume[p]) * double(from_.pressure[p])) / bulk_modulus_ +
                               double(from_.vapour_of(p));
        transfer_throats(from_, to_);
        return report_;
    }

private:
    static constexpr auto none = std::size_t(-1);

    /// Copies the pores that both networks have, which sort their pores by corners; lists the others.
    void match_pores() {
        old_of_new_.assign(to_.pores(), none);
        new_of_old_.assign(from_.pores(), none);
        std::size_t a = 0, b = 0;
        while (a < from_.pores() || b < to_.pores()) {
            bool const old_first = b == to_.pores() || (a < from_.pores() && corners(from_, a) < corners(to_, b));
            bool const new_first = a == from_.pores() || (b < to_.pores() && corners(to_, b) < corners(from_, a));
            if (old_first) {
                removed_.push_back(changed_pore_at(from_, a++, points_));
            } else if (new_first) {
                added_.push_back(changed_pore_at(to_, b++, points_));
            } else {
                to_.volume[b] = from_.volume[a];
                to_.old_volume[b] = from_.old_volume[a];
                to_.pressure[b] = from_.pressure[a];
                if (!to_.vapour.empty()) to_.vapour[b] = from_.vapour_of(a);
                old_of_new_[b] = a;
                new_of_old_[a++] = b++;
            }
        }
        report_.kept = to_.pores() - added_.size();
        report_.changed = added_.size();
    }

    /// Unites old and new pores that overlap. Nodes of the union-find: all old pores, then all new ones.
    void unite_overlapping() {
        up_.resize(from_.pores() + to_.pores());
        std::iota(up_.begin(), up_.end(), std::size_t(0));
        area_.assign(to_.pores(), 0);
        sum_.assign(to_.pores(), 0);
        auto const by_low = [](auto const& p, auto const& q) {
            return p.low != q.low ? p.low < q.low : p.pore < q.pore;
        };
        std::sort(removed_.begin(), removed_.end(), by_low);
        std::sort(added_.begin(), added_.end(), by_low);
        Real widest(0);
        for (auto const& p : removed_) widest = max(widest, p.high - p.low);
        std::size_t start = 0;
        for (auto const& q : added_) {
            while (start < removed_.size() && removed_[start].low + widest < q.low) ++start;
            for (std::size_t k = start; k < removed_.size() && removed_[k].low <= q.high; ++k) {
                auto const& p = removed_[k];
                if (p.high < q.low) continue;
                Real const common = common_area(p.x, q.x);
                if (!(common > Real(1e-9) * min(p.area, q.area))) continue;
                area_[q.pore] += double(common);
                sum_[q.pore] += double(common) * double(from_.pressure[p.pore]);
                unite(up_, p.pore, new_node(q.pore));
            }
        }
    }

    /// A region without new pores joins its neighbours, and their neighbours if those are removed too.
    void unite_lone_regions() {
        std::vector<std::uint8_t> has_new(up_.size());
        bool moved = true;
        while (moved) {
            std::fill(has_new.begin(), has_new.end(), std::uint8_t(0));
            for (std::size_t q = 0; q < to_.pores(); ++q) has_new[find_root(up_, new_node(q))] = 1;
            moved = false;
            for (auto const& p : removed_) {
                if (has_new[find_root(up_, p.pore)]) continue;
                from_.throats_of.for_each(p.pore, [&](std::size_t t, int side) {
                    auto const other = from_.throat_pore[std::size_t(1 - side)][t];
                    if (other < 0) return;
                    auto const found = new_of_old_[std::size_t(other)];
                    auto const next = found == none ? std::size_t(other) : new_node(found);
                    if (find_root(up_, next) == find_root(up_, p.pore)) return;
                    unite(up_, p.pore, next);
                    moved = true;
                });
            }
        }
    }

    /// Sums the fluid of each region, and gives its new pores the mean pressures of the old ones that they overlap.
    void find_contents() {
        regions_.resize(up_.size());
        for (auto const& p : removed_) {
            region& r = region_of(p.pore);
            double const filled = double(from_.old_volume[p.pore]) * double(from_.pressure[p.pore]);
            r.content += filled - bulk_modulus_ * double(from_.vapour_of(p.pore));
            r.old_volume += double(from_.old_volume[p.pore]);
            r.real = true;
        }
        for (auto const& q : added_) region_of(new_node(q.pore)).real = true;
        for (std::size_t q = 0; q < to_.pores(); ++q) {
            region& r = region_of(new_node(q));
            if (!r.real) continue;
            touched_.push_back(q);
            double const volume = double(to_.old_volume[q]);
            double pressure = area_[q] > 0 ? sum_[q] / area_[q] : 0;
            if (old_of_new_[q] != none) { // neighbour of a region without new pores
                pressure = double(to_.pressure[q]);
                r.content += volume * pressure - bulk_modulus_ * double(to_.vapour_of(q));
                r.old_volume += volume;
            }
            to_.pressure[q] = Real(pressure);
            r.guess += volume * double(to_.pressure[q]);
            r.volume += volume;
        }
    }

    /// Shifts the pressures of each region so that it has its content.
    void share_out() {
        for (std::size_t q : touched_) {
            region const& r = region_of(new_node(q));
            double const volume = double(to_.old_volume[q]);
            double const wanted = double(to_.pressure[q]) + (r.content - r.guess) / r.volume;
            bool const torn = wanted < minimum_pressure_;
            to_.pressure[q] = Real(torn ? minimum_pressure_ : wanted);
            if (!to_.vapour.empty())
                to_.vapour[q] = Real(torn ? (minimum_pressure_ - wanted) * volume / bulk_modulus_ : 0);
            report_.residual += (volume * double(to_.pressure[q])) / bulk_modulus_ - double(to_.vapour_of(q));
            report_.volume += volume;
        }
        for (auto const& r : regions_) {
            if (!r.real) continue;
            ++report_.regions;
            report_.volume -= r.old_volume;
            (r.volume > 0 ? report_.residual : report_.lost) += (r.volume > 0 ? -1 : 1) * r.content / bulk_modulus_;
        }
    }

    struct region {
        double content = 0, guess = 0, volume = 0, old_volume = 0;
        bool real = false;
    };
    std::size_t new_node(std::size_t pore) const noexcept { return from_.pores() + pore; }
    region& region_of(std::size_t node) { return regions_[find_root(up_, node)]; }

    pore_network<Real, 2> const& from_;
    pore_network<Real, 2>& to_;
    points_view<Real, 2> points_;
    double bulk_modulus_, minimum_pressure_;
    transferred_fluid report_;
    std::vector<std::size_t> old_of_new_, new_of_old_, up_, touched_;
    std::vector<changed_pore<Real>> removed_, added_;
    std::vector<double> area_, sum_; ///< of each new pore: overlap with old ones, m^2, and pressure times it
    std::vector<region> regions_;
};
} // namespace detail

/// Transfers the fluid of a network to the network of a new mesh of the same particles in the same positions.
///
/// A pore that is in both meshes keeps its volumes, pressure and vapour, to the bit. The other pores form regions of
/// old and new pores that overlap. In a region each new pore first gets the mean of the old pressures, weighted with
/// the areas that it covers. Then one pressure is added to all of them, such that the region keeps its fluid content.
/// So a uniform pressure stays uniform if the volume of the region is unchanged. On the boundary a region may gain or
/// lose area but keeps its content. A region without new pores gives its content to the neighbouring pores. A new pore
/// that overlaps no old pore starts at zero pressure.
///
/// \param from network of the old mesh
/// \param to network of the new mesh, with volumes, apertures and conductances. It receives the fluid, the flows of
///        throats that are also in `from`, and the value, volume and rate of sources of the same name.
/// \param points centres, m; \param bulk_modulus K_f, Pa; \param minimum_pressure Pa
template <class Real>
transferred_fluid transfer_fluid(pore_network<Real, 2> const& from, pore_network<Real, 2>& to,
                                 points_view<Real, 2> points, double bulk_modulus, double minimum_pressure) {
    return detail::fluid_transfer<Real>(from, to, points, bulk_modulus, minimum_pressure).run();
}

} // namespace lacuna
