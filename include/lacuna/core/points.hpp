// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>

namespace lacuna {

/// Read-only view of `count` points, in m: the positions of a particle store or a plain array of vectors. The Dim
/// coordinates of a point are contiguous; consecutive points are `stride` scalars apart.
template <class Real, int Dim>
struct points_view {
    Real const* data = nullptr;
    std::size_t count = 0;
    std::size_t stride = Dim;

    std::size_t size() const noexcept { return count; }
    /// Coordinate `axis` of point `i`.
    Real operator()(std::size_t i, int axis) const noexcept { return data[i * stride + std::size_t(axis)]; }
    vec<Real, Dim> operator[](std::size_t i) const noexcept {
        vec<Real, Dim> result;
        for (int axis = 0; axis < Dim; ++axis) result[axis] = (*this)(i, axis);
        return result;
    }
};

/// A position or displacement as text for a message: "(0.5, 2)".
template <class T, int N>
std::string to_text(vec<T, N> const& x) {
    std::string text = "(";
    for (int axis = 0; axis < N; ++axis) text += (axis ? ", " : "") + to_text(double(x[axis]));
    return text + ")";
}

/// View of a vector of points; valid as long as the vector is not resized.
template <class Real, int Dim>
points_view<Real, Dim> view_points(std::vector<vec<Real, Dim>> const& points) noexcept {
    return {points.empty() ? nullptr : points.front().data(), points.size(), std::size_t(Dim)};
}

/// Checks that no two particles are at the same position.
/// \param id callable: index of a point -> number of the particle in the message
/// \throws std::invalid_argument for two particles at the same position
template <class Real, int Dim, class Id>
void require_apart(points_view<Real, Dim> const& points, Id const& id) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    auto const before = [&](std::size_t a, std::size_t b) {
        for (int axis = 0; axis < Dim; ++axis)
            if (points(a, axis) != points(b, axis)) return points(a, axis) < points(b, axis);
        return false;
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return before(a, b) || (!before(b, a) && id(a) < id(b));
    });
    for (std::size_t n = 1; n < order.size(); ++n)
        if (!before(order[n - 1], order[n]))
            throw std::invalid_argument("particles " + std::to_string(id(order[n - 1])) + " and " +
                                        std::to_string(id(order[n])) + " are at the same position " +
                                        to_text(points[order[n]]) +
                                        " m: must be apart, else there are no pores between them");
}

} // namespace lacuna
