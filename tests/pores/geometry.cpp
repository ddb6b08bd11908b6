// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "reference.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <lacuna/core/dual.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/pores/mesh/geometry.hpp>

using namespace lacuna;
using point = vec<double, 2>;

namespace {

constexpr double pi = 3.14159265358979323846;

struct three_discs {
    point x[3];
    double r[3];
};

/// Touching discs, the first at the origin, the second on the x axis, the third above.
three_discs touching(double r0, double r1, double r2) {
    double const a = r0 + r1, b = r0 + r2, c = r1 + r2;
    double const x = (a * a + b * b - c * c) / (2 * a);
    return {{{0, 0}, {a, 0}, {x, std::sqrt(b * b - x * x)}}, {r0, r1, r2}};
}

double volume(three_discs const& d, double thickness) {
    return pore_volume(d.x[0], d.x[1], d.x[2], d.r[0], d.r[1], d.r[2], thickness, 0.0);
}
point traction_on(three_discs const& d, int c, double thickness) {
    int const j = (c + 1) % 3, k = (c + 2) % 3;
    return pore_traction(d.x[c], d.x[j], d.x[k], d.r[c], d.r[j], d.r[k], thickness);
}
double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

} // namespace

TEST_CASE("angle of a vector agrees with the standard library") {
    for (int k = 0; k <= 2000; ++k) {
        double const angle = pi * k / 2000;
        double const y = std::fabs(3 * std::sin(angle)), x = 3 * std::cos(angle);
        REQUIRE_THAT(detail::upper_angle(y, x), WithinAbs(std::atan2(y, x), 5e-16));
    }
    for (int k = 0; k <= 400; ++k) { // on both sides of the angles at which the reduction changes
        double const angle = pi * (k / 4 % 4 * 2 + 1) / 8 + 1e-3 * (k / 400.0 - 0.5);
        double const y = std::sin(angle), x = std::cos(angle);
        REQUIRE_THAT(detail::upper_angle(y, x), WithinAbs(std::atan2(y, x), 5e-16));
    }
    REQUIRE_THAT(detail::upper_angle(0.0, 1.0), WithinAbs(0, 0));
    REQUIRE_THAT(detail::upper_angle(0.0, -1.0), WithinRel(pi, 1e-16));
    REQUIRE_THAT(detail::upper_angle(2.0, 0.0), WithinRel(pi / 2, 1e-16));
    REQUIRE_THAT(detail::upper_angle(0.0, 0.0), WithinAbs(0, 0));
    REQUIRE_THAT(detail::upper_angle(1.0f, -1.0f), WithinRel(float(3 * pi / 4), 2e-7f));
}

TEST_CASE("void of three equal touching discs") {
    auto const d = touching(1, 1, 1);
    REQUIRE_THAT(void_area(d.x[0], d.x[1], d.x[2], 1.0, 1.0, 1.0),
                 WithinRel(reference("9a.three_equal", "area/R^2"), 1e-11));
    REQUIRE_THAT(void_area(d.x[0], d.x[1], d.x[2], 1.0, 1.0, 1.0), WithinRel(std::sqrt(3.0) - pi / 2, 1e-14));
    double const area = triangle_area(d.x[0], d.x[1], d.x[2]);
    REQUIRE_THAT(volume(d, 1) / area, WithinRel(reference("9a.three_equal", "porosity_triangular"), 1e-11));
    for (int c = 0; c < 3; ++c) {
        auto const t = traction_on(d, c, 1);
        REQUIRE_THAT(norm(t), WithinRel(reference("9a.three_equal", "chord"), 1e-14));
        auto const opposite = d.x[(c + 2) % 3] - d.x[(c + 1) % 3];
        REQUIRE_THAT(dot(t, opposite), WithinAbs(0, 1e-14));
        auto const outwards = d.x[c] - (d.x[(c + 1) % 3] + d.x[(c + 2) % 3]) / 2.0;
        REQUIRE(dot(t, outwards) > 0);
    }
}

TEST_CASE("void of three unequal touching discs") {
    for (auto const& [id, r] : {std::pair{"9b.three_unequal_1.5_1.75_2", std::array{1.5, 1.75, 2.0}},
                                std::pair{"9b.three_unequal_1_2_3", std::array{1.0, 2.0, 3.0}}}) {
        auto const d = touching(r[0], r[1], r[2]);
        REQUIRE_THAT(volume(d, 1), WithinRel(reference(id, "pore_area"), 1e-11));
        REQUIRE_THAT(volume(d, 3.5), WithinRel(3.5 * reference(id, "pore_area"), 1e-11));
        REQUIRE_THAT(triangle_area(d.x[0], d.x[1], d.x[2]), WithinRel(reference(id, "triangle_area"), 1e-12));
        REQUIRE_THAT(triangle_area(d.x[0], d.x[2], d.x[1]), WithinRel(-reference(id, "triangle_area"), 1e-12));
        for (int c = 0; c < 3; ++c) {
            // The references have twelve digits; the formulas of their derivation give more.
            auto const ri = r[std::size_t(c)], rj = r[std::size_t((c + 1) % 3)], rk = r[std::size_t((c + 2) % 3)];
            double const angle = 2 * std::atan(std::sqrt(rj * rk / (ri * (ri + rj + rk))));
            double const computed = corner_angle(d.x[c], d.x[(c + 1) % 3], d.x[(c + 2) % 3]);
            REQUIRE_THAT(computed, WithinRel(reference(id, "angles", c), 1e-11));
            REQUIRE_THAT(computed, WithinRel(angle, 1e-14));
            REQUIRE_THAT(norm(traction_on(d, c, 1)), WithinRel(reference(id, "chords", c), 1e-11));
            REQUIRE_THAT(norm(traction_on(d, c, 1)), WithinRel(2 * ri * std::sin(angle / 2), 1e-14));
        }
    }
    auto const positions = reference_table("9c.positions");
    auto const d = touching(1.5, 1.75, 2.0);
    for (int c = 0; c < 3; ++c)
        for (int axis = 0; axis < 2; ++axis)
            REQUIRE_THAT(d.x[c][axis], WithinAbs(positions[std::size_t(c)][std::size_t(axis)], 1e-11));
}

TEST_CASE("volume is floored, also for an inverted triangle") {
    point const a{0, 0}, b{1, 0}, c{0.5, 0.1};
    REQUIRE(void_area(a, b, c, 0.5, 0.5, 0.5) < 0);
    REQUIRE(pore_volume(a, b, c, 0.5, 0.5, 0.5, 2.0, 1e-3) == 1e-3);
    REQUIRE(void_area(a, c, b, 0.01, 0.01, 0.01) < 0);
    REQUIRE(pore_volume(a, c, b, 0.01, 0.01, 0.01, 2.0, 1e-3) == 1e-3);
}

TEST_CASE("joint point is the contact point of touching discs and of equal power to others") {
    auto const touch = joint_point(point{1, 0}, point{4, 4}, 2.0, 3.0);
    REQUIRE_THAT(touch[0], WithinRel(1 + 3 * 0.4, 1e-15));
    REQUIRE_THAT(touch[1], WithinRel(4 * 0.4, 1e-15));
    // 10 apart, radii 1 and 3: x^2 - 1 = (10 - x)^2 - 9 at x = 4.6.
    auto const apart = joint_point(point{0, 0}, point{10, 0}, 1.0, 3.0);
    REQUIRE_THAT(apart[0], WithinRel(4.6, 1e-15));
    auto const other = joint_point(point{10, 0}, point{0, 0}, 3.0, 1.0);
    REQUIRE_THAT(other[0], WithinRel(4.6, 1e-15));
}

TEST_CASE("tractions are conjugate to the volume, whether discs touch, overlap or stand apart") {
    double const thickness = 0.7;
    std::mt19937_64 engine(3);
    for (int trial = 0; trial < 60; ++trial) {
        auto d = touching(1 + uniform(engine), 1 + uniform(engine), 1 + uniform(engine));
        double const stretch = trial < 10 ? 1.0 : trial < 30 ? 0.99 : 1.5;
        for (auto& x : d.x) x = x * stretch + point{0.02 * uniform(engine), 0.02 * uniform(engine)};
        for (int c = 0; c < 3; ++c) {
            auto const t = traction_on(d, c, thickness);
            for (int axis = 0; axis < 2; ++axis) {
                double const h = 1e-5;
                auto more = d, less = d;
                more.x[c][axis] += h;
                less.x[c][axis] -= h;
                double const slope = (volume(more, thickness) - volume(less, thickness)) / (2 * h);
                REQUIRE_THAT(t[axis], WithinAbs(slope, 1e-9));
            }
        }
    }
}

TEST_CASE("dual numbers give the same derivative as the tractions") {
    using number = dual<double, 6>;
    auto const d = touching(1.5, 1.75, 2.0);
    vec<number, 2> x[3];
    for (int c = 0; c < 3; ++c)
        for (int axis = 0; axis < 2; ++axis) x[c][axis] = number::variable(d.x[c][axis], 2 * c + axis);
    auto const v = pore_volume(x[0], x[1], x[2], number(1.5), number(1.75), number(2.0), number(1.0), number(0.0));
    REQUIRE_THAT(v.value, WithinRel(reference("9b.three_unequal_1.5_1.75_2", "pore_area"), 1e-11));
    for (int c = 0; c < 3; ++c)
        for (int axis = 0; axis < 2; ++axis)
            REQUIRE_THAT(v.derivative[2 * c + axis], WithinAbs(traction_on(d, c, 1)[axis], 1e-13));
}

TEST_CASE("the forces of a uniform pressure on a pore's discs have no sum and no moment, touching or not") {
    std::mt19937_64 engine(5);
    for (int trial = 0; trial < 200; ++trial) {
        three_discs d;
        for (int c = 0; c < 3; ++c) {
            d.x[c] = {10 * uniform(engine), 10 * uniform(engine)};
            d.r[c] = 0.2 + uniform(engine);
        }
        point force{};
        double moment = 0;
        for (int c = 0; c < 3; ++c) {
            auto const t = traction_on(d, c, 2.0);
            force += t;
            moment += cross(d.x[c], t);
        }
        REQUIRE_THAT(norm(force), WithinAbs(0, 1e-12));
        REQUIRE_THAT(moment, WithinAbs(0, 1e-11));
    }
}

TEST_CASE("packs give in each lane the same as plain numbers") {
    using row = pack<double, 4>;
    std::mt19937_64 engine(7);
    vec<row, 2> x[3];
    row r[3];
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 4; ++k) {
            x[c][0].v[k] = uniform(engine);
            x[c][1].v[k] = uniform(engine);
            r[c].v[k] = 0.1 * uniform(engine);
        }
    auto const v = void_area(x[0], x[1], x[2], r[0], r[1], r[2]);
    auto const t = pore_traction(x[0], x[1], x[2], r[0], r[1], r[2], row(2.0));
    for (int k = 0; k < 4; ++k) {
        auto const at = [&](int c) { return point{x[c][0][k], x[c][1][k]}; };
        REQUIRE_THAT(v[k], WithinAbs(void_area(at(0), at(1), at(2), r[0][k], r[1][k], r[2][k]), 1e-15));
        auto const one = pore_traction(at(0), at(1), at(2), r[0][k], r[1][k], r[2][k], 2.0);
        REQUIRE_THAT(t[0][k], WithinAbs(one[0], 1e-15));
    }
}
