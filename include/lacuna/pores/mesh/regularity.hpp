// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <lacuna/pores/mesh/exact_signs.hpp>
#include <lacuna/pores/mesh/mesh.hpp>

namespace lacuna::detail {

/// Whether a tetrahedron of hardly any volume is flat. If two of its particles are closer to each other than 1e-3 of
/// its longest edge, it is flat only if six times its volume is at most 1e-10 of the product of the three edges at each
/// corner.
inline bool is_shaped_flat(std::array<vec<double, 3>, 4> const& x, double six_volumes) noexcept {
    double shortest = norm(x[1] - x[0]), longest = shortest, least_product = std::numeric_limits<double>::infinity();
    for (std::size_t corner = 0; corner < 4; ++corner) {
        double product = 1;
        for (std::size_t other = 0; other < 4; ++other) {
            if (other == corner) continue;
            double const edge = norm(x[other] - x[corner]);
            product *= edge;
            shortest = std::min(shortest, edge);
            longest = std::max(longest, edge);
        }
        least_product = std::min(least_product, product);
    }
    return shortest > 1e-3 * longest || std::fabs(six_volumes) <= 1e-10 * least_product;
}

/// Tests whether simplices are a regular triangulation of sites. They are if
///   - each simplex has positive orientation, and its neighbours' opposite corners lie outside its orthogonal sphere;
///   - their boundary is one convex surface. It may lack simplices of zero size up to rounding. Where it is straight,
///     the corner of the next side lies outside the orthogonal sphere too;
///   - a site that is no corner lies outside all orthogonal spheres. Testing the simplex that contains the site is
///     enough.
/// A sphere counts as empty if changing the weights by at most 1e-7 of the squared distance of the nearest two of its
/// sites would make it empty: rounding may decide between nearly equal diagonals.
template <int Dim>
class regularity {
public:
    using simplex = typename exact_signs<Dim>::simplex;

    /// \param mesh its corners are sites[index[corner]]
    regularity(pore_mesh<Dim> const& mesh, weighted_sites<Dim> const& sites, std::vector<std::int32_t> const& index)
        : sign_(sites), neighbours_(mesh.neighbours), unit_(sites.unit(sites.reach)) {
        simplices_ = mesh.simplices;
        for (auto& s : simplices_)
            for (auto& corner : s) corner = index[std::size_t(corner)];
    }

    bool holds() const {
        for (auto const& s : simplices_)
            if (!(sign_.orientation(s) > 0)) return false;
        return !simplices_.empty() && spheres_are_empty() && boundary_is_convex() && others_are_hidden();
    }

private:
    static constexpr auto dim = std::size_t(Dim);
    using point = vec<double, Dim>;
    struct ridge {
        std::array<std::int32_t, dim - 1> sites;
        std::size_t side, opposite;
        bool operator<(ridge const& o) const noexcept { return sites < o.sites; }
    };

    /// Position in units of the reach, up to a factor of 2.
    point at(std::int32_t site) const noexcept {
        point x;
        for (std::size_t a = 0; a < dim; ++a) x[int(a)] = sign_.sites().x[std::size_t(site)][a] * unit_;
        return x;
    }

    bool is_outside_sphere(simplex const& s, std::int32_t p) const {
        auto const r = sign_.read(s, p);
        double const allowed = 1e-7 * r.nearest * r.share;
        if (r.error <= allowed || std::fabs(r.inside) > r.error + allowed) return r.inside <= allowed;
        return sign_.exact_inside(s, p) <= allowed;
    }
    bool spheres_are_empty() const {
        for (std::size_t s = 0; s < simplices_.size(); ++s)
            for (auto const other : neighbours_[s]) {
                if (other < 0 || std::size_t(other) < s) continue;
                auto const& back = neighbours_[std::size_t(other)];
                auto const corner = std::size_t(std::find(back.begin(), back.end(), std::int32_t(s)) - back.begin());
                if (!is_outside_sphere(simplices_[s], simplices_[std::size_t(other)][corner])) return false;
            }
        return true;
    }

    /// Whether a simplex has zero size up to rounding: the mesh may lack it along a straight side of the hull.
    /// \param size Dim! times its size, in the units of at()
    bool is_degenerate(std::array<point, dim + 1> const& x, double size) const noexcept {
        double longest = 0;
        for (std::size_t a = 0; a <= dim; ++a)
            for (std::size_t b = a + 1; b <= dim; ++b) longest = std::max(longest, norm(x[b] - x[a]));
        bool const small = std::fabs(size) <= 1e-11 * std::pow(longest, Dim) &&
                           longest < weighted_sites<Dim>::longest_degenerate(sign_.sites().reach * unit_);
        if constexpr (Dim == 3) return small && is_shaped_flat(x, size);
        return small;
    }

    /// Sine of the angle by which the boundary bends inwards at the ridge `from`, between `side` and the next side. It
    /// is the height of that side's opposite site `to` within `side`, over the distance of `to` from the ridge. 0 if
    /// these sites span a degenerate simplex.
    double inward_sine(std::array<std::int32_t, dim> const& side, ridge const& from, std::int32_t to) const noexcept {
        double within, squares;
        auto const x = at(side[0]), away = at(to) - at(from.sites[0]);
        std::array<point, dim + 1> all;
        for (std::size_t c = 0; c < dim; ++c) all[c] = at(side[c]);
        all[dim] = at(to);
        if constexpr (Dim == 2) {
            auto const along = at(side[1]) - x;
            within = cross(along, at(to) - x);
            squares = norm(along) * norm(away);
        } else {
            auto const across = cross(at(side[1]) - x, at(side[2]) - x);
            auto const edge = at(from.sites[1]) - at(from.sites[0]);
            within = -dot(across, at(to) - x);
            squares = norm(across) * norm(cross(edge, away)) / norm(edge);
        }
        return is_degenerate(all, within) ? 0 : within / squares;
    }

    /// Whether two sides in one plane face each other: both sides of a cut into the mesh, which lacks a flat simplex.
    bool is_cut(std::array<std::int32_t, dim> const& a, std::array<std::int32_t, dim> const& b) const noexcept {
        auto const normal = [&](auto const& side) {
            return cross(at(side[1]) - at(side[0]), at(side[2]) - at(side[0]));
        };
        auto const is_wide = [&](auto const& side) {
            double longest = 0;
            for (std::size_t c = 0; c < dim; ++c)
                longest = std::max(longest, norm(at(side[(c + 1) % dim]) - at(side[c])));
            return norm(normal(side)) > 1e-3 * longest * longest;
        };
        return dot(normal(a), normal(b)) < 0 && is_wide(a) && is_wide(b);
    }

    bool boundary_is_convex() const {
        std::vector<std::array<std::int32_t, dim>> sides;
        std::vector<std::size_t> owner; // simplex of each side
        std::vector<ridge> ridges;
        for (std::size_t s = 0; s < simplices_.size(); ++s)
            for (std::size_t c = 0; c <= dim; ++c)
                if (neighbours_[s][c] < 0) {
                    sides.push_back(side_of(simplices_[s], c));
                    owner.push_back(s);
                }
        for (std::size_t f = 0; f < sides.size(); ++f)
            for (std::size_t c = 0; c < dim; ++c) {
                ridge one{{}, f, c};
                for (std::size_t k = 0; k + 1 < dim; ++k) one.sites[k] = sides[f][k < c ? k : k + 1];
                sort_corners(one.sites);
                ridges.push_back(one);
            }
        std::sort(ridges.begin(), ridges.end());
        std::vector<std::size_t> root(sides.size());
        for (std::size_t f = 0; f < sides.size(); ++f) root[f] = f;
        auto const find = [&](std::size_t f) {
            while (root[f] != f) f = root[f] = root[root[f]];
            return f;
        };
        std::size_t surfaces = sides.size();
        double total_angle = 0;
        for (std::size_t k = 0; k < ridges.size(); k += 2) {
            if (k + 1 == ridges.size() || ridges[k].sites != ridges[k + 1].sites) return false;
            if (k + 2 < ridges.size() && ridges[k].sites == ridges[k + 2].sites) return false;
            auto const &a = ridges[k], &b = ridges[k + 1];
            double const sine = inward_sine(sides[a.side], a, sides[b.side][b.opposite]);
            if (!(sine >= -1e-10)) return false;
            if constexpr (Dim == 3)
                if (sine < 1e-10 && is_cut(sides[a.side], sides[b.side])) return false;
            if (sine < 1e-10 && !(is_outside_sphere(simplices_[owner[a.side]], sides[b.side][b.opposite]) &&
                                  is_outside_sphere(simplices_[owner[b.side]], sides[a.side][a.opposite])))
                return false;
            if constexpr (Dim == 2) total_angle += angle_between(sides[a.side], sides[b.side], sine);
            auto const one = find(a.side), other = find(b.side);
            surfaces -= one != other;
            root[one] = other;
        }
        return surfaces == 1 && total_angle < 7;
    }
    /// Angle from one side to the next in the plane, rad. These angles sum to 2 pi if the boundary goes round once.
    double angle_between(std::array<std::int32_t, dim> const& a, std::array<std::int32_t, dim> const& b,
                         double sine) const noexcept {
        return std::atan2(sine, dot(at(a[1]) - at(a[0]), at(b[1]) - at(b[0])) /
                                    (norm(at(a[1]) - at(a[0])) * norm(at(b[1]) - at(b[0]))));
    }

    bool others_are_hidden() const {
        std::vector<std::uint8_t> seen(sign_.sites().size(), 0);
        for (auto const& s : simplices_)
            for (auto const corner : s) seen[std::size_t(corner)] = 1;
        std::size_t t = 0;
        for (std::size_t p = 0; p < seen.size(); ++p)
            if (!seen[p] && !is_hidden(std::int32_t(p), t)) return false;
        return true;
    }
    /// Whether a site beyond a side of the hull is so by rounding only.
    /// \param s corner c is the site, the others those of the side
    bool is_on_hull(simplex const& s, [[maybe_unused]] std::size_t c) const noexcept {
        std::array<point, dim + 1> x;
        for (std::size_t k = 0; k <= dim; ++k) x[k] = at(s[k]);
        std::array<std::array<double, dim>, dim> m;
        for (std::size_t k = 0; k < dim; ++k)
            for (std::size_t a = 0; a < dim; ++a) m[k][a] = x[k + 1][int(a)] - x[0][int(a)];
        double const size = determinant(m);
        if constexpr (Dim == 2) {
            // The next side may be short, and not hide the site.
            auto const &from = x[(c + 1) % 3], &to = x[(c + 2) % 3];
            double const nearest = std::min(norm(x[c] - from), norm(x[c] - to));
            if (std::fabs(size) > 1e-10 * norm(to - from) * nearest) return false;
        }
        return is_degenerate(x, size);
    }
    /// \param t simplex at which the search begins; becomes the one at which it ends
    bool is_hidden(std::int32_t p, std::size_t& t) const {
        for (std::size_t steps = 0; steps <= simplices_.size(); ++steps) {
            std::int32_t next = -1;
            bool inside = true;
            for (std::size_t c = 0; c <= dim && inside; ++c) {
                auto replaced = simplices_[t];
                replaced[c] = p;
                double const size = sign_.orientation(replaced);
                if (size >= 0) continue;
                next = neighbours_[t][c];
                if (next < 0 && is_on_hull(replaced, c)) continue;
                inside = false;
            }
            if (inside) return is_outside_sphere(simplices_[t], p);
            if (next < 0) return false;
            t = std::size_t(next);
        }
        return false;
    }

    exact_signs<Dim> sign_;
    std::vector<simplex> simplices_;
    std::vector<simplex> const& neighbours_;
    double unit_;
};

} // namespace lacuna::detail
