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
#include <lacuna/pores/mesh/close_groups.hpp>
#include <lacuna/pores/mesh/incremental_triangulation.hpp>
#include <lacuna/pores/mesh/mesh.hpp>
#include <lacuna/pores/mesh/qhull.hpp>
#include <lacuna/pores/mesh/regularity.hpp>
#include <lacuna/pores/mesh/scaled_particles.hpp>

namespace lacuna {

namespace detail {

/// Whether a simplex of particles near each other has no size but for rounding.
template <int Dim>
bool is_wall(std::array<std::int32_t, std::size_t(Dim) + 1> const& corner, points_view<double, Dim> places,
             double reach) {
    double longest = 0;
    for (std::size_t a = 0; a < corner.size(); ++a)
        for (std::size_t b = a + 1; b < corner.size(); ++b)
            longest = std::max(longest, norm(places[std::size_t(corner[b])] - places[std::size_t(corner[a])]));
    return longest < weighted_sites<Dim>::longest_wall(reach) &&
           std::fabs(simplex_size<double, Dim>(corner, places)) <=
               1e-12 * (Dim == 2 ? longest * longest : longest * longest * longest);
}

/// Simplices of the lower hull of (x, |x|^2 - r^2).
/// \throws std::runtime_error when Qhull gives up, or two simplices lie on the same side of an edge or facet.
template <int Dim>
pore_mesh<Dim> lower_hull(scaled_particles<Dim> const& all) {
    constexpr auto dim = std::size_t(Dim);
    std::size_t const count = all.x.size();
    std::vector<double> lifted((dim + 1) * (count + 1));
    scaled_point<Dim> middle{};
    double top = -1e300;
    for (std::size_t k = 0; k < count; ++k) {
        double* const to = lifted.data() + (dim + 1) * k;
        to[dim] = all.shift(k) - all.radius[k] * all.radius[k];
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
        if (is_wall<Dim>(corner, places, all.reach)) continue;
        if (simplex_size<double, Dim>(corner, places) < 0) std::swap(corner[0], corner[1]);
        for (auto& c : corner) c = all.particle[std::size_t(c)];
        mesh.simplices.push_back(corner);
    }
    connect(mesh);
    return mesh;
}

/// Takes away what has no size but for rounding, from outside: simplices over a straight side of the hull.
template <int Dim>
void strip_walls(pore_mesh<Dim>& mesh, points_view<double, Dim> places, double reach) {
    std::vector<std::uint8_t> gone(mesh.size(), 0);
    std::vector<std::size_t> front;
    auto const look = [&](std::size_t s) {
        bool outer = false;
        for (auto const other : mesh.neighbours[s]) outer = outer || other < 0 || gone[std::size_t(other)];
        if (gone[s] || !outer || !is_wall(mesh.simplices[s], places, reach)) return;
        gone[s] = 1;
        front.push_back(s);
    };
    for (std::size_t s = 0; s < mesh.size(); ++s) look(s);
    while (!front.empty()) {
        auto const s = front.back();
        front.pop_back();
        for (auto const other : mesh.neighbours[s])
            if (other >= 0) look(std::size_t(other));
    }
    std::size_t kept = 0;
    for (std::size_t s = 0; s < mesh.size(); ++s)
        if (!gone[s]) mesh.simplices[kept++] = mesh.simplices[s];
    mesh.simplices.resize(kept);
}

/// The same simplices as lower_hull(), by exact signs.
template <int Dim>
pore_mesh<Dim> exact_hull(scaled_particles<Dim> const& all, weighted_sites<Dim> const& sites) {
    pore_mesh<Dim> mesh;
    mesh.simplices = incremental_triangulation<Dim>(sites).simplices();
    connect(mesh);
    strip_walls(mesh, points_view<double, Dim>{sites.x.front().data(), sites.size(), std::size_t(Dim)}, sites.reach);
    for (auto& s : mesh.simplices)
        for (auto& corner : s) corner = all.particle[std::size_t(corner)];
    connect(mesh);
    return mesh;
}

/// Whether Qhull's simplices are those of a regular triangulation.
template <int Dim>
bool is_regular(pore_mesh<Dim> const& mesh, scaled_particles<Dim> const& all, weighted_sites<Dim> const& sites) {
    std::vector<std::int32_t> index(std::size_t(*std::max_element(all.particle.begin(), all.particle.end())) + 1);
    for (std::size_t k = 0; k < all.particle.size(); ++k) index[std::size_t(all.particle[k])] = std::int32_t(k);
    return regularity<Dim>(mesh, sites, index).holds();
}

/// Particles of a body that others of them are near, and their simplices.
template <int Dim>
struct body_part {
    std::vector<std::int32_t> particle;
    pore_mesh<Dim> mesh; ///< corners are particles of the whole
};

} // namespace detail

/// Regular (radius-weighted Delaunay) triangulation of discs or spheres: the lower hull of (x, |x|^2 - r^2). It covers
/// the convex hull of the centres; two particles that touch share an edge, unless a third overlaps them where they
/// meet.
///
/// A particle that is overlapped so much that its power cell is empty is a corner of no simplex; of particles at one
/// place (up to 1e-10 of the reach: the extent, but at most 64 of the largest radius) only the largest is. Fewer than
/// Dim + 1 particles, or particles on a line (in space: in a plane; up to 1e-9 of the reach), give an empty mesh. Where
/// more than Dim + 1 lie on one circle or sphere, a rule that looks at the particles' places alone decides on the
/// diagonals: in the plane Qhull's, in space heights shifted by up to 1e-7 N^(-2/3) of the squared extent, N the number
/// of particles, and at most by 6.4e-6 r^2; simplices then stay clear of the other particles up to that much. (In space
/// nearly flat tetrahedra within the body belong to a regular triangulation; they are pores of hardly any volume.)
///
/// What Qhull gives is checked (see detail::regularity). It rounds by some 1e-15 of the squared extent: where that
/// is too much, as with one particle far away or radii of very different size, the particles are triangulated by exact
/// signs instead, which takes several times as long. Thread-safe.
///
/// \param points centres, m, within 1e70 m
/// \param radii one per point, m, >= 0
/// \throws std::invalid_argument for a value that is not finite, or out of range
template <class Real, int Dim>
pore_mesh<Dim> regular_triangulation(points_view<Real, Dim> points, Real const* radii) {
    detail::require_particles(points, radii);
    if (points.size() < std::size_t(Dim) + 1) return {};
    auto const all = detail::scale_particles(points, radii);
    if (detail::lie_flat(all)) return {};

    double const squared_extent = 1 / (all.scale * all.scale);
    auto sites = detail::make_sites(all.particle, points, radii,
                                    [&](std::size_t k) { return all.shift(k) * squared_extent; });
    sites.reach = all.reach / all.scale * sites.scale;
    try {
        auto mesh = detail::lower_hull(all);
        if (detail::is_regular(mesh, all, sites)) return mesh;
    } catch (std::runtime_error const&) {
        // Qhull gives up, or its simplices overlap.
    }
    return detail::exact_hull(all, sites);
}

namespace detail {

/// The simplices of some particles, peeled.
template <class Real, int Dim>
pore_mesh<Dim> triangulate_part(std::vector<std::int32_t> const& part, points_view<Real, Dim> points, Real const* radii,
                                Real cutoff) {
    std::vector<vec<Real, Dim>> x;
    std::vector<Real> r;
    for (auto const i : part) {
        x.push_back(points[std::size_t(i)]);
        r.push_back(radii[i]);
    }
    auto mesh = peel(regular_triangulation(view_points(x), r.data()), view_points(x), r.data(), cutoff);
    for (auto& s : mesh.simplices)
        for (auto& corner : s) corner = part[std::size_t(corner)];
    return mesh;
}

/// Unites a part with the others whose particles are in the orthogonal spheres of its simplices.
/// \return whether there were any
template <class Real, int Dim>
bool unite_broken(pore_mesh<Dim> const& mesh, exact_signs<Dim> const& signs, close_groups<Real, Dim>& groups,
                  points_view<Real, Dim> points, Real const* radii, double largest_radius) {
    bool any = false;
    for (auto const& s : mesh.simplices) {
        auto const [low, high] = orthogonal_box(s, points, radii, largest_radius);
        groups.for_each_other(s[0], low, high, [&](std::int32_t p) {
            if (groups.group(p) == groups.group(s[0]) || !(signs.inside(s, p) > 0)) return;
            groups.unite(s[0], p);
            any = true;
        });
    }
    return any;
}

} // namespace detail

/// The pores' simplices of a body: regular_triangulation(), then peel() with the given or the default cutoff.
///
/// Particles farther from all others than eight times the cutoff, and than sixteen times the largest radius, are
/// triangulated by themselves: no number of theirs enters the others' triangulation. Where one of their particles is in
/// the orthogonal sphere of another's simplex, as one in the middle of a ring, the two are triangulated as one.
/// \param cutoff longest edge of the body's boundary, m; 0 for default_cutoff().
/// \throws std::invalid_argument for a value that is not finite, or out of range
template <class Real, int Dim>
pore_mesh<Dim> triangulate_body(points_view<Real, Dim> points, Real const* radii, Real cutoff = Real(0)) {
    detail::require_particles(points, radii);
    if (cutoff == Real(0)) cutoff = default_cutoff(radii, points.size());
    if (!(cutoff > Real(0))) refuse("cutoff", double(cutoff), "> 0");
    auto const whole = [&] { return peel(regular_triangulation(points, radii), points, radii, cutoff); };
    double const largest = points.size() > 0 ? double(*std::max_element(radii, radii + points.size())) : 0;
    double const reach = 8 * std::max(double(cutoff), 2 * largest);
    if (points.size() < std::size_t(Dim) + 1 || !std::isfinite(reach)) return whole();
    detail::close_groups<Real, Dim> groups(points, reach);
    auto lists = groups.list();
    if (lists.size() == 1) return whole();

    std::vector<std::int32_t> everyone(points.size());
    for (std::size_t i = 0; i < everyone.size(); ++i) everyone[i] = std::int32_t(i);
    auto const sites = detail::make_sites(everyone, points, radii, [](std::size_t) { return 0.0; });
    detail::exact_signs<Dim> const signs(sites);
    std::vector<detail::body_part<Dim>> parts;
    for (bool again = true; again; lists = groups.list()) {
        again = false;
        std::vector<detail::body_part<Dim>> next;
        auto known = parts.begin();
        for (auto& list : lists) {
            if (list.size() < std::size_t(Dim) + 1) continue;
            // Parts come in the order of their first particles, and only grow.
            while (known != parts.end() && known->particle[0] < list[0]) ++known;
            if (known != parts.end() && known->particle == list) {
                next.push_back(std::move(*known++));
                continue;
            }
            auto mesh = detail::triangulate_part(list, points, radii, cutoff);
            next.push_back({std::move(list), std::move(mesh)});
        }
        parts = std::move(next);
        for (auto const& part : parts)
            again = detail::unite_broken(part.mesh, signs, groups, points, radii, largest) || again;
    }
    pore_mesh<Dim> body;
    for (auto const& part : parts)
        body.simplices.insert(body.simplices.end(), part.mesh.simplices.begin(), part.mesh.simplices.end());
    detail::connect(body);
    return body;
}

} // namespace lacuna
