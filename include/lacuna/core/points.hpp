// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <lacuna/core/vec.hpp>

namespace lacuna {

/// Read-only view of `count` points whose Dim coordinates lie next to each other, `stride` scalars apart
/// from one point to the next: the positions of a particle store, or of a plain array of vectors. In m.
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

/// View of a vector of points; valid as long as the vector is not resized.
template <class Real, int Dim>
points_view<Real, Dim> view_points(std::vector<vec<Real, Dim>> const& points) noexcept {
    return {points.empty() ? nullptr : points.front().data(), points.size(), std::size_t(Dim)};
}

} // namespace lacuna
