// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/parallel.hpp>
#include <lacuna/core/points.hpp>

/// \file
/// The interface of neighbour searches. All searches return the same list, bit for bit, for the same input: they share
/// one comparison, and every list is sorted.

namespace lacuna {

/// Indices in the input of two particles that are close to each other; i < j.
struct neighbor_pair {
    std::int32_t i;
    std::int32_t j;
    friend constexpr bool operator==(neighbor_pair const&, neighbor_pair const&) = default;
};

namespace detail {
template <class S>
concept search_types = std::floating_point<typename S::real_type> && (S::dim == 2 || S::dim == 3);
template <class S>
concept search_build = requires(S search, points_view<typename S::real_type, S::dim> const& points,
                                typename S::real_type cutoff) { search.build(points, cutoff); };
template <class S>
concept search_pairs = requires(S const built, std::vector<neighbor_pair>& out) { built.pairs(out); };
template <class S>
concept search_touching_pairs = requires(S search, points_view<typename S::real_type, S::dim> const& points,
                                         std::span<typename S::real_type const> radii, typename S::real_type margin,
                                         std::vector<neighbor_pair>& out) {
    search.touching_pairs(points, radii, margin, out);
};
} // namespace detail

/// Requirements on a neighbour search, such as brute_force, kd_tree and cell_grid.
///
/// * `build(points, cutoff)`, then `pairs(out)`: all pairs whose centres are at most `cutoff` apart [m].
/// * `touching_pairs(points, radii, margin, out)`: all pairs with distance <= r_i + r_j + margin [m].
///
/// Limits are inclusive. Each pair occurs once, the list is sorted by (i, j), and it replaces the content of `out`. A
/// search copies its input. The calls throw std::invalid_argument for a position that is not finite and a radius that
/// is negative or not finite (naming the particle), for a negative cutoff or margin, for a limit whose square
/// overflows, and unless there is one radius per point.
template <class S>
concept neighbor_search = std::default_initializable<S> && std::copyable<S> && detail::search_types<S> &&
    detail::search_build<S> && detail::search_pairs<S> && detail::search_touching_pairs<S>;

namespace detail {

/// Returns sum + d^2 with the same rounding wherever it is inlined. If the processor has a fused multiply-add, the
/// compiler may contract products and sums differently in different places; std::fma fixes one way.
template <class Real>
inline Real add_square(Real sum, Real d) noexcept {
#if defined(__FMA__) || defined(__FP_FAST_FMA) || defined(__aarch64__)
    return std::fma(d, d, sum);
#else
    return sum + d * d;
#endif
}

/// True if points at squared distance d2 are a pair. All searches use this comparison.
template <class Real>
inline bool in_reach(Real d2, Real radius_i, Real radius_j, Real margin) noexcept {
    Real const limit = (radius_i + radius_j) + margin;
    return d2 <= limit * limit;
}

/// Relative allowance for the rounding of a distance, of a limit and of the sums in a tree.
template <class Real>
inline constexpr Real rounding_slack = 256 * std::numeric_limits<Real>::epsilon();

template <class Real, int Dim>
void require_finite_points(points_view<Real, Dim> const& points) {
    if (points.size() > (std::size_t(1) << 29)) refuse("number of points", double(points.size()), "at most 2^29");
    bool finite = true;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < Dim; ++axis) finite = finite && points(i, axis) - points(i, axis) == Real(0);
    if (finite) return;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < Dim; ++axis)
            require_finite("position of particle " + std::to_string(i) + ", coordinate " + std::to_string(axis),
                           double(points(i, axis)));
}

template <class Real>
void require_length(char const* field, Real value) {
    require_not_negative(field, double(value));
    if (!std::isfinite(value * value)) refuse(field, double(value), "small enough for its square to be finite");
}

/// Checks the input of touching_pairs. Returns the largest radius, 0 without particles.
template <class Real>
Real require_radii(std::span<Real const> radii, std::size_t count, Real margin) {
    if (radii.size() != count)
        refuse("number of radii", double(radii.size()), "the number of points, " + std::to_string(count));
    require_length("margin", margin);
    Real largest = 0;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        if (!(radii[i] >= 0 && std::isfinite(radii[i])))
            refuse("radius of particle " + std::to_string(i), double(radii[i]), ">= 0 and finite");
        largest = std::max(largest, radii[i]);
    }
    require_length("twice the largest radius + margin", 2 * largest + margin);
    return largest;
}

/// Sorts pairs by (i, j).
inline void sort_pairs(neighbor_pair* first, neighbor_pair* last) {
    std::sort(first, last,
              [](neighbor_pair const& a, neighbor_pair const& b) { return a.i < b.i || (a.i == b.i && a.j < b.j); });
}

/// Sorts the pairs of one i by j. Rows are short except for degenerate input.
inline void sort_row(neighbor_pair* first, neighbor_pair* last) {
    if (last - first > 32) return sort_pairs(first, last);
    for (neighbor_pair* p = first; p < last; ++p) {
        neighbor_pair const moving = *p;
        neighbor_pair* to = p;
        for (; to > first && moving.j < to[-1].j; --to) *to = to[-1];
        *to = moving;
    }
}

/// Calls `pairs_of(first, last, part)` for one range of the `count` particles per thread. Joins the pairs in the order
/// of the ranges.
/// \param pairs_of writes the pairs to `part`, which it may enlarge, and returns their number
/// \param parts buffers, which the caller stores for the next call
template <class PairsOf>
void join_pairs(std::size_t count, int threads, std::vector<std::vector<neighbor_pair>>& parts,
                std::vector<neighbor_pair>& out, PairsOf const& pairs_of) {
    auto const ranges = std::size_t(threads);
    parts.resize(ranges);
    std::vector<std::size_t> begin(ranges + 1, 0);
    for_each_chunk(threads, threads, [&](int t) {
        auto const k = std::size_t(t);
        begin[k + 1] = pairs_of(count * k / ranges, count * (k + 1) / ranges, parts[k]);
    });
    for (std::size_t k = 0; k < ranges; ++k) begin[k + 1] += begin[k];
    out.resize(begin.back());
    for_each_chunk(threads, threads, [&](int t) {
        auto const k = std::size_t(t);
        std::copy_n(parts[k].begin(), begin[k + 1] - begin[k], out.begin() + std::ptrdiff_t(begin[k]));
    });
}

} // namespace detail
} // namespace lacuna
