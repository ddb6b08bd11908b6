// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

extern "C" {
#include <libqhull_r/libqhull_r.h>
}
// Qhull's header leaves these two words behind as macros.
#undef True
#undef False

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh.hpp>

/// \file
/// The only header that knows Qhull; a program that includes it links qhull_r.

namespace lacuna {

namespace detail {

/// A place for Qhull's messages: it would write to stderr otherwise.
class message_file {
public:
    message_file() {
#if defined(__unix__) || defined(__APPLE__)
        file_ = open_memstream(&text_, &size_);
#else
        file_ = std::tmpfile();
#endif
        if (!file_) throw std::runtime_error("triangulation: no memory for the messages of Qhull");
    }
    message_file(message_file const&) = delete;
    message_file& operator=(message_file const&) = delete;
    ~message_file() {
        std::fclose(file_);
        std::free(text_);
    }
    std::FILE* file() const noexcept { return file_; }
    std::string first_line() const {
        std::fflush(file_);
        std::string const all = text_ ? std::string(text_, size_) : std::string();
        auto const first = all.find_first_not_of("\n ");
        return first == std::string::npos ? "" : all.substr(first, all.find('\n', first) - first);
    }

private:
    std::FILE* file_ = nullptr;
    char* text_ = nullptr;
    std::size_t size_ = 0;
};

struct qhull_memory {
    qhT state;
    explicit qhull_memory(std::FILE* errors) { qh_zero(&state, errors); }
    qhull_memory(qhull_memory const&) = delete;
    qhull_memory& operator=(qhull_memory const&) = delete;
    ~qhull_memory() {
        int current = 0, total = 0;
        qh_freeqhull(&state, 0);
        qh_memfreeshort(&state, &current, &total);
    }
};

/// Orders points along a slanted line: along an axis, rounding would decide on the order of an upright row.
inline double along(std::array<double, 2> const& x) { return x[0] + 0.6180339887498949 * x[1]; }

/// Area of the convex hull of points that are sorted by along().
inline double hull_area(std::vector<std::array<double, 2>> const& points) {
    std::vector<std::array<double, 2>> hull;
    auto const chain = [&](auto first, auto last) {
        std::size_t const base = hull.size();
        for (; first != last; ++first) {
            while (hull.size() >= base + 2) {
                auto const &a = hull[hull.size() - 2], &b = hull.back(), &c = *first;
                if ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0) break;
                hull.pop_back();
            }
            hull.push_back(*first);
        }
        hull.pop_back();
    };
    chain(points.begin(), points.end());
    chain(points.rbegin(), points.rend());
    double twice = 0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
        auto const &a = hull[k], &b = hull[(k + 1) % hull.size()];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return twice / 2;
}

/// Distinct particles of a triangulation, moved and scaled to fit into a box of side 1 around the origin.
struct scaled_discs {
    std::vector<std::int32_t> particle;   ///< their numbers
    std::vector<std::array<double, 2>> x; ///< their centres, sorted by along()
    std::vector<double> radius;
};

/// Triangles of the lower hull of (x, |x|^2 - r^2).
/// \throws std::runtime_error when Qhull gives up, or two triangles lie on the same side of an edge.
inline pore_mesh<2> lower_hull(scaled_discs const& discs) {
    std::size_t const count = discs.x.size();
    std::vector<coordT> lifted(3 * (count + 1));
    double middle[2] = {0, 0}, top = -1e300;
    for (std::size_t k = 0; k < count; ++k) {
        auto const& x = discs.x[k];
        lifted[3 * k] = x[0];
        lifted[3 * k + 1] = x[1];
        lifted[3 * k + 2] = x[0] * x[0] + x[1] * x[1] - discs.radius[k] * discs.radius[k];
        top = std::max(top, lifted[3 * k + 2]);
        for (int axis = 0; axis < 2; ++axis) middle[axis] += x[std::size_t(axis)] / double(count);
    }
    // One more point, high above the middle, closes the hull from above: without it a few points on one circle
    // would have no volume at all.
    lifted[3 * count] = middle[0];
    lifted[3 * count + 1] = middle[1];
    lifted[3 * count + 2] = top + 1;

    message_file messages;
    qhull_memory memory(messages.file());
    qhT* const qh = &memory.state;
    char command[] = "qhull Qt";
    if (qh_new_qhull(qh, 3, int(count + 1), lifted.data(), 0, command, nullptr, messages.file()) != 0)
        throw std::runtime_error("triangulation: " + messages.first_line());
    pore_mesh<2> mesh;
    for (facetT* facet = qh->facet_list; facet && facet->next; facet = facet->next) {
        if (facet->normal[2] >= 0 || qh_setsize(qh, facet->vertices) != 3) continue;
        std::size_t corner[3];
        for (int c = 0; c < 3; ++c)
            corner[c] = std::size_t(qh_pointid(qh, static_cast<vertexT*>(facet->vertices->e[c].p)->point));
        if (std::max({corner[0], corner[1], corner[2]}) == count) continue;
        auto const edge = [&](int a, int b) {
            auto const &from = discs.x[corner[a]], &to = discs.x[corner[b]];
            return vec<double, 2>{to[0] - from[0], to[1] - from[1]};
        };
        auto const ab = edge(0, 1), ac = edge(0, 2);
        double const area = cross(ab, ac) / 2;
        double const longest = std::max({squared_norm(ab), squared_norm(ac), squared_norm(edge(1, 2))});
        // Walls of the hull over a straight side of the body have no area but for rounding.
        if (std::fabs(area) <= 1e-12 * longest) continue;
        if (area < 0) std::swap(corner[1], corner[2]);
        mesh.simplices.push_back({discs.particle[corner[0]], discs.particle[corner[1]], discs.particle[corner[2]]});
    }
    connect(mesh);
    return mesh;
}

/// The particles that a triangulation sees: of those at one place (up to 1e-10 of the extent) the largest alone.
template <class Real>
scaled_discs scale_discs(points_view<Real, 2> points, Real const* radii) {
    double low[2], extent = 0, middle[2];
    for (int axis = 0; axis < 2; ++axis) {
        low[axis] = double(points(0, axis));
        double high = low[axis];
        for (std::size_t i = 0; i < points.size(); ++i) {
            low[axis] = std::min(low[axis], double(points(i, axis)));
            high = std::max(high, double(points(i, axis)));
        }
        middle[axis] = low[axis] / 2 + high / 2;
        extent = std::max(extent, high - low[axis]);
    }
    double const scale = extent > 0 ? 1 / extent : 0;
    auto const place = [&](std::int32_t i) {
        auto const k = std::size_t(i);
        return std::array{(double(points(k, 0)) - middle[0]) * scale, (double(points(k, 1)) - middle[1]) * scale};
    };

    std::vector<std::pair<double, std::int32_t>> order;
    for (std::int32_t i = 0; i < std::int32_t(points.size()); ++i) order.push_back({along(place(i)), i});
    std::sort(order.begin(), order.end());
    scaled_discs discs;
    double const same = 1e-10;
    for (auto const& [key, i] : order) {
        auto const x = place(i);
        double const radius = double(radii[i]) * scale;
        bool fresh = true;
        for (std::size_t k = discs.x.size(); fresh && k-- > 0 && key - along(discs.x[k]) <= 2 * same;) {
            if (std::fabs(x[0] - discs.x[k][0]) > same || std::fabs(x[1] - discs.x[k][1]) > same) continue;
            fresh = false;
            if (radius > discs.radius[k]) {
                discs.particle[k] = i;
                discs.radius[k] = radius;
            }
        }
        if (!fresh) continue;
        discs.particle.push_back(i);
        discs.x.push_back(x);
        discs.radius.push_back(radius);
    }
    return discs;
}

/// Area of the triangles in the scaled frame.
inline double filled_area(pore_mesh<2> const& mesh, scaled_discs const& discs) {
    std::vector<std::array<double, 2>> place(std::size_t(1) + std::size_t(*std::max_element(
                                                                 discs.particle.begin(), discs.particle.end())));
    for (std::size_t k = 0; k < discs.x.size(); ++k) place[std::size_t(discs.particle[k])] = discs.x[k];
    double twice = 0;
    for (auto const& t : mesh.simplices) {
        auto const &a = place[std::size_t(t[0])], &b = place[std::size_t(t[1])], &c = place[std::size_t(t[2])];
        twice += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }
    return twice / 2;
}

} // namespace detail

/// Regular (radius-weighted Delaunay) triangulation of discs: the lower hull of (x, |x|^2 - r^2). It covers the
/// convex hull of the centres; two discs that touch share an edge, unless a third overlaps them where they meet.
///
/// A particle that is overlapped so much that its power cell is empty is a corner of no triangle; of particles at
/// one place (up to 1e-10 of the extent) only the largest is. Fewer than three particles, or particles on a line (up
/// to 1e-9 of their extent), give an empty mesh. Where more than three lie on one circle, Qhull decides on the
/// diagonals: the same way each time for the same input. Thread-safe.
///
/// \param points centres, m
/// \param radii one per point, m, >= 0
/// \throws std::invalid_argument for a value that is not finite, or a negative radius;
///         std::runtime_error when Qhull fails, or its triangles do not fill the convex hull exactly once.
template <class Real>
pore_mesh<2> regular_triangulation(points_view<Real, 2> points, Real const* radii) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int axis = 0; axis < 2; ++axis)
            require_finite("position of particle " + std::to_string(i), double(points(i, axis)));
        require_not_negative("radius of particle " + std::to_string(i), double(radii[i]));
    }
    if (points.size() < 3) return {};
    auto const discs = detail::scale_discs(points, radii);
    if (discs.x.size() < 3) return {};
    double const hull = detail::hull_area(discs.x);
    if (hull < 1e-9) return {};

    auto mesh = detail::lower_hull(discs);
    double const filled = detail::filled_area(mesh, discs);
    if (std::fabs(filled - hull) > 1e-9 * hull)
        throw std::runtime_error("triangulation: the triangles fill " + to_text(filled / hull) +
                                 " of the convex hull of the particles");
    return mesh;
}

/// The pores' triangles of a body: regular_triangulation(), then peel() with the given or the default cutoff.
/// \param cutoff longest edge of the body's boundary, m; 0 for default_cutoff().
template <class Real>
pore_mesh<2> triangulate_body(points_view<Real, 2> points, Real const* radii, Real cutoff = Real(0)) {
    auto const mesh = regular_triangulation(points, radii);
    return peel(mesh, points, radii, cutoff == Real(0) ? default_cutoff(radii, points.size()) : cutoff);
}

} // namespace lacuna
