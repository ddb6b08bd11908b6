// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh.hpp>
#include <lacuna/pores/qhull.hpp>

namespace lacuna {

namespace detail {

/// Coordinates of a point in the scaled frame of a triangulation.
template <int Dim>
using scaled_point = std::array<double, std::size_t(Dim)>;

/// Orders points along a slanted line: along an axis, rounding would decide on the order of a row.
template <int Dim>
double along(scaled_point<Dim> const& x) noexcept {
    double sum = x[0] + 0.6180339887498949 * x[1];
    if constexpr (Dim == 3) sum += 0.3819660112501051 * x[2];
    return sum;
}

/// Distinct particles of a triangulation, moved and scaled to fit into a box of side 1 around the origin.
template <int Dim>
struct scaled_particles {
    std::vector<std::int32_t> particle; ///< their numbers
    std::vector<scaled_point<Dim>> x;   ///< their centres, sorted by along()
    std::vector<double> radius;
};

/// How far the points are from lying on one line (in space: in one plane): the height, over the extent, of the largest
/// simplex that choosing the farthest point time after time gives.
template <int Dim>
double flatness(std::vector<scaled_point<Dim>> const& points) {
    std::vector<scaled_point<Dim>> rest(points);
    for (auto& x : rest)
        for (std::size_t axis = 0; axis < std::size_t(Dim); ++axis) x[axis] -= points[0][axis];
    double height = 0;
    for (int direction = 0; direction < Dim; ++direction) {
        auto const squared = [](auto const& x) {
            double sum = 0;
            for (double const c : x) sum += c * c;
            return sum;
        };
        auto const far = *std::max_element(rest.begin(), rest.end(),
                                           [&](auto const& a, auto const& b) { return squared(a) < squared(b); });
        height = std::sqrt(squared(far));
        if (!(height > 0)) return 0;
        for (auto& x : rest) {
            double share = 0;
            for (std::size_t axis = 0; axis < std::size_t(Dim); ++axis) share += x[axis] * far[axis] / height / height;
            for (std::size_t axis = 0; axis < std::size_t(Dim); ++axis) x[axis] -= share * far[axis];
        }
    }
    return height;
}

/// Small numbers in no order, from -1 to 1, one for each k.
inline double scatter(std::uint64_t k) noexcept {
    k = (k + 1) * 0x9e3779b97f4a7c15;
    k = (k ^ (k >> 30)) * 0xbf58476d1ce4e5b9;
    k = (k ^ (k >> 27)) * 0x94d049bb133111eb;
    return double((k ^ (k >> 31)) >> 11) * 0x1p-52 - 1;
}

/// Simplices of the lower hull of (x, |x|^2 - r^2).
/// \throws std::runtime_error when Qhull gives up, or two simplices lie on the same side of an edge or facet.
template <int Dim>
pore_mesh<Dim> lower_hull(scaled_particles<Dim> const& all) {
    constexpr auto dim = std::size_t(Dim);
    std::size_t const count = all.x.size();
    std::vector<coordT> lifted((dim + 1) * (count + 1));
    scaled_point<Dim> middle{};
    double top = -1e300;
    // In space Qhull cuts up more than four points on one sphere in a way that leaves flat tetrahedra between the
    // others. Heights in general position have no such points.
    double const nudge = Dim == 3 ? 1e-7 * std::pow(double(count), -2.0 / 3.0) : 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        coordT* const to = lifted.data() + (dim + 1) * k;
        to[dim] = nudge * scatter(k) - all.radius[k] * all.radius[k];
        for (std::size_t axis = 0; axis < dim; ++axis) {
            double const x = all.x[k][axis];
            to[axis] = x;
            to[dim] += x * x;
            middle[axis] += x / double(count);
        }
        top = std::max(top, to[dim]);
    }
    // One more point, high above the middle, closes the hull from above: without it a few points on one circle
    // would have no volume at all.
    std::copy(middle.begin(), middle.end(), lifted.begin() + std::ptrdiff_t((dim + 1) * count));
    lifted[(dim + 1) * count + dim] = top + 1;

    convex_hull hull(Dim + 1, lifted);
    qhT* const qh = hull.get();
    pore_mesh<Dim> mesh;
    for (facetT* facet = qh->facet_list; facet && facet->next; facet = facet->next) {
        if (facet->normal[Dim] >= 0 || qh_setsize(qh, facet->vertices) != Dim + 1) continue;
        typename pore_mesh<Dim>::simplex corner;
        for (std::size_t c = 0; c <= dim; ++c)
            corner[c] = std::int32_t(qh_pointid(qh, static_cast<vertexT*>(facet->vertices->e[c].p)->point));
        if (*std::max_element(corner.begin(), corner.end()) == std::int32_t(count)) continue;
        points_view<double, Dim> const places{all.x.front().data(), count, dim};
        double const size = simplex_size<double, Dim>(corner, places);
        double longest = 0;
        for (std::size_t a = 0; a <= dim; ++a)
            for (std::size_t b = a + 1; b <= dim; ++b)
                longest = std::max(longest, norm(places[std::size_t(corner[b])] - places[std::size_t(corner[a])]));
        // Walls of the hull over a straight side of the body have no size but for rounding.
        if (std::fabs(size) <= 1e-12 * (Dim == 2 ? longest * longest : longest * longest * longest)) continue;
        if (size < 0) std::swap(corner[0], corner[1]);
        for (auto& c : corner) c = all.particle[std::size_t(c)];
        mesh.simplices.push_back(corner);
    }
    connect(mesh);
    return mesh;
}

/// The particles that a triangulation sees: of those at one place (up to 1e-10 of the extent) the largest alone.
template <class Real, int Dim>
scaled_particles<Dim> scale_particles(points_view<Real, Dim> points, Real const* radii) {
    constexpr auto dim = std::size_t(Dim);
    scaled_point<Dim> middle{};
    double extent = 0;
    for (std::size_t axis = 0; axis < dim; ++axis) {
        double low = double(points(0, int(axis))), high = low;
        for (std::size_t i = 0; i < points.size(); ++i) {
            low = std::min(low, double(points(i, int(axis))));
            high = std::max(high, double(points(i, int(axis))));
        }
        middle[axis] = low / 2 + high / 2;
        extent = std::max(extent, high - low);
    }
    double const scale = extent > 0 ? 1 / extent : 0;
    auto const place = [&](std::int32_t i) {
        scaled_point<Dim> x;
        for (std::size_t axis = 0; axis < dim; ++axis)
            x[axis] = (double(points(std::size_t(i), int(axis))) - middle[axis]) * scale;
        return x;
    };

    std::vector<std::pair<double, std::int32_t>> order;
    for (std::int32_t i = 0; i < std::int32_t(points.size()); ++i) order.push_back({along<Dim>(place(i)), i});
    std::sort(order.begin(), order.end());
    scaled_particles<Dim> all;
    double const same = 1e-10;
    for (auto const& [key, i] : order) {
        auto const x = place(i);
        double const radius = double(radii[i]) * scale;
        bool fresh = true;
        for (std::size_t k = all.x.size(); fresh && k-- > 0 && key - along<Dim>(all.x[k]) <= 2 * same;) {
            double apart = 0;
            for (std::size_t axis = 0; axis < dim; ++axis) apart = std::max(apart, std::fabs(x[axis] - all.x[k][axis]));
            if (apart > same) continue;
            fresh = false;
            if (radius > all.radius[k]) {
                all.particle[k] = i;
                all.radius[k] = radius;
            }
        }
        if (!fresh) continue;
        all.particle.push_back(i);
        all.x.push_back(x);
        all.radius.push_back(radius);
    }
    return all;
}

/// Size of the simplices, and of the convex hull, in the scaled frame.
template <int Dim>
std::array<double, 2> filled_size(pore_mesh<Dim> const& mesh, scaled_particles<Dim> const& all) {
    auto const most = *std::max_element(all.particle.begin(), all.particle.end());
    std::vector<scaled_point<Dim>> place(std::size_t(most) + 1);
    std::vector<coordT> flat;
    for (std::size_t k = 0; k < all.x.size(); ++k) {
        place[std::size_t(all.particle[k])] = all.x[k];
        flat.insert(flat.end(), all.x[k].begin(), all.x[k].end());
    }
    return {mesh_size(mesh, points_view<double, Dim>{place.front().data(), place.size(), std::size_t(Dim)}),
            convex_hull(Dim, flat).size()};
}

} // namespace detail

/// Regular (radius-weighted Delaunay) triangulation of discs or spheres: the lower hull of (x, |x|^2 - r^2). It covers
/// the convex hull of the centres; two particles that touch share an edge, unless a third overlaps them where they
/// meet.
///
/// A particle that is overlapped so much that its power cell is empty is a corner of no simplex; of particles at one
/// place (up to 1e-10 of the extent) only the largest is. Fewer than Dim + 1 particles, or particles on a line (in
/// space: in a plane; up to 1e-9 of their extent), give an empty mesh. Where more than Dim + 1 lie on one circle or
/// sphere, a rule that looks at the particles' places alone decides on the diagonals: in the plane Qhull's, in space
/// heights shifted by up to 1e-7 N^(-2/3) of the squared extent, N the number of particles; simplices then stay clear
/// of the other particles up to that much. (In space nearly flat tetrahedra within the body belong to a regular
/// triangulation; they are pores of hardly any volume.) Thread-safe.
///
/// \param points centres, m
/// \param radii one per point, m, >= 0
/// \throws std::invalid_argument for a value that is not finite, or a negative radius;
///         std::runtime_error when Qhull fails, or its simplices do not fill the convex hull exactly once.
template <class Real, int Dim>
pore_mesh<Dim> regular_triangulation(points_view<Real, Dim> points, Real const* radii) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int axis = 0; axis < Dim; ++axis)
            require_finite("position of particle " + std::to_string(i), double(points(i, axis)));
        require_not_negative("radius of particle " + std::to_string(i), double(radii[i]));
    }
    if (points.size() < std::size_t(Dim) + 1) return {};
    auto const all = detail::scale_particles(points, radii);
    if (all.x.size() < std::size_t(Dim) + 1 || detail::flatness<Dim>(all.x) < 1e-9) return {};

    auto mesh = detail::lower_hull(all);
    auto const [filled, hull] = detail::filled_size(mesh, all);
    if (std::fabs(filled - hull) > 1e-9 * hull)
        throw std::runtime_error("triangulation: the simplices fill " + to_text(filled / hull) +
                                 " of the convex hull of the particles");
    return mesh;
}

/// The pores' simplices of a body: regular_triangulation(), then peel() with the given or the default cutoff.
/// \param cutoff longest edge of the body's boundary, m; 0 for default_cutoff().
template <class Real, int Dim>
pore_mesh<Dim> triangulate_body(points_view<Real, Dim> points, Real const* radii, Real cutoff = Real(0)) {
    auto const mesh = regular_triangulation(points, radii);
    return peel(mesh, points, radii, cutoff == Real(0) ? default_cutoff(radii, points.size()) : cutoff);
}

} // namespace lacuna
