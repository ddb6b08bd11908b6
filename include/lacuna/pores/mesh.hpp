// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/geometry.hpp>

namespace lacuna {

/// Division of a body into simplices whose corners are particles: triangles in the plane.
template <int Dim>
struct pore_mesh {
    using simplex = std::array<std::int32_t, std::size_t(Dim) + 1>;
    /// Particles at the corners; in the plane counter-clockwise, the smallest number first, rows in ascending order.
    std::vector<simplex> simplices;
    /// neighbours[s][c] is the simplex across the side opposite corner c of simplex s, -1 on the boundary.
    std::vector<simplex> neighbours;

    std::size_t size() const noexcept { return simplices.size(); }
};

namespace detail {

/// Sorts the triangles and finds who lies across each side.
/// \throws std::runtime_error when two triangles lie on the same side of an edge.
inline void connect(pore_mesh<2>& mesh) {
    for (auto& t : mesh.simplices) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(mesh.simplices.begin(), mesh.simplices.end());
    mesh.neighbours.assign(mesh.size(), {-1, -1, -1});
    struct side {
        std::int32_t low, high, triangle, corner;
        bool ascending;
        bool operator<(side const& o) const noexcept {
            return low != o.low ? low < o.low : high != o.high ? high < o.high : triangle < o.triangle;
        }
    };
    std::vector<side> sides;
    sides.reserve(3 * mesh.size());
    for (std::size_t t = 0; t < mesh.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            auto const a = mesh.simplices[t][(c + 1) % 3], b = mesh.simplices[t][(c + 2) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), std::int32_t(t), std::int32_t(c), a < b});
        }
    std::sort(sides.begin(), sides.end());
    for (std::size_t k = 1; k < sides.size(); ++k) {
        auto const &a = sides[k - 1], &b = sides[k];
        if (a.low != b.low || a.high != b.high) continue;
        if (a.ascending == b.ascending)
            throw std::runtime_error("triangulation: two triangles on the same side of the edge " +
                                     std::to_string(a.low) + "-" + std::to_string(a.high));
        mesh.neighbours[std::size_t(a.triangle)][std::size_t(a.corner)] = b.triangle;
        mesh.neighbours[std::size_t(b.triangle)][std::size_t(b.corner)] = a.triangle;
    }
}

} // namespace detail

/// Total area of a mesh, m^2.
template <class Real>
Real mesh_area(pore_mesh<2> const& mesh, points_view<Real, 2> points) {
    Real total(0);
    for (auto const& t : mesh.simplices)
        total += triangle_area(points[std::size_t(t[0])], points[std::size_t(t[1])], points[std::size_t(t[2])]);
    return total;
}

/// The outer edges of a triangulation of scattered particles bridge bays and skim straight rows: they are not part
/// of the body. This takes away, from outside inwards until none is left, each triangle with a boundary edge that
///   - is longer than `cutoff`, or
///   - joins two particles that do not touch (gap above 1 % of r_i + r_j) and closes off a triangle that its three
///     discs fill completely (void_area <= 0): a sliver over a row of particles.
///
/// \param cutoff longest boundary edge, m, > 0, infinity allowed; default_cutoff() is twice the mean diameter: wider
///        than any void of a dense packing, narrower than a missing particle.
/// \throws std::invalid_argument for a cutoff that is not positive.
template <class Real>
pore_mesh<2> peel(pore_mesh<2> const& mesh, points_view<Real, 2> points, Real const* radii, Real cutoff) {
    if (!(cutoff > Real(0))) refuse("cutoff", double(cutoff), "> 0");
    std::vector<std::uint8_t> gone(mesh.size(), 0);
    auto const outside = [&](std::size_t t, std::size_t c) {
        auto const& corners = mesh.simplices[t];
        auto const k = std::size_t(corners[c]);
        auto const i = std::size_t(corners[(c + 1) % 3]), j = std::size_t(corners[(c + 2) % 3]);
        Real const length = norm(points[j] - points[i]);
        if (length > cutoff) return true;
        return length > Real(1.01) * (radii[i] + radii[j]) &&
               void_area(points[k], points[i], points[j], radii[k], radii[i], radii[j]) <= Real(0);
    };
    std::vector<std::size_t> front;
    auto const look = [&](std::size_t t) {
        if (gone[t]) return;
        for (std::size_t c = 0; c < 3; ++c) {
            auto const other = mesh.neighbours[t][c];
            if ((other < 0 || gone[std::size_t(other)]) && outside(t, c)) {
                gone[t] = 1;
                front.push_back(t);
                return;
            }
        }
    };
    for (std::size_t t = 0; t < mesh.size(); ++t) look(t);
    while (!front.empty()) {
        auto const t = front.back();
        front.pop_back();
        for (auto const other : mesh.neighbours[t])
            if (other >= 0) look(std::size_t(other));
    }
    pore_mesh<2> body;
    for (std::size_t t = 0; t < mesh.size(); ++t)
        if (!gone[t]) body.simplices.push_back(mesh.simplices[t]);
    detail::connect(body);
    return body;
}

/// Twice the mean diameter of the particles; infinity where they have none. m.
template <class Real>
Real default_cutoff(Real const* radii, std::size_t count) noexcept {
    Real sum(0);
    for (std::size_t i = 0; i < count; ++i) sum += radii[i];
    return sum > Real(0) ? Real(4) * sum / Real(count) : std::numeric_limits<Real>::infinity();
}

} // namespace lacuna
