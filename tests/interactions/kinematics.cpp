// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <numbers>

#include <lacuna/interactions/kinematics.hpp>

#include "catch.hpp"

using lacuna::body;
using lacuna::vec;

namespace {

constexpr double pi = std::numbers::pi;

/// v rotated about the unit axis by the angle (Rodrigues).
vec<double, 3> rotate(vec<double, 3> const& v, vec<double, 3> const& axis, double angle) {
    return v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - std::cos(angle)));
}
vec<double, 2> rotate(vec<double, 2> const& v, double angle) {
    return v * std::cos(angle) + perpendicular(v) * std::sin(angle);
}

} // namespace

TEST_CASE("relative motion of two discs by hand", "[kinematics]") {
    // i at the origin, r = 1, spin 3; j at (0, 4), r = 2, spin -1, moving at (0.5, 0.25); dt = 0.001.
    // n = (0, 1), s = (-1, 0): rate 0.25; slip -0.5 - 4/3 (1 * 3 + 2 * -1) = -0.5 - 4/3 per second.
    body<double, 2> const i{{0, 0}, {0, 0}, {3}, 1, 1}, j{{0, 4}, {0.5, 0.25}, {-1}, 2, 1};
    auto const frame = relative_motion(i, j, 1e-3);
    REQUIRE_THAT(frame.normal[1], WithinRel(1.0, 1e-15));
    REQUIRE(frame.motion.distance == 4);
    REQUIRE_THAT(frame.motion.normal_rate, WithinRel(0.25, 1e-15));
    REQUIRE_THAT(frame.motion.slip[0], WithinRel(-0.001 * (0.5 + 4.0 / 3), 1e-4));
    REQUIRE_THAT(frame.lever, WithinRel(4.0 / 3, 1e-15));
    // Tension pulls i towards j, a positive shear force on i is along s; the torque per radius is the same for both.
    auto const force = frame.force(10, {2});
    REQUIRE_THAT(force[0], WithinRel(-2.0, 1e-14));
    REQUIRE_THAT(force[1], WithinRel(10.0, 1e-14));
    REQUIRE_THAT(frame.torque_per_radius({2})[0], WithinRel(8.0 / 3, 1e-14));
}

TEST_CASE("forces of a pair of discs have no moment", "[kinematics]") {
    body<double, 2> const i{{0.3, -1}, {}, {}, 1.5, 1}, j{{2, 1.1}, {}, {}, 0.75, 1};
    auto const frame = relative_motion(i, j, 1e-3);
    auto const f = frame.force(-3, {5});
    double const torque = frame.torque_per_radius({5})[0] * (1.5 + 0.75);
    REQUIRE_THAT(cross(i.position, f) + cross(j.position, -f) + torque, WithinAbs(0, 1e-14));
}

TEST_CASE("forces of a pair of spheres have no moment", "[kinematics][3d]") {
    body<double, 3> const i{{0.3, -1, 0.2}, {}, {}, 1.5, 1}, j{{2, 1.1, -0.4}, {}, {}, 0.75, 1};
    auto const frame = relative_motion(i, j, 1e-3);
    vec<double, 3> shear{1, -2, 0.5};
    shear -= frame.normal * dot(frame.normal, shear);
    auto const f = frame.force(-3, shear);
    auto const sum = cross(i.position, f) + cross(j.position, -f) + frame.torque_per_radius(shear) * (1.5 + 0.75);
    REQUIRE(norm(sum) < 1e-14);
}

TEST_CASE("a rigid motion in the plane gives no slip, at any stretch and through ten turns", "[kinematics]") {
    double const ri = 1.2, rj = 0.7, dt = 1e-3;
    for (double const stretch : {0.9, 1.0, 1.1})
        for (int const steps_per_turn : {700, 7000}) {
            vec<double, 2> const arm_i{-0.4, 0.3}, arm_j = arm_i + vec<double, 2>{0.6, 0.8} * (stretch * (ri + rj));
            vec<double, 2> const drift{0.3, -0.2};
            double const spin = 2 * pi / (steps_per_turn * dt);
            auto const position_of = [&](vec<double, 2> const& arm, int n) {
                return rotate(arm, 2 * pi * n / steps_per_turn) + drift * (n * dt);
            };
            double total = 0, largest = 0;
            for (int n = 1; n <= 10 * steps_per_turn; ++n) {
                body<double, 2> i{position_of(arm_i, n), {}, {spin}, ri, 1},
                    j{position_of(arm_j, n), {}, {spin}, rj, 1};
                i.velocity = (i.position - position_of(arm_i, n - 1)) / dt;
                j.velocity = (j.position - position_of(arm_j, n - 1)) / dt;
                total += relative_motion(i, j, dt).motion.slip[0];
                largest = std::max(largest, std::fabs(total));
            }
            // A rotation by 20 pi with 70,000 roundings of 1e-15 each.
            REQUIRE(largest < 1e-10);
        }
}

TEST_CASE("a disc that rolls around another does not slip", "[kinematics]") {
    // Two gears on a bar that rotates at Omega: r_i w_i + r_j w_j = (r_i + r_j) Omega.
    double const ri = 1.2, rj = 0.7, dt = 1e-3, omega = 1.7, spin_i = 5.0;
    double const spin_j = ((ri + rj) * omega - ri * spin_i) / rj;
    double total = 0;
    for (int n = 1; n <= 10000; ++n) {
        auto const at = [&](int m) { return rotate(vec<double, 2>{ri + rj, 0}, omega * dt * m); };
        body<double, 2> const i{{0, 0}, {0, 0}, {spin_i}, ri, 1},
            j{at(n), (at(n) - at(n - 1)) / dt, {spin_j}, rj, 1};
        total += relative_motion(i, j, dt).motion.slip[0];
    }
    REQUIRE_THAT(total, WithinAbs(0, 1e-10));
}

TEST_CASE("a rigid motion in space gives no slip, and the shear force rotates with the pair", "[kinematics][3d]") {
    double const ri = 1.2, rj = 0.7, dt = 1e-3;
    vec<double, 3> const axes[] = {
        {0, 0, 1}, {0.6, 0, 0.8}, {1 / std::sqrt(3.0), -1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}, {0.36, 0.48, 0.8}};
    for (auto const& axis : axes)
        for (double const stretch : {0.9, 1.0, 1.1}) {
            int const steps_per_turn = 4000;
            vec<double, 3> const arm_i{-0.4, 0.3, 0.1}, n0{0.36, 0.48, 0.8};
            auto const arm_j = arm_i + n0 * (stretch * (ri + rj));
            double const rate = 2 * pi / (steps_per_turn * dt);
            auto const position_of = [&](vec<double, 3> const& arm, int n) {
                return rotate(arm, axis, 2 * pi * n / steps_per_turn) + vec<double, 3>{0.1, -0.2, 0.3} * (n * dt);
            };
            vec<double, 3> shear0 = cross(n0, vec<double, 3>{1, 0, 0});
            shear0 *= 1 / norm(shear0);
            auto shear = shear0, moved = vec<double, 3>{};
            double length = 0, away = 0;
            for (int n = 1; n <= 10 * steps_per_turn; ++n) {
                body<double, 3> i{position_of(arm_i, n), {}, axis * rate, ri, 1},
                    j{position_of(arm_j, n), {}, axis * rate, rj, 1};
                i.velocity = (i.position - position_of(arm_i, n - 1)) / dt;
                j.velocity = (j.position - position_of(arm_j, n - 1)) / dt;
                auto const frame = relative_motion(i, j, dt);
                shear = frame.rotate_with_pair(shear);
                moved = frame.rotate_with_pair(moved) + frame.motion.slip;
                length = std::max(length, std::fabs(norm(shear) - 1));
                away = std::max(away, norm(shear - rotate(shear0, axis, 2 * pi * n / steps_per_turn)));
            }
            INFO("axis " << axis[0] << " " << axis[1] << " " << axis[2] << ", stretch " << stretch);
            CHECK(norm(moved) < 1e-9);
            CHECK(length < 1e-10);
            // The twist about n is exact to third order in the angle of a step: 40,000 times (2 pi / 4000)^3 / 12.
            CHECK(away < 2e-5);
        }
}

TEST_CASE("in space a pair in a plane moves as two discs do", "[kinematics][3d]") {
    body<double, 2> const i{{0, 0}, {0.1, -0.3}, {3}, 1, 1}, j{{1.2, 1.6}, {-0.5, 0.25}, {-1}, 0.8, 1};
    body<double, 3> const i3{{0, 0, 0}, {0.1, -0.3, 0}, {0, 0, 3}, 1, 1},
        j3{{1.2, 1.6, 0}, {-0.5, 0.25, 0}, {0, 0, -1}, 0.8, 1};
    auto const flat = relative_motion(i, j, 1e-3);
    auto const full = relative_motion(i3, j3, 1e-3);
    auto const tangent = perpendicular(flat.normal);
    REQUIRE_THAT(full.motion.slip[0], WithinRel(flat.motion.slip[0] * tangent[0], 1e-5));
    REQUIRE_THAT(full.motion.slip[1], WithinRel(flat.motion.slip[0] * tangent[1], 1e-5));
    REQUIRE_THAT(full.motion.slip[2], WithinAbs(0, 1e-18));
    REQUIRE_THAT(full.motion.normal_rate, WithinRel(flat.motion.normal_rate, 1e-14));
    vec<double, 3> const shear{tangent[0] * 2, tangent[1] * 2, 0};
    REQUIRE_THAT(full.torque_per_radius(shear)[2], WithinRel(flat.torque_per_radius({2})[0], 1e-14));
}
