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

/// Whether a simplex of particles that are near each other has zero size up to rounding.
/// \param reach scaled_particles::reach, in units of `points`
template <int Dim>
bool is_degenerate(std::array<std::int32_t, std::size_t(Dim) + 1> const& corner, points_view<double, Dim> points,
             double reach) {
    double const unit = weighted_sites<Dim>::unit(reach);
    auto const edge = [&](std::size_t from, std::size_t to) {
        return (points[std::size_t(corner[to])] - points[std::size_t(corner[from])]) * unit;
    };
    double longest = 0;
    for (std::size_t a = 0; a < corner.size(); ++a)
        for (std::size_t b = a + 1; b < corner.size(); ++b) longest = std::max(longest, norm(edge(a, b)));
    if (!(longest < weighted_sites<Dim>::longest_degenerate(reach * unit))) return false;
    if constexpr (Dim == 2) {
        return std::fabs(triangle_area({}, edge(0, 1), edge(0, 2))) <= 1e-12 * (longest * longest);
    } else {
        double const size = tetrahedron_volume({}, edge(0, 1), edge(0, 2), edge(0, 3));
        return std::fabs(size) <= 1e-12 * (longest * longest * longest) &&
               is_shaped_flat({vec<double, 3>{}, edge(0, 1), edge(0, 2), edge(0, 3)}, 6 * size);
    }
}

/// Simplices of the lower hull of (x, |x|^2 - r^2), computed by Qhull.
/// \throws std::runtime_error when Qhull fails, or two simplices lie on the same side of an edge or facet.
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
    // One more point, high above the middle, closes the hull from above. Without it points on one circle (in space: on
    // one sphere) would lie in a plane and have no hull.
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
        points_view<double, Dim> const points{all.x.front().data(), count, dim};
        if (is_degenerate<Dim>(corner, points, all.reach)) continue;
        if (simplex_size<double, Dim>(corner, points) < 0) std::swap(corner[0], corner[1]);
        for (auto& c : corner) c = all.particle[std::size_t(c)];
        mesh.simplices.push_back(corner);
    }
    connect(mesh);
    return mesh;
}

/// Whether a degenerate simplex lies flat over its side opposite a corner. A needle between two close particles and
/// distant ones does not lie flat over its short side: without it the boundary would have a cut. In the plane the sines
/// of both angles at the side are within 1e-9. In space, if two of the particles are closer to each other than 1e-3 of
/// the longest edge, the height is within 1e-4 of it.
/// \param unit weighted_sites::unit()
template <int Dim>
bool is_flat_over(std::array<std::int32_t, std::size_t(Dim) + 1> const& s, std::size_t corner,
                  points_view<double, Dim> points, double unit) {
    auto const side = side_of(s, corner);
    auto const x = [&](std::size_t c) { return points[std::size_t(side[c])] * unit; };
    vec<double, Dim> const top = points[std::size_t(s[corner])] * unit, to = top - x(0);
    if constexpr (Dim == 2) {
        auto const along = x(1) - x(0);
        double const nearest = std::min(norm(to), norm(top - x(1)));
        return !(std::fabs(cross(along, to)) / norm(along) > 1e-9 * nearest);
    } else {
        auto const across = cross(x(1) - x(0), x(2) - x(0));
        auto const edges = {norm(x(1) - x(0)), norm(x(2) - x(0)), norm(x(2) - x(1)), norm(to)};
        double const longest = std::max(edges);
        return std::min(edges) > 1e-3 * longest || !(std::fabs(dot(across, to)) / norm(across) > 1e-4 * longest);
    }
}

/// Removes, from outside inwards, simplices of zero size up to rounding that lie flat over straight sides of the hull.
template <int Dim>
void strip_degenerate(pore_mesh<Dim>& mesh, points_view<double, Dim> points, double reach) {
    std::vector<std::uint8_t> removed(mesh.size(), 0);
    std::vector<std::size_t> front;
    auto const look = [&](std::size_t s) {
        if (removed[s]) return;
        bool outer = false, flat = true;
        for (std::size_t c = 0; c <= std::size_t(Dim); ++c) {
            auto const other = mesh.neighbours[s][c];
            if (other >= 0 && !removed[std::size_t(other)]) continue;
            outer = true;
            flat = flat && is_flat_over<Dim>(mesh.simplices[s], c, points, weighted_sites<Dim>::unit(reach));
        }
        if (!outer || !flat || !is_degenerate(mesh.simplices[s], points, reach)) return;
        removed[s] = 1;
        front.push_back(s);
    };
    for (std::size_t s = 0; s < mesh.size(); ++s) look(s);
    while (!front.empty()) {
        auto const s = front.back();
        front.pop_back();
        for (auto const other : mesh.neighbours[s])
            if (other >= 0) look(std::size_t(other));
    }
    std::size_t count = 0;
    for (std::size_t s = 0; s < mesh.size(); ++s)
        if (!removed[s]) mesh.simplices[count++] = mesh.simplices[s];
    mesh.simplices.resize(count);
}

/// The same simplices as lower_hull(), computed with exact signs.
template <int Dim>
pore_mesh<Dim> exact_hull(scaled_particles<Dim> const& all, weighted_sites<Dim> const& sites) {
    pore_mesh<Dim> mesh;
    mesh.simplices = incremental_triangulation<Dim>(sites).simplices();
    connect(mesh);
    points_view<double, Dim> const points{sites.x.front().data(), sites.size(), std::size_t(Dim)};
    strip_degenerate(mesh, points, sites.reach);
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

/// A group of particles that is triangulated by itself, and its simplices.
template <int Dim>
struct mesh_part {
    std::vector<std::int32_t> particle; ///< in ascending order
    pore_mesh<Dim> mesh;                ///< corners are numbered as in the whole packing
};

} // namespace detail

/// Regular (radius-weighted Delaunay) triangulation of discs or spheres: the lower hull of (x, |x|^2 - r^2). It covers
/// the convex hull of the centres. Two particles that touch share an edge, unless a third overlaps their contact.
///
/// The reach below is the extent of the packing, but at most 64 times the largest radius.
///   - A particle is a corner of no simplex if others overlap it so much that its power cell is empty.
///   - If the centres of several particles coincide (up to 1e-10 of the reach), only the largest becomes a corner.
///   - A simplex of zero size up to rounding, along a straight side of the hull, is left out.
///   - A coordinate or radius under 1e-290 m counts as 0.
///   - Fewer than Dim + 1 particles give an empty mesh. So do particles on a line (in space: in a plane), up to 1e-9 of
///     the reach.
///   - If more than Dim + 1 particles lie on one circle or sphere, the choice of diagonals depends on the positions
///     alone. In the plane Qhull chooses. In space heights are shifted by up to 1e-7 N^(-2/3) of the squared extent
///     (N: number of particles), and at most by 6.4e-6 r^2 (if r = 0: of the largest r, unless all are 0). Orthogonal
///     spheres are empty of other particles up to that.
///   - In space a regular triangulation may contain nearly flat tetrahedra in the interior: pores of hardly any volume.
///
/// Qhull's result is checked (see detail::regularity), since Qhull rounds by some 1e-15 of the squared extent. That is
/// too much for a particle far away from the others, or for radii of very different size. In such cases exact signs
/// repeat the triangulation, which takes several times as long. Thread-safe.
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

    auto const sites = detail::make_sites(all, points, radii);
    try {
        auto mesh = detail::lower_hull(all);
        if (detail::is_regular(mesh, all, sites)) return mesh;
    } catch (std::runtime_error const&) {
        // Qhull failed, or its simplices overlap: exact signs handle both.
    }
    return detail::exact_hull(all, sites);
}

namespace detail {

/// Triangulates some of the particles by themselves and peels the result. Corners are numbered as in the whole packing.
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

/// Unites a part with each group that has a particle inside the orthogonal sphere of one of the part's simplices.
/// \return whether any group was united
template <class Real, int Dim>
bool unite_overlapping(pore_mesh<Dim> const& mesh, exact_signs<Dim> const& signs, close_groups<Real, Dim>& groups,
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

/// The simplices that become pores: regular_triangulation(), then peel() with the given or the default cutoff.
///
/// A group of particles is triangulated by itself if its distance from all others exceeds both eight times the cutoff
/// and sixteen times the largest radius. Its coordinates then do not affect the triangulation of the others. Two groups
/// are triangulated together if a particle of one is inside the orthogonal sphere of a simplex of the other, such as a
/// particle in the middle of a ring.
/// \param points centres, m; \param radii one per point, m, >= 0
/// \param cutoff longest edge on the boundary of the mesh, m; 0 for default_cutoff().
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

    std::vector<std::int32_t> all_particles(points.size());
    for (std::size_t i = 0; i < all_particles.size(); ++i) all_particles[i] = std::int32_t(i);
    auto const sites = detail::make_sites(all_particles, points, radii);
    detail::exact_signs<Dim> const signs(sites);
    std::vector<detail::mesh_part<Dim>> parts;
    for (bool again = true; again; lists = groups.list()) {
        again = false;
        std::vector<detail::mesh_part<Dim>> next;
        auto known = parts.begin();
        for (auto& list : lists) {
            if (list.size() < std::size_t(Dim) + 1) continue;
            // Both lists are sorted by first particle, and a part only ever grows: an unchanged one is reused.
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
            again = detail::unite_overlapping(part.mesh, signs, groups, points, radii, largest) || again;
    }
    pore_mesh<Dim> mesh;
    for (auto const& part : parts)
        mesh.simplices.insert(mesh.simplices.end(), part.mesh.simplices.begin(), part.mesh.simplices.end());
    detail::connect(mesh);
    return mesh;
}

} // namespace lacuna
