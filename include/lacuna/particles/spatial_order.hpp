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

/// Place along the Hilbert curve of a cell with coordinates below 2^Bits (J. Skilling, "Programming the Hilbert
/// curve", AIP Conf. Proc. 707, 381 (2004)).
template <int Dim, int Bits>
constexpr std::uint64_t hilbert_key(std::uint32_t (&x)[Dim]) noexcept {
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

} // namespace detail

/// Numbering in which neighbours in space are neighbours in memory: particles along a Hilbert curve.
/// \param points positions, m; finite
/// \return order, a permutation: particle order[k] of the input becomes number k. Points that share a cell of the
///         curve (1/65535 of the extent) keep their order.
/// \throws std::invalid_argument when a coordinate is not finite
template <class Real, int Dim>
std::vector<std::int32_t> spatial_order(points_view<Real, Dim> points) {
    constexpr int bits = 16;
    Real low[Dim], span = 0;
    for (int axis = 0; axis < Dim; ++axis) {
        Real high = low[axis] = points.size() ? points(0, axis) : Real(0);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!std::isfinite(points(i, axis)))
                refuse("particle " + std::to_string(i) + ".position", double(points(i, axis)), "finite");
            low[axis] = std::min(low[axis], points(i, axis));
            high = std::max(high, points(i, axis));
        }
        span = std::max(span, high - low[axis]);
    }
    std::vector<std::pair<std::uint64_t, std::int32_t>> keyed(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::uint32_t cell[Dim];
        for (int axis = 0; axis < Dim; ++axis)
            cell[axis] = span > Real(0)
                             ? std::uint32_t(double(points(i, axis) - low[axis]) / double(span) * 65535.0 + 0.5)
                             : 0u;
        keyed[i] = {detail::hilbert_key<Dim, bits>(cell), std::int32_t(i)};
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<std::int32_t> order(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = keyed[k].second;
    return order;
}

} // namespace lacuna
