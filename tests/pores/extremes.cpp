// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <lacuna/pores/mesh/no_pores.hpp>
#include <lacuna/pores/mesh/wide_number.hpp>
#include <lacuna/pores/network/pore_network.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

using namespace lacuna;

namespace {

constexpr double pi = 3.14159265358979323846;

double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

template <int Dim, class Real = double>
struct body {
    std::vector<vec<Real, Dim>> x;
    std::vector<Real> r;

    void add(vec<Real, Dim> const& at, Real radius = Real(0.5)) {
        x.push_back(at);
        r.push_back(radius);
    }
    void add(body const& other, vec<Real, Dim> const& at) {
        for (std::size_t k = 0; k < other.x.size(); ++k) add(other.x[k] + at, other.r[k]);
    }
    pore_mesh<Dim> mesh() const { return regular_triangulation(view_points(x), r.data()); }
    pore_mesh<Dim> pores(Real cutoff = Real(0)) const { return triangulate_body(view_points(x), r.data(), cutoff); }
};

/// A disc and its six neighbours: six triangles.
template <class Real = double>
body<2, Real> make_hexagon() {
    body<2, Real> b;
    b.add({0, 0});
    for (int k = 0; k < 6; ++k) b.add({Real(std::cos(k * pi / 3)), Real(std::sin(k * pi / 3))});
    return b;
}
/// Spheres of a cubic lattice, displaced by up to a tenth of a diameter along each axis.
body<3> make_heap(int n) {
    std::mt19937_64 engine(3);
    body<3> b;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k)
                b.add({i + 0.1 * uniform(engine), j + 0.1 * uniform(engine), k + 0.1 * uniform(engine)});
    return b;
}
vec<double, 3> direction(int k) {
    double const z = -0.9 + 0.17 * k, angle = 2.4 * k;
    return {std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z};
}

using number = long double;

template <std::size_t N>
number determinant_of(std::array<std::array<number, N>, N> m) {
    number product = 1;
    for (std::size_t i = 0; i < N; ++i) {
        std::size_t best = i;
        for (std::size_t k = i; k < N; ++k)
            if (std::fabs(m[k][i]) > std::fabs(m[best][i])) best = k;
        if (m[best][i] == 0) return 0;
        if (best != i) product = -product;
        std::swap(m[i], m[best]);
        product *= m[i][i];
        for (std::size_t k = i + 1; k < N; ++k)
            for (std::size_t c = N; c-- > i;) m[k][c] -= m[k][i] / m[i][i] * m[i][c];
    }
    return product;
}

/// All simplices with an empty orthogonal sphere, by brute force: determinants of the lifted points.
template <int Dim>
std::vector<std::array<std::int32_t, std::size_t(Dim) + 1>> try_all(body<Dim> const& b) {
    constexpr auto dim = std::size_t(Dim);
    using simplex = std::array<std::int32_t, dim + 1>;
    auto const lifted = [&](std::int32_t i, std::int32_t from) {
        std::array<number, dim + 1> row{};
        for (std::size_t a = 0; a < dim; ++a) {
            row[a] = number(b.x[std::size_t(i)][int(a)]) - number(b.x[std::size_t(from)][int(a)]);
            row[dim] += row[a] * row[a];
        }
        row[dim] +=
            number(b.r[std::size_t(from)]) * b.r[std::size_t(from)] - number(b.r[std::size_t(i)]) * b.r[std::size_t(i)];
        return row;
    };
    std::vector<simplex> found;
    auto const n = std::int32_t(b.x.size());
    simplex s;
    for (std::size_t c = 0; c <= dim; ++c) s[c] = std::int32_t(c);
    for (;;) {
        std::array<std::array<number, dim>, dim> flat;
        for (std::size_t k = 0; k < dim; ++k)
            for (std::size_t a = 0; a < dim; ++a) flat[k][a] = lifted(s[k + 1], s[0])[a];
        number const size = determinant_of(flat);
        bool empty = size != 0;
        for (std::int32_t p = 0; p < n && empty; ++p) {
            if (std::count(s.begin(), s.end(), p)) continue;
            std::array<std::array<number, dim + 1>, dim + 1> m;
            for (std::size_t k = 0; k < dim; ++k) m[k] = lifted(s[k + 1], s[0]);
            m[dim] = lifted(p, s[0]);
            // The height of p over the plane of the others has this sign.
            empty = determinant_of(m) * size > 0;
        }
        if (empty) found.push_back(s);
        std::size_t c = dim + 1;
        while (c > 0 && s[c - 1] == n - std::int32_t(dim + 1 - (c - 1))) --c;
        if (c == 0) return found;
        ++s[c - 1];
        for (; c <= dim; ++c) s[c] = s[c - 1] + 1;
    }
}
template <int Dim>
auto sorted_corners(pore_mesh<Dim> const& mesh) {
    auto all = mesh.simplices;
    for (auto& s : all) std::sort(s.begin(), s.end());
    std::sort(all.begin(), all.end());
    return all;
}

} // namespace

TEST_CASE("one disc far away changes no pore of the others, in any direction") {
    auto const near = make_hexagon();
    auto const expected = near.pores().simplices;
    REQUIRE(expected.size() == 6);
    for (double const far : {20.0, 1e3, 1e5, 1e6, 3e6, 1e7, 2e7, 1e8, 1e9, 1e10, 1e12, 1e17, 1e30})
        for (int k = 0; k < 36; ++k) {
            auto b = near;
            b.add({far * std::cos(0.1 + k * pi / 18), far * std::sin(0.1 + k * pi / 18)});
            REQUIRE(b.pores().simplices == expected);
            // The triangulation of all discs also has a triangle for each side of the hexagon that faces the far disc.
            auto const all = b.mesh().simplices;
            REQUIRE(std::includes(all.begin(), all.end(), expected.begin(), expected.end()));
            REQUIRE(all.size() == 9);
        }
}

TEST_CASE("one sphere far away changes no pore of the others") {
    auto const near = make_heap(3);
    auto const expected = near.pores().simplices;
    REQUIRE(expected.size() > 40);
    for (double const far : {30.0, 1e2, 1e3, 1e4, 1e5, 1e7, 1e9, 1e15})
        for (int k = 0; k < 11; ++k) {
            auto b = near;
            b.add(direction(k) * far);
            REQUIRE(b.pores().simplices == expected);
        }
    // All five spheres: a tetrahedron, and one more for each of its sides that faces the far sphere.
    body<3> four;
    four.add({1, 1, 1});
    four.add({1, -1, -1});
    four.add({-1, 1, -1});
    four.add({-1, -1, 1});
    for (double const far : {1e3, 1e5, 1e7, 1e9})
        for (int k = 0; k < 11; ++k) {
            auto b = four;
            b.add(direction(k) * far);
            std::size_t seen = 0;
            for (auto const& corner : four.x) seen += dot(corner, direction(k)) < 0; // the side opposite it
            REQUIRE(b.mesh().size() == 1 + seen);
        }
}

TEST_CASE("several groups of particles far from each other have their own pores") {
    auto const hexagon = make_hexagon();
    for (double const far : {40.0, 1e4, 1e8, 1e11}) {
        body<2> b;
        b.add({-3 * far, far});
        b.add(hexagon, {0, 0});
        b.add({far, 0.3 * far});
        b.add({far, 0.3 * far + 1});
        b.add(hexagon, {0.5 * far, -far});
        b.add({-far, -2 * far});
        auto const pores = b.pores();
        REQUIRE(pores.size() == 12);
        std::size_t corner = 0;
        for (std::size_t t = 0; t < 12; ++t) {
            REQUIRE(pores.simplices[t][0] == (t < 6 ? 1 : 10));
            corner += std::size_t(std::count(pores.neighbours[t].begin(), pores.neighbours[t].end(), -1));
        }
        REQUIRE(corner == 12);
    }
}

TEST_CASE("discs and spheres in single precision, one far away") {
    auto b = make_hexagon<float>();
    auto const expected = b.pores().simplices;
    REQUIRE(expected.size() == 6);
    for (float const far : {1e3f, 1e7f, 1e12f, 1e30f}) {
        auto c = b;
        c.add({far, -0.3f * far});
        REQUIRE(c.pores().simplices == expected);
    }
}

TEST_CASE("particles in the middle of a ring, far from it, are corners of its pores") {
    // A ring of 126 touching discs; in its middle one disc, or a hexagon.
    body<2> ring;
    double const radius = 0.5 / std::sin(pi / 126);
    for (int k = 0; k < 126; ++k)
        ring.add({radius * std::cos(2 * pi * (k + 0.3) / 126), radius * std::sin(2 * pi * (k + 0.3) / 126)});
    double const filled = 63 * radius * radius * std::sin(2 * pi / 126);
    REQUIRE(ring.pores().size() == 124);

    auto one = ring;
    one.add({0.31, -0.17});
    auto const pores = one.pores();
    REQUIRE(pores.size() == 126);
    for (auto const& s : pores.simplices) REQUIRE(std::count(s.begin(), s.end(), 126) == 1);
    REQUIRE_THAT(mesh_size(pores, view_points(one.x)), WithinRel(filled, 1e-12));

    auto many = ring;
    many.add(make_hexagon(), {0.31, -0.17});
    many.add({1e9, 1e9});
    auto const all = many.pores();
    REQUIRE_THAT(mesh_size(all, view_points(many.x)), WithinRel(filled, 1e-12));
    // Euler: 2 (particles) - 2 - (on the boundary).
    REQUIRE(all.size() == 2 * 133 - 2 - 126);
}

TEST_CASE("radii from 1 to 1e-4, small ones upon large ones: the same simplices as by brute force") {
    std::mt19937_64 engine(7);
    for (double const ratio : {1e2, 1e3, 1e4})
        for (int trial = 0; trial < 4; ++trial) {
            body<2> discs;
            body<3> spheres;
            for (int k = 0; k < 5; ++k) {
                vec<double, 2> const x{6 * uniform(engine), 6 * uniform(engine)};
                vec<double, 3> const y{5 * uniform(engine), 5 * uniform(engine), 5 * uniform(engine)};
                discs.add(x, 1);
                spheres.add(y, 1);
                for (int j = 0; j < 5; ++j) {
                    double const small = (0.3 + uniform(engine)) / ratio;
                    discs.add(
                        x + vec<double, 2>{1 + 1 / ratio + 3 / ratio * uniform(engine), 3 / ratio * uniform(engine)},
                        small);
                    if (j < 2 + k % 3)
                        spheres.add(y + vec<double, 3>{3 / ratio * uniform(engine),
                                                       1 + 1 / ratio + 3 / ratio * uniform(engine),
                                                       3 / ratio * uniform(engine)},
                                    small);
                }
            }
            REQUIRE(sorted_corners(discs.mesh()) == try_all(discs));
            REQUIRE(sorted_corners(spheres.mesh()) == try_all(spheres));
        }
}

TEST_CASE("a disc just inside a straight side of the hull is on it, however far another disc is") {
    // The sides to the disc in the middle bend inwards by twice this share of a diameter: the triangle of all three
    // belongs to the hull.
    for (double const inwards : {1e-6, 1e-7, 1e-8, 3e-9, 1e-9, 2e-10})
        for (double const far : {10.0, 1e4, 1e6, 2e6, 5e6, 1e7, 1e8, 1e10}) {
            body<2> b;
            b.add({0, 0});
            b.add({1, inwards});
            b.add({2, 0});
            b.add({0.5, 0.9});
            b.add({1.5, 0.9});
            b.add({0.3 * far, far});
            auto const all = b.mesh().simplices;
            REQUIRE(std::count(all.begin(), all.end(), std::array<std::int32_t, 3>{0, 2, 1}) == 1);
        }
}

TEST_CASE("points among spheres are hidden in them or corners, however far another sphere is") {
    auto b = make_heap(3);
    auto const expected = b.pores(2).simplices;
    for (int k = 0; k < 5; ++k) b.add(b.x[13] + direction(k) * (0.01 + 0.05 * k), 0); // in the sphere in the middle
    REQUIRE(b.pores(2).simplices == expected);
    for (double const far : {1e3, 1e6, 1e9, 1e15, 1e20, 1e30, 1e60})
        for (int k = 0; k < 11; ++k) {
            auto c = b;
            c.add(direction(k) * far);
            auto const mesh = c.mesh().simplices;
            for (auto const& s : mesh)
                for (auto const i : s) REQUIRE((i < 27 || i == 32));
            REQUIRE(c.pores(2).simplices == expected);
        }
    // In the middle of four spheres that leave a gap there, the point is a corner of four tetrahedra.
    body<3> four;
    four.add({1, 1, 1});
    four.add({1, -1, -1});
    four.add({-1, 1, -1});
    four.add({-1, -1, 1});
    four.add({0.1, 0, 0}, 0);
    REQUIRE(four.mesh().size() == 4);
    for (double const far : {1e6, 1e15, 1e20, 1e30}) {
        auto c = four;
        c.add({far, 0.1 * far, 0.2 * far});
        std::size_t around = 0;
        for (auto const& s : c.mesh().simplices) around += std::size_t(std::count(s.begin(), s.end(), 4));
        REQUIRE(around == 4);
    }
}

namespace {

/// A small simplex within a large one around it: all simplices but the small one have corners of both.
template <class Real, int Dim>
void require_small_within_large(double small, double large) {
    constexpr auto corners = std::size_t(Dim) + 1;
    body<Dim, Real> b;
    for (double const scale : {small, large})
        for (std::size_t c = 0; c < corners; ++c) {
            vec<Real, Dim> x{};
            for (int a = 0; a < Dim; ++a) x[a] = Real(scale * (a == int(c) ? 1.0 : Dim == int(c) ? -0.7 : -0.1));
            b.add(x, Real(1e-3 * small));
        }
    auto const mesh = b.mesh();
    // 2 V - 2 - H triangles of V vertices, H of them on the hull.
    if (Dim == 2) REQUIRE(mesh.size() == 7);
    std::size_t inner = 0, outer = 0, open = 0;
    for (std::size_t t = 0; t < mesh.size(); ++t) {
        auto const& s = mesh.simplices[t];
        std::size_t near = 0;
        for (auto const i : s) near += i < std::int32_t(corners);
        inner += near == corners;
        outer += near == 0;
        for (std::size_t c = 0; c < corners; ++c)
            if (mesh.neighbours[t][c] < 0) {
                ++open;
                for (std::size_t k = 0; k < corners; ++k) REQUIRE((k == c || s[k] >= std::int32_t(corners)));
            }
    }
    REQUIRE(inner == 1);
    REQUIRE(outer == 0);
    REQUIRE(open == corners);
}

} // namespace

TEST_CASE("a small simplex within a large one: lengths over the range of the numbers") {
    for (double const large : {1e2, 1e10, 1e20, 1e37})
        for (double const small : {1e-41, 1e-30, 1e-10, 1.0}) {
            require_small_within_large<float, 2>(small, large);
            require_small_within_large<float, 3>(small, large);
        }
    for (double const large : {1e-250, 1e-100, 1.0, 1e20, 1e69})
        for (double const small : {1e-270, 1e-180, 1e-120, 1e-60, 1e-3})
            if (small < large) {
                require_small_within_large<double, 2>(small, large);
                require_small_within_large<double, 3>(small, large);
            }
}

TEST_CASE("numbers that neither overflow nor underflow: sums and products by hand") {
    using detail::wide_number;
    auto const sign = [](wide_number const& a) { return (a.value() > 0) - (a.value() < 0); };
    // (2^600 + 2^-600)^2 = 2^1200 + 2 + 2^-1200, and 2^1200 alone is beyond a double.
    wide_number const large(0x1p600), small(0x1p-600), sum = large + small;
    REQUIRE(sign(sum * sum - large * large - small * small - wide_number(2)) == 0);
    REQUIRE(sign(sum * sum - large * large - wide_number(2)) > 0);
    REQUIRE(sign(large * large + wide_number(2) - sum * sum) < 0);
    REQUIRE((small * small).value() == 0x1p-1074);
    REQUIRE((-(small * small)).value() == -0x1p-1074);
    REQUIRE((large * small * wide_number(3)).value() == 3);
    REQUIRE((sum - large).value() == 0x1p-600);
    REQUIRE(wide_number(0).value() == 0);
    REQUIRE((wide_number(5e-324) * wide_number(1e308) * wide_number(1e16)).value() == 0x1p-1074 * 1e308 * 1e16);
    std::mt19937_64 engine(11);
    for (int k = 0; k < 2000; ++k) {
        // Whole numbers under 2^30, shifted: their products fit into whole numbers of 64 bits.
        auto const whole = [&] { return std::int64_t(engine() >> 34) - (std::int64_t(1) << 29); };
        std::int64_t const a = whole(), b = whole(), c = whole();
        int const shift = int(engine() % 1500) - 750;
        auto const number = [&](std::int64_t i) { return wide_number(std::ldexp(double(i), shift)); };
        auto const product = (number(a) * number(b) - number(c) * number(a)) + number(b) * number(c);
        auto const back = wide_number(std::ldexp(1.0, -shift));
        REQUIRE_THAT((product * back * back).value(), WithinRel(double(a * b - c * a + b * c), 1e-15));
        REQUIRE(wide_number::difference(double(a), double(b)).value() == double(a - b));
        REQUIRE(sign(wide_number::square(double(a)) - wide_number(double(a)) * wide_number(double(a))) == 0);
    }
}

TEST_CASE("small spheres that touch each other and a large one have a pore") {
    for (double const small : {1e-2, 1e-4, 1e-6, 1e-7, 1e-8}) {
        body<3> b;
        b.add({0, 0, 0}, 0.5);
        for (int k = 0; k < 3; ++k)
            b.add({small * std::cos(2 * pi * k / 3), small * std::sin(2 * pi * k / 3), 0.5 + small}, 0.86 * small);
        REQUIRE(b.mesh().size() == 1);
        // A fourth one upon the three: two tetrahedra.
        b.add({0, 0, 0.5 + 2.4 * small}, 0.86 * small);
        REQUIRE(b.mesh().size() == 2);
    }
}

TEST_CASE("without triangles of hardly any area the boundary has no cut") {
    // Five discs on one line, two of them near each other, and a sixth above its end: a fan.
    body<2> b;
    for (double const x : {0.0, 2e5, 2e5 + 5e-3, 4e5, 4e5 + 0.02}) b.add({x, 0}, 0);
    b.add({4e5 + 0.02, 7e-3}, 0);
    std::vector<std::array<std::int32_t, 3>> const fan{{0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}};
    REQUIRE(sorted_corners(b.mesh()) == fan);
}

TEST_CASE("pores of single precision where its cubes overflow or underflow, and a network that refuses them") {
    auto const expected = make_hexagon().pores().simplices;
    auto const cubic = make_heap(3);
    auto const tetrahedra = cubic.pores().simplices;
    for (double const scale : {1e-20, 1e-13, 1.0, 1e13, 1e20, 1e30}) {
        body<2, float> discs;
        for (auto const& x : make_hexagon().x)
            discs.add({float(scale * x[0]), float(scale * x[1])}, float(0.5 * scale));
        REQUIRE(discs.pores().simplices == expected);
        body<3, float> spheres;
        for (auto const& x : cubic.x)
            spheres.add({float(scale * x[0]), float(scale * x[1]), float(scale * x[2])}, float(0.5 * scale));
        REQUIRE(spheres.pores().simplices == tetrahedra);
        auto const of_spheres = [&] {
            (void)make_pore_network(spheres.pores(), view_points(spheres.x), spheres.r.data());
        };
        if (scale > 1e10)
            REQUIRE_THROWS_WITH(of_spheres(), contains_text("must be finite"));
        else if (scale == 1)
            REQUIRE_NOTHROW(of_spheres());
    }
}

TEST_CASE("positions and radii with too large squares are refused") {
    auto b = make_hexagon();
    b.x[3] = {1e200, 0};
    REQUIRE_THROWS_WITH(b.pores(), contains_text("position of particle 3 = 1e+200: must be"));
    REQUIRE_THROWS_WITH(b.mesh(), contains_text("position of particle 3 = 1e+200: must be"));
    b.x[3] = {1, 0};
    b.r[2] = 1e100;
    REQUIRE_THROWS_WITH(b.pores(), contains_text("radius of particle 2 = 1e+100: must be"));
}

TEST_CASE("signs are exact where rounding would decide") {
    // The point (0.5 + i u, 0.5 + j u) and the diagonal: 12 (y - x) by hand.
    double const u = 0x1p-53;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
            detail::weighted_sites<2> const sites{
                {{0.5 + i * u, 0.5 + j * u}, {12, 12}, {24, 24}}, {0, 0, 0}, {0, 0, 0}};
            double const sign = detail::exact_signs<2>(sites).orientation({0, 1, 2});
            double const expected = (0.5 + j * u) - (0.5 + i * u);
            REQUIRE((sign > 0) == (expected > 0));
            REQUIRE((sign < 0) == (expected < 0));
        }
    // The fourth corner of a square, on the circle of the others or off it by the last bit; the same with its radius.
    auto const inside = [](double x, double radius) {
        detail::weighted_sites<2> const sites{{{0, 0}, {1, 0}, {0, 1}, {x, x}}, {0, 0, 0, radius}, {0, 0, 0, 0}};
        return detail::exact_signs<2>(sites).inside({0, 1, 2}, 3);
    };
    REQUIRE(inside(1, 0) == 0);
    REQUIRE(inside(1 - 0x1p-53, 0) > 0);
    REQUIRE(inside(1 + 0x1p-52, 0) < 0);
    REQUIRE(inside(1, 1e-30) > 0);
    // With x = 1 + e the power is 2 e (1 + e), by hand.
    REQUIRE(inside(1 + 0x1p-40, std::sqrt(0x1p-39) * 0.999) < 0);
    REQUIRE(inside(1 + 0x1p-40, std::sqrt(0x1p-39) * 1.001) > 0);
    // A cube's corners are on one sphere.
    detail::weighted_sites<3> cube;
    for (int k = 0; k < 8; ++k) {
        cube.x.push_back({0.1 * (k & 1), 0.1 * (k >> 1 & 1), 0.1 * (k >> 2)});
        cube.radius.push_back(0.05);
        cube.shift.push_back(0);
    }
    detail::exact_signs<3> const of_cube(cube);
    REQUIRE(of_cube.orientation({0, 1, 2, 4}) > 0);
    for (std::int32_t const p : {3, 5, 6, 7}) REQUIRE(of_cube.inside({0, 1, 2, 4}, p) == 0);
    cube.radius[7] = 0.05 + 1e-17;
    REQUIRE(of_cube.inside({0, 1, 2, 4}, 7) > 0);
    cube.x[7][0] = std::nextafter(0.1, 1.0);
    cube.radius[7] = 0.05;
    REQUIRE(of_cube.inside({0, 1, 2, 4}, 7) < 0);
}

TEST_CASE("incremental insertion fills lattices, with many points on circles, and agrees with Qhull on random points") {
    detail::weighted_sites<2> square;
    detail::weighted_sites<3> cubic;
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) {
            square.x.push_back({i / 16.0, j / 16.0});
            for (int k = 0; k < 5 && j < 5 && i < 5; ++k) cubic.x.push_back({i / 8.0, j / 8.0, k / 8.0});
        }
    square.radius.assign(81, 1.0 / 32);
    square.shift.assign(81, 0);
    cubic.radius.assign(125, 1.0 / 16);
    cubic.shift.assign(125, 0);
    REQUIRE(detail::incremental_triangulation<2>(square).simplices().size() == 128);
    double volume = 0;
    for (auto const& s : detail::incremental_triangulation<3>(cubic).simplices()) {
        double const six = detail::exact_signs<3>(cubic).orientation(s);
        REQUIRE(six > 0);
        volume += six / 6;
    }
    REQUIRE_THAT(volume, WithinRel(0.125, 1e-12));

    std::mt19937_64 engine(41);
    body<2> b;
    detail::weighted_sites<2> sites;
    for (int k = 0; k < 400; ++k) {
        b.add({uniform(engine), uniform(engine)}, 0.04 * uniform(engine));
        sites.x.push_back({b.x.back()[0], b.x.back()[1]});
        sites.radius.push_back(b.r.back());
        sites.shift.push_back(0);
    }
    pore_mesh<2> mesh;
    mesh.simplices = detail::incremental_triangulation<2>(sites).simplices();
    REQUIRE(sorted_corners(mesh) == sorted_corners(b.mesh()));
}

TEST_CASE("the check of a triangulation finds a wrong diagonal, a hole, a lost particle") {
    body<2> b;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) b.add({(j + 0.4 * (i % 2)) / 8, i / 8.0}, 0.05);
    detail::weighted_sites<2> sites;
    std::vector<std::int32_t> index;
    for (std::size_t k = 0; k < b.x.size(); ++k) {
        sites.x.push_back({b.x[k][0], b.x[k][1]});
        index.push_back(std::int32_t(k));
    }
    sites.radius = b.r;
    sites.shift.assign(b.x.size(), 0);
    sites.reach = 1;
    auto const right = b.mesh();
    auto const holds = [&](pore_mesh<2> const& mesh) { return detail::regularity<2>(mesh, sites, index).holds(); };
    REQUIRE(holds(right));

    auto hole = right;
    hole.simplices.erase(hole.simplices.begin() + 9);
    detail::connect(hole);
    REQUIRE_FALSE(holds(hole));

    std::size_t flips = 0;
    for (std::size_t t = 0; t < right.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            auto const other = right.neighbours[t][c];
            if (other < 0 || std::size_t(other) < t) continue;
            auto const side = detail::side_of(right.simplices[t], c);
            auto const own = right.simplices[t][c];
            std::int32_t across = -1;
            for (auto const i : right.simplices[std::size_t(other)])
                if (i != side[0] && i != side[1]) across = i;
            auto flipped = right;
            flipped.simplices[t] = {own, side[0], across};
            flipped.simplices[std::size_t(other)] = {own, across, side[1]};
            detail::connect(flipped);
            REQUIRE_FALSE(holds(flipped));
            ++flips;
        }
    REQUIRE(flips > 15);

    // A disc in the middle that is a corner of no simplex.
    sites.x.push_back({0.2, 0.2});
    sites.radius.push_back(0.05);
    sites.shift.push_back(0);
    REQUIRE_FALSE(holds(right));
    // A hidden disc may be missing; a disc outside the hull may not.
    sites.radius.back() = 0;
    sites.x.back() = {0.125 + 0.01, 0.0 + 0.01};
    REQUIRE(holds(right));
    sites.x.back() = {-0.1, 0.1};
    REQUIRE_FALSE(holds(right));
}

TEST_CASE("a refusal of particles without pores names the reason and the particles") {
    auto const refuse = [](body<2> const& b) {
        try {
            refuse_no_pores(view_points(b.x), b.r.data());
        } catch (particle_refusal const& bad) {
            throw bad.named([](std::size_t i) { return i + 100; });
        }
    };
    body<2> b;
    b.add({0, 1});
    b.add({1, 1});
    REQUIRE_THROWS_AS(refuse(b), std::invalid_argument);
    REQUIRE_THROWS_WITH(refuse(b), contains_text("number of pores = 0: must be at least 1") &&
                                       contains_text("3 particles around it, and there are 2"));
    b.add({2, 1});
    REQUIRE_THROWS_WITH(refuse(b), contains_text("particle 100 at (0, 1) m") &&
                                       contains_text("particle 102 at (2, 1) m") && contains_text("on one line"));
    b.add({0, 90});
    REQUIRE_THROWS_WITH(refuse(b), contains_text("too far from each other"));
    body<3> c;
    for (int k = 0; k < 9; ++k) c.add({double(k % 3), double(k / 3), 7});
    REQUIRE_THROWS_WITH(refuse_no_pores(view_points(c.x), c.r.data()),
                        contains_text("particle 0 at (0, 0, 7) m to particle 8 at (2, 2, 7) m, lie in one plane"));

    // A simplex without size is no pore.
    pore_mesh<2> flat;
    flat.simplices = {{0, 1, 2}};
    flat.neighbours = {{-1, -1, -1}};
    REQUIRE_THROWS_WITH(make_pore_network(flat, view_points(b.x), b.r.data()),
                        contains_text("0 at (0, 1), 1 at (1, 1), 2 at (2, 1) m = 0: must be > 0"));
}
