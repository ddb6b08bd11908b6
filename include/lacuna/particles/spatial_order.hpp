// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>

namespace lacuna {

namespace detail {

/// Index along the Hilbert curve of a cell with coordinates below 2^Bits (J. Skilling, "Programming the Hilbert curve",
/// AIP Conf. Proc. 707, 381 (2004)).
template <int Dim, int Bits>
constexpr std::uint64_t hilbert_key(std::uint32_t (&x)[std::size_t(Dim)]) noexcept {
    static_assert(Dim * Bits <= 64 && Bits <= 31);
    for (std::uint32_t q = 1u << (Bits - 1); q > 1; q >>= 1) {
        std::uint32_t const p = q - 1;
        for (int i = 0; i < Dim; ++i) {
            if (x[i] & q) {
                x[0] ^= p;
            } else {
                std::uint32_t const t = (x[0] ^ x[i]) & p;
                x[0] ^= t;
                x[i] ^= t;
            }
        }
    }
    for (int i = 1; i < Dim; ++i) x[i] ^= x[i - 1];
    std::uint32_t t = 0;
    for (std::uint32_t q = 1u << (Bits - 1); q > 1; q >>= 1)
        if (x[Dim - 1] & q) t ^= q - 1;
    for (int i = 0; i < Dim; ++i) x[i] ^= t;
    std::uint64_t key = 0;
    for (int bit = Bits - 1; bit >= 0; --bit)
        for (int i = 0; i < Dim; ++i) key = (key << 1) | ((x[i] >> bit) & 1u);
    return key;
}

/// The interval along one axis that contains almost all points, or all of them if it is then at most about twice as
/// long. So a particle that has flown away does not change the order of the others. {0, 0} for no points.
/// \throws std::invalid_argument if a coordinate is not finite
template <class Real, int Dim>
std::pair<double, double> usual_interval(points_view<Real, Dim> points, int axis, std::vector<double>& buffer) {
    buffer.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!std::isfinite(points(i, axis)))
            refuse("particle " + std::to_string(i) + ".position", double(points(i, axis)), "finite");
        buffer.push_back(double(points(i, axis)));
    }
    if (buffer.empty()) return {0, 0};
    auto const share = std::ptrdiff_t(buffer.size() / 64);
    auto const at = [&](std::ptrdiff_t k) {
        std::nth_element(buffer.begin(), buffer.begin() + k, buffer.end());
        return buffer[std::size_t(k)];
    };
    auto const all = std::minmax_element(buffer.begin(), buffer.end());
    double const low = *all.first, high = *all.second;
    double const first = at(share), last = at(std::ptrdiff_t(buffer.size()) - 1 - share), rest = (last - first) / 31;
    if (high - low <= 2 * (last - first + 2 * rest)) return {low, high};
    return {std::max(low, first - rest), std::min(high, last + rest)};
}

} // namespace detail

/// Orders particles along a Hilbert curve, so that neighbours in space are neighbours in memory.
/// \param points positions, m; finite
/// \return a permutation: particle order[k] of the input becomes number k. Points that share a cell of the curve
///         (1/65535 of the extent) are ordered by their coordinates.
/// \throws std::invalid_argument if a coordinate is not finite
template <class Real, int Dim>
std::vector<std::int32_t> spatial_order(points_view<Real, Dim> points) {
    constexpr int bits = 16;
    double low[std::size_t(Dim)], span = 0;
    std::vector<double> buffer;
    for (int axis = 0; axis < Dim; ++axis) {
        auto const [first, last] = detail::usual_interval(points, axis, buffer);
        low[axis] = first;
        span = std::max(span, last - first);
    }
    std::vector<std::pair<std::uint64_t, std::int32_t>> keyed(points.size());
    auto const before = [&](auto const& a, auto const& b) {
        if (a.first != b.first) return a.first < b.first;
        for (int axis = 0; axis < Dim; ++axis) {
            Real const x = points(std::size_t(a.second), axis), y = points(std::size_t(b.second), axis);
            if (x != y) return x < y;
        }
        return a.second < b.second;
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::uint32_t cell[std::size_t(Dim)];
        for (int axis = 0; axis < Dim; ++axis)
            cell[axis] =
                span > 0
                    ? std::uint32_t(std::clamp((double(points(i, axis)) - low[axis]) / span, 0.0, 1.0) * 65535.0 + 0.5)
                    : 0u;
        keyed[i] = {detail::hilbert_key<Dim, bits>(cell), std::int32_t(i)};
    }
    std::sort(keyed.begin(), keyed.end(), before);
    std::vector<std::int32_t> order(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = keyed[k].second;
    return order;
}

/// Orders particles in the plane along a curve that sweeps the packing strip by strip, back and forth. Strips run
/// across the longer side of the packing and are as wide as the mean distance of particles.
///
/// In this order all partners of a particle are within about one strip on either side. This window stays in the cache
/// even for a million particles, so that each record comes from memory once. Along a Hilbert curve most partners are
/// closer, but some are very far. In space the window is a whole layer, and spatial_order() is better.
/// \param points positions, m; finite
/// \return as for spatial_order()
/// \throws std::invalid_argument if a coordinate is not finite
template <class Real>
std::vector<std::int32_t> strip_order(points_view<Real, 2> points) {
    double low[2] = {0, 0}, side[2] = {0, 0};
    std::vector<double> buffer;
    for (int axis = 0; axis < 2; ++axis) {
        auto const [first, last] = detail::usual_interval(points, axis, buffer);
        low[axis] = first;
        side[axis] = last - first;
    }
    int const along = side[0] > side[1] ? 0 : 1, across = 1 - along;
    double const width = std::sqrt(side[0] * side[1] / double(std::max<std::size_t>(points.size(), 1)));
    double const strips = width > 0 ? side[along] / width : 0.0;
    struct key {
        std::int64_t strip;
        double position, depth;
        std::int32_t number;
        bool operator<(key const& o) const noexcept {
            if (strip != o.strip) return strip < o.strip;
            if (position != o.position) return position < o.position;
            return depth != o.depth ? depth < o.depth : number < o.number;
        }
    };
    std::vector<key> keyed(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        // Absolute coordinates: rounding may make the differences to `low` of two points equal.
        double const depth = double(points(i, along)), position = double(points(i, across));
        auto const strip = strips < 1e9 && width > 0 ? std::int64_t(std::clamp((depth - low[along]) / width, -1e9, 1e9))
                                                     : std::int64_t(0);
        keyed[i] = {strip, strip % 2 ? -position : position, depth, std::int32_t(i)};
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<std::int32_t> order(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = keyed[k].number;
    return order;
}

} // namespace lacuna
