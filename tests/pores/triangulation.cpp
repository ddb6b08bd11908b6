// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include <lacuna/pores/mesh/triangulation.hpp>

using namespace lacuna;
using point = vec<double, 2>;
using points = std::vector<point>;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();

double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

pore_mesh<2> mesh_of(points const& x, std::vector<double> const& r) {
    return regular_triangulation(view_points(x), r.data());
}
pore_mesh<2> body_of(points const& x, std::vector<double> const& r, double cutoff = 0) {
    return triangulate_body(view_points(x), r.data(), cutoff);
}
double area_of(pore_mesh<2> const& mesh, points const& x) { return mesh_size(mesh, view_points(x)); }

/// Area of the convex hull, by gift wrapping.
double wrapped_area(points const& x) {
    std::size_t const start = std::size_t(
        std::min_element(x.begin(), x.end(),
                         [](auto const& a, auto const& b) { return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1]; }) -
        x.begin());
    double twice = 0;
    std::size_t at = start;
    for (std::size_t round = 0; round < x.size(); ++round) {
        std::size_t next = at == 0 ? 1 : 0;
        for (std::size_t k = 0; k < x.size(); ++k) {
            double const turn = cross(x[next] - x[at], x[k] - x[at]);
            if (turn < 0 || (turn == 0 && squared_norm(x[k] - x[at]) > squared_norm(x[next] - x[at]))) next = k;
        }
        twice += cross(x[at], x[next]);
        at = next;
        if (at == start) break;
    }
    return twice / 2;
}

bool has_edge(pore_mesh<2> const& mesh, int a, int b) {
    for (auto const& t : mesh.simplices)
        if (std::count(t.begin(), t.end(), a) && std::count(t.begin(), t.end(), b)) return true;
    return false;
}

/// Corners counter-clockwise with positive area, smallest first, in order; neighbours mutual and across one edge.
void require_well_formed(pore_mesh<2> const& mesh, points const& x) {
    REQUIRE(std::is_sorted(mesh.simplices.begin(), mesh.simplices.end()));
    REQUIRE(mesh.neighbours.size() == mesh.size());
    for (std::size_t t = 0; t < mesh.size(); ++t) {
        auto const& s = mesh.simplices[t];
        double const area = triangle_area(x[std::size_t(s[0])], x[std::size_t(s[1])], x[std::size_t(s[2])]);
        REQUIRE(area > 0);
        REQUIRE(s[0] < std::min(s[1], s[2]));
        for (std::size_t c = 0; c < 3; ++c) {
            int const other = mesh.neighbours[t][c];
            if (other < 0) continue;
            auto const& back = mesh.neighbours[std::size_t(other)];
            REQUIRE(std::count(back.begin(), back.end(), int(t)) == 1);
            int shared = 0;
            for (int const corner : mesh.simplices[std::size_t(other)])
                shared += int(std::count(s.begin(), s.end(), corner));
            REQUIRE(shared == 2);
            REQUIRE(std::count(mesh.simplices[std::size_t(other)].begin(), mesh.simplices[std::size_t(other)].end(),
                               s[c]) == 0);
        }
    }
}

/// No disc comes nearer to the orthogonal circle of a triangle than its corners: the property that defines it.
void require_regular(pore_mesh<2> const& mesh, points const& x, std::vector<double> const& r) {
    for (auto const& s : mesh.simplices) {
        auto const a = std::size_t(s[0]), b = std::size_t(s[1]), c = std::size_t(s[2]);
        point const u = x[b] - x[a], v = x[c] - x[a];
        double const e = (squared_norm(u) - r[b] * r[b] + r[a] * r[a]) / 2;
        double const f = (squared_norm(v) - r[c] * r[c] + r[a] * r[a]) / 2;
        double const det = cross(u, v);
        point const centre{(e * v[1] - f * u[1]) / det, (u[0] * f - v[0] * e) / det};
        double const power = squared_norm(centre) - r[a] * r[a];
        for (std::size_t k = 0; k < x.size(); ++k) {
            double const other = squared_norm(x[k] - x[a] - centre) - r[k] * r[k];
            REQUIRE(other >= power - 1e-9 * (1 + std::fabs(power)));
        }
    }
}

struct lattice {
    points x;
    std::vector<double> r;
};
lattice make_lattice(int rows, int columns, bool hexagonal, double scale = 1) {
    lattice l;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            double const x = hexagonal ? j + 0.5 * (i % 2) : j, y = hexagonal ? i * std::sqrt(0.75) : i;
            l.x.push_back({scale * x, scale * y});
            l.r.push_back(scale * 0.5);
        }
    return l;
}

/// Hull area of n hexagonal rows of n discs of diameter 1, every other row shifted by half a diameter: a rectangle of
/// n - 1 by n - 1 rows, on one side half a diameter more over n - 2 rows.
double hexagonal_hull(int n) { return std::sqrt(0.75) * ((n - 1) * (n - 1) + 0.5 * (n - 2)); }

} // namespace

TEST_CASE("too few particles, or particles on a line, have no pores") {
    REQUIRE(mesh_of({}, {}).size() == 0);
    REQUIRE(mesh_of({{1, 2}}, {1}).size() == 0);
    REQUIRE(mesh_of({{1, 2}, {3, 4}}, {1, 1}).size() == 0);
    REQUIRE(mesh_of({{1, 1}, {1, 1}, {1, 1}, {1, 1}}, {1, 2, 3, 1}).size() == 0);
    points line;
    std::vector<double> r;
    for (int k = 0; k < 50; ++k) {
        line.push_back({1e-6 * k, 0.1 + 0.3e-6 * k});
        r.push_back(1e-6);
    }
    REQUIRE(mesh_of(line, r).size() == 0);
    REQUIRE(body_of(line, r).size() == 0);
    for (auto& x : line) x = {x[0], 0.25};
    REQUIRE(mesh_of(line, r).size() == 0);
}

TEST_CASE("one triangle, whatever the order of its corners") {
    points x{{0, 0}, {1e-6, 0}, {0, 1e-6}};
    std::vector<double> const r{1e-7, 1e-7, 1e-7};
    auto const mesh = mesh_of(x, r);
    REQUIRE(mesh.size() == 1);
    REQUIRE(mesh.simplices[0] == std::array<std::int32_t, 3>{0, 1, 2});
    REQUIRE(mesh.neighbours[0] == std::array<std::int32_t, 3>{-1, -1, -1});
    std::swap(x[1], x[2]);
    REQUIRE(mesh_of(x, r).simplices[0] == std::array<std::int32_t, 3>{0, 2, 1});
}

TEST_CASE("bad input is refused by name") {
    points x{{0, 0}, {1, 0}, {0, 1}};
    std::vector<double> r{1, 1, 1};
    x[1][1] = std::nan("");
    REQUIRE_THROWS_WITH(mesh_of(x, r), contains_text("position of particle 1"));
    x[1][1] = 0;
    r[2] = -1;
    REQUIRE_THROWS_WITH(mesh_of(x, r), contains_text("radius of particle 2 = -1"));
    r[2] = 1;
    REQUIRE_THROWS_WITH(body_of(x, r, -1), contains_text("cutoff = -1"));
}

TEST_CASE("random discs: fills the hull, and no disc enters a triangle's orthogonal circle") {
    std::mt19937_64 engine(11);
    for (int trial = 0; trial < 5; ++trial) {
        points x;
        std::vector<double> r;
        for (int k = 0; k < 150; ++k) {
            x.push_back({2 * uniform(engine), uniform(engine)});
            r.push_back(0.05 * uniform(engine));
        }
        auto const mesh = mesh_of(x, r);
        require_well_formed(mesh, x);
        require_regular(mesh, x, r);
        REQUIRE_THAT(area_of(mesh, x), WithinRel(wrapped_area(x), 1e-9));
    }
}

TEST_CASE("radii change the edges") {
    points const x{{-1, 0}, {1, 0}, {0, 0.9}, {0, -0.9}};
    REQUIRE(has_edge(mesh_of(x, {0, 0, 0, 0}), 2, 3));
    REQUIRE_FALSE(has_edge(mesh_of(x, {0, 0, 0, 0}), 0, 1));
    REQUIRE(has_edge(mesh_of(x, {0.9, 0.9, 0.1, 0.1}), 0, 1));
}

TEST_CASE("lattices, with many particles on one circle, are filled") {
    for (bool const hexagonal : {false, true})
        for (int const n : {2, 3, 4, 9, 30})
            for (double const scale : {1.0, 1.7e-6}) {
                auto l = make_lattice(n, n, hexagonal, scale);
                for (auto& x : l.x) x += point{100 * scale, -30 * scale};
                auto const mesh = mesh_of(l.x, l.r);
                require_well_formed(mesh, l.x);
                if (!hexagonal) {
                    REQUIRE(mesh.size() == std::size_t(2 * (n - 1) * (n - 1)));
                    REQUIRE_THAT(area_of(mesh, l.x), WithinRel(scale * scale * (n - 1) * (n - 1), 1e-12));
                } else {
                    REQUIRE_THAT(area_of(mesh, l.x), WithinRel(scale * scale * hexagonal_hull(n), 1e-12));
                }
                REQUIRE(mesh.simplices == mesh_of(l.x, l.r).simplices);
            }
}

TEST_CASE("lattices that differ by rounding from straight rows are filled, rotated or not") {
    std::mt19937_64 engine(13);
    for (double const noise : {1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-4})
        for (bool const hexagonal : {false, true})
            for (double const turn : {0.0, 0.4, 2.0}) {
                auto l = make_lattice(25, 25, hexagonal);
                for (auto& x : l.x) {
                    x += point{noise * (uniform(engine) - 0.5), noise * (uniform(engine) - 0.5)};
                    x = {std::cos(turn) * x[0] - std::sin(turn) * x[1], std::sin(turn) * x[0] + std::cos(turn) * x[1]};
                }
                auto const mesh = mesh_of(l.x, l.r);
                require_well_formed(mesh, l.x);
                REQUIRE_THAT(area_of(mesh, l.x),
                             WithinRel(hexagonal ? hexagonal_hull(25) : 576.0, 1e-9 + 10 * noise));
                // Peeling removes the slivers along the rows, and leaves the lattice's own triangles.
                auto const body = body_of(l.x, l.r);
                REQUIRE(body.size() == std::size_t(hexagonal ? 2 * 24 * 24 + 23 : 2 * 24 * 24));
            }
}

TEST_CASE("a hundred discs on one circle") {
    points x;
    for (int k = 0; k < 100; ++k) x.push_back({std::cos(2 * pi * k / 100), std::sin(2 * pi * k / 100)});
    auto const mesh = mesh_of(x, std::vector<double>(100, 0.01));
    require_well_formed(mesh, x);
    REQUIRE(mesh.size() == 98);
    REQUIRE_THAT(area_of(mesh, x), WithinRel(50 * std::sin(2 * pi / 100), 1e-10));
}

TEST_CASE("if centres coincide, exactly or nearly, only the largest particle is a corner") {
    auto l = make_lattice(6, 6, false);
    for (int k = 0; k < 36; k += 2) {
        l.x.push_back(l.x[std::size_t(k)] + point{k % 4 ? 1e-14 : 0.0, 0});
        l.r.push_back(k % 4 ? 0.3 : 0.51);
    }
    auto const mesh = mesh_of(l.x, l.r);
    require_well_formed(mesh, l.x);
    REQUIRE(mesh.size() == 50);
    REQUIRE_THAT(area_of(mesh, l.x), WithinRel(25.0, 1e-9));
    std::set<int> corners;
    for (auto const& t : mesh.simplices) corners.insert(t.begin(), t.end());
    REQUIRE(corners.size() == 36);
    REQUIRE(corners.count(0) == 0);
    REQUIRE(corners.count(36) == 1);
    REQUIRE(corners.count(2) == 1);
    REQUIRE(corners.count(37) == 0);
}

TEST_CASE("a disc inside another has no triangle") {
    auto l = make_lattice(4, 4, true);
    l.x.push_back(l.x[5] + point{0.05, 0.02});
    l.r.push_back(0.01);
    auto const mesh = mesh_of(l.x, l.r);
    require_well_formed(mesh, l.x);
    REQUIRE_THAT(area_of(mesh, l.x), WithinRel(wrapped_area(l.x), 1e-9));
    for (auto const& t : mesh.simplices) REQUIRE(*std::max_element(t.begin(), t.end()) < 16);
}

TEST_CASE("touching discs share an edge, whatever their radii") {
    std::mt19937_64 engine(17);
    for (int trial = 0; trial < 20; ++trial) {
        points x{{0, 0}};
        std::vector<double> r{1};
        std::vector<std::pair<int, int>> contacts;
        for (int attempt = 0; attempt < 3000 && x.size() < 120; ++attempt) {
            auto const host = std::size_t(uniform(engine) * double(x.size()));
            double const radius = 0.2 + 1.8 * uniform(engine), angle = 2 * pi * uniform(engine);
            point const centre = x[host] + point{std::cos(angle), std::sin(angle)} * (r[host] + radius);
            bool free = true;
            for (std::size_t k = 0; k < x.size(); ++k)
                free = free && (k == host || norm(x[k] - centre) > r[k] + radius);
            if (!free) continue;
            contacts.push_back({int(host), int(x.size())});
            x.push_back(centre);
            r.push_back(radius);
        }
        auto const mesh = mesh_of(x, r);
        require_well_formed(mesh, x);
        for (auto const& [a, b] : contacts) REQUIRE(has_edge(mesh, a, b));
    }
}

TEST_CASE("dense packings of radii from 1 to 10, each disc laid against two: every contact is an edge") {
    std::mt19937_64 engine(23);
    for (int trial = 0; trial < 3; ++trial) {
        points x{{0, 0}, {2, 0}};
        std::vector<double> r{1, 1};
        std::vector<std::pair<int, int>> contacts{{0, 1}};
        while (x.size() < 150) {
            double const radius = std::pow(10.0, uniform(engine));
            point best{};
            std::pair<int, int> hosts{-1, -1};
            for (std::size_t i = 0; i < x.size(); ++i)
                for (std::size_t j = 0; j < x.size(); ++j) {
                    point const along = x[j] - x[i];
                    double const apart = norm(along), to_i = r[i] + radius, to_j = r[j] + radius;
                    if (i == j || apart >= to_i + to_j) continue;
                    double const share = (apart * apart + to_i * to_i - to_j * to_j) / (2 * apart);
                    point const centre = x[i] + along * (share / apart) +
                                         perpendicular(along) * (std::sqrt(to_i * to_i - share * share) / apart);
                    if (hosts.first >= 0 && squared_norm(centre) >= squared_norm(best)) continue;
                    bool free = true;
                    for (std::size_t k = 0; free && k < x.size(); ++k)
                        free = k == i || k == j || norm(x[k] - centre) > (r[k] + radius) * (1 + 1e-9);
                    if (!free) continue;
                    best = centre;
                    hosts = {int(i), int(j)};
                }
            REQUIRE(hosts.first >= 0);
            contacts.push_back({hosts.first, int(x.size())});
            contacts.push_back({hosts.second, int(x.size())});
            x.push_back(best);
            r.push_back(radius);
        }
        REQUIRE(*std::max_element(r.begin(), r.end()) > 8 * *std::min_element(r.begin(), r.end()));
        auto const mesh = mesh_of(x, r);
        require_well_formed(mesh, x);
        require_regular(mesh, x, r);
        for (auto const& [a, b] : contacts) REQUIRE(has_edge(mesh, a, b));
    }
}

TEST_CASE("far from the origin, and with nearly coincident pairs") {
    std::mt19937_64 engine(29);
    for (double const offset : {0.0, 1e3, 1e6}) {
        points x;
        std::vector<double> r;
        for (int k = 0; k < 100; ++k) {
            x.push_back({uniform(engine), uniform(engine)});
            r.push_back(0.03 * uniform(engine));
        }
        for (std::size_t k = 0; k < 20; ++k) {
            x.push_back(x[k] + point{1e-7 * uniform(engine), 1e-7 * uniform(engine)});
            r.push_back(r[k]);
        }
        points moved;
        for (auto const& y : x) moved.push_back(y + point{offset, -3 * offset});
        // Positions of the moved points, after rounding.
        points back;
        for (auto const& y : moved) back.push_back(y - point{offset, -3 * offset});
        auto const mesh = mesh_of(moved, r);
        require_well_formed(mesh, back);
        require_regular(mesh, back, r);
        REQUIRE_THAT(area_of(mesh, back), WithinRel(wrapped_area(back), 1e-9));
    }
}

TEST_CASE("a strip of particles hardly wider than a line") {
    std::mt19937_64 engine(31);
    for (double const width : {1e-3, 1e-5, 1e-7}) {
        points x;
        for (int k = 0; k < 60; ++k) x.push_back({uniform(engine), width * uniform(engine)});
        auto const mesh = mesh_of(x, std::vector<double>(60, 1e-4));
        require_well_formed(mesh, x);
        REQUIRE_THAT(area_of(mesh, x), WithinRel(wrapped_area(x), 1e-7));
    }
}

TEST_CASE("peeling removes long outer edges, from outside inwards, and nothing in the interior") {
    // A U of lattice discs: the hull bridges its bay, which is five wide.
    auto const full = make_lattice(9, 11, false);
    lattice u;
    for (std::size_t k = 0; k < full.x.size(); ++k) {
        bool const bay = full.x[k][1] > 2.5 && full.x[k][0] > 2.5 && full.x[k][0] < 7.5;
        if (bay) continue;
        u.x.push_back(full.x[k]);
        u.r.push_back(0.5);
    }
    auto const mesh = mesh_of(u.x, u.r);
    REQUIRE_THAT(area_of(mesh, u.x), WithinRel(80.0, 1e-12));
    auto const body = body_of(u.x, u.r);
    require_well_formed(body, u.x);
    // In either corner of the bay one triangle stays, behind an edge of length sqrt(2).
    REQUIRE_THAT(area_of(body, u.x), WithinRel(80.0 - 6 * 6 + 2 * 0.5, 1e-12));
    REQUIRE(body.size() == 90);
    REQUIRE(body_of(u.x, u.r, infinity).size() == mesh.size());
    REQUIRE(body_of(u.x, u.r, 0.5).size() == 0);

    // The same hole in the interior is not on the boundary: it remains as a few large pores.
    lattice o;
    for (std::size_t k = 0; k < full.x.size(); ++k) {
        bool const hole = full.x[k][1] > 2.5 && full.x[k][1] < 5.5 && full.x[k][0] > 2.5 && full.x[k][0] < 7.5;
        if (hole) continue;
        o.x.push_back(full.x[k]);
        o.r.push_back(0.5);
    }
    REQUIRE_THAT(area_of(body_of(o.x, o.r), o.x), WithinRel(80.0, 1e-12));
}

TEST_CASE("a sliver over a straight row is peeled, a bay between two rows is not") {
    // The middle disc of three in a row sinks by a tenth of a radius: its hull edge has no void behind it.
    points const row{{0, 0}, {1, -0.05}, {2, 0}, {0.5, -0.9}, {1.5, -0.9}};
    std::vector<double> const r(5, 0.5);
    REQUIRE(mesh_of(row, r).size() == 4);
    REQUIRE(body_of(row, r, infinity).size() == 3);
    auto const hex = make_lattice(3, 3, true);
    REQUIRE(body_of(hex.x, hex.r).size() == 9);
}

TEST_CASE("the default cutoff is twice the mean diameter") {
    std::vector<double> const r{1, 2, 3};
    REQUIRE_THAT(default_cutoff(r.data(), 3), WithinRel(8.0, 1e-15));
    std::vector<double> const none{0, 0};
    REQUIRE(default_cutoff(none.data(), 2) == infinity);
}

TEST_CASE("triangulations in two threads at once agree with one alone") {
    std::mt19937_64 engine(19);
    points x;
    std::vector<double> r;
    for (int k = 0; k < 2000; ++k) {
        x.push_back({uniform(engine), uniform(engine)});
        r.push_back(0.01 * uniform(engine));
    }
    auto const alone = mesh_of(x, r);
    pore_mesh<2> one, two;
    std::thread other([&] { one = mesh_of(x, r); });
    two = mesh_of(x, r);
    other.join();
    REQUIRE(one.simplices == alone.simplices);
    REQUIRE(two.simplices == alone.simplices);
    REQUIRE(one.neighbours == alone.neighbours);
}

TEST_CASE("positions in single precision") {
    std::vector<vec<float, 2>> x;
    std::vector<float> r;
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) {
            x.push_back({1e-6f * (float(j) + 0.5f * float(i % 2)), 1e-6f * 0.8660254f * float(i)});
            r.push_back(0.5e-6f);
        }
    REQUIRE(triangulate_body(view_points(x), r.data()).size() == 2 * 11 * 11 + 10);
}
