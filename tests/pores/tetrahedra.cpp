// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <lacuna/core/dual.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

using namespace lacuna;
using point = vec<double, 3>;
using points = std::vector<point>;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();

double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }
point random_point(std::mt19937_64& engine) { return {uniform(engine), uniform(engine), uniform(engine)}; }

pore_mesh<3> mesh_of(points const& x, std::vector<double> const& r) {
    return regular_triangulation(view_points(x), r.data());
}
pore_mesh<3> body_of(points const& x, std::vector<double> const& r, double cutoff = 0) {
    return triangulate_body(view_points(x), r.data(), cutoff);
}
double size_of(pore_mesh<3> const& mesh, points const& x) { return mesh_size(mesh, view_points(x)); }
double void_of(pore_mesh<3> const& mesh, points const& x, std::vector<double> const& r) {
    double total = 0;
    for (auto const& s : mesh.simplices) total += simplex_void(s, view_points(x), r.data());
    return total;
}

double det(point const& a, point const& b, point const& c) { return dot(a, cross(b, c)); }

/// Volume of the convex hull by trying every three points for a facet: the rest lies on one side. For points in general
/// position.
double tried_volume(points const& x) {
    double six = 0;
    for (std::size_t a = 0; a < x.size(); ++a)
        for (std::size_t b = a + 1; b < x.size(); ++b)
            for (std::size_t c = b + 1; c < x.size(); ++c) {
                int above = 0, below = 0;
                for (std::size_t k = 0; k < x.size() && !(above && below); ++k) {
                    if (k == a || k == b || k == c) continue;
                    (det(x[b] - x[a], x[c] - x[a], x[k] - x[a]) > 0 ? above : below) = 1;
                }
                if (!above || !below) six += std::fabs(det(x[a] - x[0], x[b] - x[0], x[c] - x[0]));
            }
    return six / 6;
}

bool has_edge(pore_mesh<3> const& mesh, int a, int b) {
    for (auto const& s : mesh.simplices)
        if (std::count(s.begin(), s.end(), a) && std::count(s.begin(), s.end(), b)) return true;
    return false;
}

/// Positive volumes, canonical rows, neighbours mutual and across one facet of three particles.
void require_well_formed(pore_mesh<3> const& mesh, points const& x) {
    REQUIRE(std::is_sorted(mesh.simplices.begin(), mesh.simplices.end()));
    REQUIRE(mesh.neighbours.size() == mesh.size());
    for (std::size_t t = 0; t < mesh.size(); ++t) {
        auto const& s = mesh.simplices[t];
        auto const at = [&](std::size_t c) { return x[std::size_t(s[c])]; };
        REQUIRE(det(at(1) - at(0), at(2) - at(0), at(3) - at(0)) > 0);
        REQUIRE((s[0] < s[1] && s[1] < std::min(s[2], s[3])));
        for (std::size_t c = 0; c < 4; ++c) {
            int const other = mesh.neighbours[t][c];
            if (other < 0) continue;
            auto const& back = mesh.neighbours[std::size_t(other)];
            REQUIRE(std::count(back.begin(), back.end(), int(t)) == 1);
            auto const& corners = mesh.simplices[std::size_t(other)];
            for (std::size_t k = 0; k < 4; ++k)
                REQUIRE(std::count(corners.begin(), corners.end(), s[k]) == (k == c ? 0 : 1));
        }
    }
}

/// No sphere comes nearer to the orthogonal sphere of a tetrahedron than its corners, up to `slack` (m^2).
void require_regular(pore_mesh<3> const& mesh, points const& x, std::vector<double> const& r, double slack) {
    for (auto const& s : mesh.simplices) {
        auto const corner = [&](std::size_t c) { return std::size_t(s[c]); };
        point u[3];
        double e[3];
        for (std::size_t c = 0; c < 3; ++c) {
            u[c] = x[corner(c + 1)] - x[corner(0)];
            e[c] = (squared_norm(u[c]) - std::pow(r[corner(c + 1)], 2) + std::pow(r[corner(0)], 2)) / 2;
        }
        point const centre =
            (cross(u[1], u[2]) * e[0] + cross(u[2], u[0]) * e[1] + cross(u[0], u[1]) * e[2]) / det(u[0], u[1], u[2]);
        double const power = squared_norm(centre) - std::pow(r[corner(0)], 2);
        for (std::size_t k = 0; k < x.size(); ++k) {
            double const other = squared_norm(x[k] - x[corner(0)] - centre) - r[k] * r[k];
            REQUIRE(other >= power - slack * (1 + squared_norm(centre)));
        }
    }
}

struct packing_of_spheres {
    points x;
    std::vector<double> r;
};
packing_of_spheres make_cubic(int n, double scale = 1) {
    packing_of_spheres p;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) p.x.push_back(point{double(i), double(j), double(k)} * scale);
    p.r.assign(p.x.size(), 0.5 * scale);
    return p;
}
/// Face-centred cubic cells of touching spheres of radius 1: edge 2 sqrt(2).
packing_of_spheres make_fcc(int n) {
    packing_of_spheres p;
    for (int i = 0; i <= 2 * n; ++i)
        for (int j = 0; j <= 2 * n; ++j)
            for (int k = 0; k <= 2 * n; ++k)
                if ((i + j + k) % 2 == 0) p.x.push_back(point{double(i), double(j), double(k)} * std::sqrt(2.0));
    p.r.assign(p.x.size(), 1.0);
    return p;
}

points const regular_tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};

} // namespace

TEST_CASE("four touching spheres") {
    double const radius = std::sqrt(2.0);
    auto const& x = regular_tetrahedron;
    auto const mesh = mesh_of(x, std::vector<double>(4, radius));
    REQUIRE(mesh.size() == 1);
    double const cube = radius * radius * radius;
    REQUIRE_THAT(size_of(mesh, x) / cube, WithinRel(reference("9g.3D_four_spheres", "tetra_volume/R^3"), 1e-11));
    REQUIRE_THAT(void_of(mesh, x, std::vector<double>(4, radius)) / cube,
                 WithinRel(reference("9g.3D_four_spheres", "pore_volume/R^3"), 1e-11));
    REQUIRE_THAT(solid_angle(x[0], x[1], x[2], x[3]), WithinRel(reference("9g.3D_four_spheres", "solid_angle"), 1e-11));
    // The joints of three spheres with each other are the middles of the edges.
    REQUIRE_THAT(triangle_area((x[0] + x[1]) * 0.5, (x[1] + x[2]) * 0.5, (x[2] + x[0]) * 0.5) / (radius * radius),
                 WithinRel(reference("9g.3D_four_spheres", "contact_triangle_area/R^2"), 1e-11));
    // The facet is 9a's triangle of three discs; arcs of half a circle in total bound its void.
    auto const facet = measure_facet(x[0], x[1], x[2], radius, radius, radius);
    REQUIRE_THAT(facet.void_area / (radius * radius), WithinRel(reference("9a.three_equal", "area/R^2"), 1e-11));
    REQUIRE_THAT(facet.hydraulic_radius / radius,
                 WithinRel(reference("9a.three_equal", "area/R^2") / pi, 1e-11));
}

TEST_CASE("an octahedron of touching spheres, however it is divided") {
    points const x{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    double const radius = std::sqrt(0.5);
    std::vector<double> const r(6, radius);
    auto const mesh = mesh_of(x, r);
    require_well_formed(mesh, x);
    REQUIRE(mesh.size() == 4);
    REQUIRE_THAT(void_of(mesh, x, r) / std::pow(radius, 3),
                 WithinRel(reference("9g.3D_four_spheres", "octahedral_pore/R^3 (6 spheres)"), 1e-10));
}

TEST_CASE("unequal touching spheres: solid angles by the arc cosine of the dihedral angles") {
    // Radii 1, 2, 3 and 1.5, each touching all others; Omega = sum of the three dihedral angles - pi.
    double const r[4] = {1, 2, 3, 1.5};
    auto const d = [&](int i, int j) { return r[i] + r[j]; };
    points x(4);
    x[1] = {d(0, 1), 0, 0};
    double const u = (d(0, 1) * d(0, 1) + d(0, 2) * d(0, 2) - d(1, 2) * d(1, 2)) / (2 * d(0, 1));
    x[2] = {u, std::sqrt(d(0, 2) * d(0, 2) - u * u), 0};
    double const a = (d(0, 1) * d(0, 1) + d(0, 3) * d(0, 3) - d(1, 3) * d(1, 3)) / (2 * d(0, 1));
    double const b = (d(0, 3) * d(0, 3) - d(2, 3) * d(2, 3) + squared_norm(x[2]) - 2 * a * x[2][0]) / (2 * x[2][1]);
    x[3] = {a, b, std::sqrt(d(0, 3) * d(0, 3) - a * a - b * b)};
    auto const dihedral = [&](int i, int j, int k, int l) {
        auto const n = cross(x[std::size_t(j)] - x[std::size_t(i)], x[std::size_t(k)] - x[std::size_t(i)]);
        auto const m = cross(x[std::size_t(j)] - x[std::size_t(i)], x[std::size_t(l)] - x[std::size_t(i)]);
        return std::acos(dot(n, m) / norm(n) / norm(m));
    };
    double expected = det(x[1], x[2], x[3]) / 6;
    for (int i = 0; i < 4; ++i) {
        int const j = (i + 1) % 4, k = (i + 2) % 4, l = (i + 3) % 4;
        double const omega = dihedral(i, j, k, l) + dihedral(i, k, l, j) + dihedral(i, l, j, k) - pi;
        auto const at = [&](int n) { return x[std::size_t(n)]; };
        REQUIRE_THAT(solid_angle(at(i), at(j), at(k), at(l)), WithinRel(omega, 1e-13));
        expected -= std::pow(r[i], 3) * omega / 3;
    }
    REQUIRE_THAT(void_volume(x[0], x[1], x[2], x[3], r[0], r[1], r[2], r[3]), WithinRel(expected, 1e-13));
    REQUIRE(pore_volume(x[0], x[1], x[2], x[3], r[0], r[1], r[2], r[3], 99.0) == 99.0);
}

TEST_CASE("solid angles of octants, half spaces and flat tetrahedra") {
    point const o{0, 0, 0}, e0{1, 0, 0}, e1{0, 3, 0}, e2{0, 0, 0.2};
    REQUIRE_THAT(solid_angle(o, e0, e1, e2), WithinRel(pi / 2, 1e-15));
    point const below{-1, -1, -1e-9}, a{1, 0, -1e-9}, b{0, 1, -1e-9};
    REQUIRE_THAT(solid_angle(o, a, b, below), WithinRel(2 * pi, 1e-8));
    REQUIRE_THAT(solid_angle(o, e0, e1, point{1, 1, 0}), WithinAbs(0, 1e-15));
}

TEST_CASE("pores in space in packs and dual numbers follow plain numbers") {
    std::mt19937_64 engine(3);
    constexpr int width = 4;
    vec<pack<double, width>, 3> packed[4];
    double plain[width];
    points x[width];
    for (int lane = 0; lane < width; ++lane) {
        for (int c = 0; c < 4; ++c)
            x[lane].push_back(regular_tetrahedron[std::size_t(c)] + random_point(engine) * 0.3);
        plain[lane] = void_volume(x[lane][0], x[lane][1], x[lane][2], x[lane][3], 0.9, 1.0, 1.1, 1.2);
    }
    for (int c = 0; c < 4; ++c)
        for (int axis = 0; axis < 3; ++axis) {
            alignas(64) double row[width];
            for (int lane = 0; lane < width; ++lane) row[lane] = x[lane][std::size_t(c)][axis];
            packed[c][axis] = pack<double, width>::load(row);
        }
    using lanes = pack<double, width>;
    auto const all = void_volume<lanes>(packed[0], packed[1], packed[2], packed[3], lanes(0.9), lanes(1.0), lanes(1.1),
                                        lanes(1.2));
    for (int lane = 0; lane < width; ++lane) REQUIRE_THAT(all[lane], WithinRel(plain[lane], 1e-14));

    using number = dual<double, 3>;
    vec<number, 3> y[4];
    for (int c = 0; c < 4; ++c)
        for (int axis = 0; axis < 3; ++axis) y[c][axis] = number(x[0][std::size_t(c)][axis]);
    for (int axis = 0; axis < 3; ++axis) y[2][axis] = number::variable(x[0][2][axis], axis);
    auto const slope = void_volume<number>(y[0], y[1], y[2], y[3], number(0.9), number(1.0), number(1.1), number(1.2));
    for (int axis = 0; axis < 3; ++axis) {
        double const h = 1e-6;
        auto const at = [&](double step) {
            auto z = x[0];
            z[2][axis] += step;
            return void_volume(z[0], z[1], z[2], z[3], 0.9, 1.0, 1.1, 1.2);
        };
        REQUIRE_THAT(slope.derivative[axis], WithinAbs((at(h) - at(-h)) / (2 * h), 1e-8));
    }
}

TEST_CASE("too few particles, or particles in a plane, have no pores in space") {
    REQUIRE(mesh_of({}, {}).size() == 0);
    REQUIRE(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 1, 1}).size() == 0);
    REQUIRE(mesh_of({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-11}}, {1, 1, 1, 1, 1}).size() == 0);
    std::mt19937_64 engine(5);
    points x;
    for (int k = 0; k < 40; ++k) {
        double const u = uniform(engine), v = uniform(engine);
        x.push_back({u, v, 0.3 * u - 0.7 * v + 5});
    }
    REQUIRE(body_of(x, std::vector<double>(40, 0.01)).size() == 0);
}

TEST_CASE("random spheres: fill the hull, and none enters a tetrahedron's orthogonal sphere") {
    std::mt19937_64 engine(7);
    for (int trial = 0; trial < 3; ++trial) {
        packing_of_spheres p;
        for (int k = 0; k < 60; ++k) {
            p.x.push_back(random_point(engine));
            p.r.push_back(0.1 * uniform(engine));
        }
        auto const mesh = mesh_of(p.x, p.r);
        require_well_formed(mesh, p.x);
        // The heights are shifted by up to 1e-7 / 60^(2/3) = 7e-9 of the squared extent.
        require_regular(mesh, p.x, p.r, 2e-7);
        REQUIRE_THAT(size_of(mesh, p.x), WithinRel(tried_volume(p.x), 1e-9));
        REQUIRE(mesh_of(p.x, p.r).simplices == mesh.simplices);
    }
}

TEST_CASE("cubic lattices, with many particles on one sphere, are filled without flat tetrahedra") {
    std::mt19937_64 engine(9);
    for (int const n : {2, 3, 5, 8})
        for (double const noise : {0.0, 1e-15, 1e-12, 1e-9}) {
            auto p = make_cubic(n);
            for (auto& x : p.x) x += random_point(engine) * noise;
            auto const body = body_of(p.x, p.r);
            require_well_formed(body, p.x);
            REQUIRE_THAT(size_of(body, p.x), WithinRel(std::pow(n - 1, 3), 1e-6));
            REQUIRE(body.size() >= std::size_t(5 * std::pow(n - 1, 3)));
            if (noise == 0) {
                // A cube has five or six tetrahedra, of a sixth or a third of it.
                REQUIRE(body.size() <= std::size_t(6 * std::pow(n - 1, 3)));
                for (auto const& s : body.simplices) REQUIRE(simplex_size<double, 3>(s, view_points(p.x)) > 0.1);
            }
            // Each cube loses eight octants of a sphere, whatever its diagonals.
            REQUIRE_THAT(void_of(body, p.x, p.r), WithinRel(std::pow(n - 1, 3) * (1 - pi / 6), 1e-6));
        }
}

TEST_CASE("face-centred cubic: two tetrahedral pores to each octahedral one") {
    for (int const n : {1, 2, 3}) {
        auto const p = make_fcc(n);
        auto const body = body_of(p.x, p.r);
        require_well_formed(body, p.x);
        double const cell = 16 * std::sqrt(2.0);
        REQUIRE_THAT(size_of(body, p.x), WithinRel(n * n * n * cell, 1e-6));
        // Four spheres in a cell of (2 sqrt 2)^3.
        REQUIRE_THAT(void_of(body, p.x, p.r), WithinRel(n * n * n * (cell - 16 * pi / 3), 1e-6));
    }
}

TEST_CASE("dense packings in space, each sphere laid against three: every contact is an edge") {
    std::mt19937_64 engine(15);
    packing_of_spheres p{{{0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3.0), 0}}, {1, 1, 1}};
    std::vector<std::array<int, 2>> contacts{{0, 1}, {1, 2}, {0, 2}};
    while (p.x.size() < 45) {
        double const radius = std::pow(10.0, uniform(engine));
        point best{};
        std::array<std::size_t, 3> hosts{};
        double nearest = infinity;
        for (std::size_t i = 0; i < p.x.size(); ++i)
            for (std::size_t j = i + 1; j < p.x.size(); ++j)
                for (std::size_t k = j + 1; k < p.x.size(); ++k)
                    for (double const side : {1.0, -1.0}) {
                        double const a = p.r[i] + radius, b = p.r[j] + radius, c = p.r[k] + radius;
                        point const u = p.x[j] - p.x[i], v = p.x[k] - p.x[i], n = cross(u, v);
                        double const nn = squared_norm(n);
                        if (nn < 1e-9) continue;
                        double const e = (squared_norm(u) + a * a - b * b) / 2,
                                     f = (squared_norm(v) + a * a - c * c) / 2;
                        point const flat = (cross(v, n) * e + cross(n, u) * f) / nn;
                        double const height = a * a - squared_norm(flat);
                        if (height <= 0) continue;
                        point const centre = p.x[i] + flat + n * (side * std::sqrt(height / nn));
                        if (squared_norm(centre) >= nearest) continue;
                        bool free = true;
                        for (std::size_t l = 0; free && l < p.x.size(); ++l)
                            free = l == i || l == j || l == k || norm(p.x[l] - centre) > (p.r[l] + radius) * (1 + 1e-6);
                        if (!free) continue;
                        nearest = squared_norm(centre);
                        best = centre;
                        hosts = {i, j, k};
                    }
        REQUIRE(nearest < infinity);
        for (auto const h : hosts) contacts.push_back({int(h), int(p.x.size())});
        p.x.push_back(best);
        p.r.push_back(radius);
    }
    auto const mesh = mesh_of(p.x, p.r);
    require_well_formed(mesh, p.x);
    for (auto const& [a, b] : contacts) REQUIRE(has_edge(mesh, a, b));
}

TEST_CASE("slivers over a layer of spheres and pores in a bay are peeled") {
    auto p = make_cubic(5);
    std::mt19937_64 engine(21);
    // Layers sink by up to a twentieth of a radius: the hull has slivers over each side.
    for (auto& x : p.x) x += random_point(engine) * 0.025;
    auto const mesh = mesh_of(p.x, p.r);
    auto const body = body_of(p.x, p.r);
    require_well_formed(body, p.x);
    REQUIRE(body.size() < mesh.size());
    for (std::size_t t = 0; t < body.size(); ++t)
        for (int const other : body.neighbours[t])
            if (other < 0) REQUIRE(simplex_size<double, 3>(body.simplices[t], view_points(p.x)) > 0.05);
    REQUIRE_THAT(size_of(body, p.x), WithinRel(64.0, 0.03));

    auto const full = make_cubic(7);
    packing_of_spheres bay;
    for (std::size_t k = 0; k < full.x.size(); ++k) {
        auto const& x = full.x[k];
        if (x[2] > 2.5 && std::fabs(x[0] - 3) < 1.5 && std::fabs(x[1] - 3) < 1.5) continue;
        bay.x.push_back(x);
        bay.r.push_back(0.5);
    }
    auto const open = body_of(bay.x, bay.r);
    require_well_formed(open, bay.x);
    // In the bay of 4 x 4 x 4 cubes only simplices along its edges stay, behind diagonals of at most sqrt(3).
    REQUIRE(size_of(open, bay.x) < 216 - 40);
    REQUIRE(size_of(open, bay.x) >= 216 - 64 - 1e-6);
    REQUIRE(body_of(bay.x, bay.r, 0.5).size() == 0);
    REQUIRE_THAT(size_of(body_of(bay.x, bay.r, infinity), bay.x), WithinRel(216.0, 1e-6));
}
