// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh/geometry.hpp>

namespace lacuna {

/// Division of a packing into simplices with corners at particle centres: triangles in the plane, tetrahedra in space.
template <int Dim>
struct pore_mesh {
    using simplex = std::array<std::int32_t, std::size_t(Dim) + 1>;
    /// Numbers of the particles at the corners. They ascend, except that the last two are swapped where simplex_size()
    /// would be negative otherwise. (In the plane: counter-clockwise, the smallest number first.) The simplices
    /// themselves are sorted too.
    std::vector<simplex> simplices;
    /// neighbours[s][c] is the simplex across the side opposite corner c of simplex s; -1 on the boundary.
    std::vector<simplex> neighbours;

    std::size_t size() const noexcept { return simplices.size(); }
};

/// Area or volume of a simplex, m^Dim; negative when it is inverted.
template <class Real, int Dim>
Real simplex_size(std::array<std::int32_t, std::size_t(Dim) + 1> const& s, points_view<Real, Dim> points) {
    auto const x = [&](std::size_t c) { return points[std::size_t(s[c])]; };
    if constexpr (Dim == 2)
        return triangle_area(x(0), x(1), x(2));
    else
        return tetrahedron_volume(x(0), x(1), x(2), x(3));
}

/// Part of a simplex that the particles at its corners do not fill, m^Dim; see void_area() and void_volume().
template <class Real, int Dim>
Real simplex_void(std::array<std::int32_t, std::size_t(Dim) + 1> const& s, points_view<Real, Dim> points,
                  Real const* radii) {
    auto const x = [&](std::size_t c) { return points[std::size_t(s[c])]; };
    auto const r = [&](std::size_t c) { return radii[std::size_t(s[c])]; };
    if constexpr (Dim == 2)
        return void_area(x(0), x(1), x(2), r(0), r(1), r(2));
    else
        return void_volume(x(0), x(1), x(2), x(3), r(0), r(1), r(2), r(3));
}

namespace detail {

/// Sorts the corners. Each swap of two corners inverts the simplex.
/// \return whether the number of swaps was odd
template <std::size_t Count>
bool sort_corners(std::array<std::int32_t, Count>& corners) noexcept {
    bool odd = false;
    for (std::size_t k = 1; k < Count; ++k)
        for (std::size_t c = k; c > 0 && corners[c] < corners[c - 1]; --c) {
            std::swap(corners[c], corners[c - 1]);
            odd = !odd;
        }
    return odd;
}

/// All corners of a simplex except one. In the plane the simplex lies to the left of the line from the first to the
/// second; in space the three are counter-clockwise as seen from outside the simplex.
template <std::size_t Count>
std::array<std::int32_t, Count - 1> side_of(std::array<std::int32_t, Count> const& simplex,
                                            std::size_t corner) noexcept {
    std::array<std::int32_t, Count - 1> side;
    for (std::size_t c = 0; c + 1 < Count; ++c) side[c] = simplex[c < corner ? c : c + 1];
    if (corner % 2 == 1) std::swap(side[Count - 3], side[Count - 2]);
    return side;
}

/// Reference for the least volume of a pore, m^Dim; see pore_network::size. Not finite if the simplex's size is not.
template <class Real, std::size_t Corners, int Dim = int(Corners) - 1>
Real reference_size(std::array<std::int32_t, Corners> const& s, points_view<Real, Dim> points, Real const* radii) {
    Real const own = simplex_size(s, points);
    if (Dim == 2 || !std::isfinite(double(own))) return own;
    Real least = radii[std::size_t(s[0])];
    for (auto const i : s) least = min(least, radii[std::size_t(i)]);
    // The regular tetrahedron of edge 2 r has the volume (2 r)^3 / (6 sqrt 2). Without this lower limit the stiffness
    // of the pore in a flat tetrahedron would have no bound.
    return max(own, Real(0.9428090415820634) * least * least * least);
}

/// Centre, outward normal and size of one side of a simplex.
template <class Real, int Dim>
struct outer_side {
    vec<Real, Dim> middle; ///< mean of the corners, m
    vec<Real, Dim> normal; ///< unit normal, outwards
    Real size;             ///< length or area, m^(Dim - 1)
};
/// \param side corners, in the order in which side_of() returns them
template <class Real, int Dim>
outer_side<Real, Dim> look_outwards(std::array<std::int32_t, std::size_t(Dim)> const& side,
                                    points_view<Real, Dim> points) {
    auto const x = [&](std::size_t c) { return points[std::size_t(side[c])]; };
    if constexpr (Dim == 2) {
        auto const along = x(1) - x(0);
        return {(x(0) + x(1)) * Real(0.5), perpendicular(-along) / norm(along), norm(along)};
    } else {
        auto const across = cross(x(1) - x(0), x(2) - x(0));
        return {(x(0) + x(1) + x(2)) / Real(3), across / norm(across), norm(across) / Real(2)};
    }
}

/// Distance of a point from a side that side_of() returned, times the side's length (in space: twice its area), m^Dim.
/// Positive on the same side as the simplex.
template <class Real, int Dim>
Real height_within(std::array<std::int32_t, std::size_t(Dim)> const& side, points_view<Real, Dim> points,
                   vec<Real, Dim> const& at) {
    auto const x = [&](std::size_t c) { return points[std::size_t(side[c])]; };
    if constexpr (Dim == 2)
        return cross(x(1) - x(0), at - x(0));
    else
        return -dot(cross(x(1) - x(0), x(2) - x(0)), at - x(0));
}

/// Sorts the simplices and fills in their neighbours.
/// \throws std::runtime_error when two simplices lie on the same side of an edge or facet.
template <int Dim>
void connect(pore_mesh<Dim>& mesh) {
    constexpr auto corners = std::size_t(Dim) + 1;
    for (auto& s : mesh.simplices)
        if (sort_corners(s)) std::swap(s[corners - 2], s[corners - 1]);
    std::sort(mesh.simplices.begin(), mesh.simplices.end());
    typename pore_mesh<Dim>::simplex none;
    none.fill(-1);
    mesh.neighbours.assign(mesh.size(), none);
    struct side {
        std::array<std::int32_t, std::size_t(Dim)> particles;
        bool odd;
        std::int32_t simplex, corner;
        bool operator<(side const& o) const noexcept {
            return particles != o.particles ? particles < o.particles
                   : odd != o.odd           ? odd < o.odd
                                            : simplex < o.simplex;
        }
    };
    std::vector<side> sides;
    sides.reserve(corners * mesh.size());
    for (std::size_t s = 0; s < mesh.size(); ++s)
        for (std::size_t c = 0; c < corners; ++c) {
            auto particles = side_of(mesh.simplices[s], c);
            bool const odd = sort_corners(particles);
            sides.push_back({particles, odd, std::int32_t(s), std::int32_t(c)});
        }
    std::sort(sides.begin(), sides.end());
    for (std::size_t k = 1; k < sides.size(); ++k) {
        auto const &a = sides[k - 1], &b = sides[k];
        if (a.particles != b.particles) continue;
        if (a.odd == b.odd) {
            std::string who;
            for (auto const i : a.particles) who.append(who.empty() ? "" : ", ").append(std::to_string(i));
            throw std::runtime_error("mesh: two simplices overlap: both lie on the same side of particles " + who);
        }
        mesh.neighbours[std::size_t(a.simplex)][std::size_t(a.corner)] = b.simplex;
        mesh.neighbours[std::size_t(b.simplex)][std::size_t(b.corner)] = a.simplex;
    }
}

/// Whether peel() removes a simplex that has an edge with a gap on the boundary: the particles fill it, or it is flat.
template <class Real, int Dim>
bool is_sliver(std::array<std::int32_t, std::size_t(Dim) + 1> const& s, points_view<Real, Dim> points,
               Real const* radii) {
    if (simplex_void(s, points, radii) <= Real(0)) return true;
    if constexpr (Dim == 3) {
        Real largest(0), least = radii[std::size_t(s[0])];
        for (std::size_t c = 0; c < s.size(); ++c) {
            auto const side = side_of(s, c);
            largest = max(largest, triangle_area(points[std::size_t(side[0])], points[std::size_t(side[1])],
                                                 points[std::size_t(side[2])]));
            least = min(least, radii[std::size_t(s[c])]);
        }
        return Real(9) * simplex_size(s, points) < least * largest;
    }
    return false;
}

/// Whether the cube of a length of these particles overflows or underflows in single precision, or nearly so.
template <class Real, int Dim>
bool leaves_single_range(points_view<Real, Dim> points, Real const* radii) noexcept {
    double length = 0, radius = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int axis = 0; axis < Dim; ++axis) length = std::max(length, std::fabs(double(points(i, axis))));
        radius = std::max(radius, double(radii[i]));
    }
    return length > 1e12 || radius > 1e12 || (radius > 0 && radius < 1e-10);
}

} // namespace detail

/// Total area or volume of a mesh, m^Dim.
template <class Real, int Dim>
Real mesh_size(pore_mesh<Dim> const& mesh, points_view<Real, Dim> points) {
    Real total(0);
    for (auto const& s : mesh.simplices) total += simplex_size(s, points);
    return total;
}

/// Removes simplices at the boundary of a triangulation that are no pores of the packing. A triangulation fills the
/// convex hull: it bridges concave parts of the outline and covers straight rows with slivers. Simplices are removed
/// from outside inwards until none is left that has a boundary side with
///   - an edge longer than `cutoff`, or
///   - an edge between two particles that do not touch (gap above 1 % of r_i + r_j), if the simplex is a sliver. It is
///     one if its particles fill it (void <= 0). In space it is also one if it is lower than a third of its smallest
///     radius: four particles of one layer, nearly in a plane.
///
/// \param cutoff longest edge on the boundary, m, > 0, infinity allowed. default_cutoff() is twice the mean diameter:
///        wider than any void of a dense packing, narrower than the hole that a missing particle leaves.
/// \throws std::invalid_argument for a cutoff that is not positive.
template <class Real, int Dim>
pore_mesh<Dim> peel(pore_mesh<Dim> const& mesh, points_view<Real, Dim> points, Real const* radii, Real cutoff) {
    if (!(cutoff > Real(0))) refuse("cutoff", double(cutoff), "> 0");
    if constexpr (!std::is_same_v<Real, double>)
        if (detail::leaves_single_range(points, radii)) {
            std::vector<vec<double, Dim>> x(points.size());
            for (std::size_t i = 0; i < x.size(); ++i)
                for (int axis = 0; axis < Dim; ++axis) x[i][axis] = double(points(i, axis));
            std::vector<double> const r(radii, radii + x.size());
            return peel(mesh, view_points(x), r.data(), double(cutoff));
        }
    constexpr auto corners = std::size_t(Dim) + 1;
    std::vector<std::uint8_t> removed(mesh.size(), 0);
    auto const outside = [&](std::size_t s, std::size_t corner) {
        auto const side = detail::side_of(mesh.simplices[s], corner);
        bool has_gap = false;
        for (std::size_t a = 0; a < side.size(); ++a)
            for (std::size_t b = a + 1; b < side.size(); ++b) {
                auto const i = std::size_t(side[a]), j = std::size_t(side[b]);
                Real const length = norm(points[j] - points[i]);
                if (length > cutoff) return true;
                has_gap = has_gap || length > Real(1.01) * (radii[i] + radii[j]);
            }
        return has_gap && detail::is_sliver(mesh.simplices[s], points, radii);
    };
    std::vector<std::size_t> front;
    auto const look = [&](std::size_t s) {
        if (removed[s]) return;
        for (std::size_t c = 0; c < corners; ++c) {
            auto const other = mesh.neighbours[s][c];
            if ((other < 0 || removed[std::size_t(other)]) && outside(s, c)) {
                removed[s] = 1;
                front.push_back(s);
                return;
            }
        }
    };
    for (std::size_t s = 0; s < mesh.size(); ++s) look(s);
    while (!front.empty()) {
        auto const s = front.back();
        front.pop_back();
        for (auto const other : mesh.neighbours[s])
            if (other >= 0) look(std::size_t(other));
    }
    pore_mesh<Dim> peeled;
    for (std::size_t s = 0; s < mesh.size(); ++s)
        if (!removed[s]) peeled.simplices.push_back(mesh.simplices[s]);
    detail::connect(peeled);
    return peeled;
}

/// Twice the mean diameter of the particles, m; infinity if all radii are 0.
template <class Real>
Real default_cutoff(Real const* radii, std::size_t count) noexcept {
    Real sum(0);
    for (std::size_t i = 0; i < count; ++i) sum += radii[i];
    return sum > Real(0) ? Real(4) * sum / Real(count) : std::numeric_limits<Real>::infinity();
}

} // namespace lacuna
