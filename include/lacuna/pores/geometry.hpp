// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/vec.hpp>

/// \file
/// Formulas of pores in the plane, over a scalar type T (plain number, pack, dual number). A pore is the triangle
/// of three particle centres, counter-clockwise, less the sectors of the discs in it; t is the thickness in m.

namespace lacuna {

namespace detail {

/// Angle of the vector (x, y) with y >= 0, from 0 to pi; 0 for the zero vector.
///
/// Written out because a law's scalar type has no inverse tangent. Argument reduced to |z| <= 0.66, where the
/// rational approximation of S. L. Moshier's Cephes library (atan.c) is good to rounding in double precision.
template <class T>
T upper_angle(T const& y, T const& x) noexcept {
    using V = value_t<T>;
    T const ax = abs(x);
    auto const steep = ax < y;
    T const low = select(steep, ax, y);
    T const high = select(steep, y, ax);
    auto const middle = low > T(V(0.66)) * high;
    T const divisor = select(middle, low + high, high);
    T const z = select(middle, low - high, low) / select(divisor > T(0), divisor, T(1));
    T const s = z * z;
    T const p = (((T(V(-8.750608600031904122785e-1)) * s + T(V(-1.615753718733365076637e1))) * s +
                  T(V(-7.500855792314704667340e1))) * s + T(V(-1.228866684490136173410e2))) * s +
                T(V(-6.485021904942025371773e1));
    T const q = ((((s + T(V(2.485846490142306297962e1))) * s + T(V(1.650270098316988542046e2))) * s +
                  T(V(4.328810604912902668951e2))) * s + T(V(4.853903996359136964868e2))) * s +
                T(V(1.945506571482613964425e2));
    T const core = z + z * (s * p / q);
    V const pi = V(3.14159265358979323846264338327950288);
    T const octant = select(middle, T(pi / 4) + core, core);
    T const quadrant = select(steep, T(pi / 2) - octant, octant);
    return select(x < T(0), T(pi) - quadrant, quadrant);
}

} // namespace detail

/// Area of the triangle a, b, c; positive when counter-clockwise. m^2.
template <class T>
constexpr T triangle_area(vec<T, 2> const& a, vec<T, 2> const& b, vec<T, 2> const& c) noexcept {
    return cross(b - a, c - a) * T(value_t<T>(0.5));
}

/// Angle of a triangle at `corner`, between the directions to the other two corners; 0 to pi.
template <class T>
T corner_angle(vec<T, 2> const& corner, vec<T, 2> const& one, vec<T, 2> const& other) noexcept {
    auto const u = one - corner, v = other - corner;
    return detail::upper_angle(abs(cross(u, v)), dot(u, v));
}

/// Area of the triangle less the three sectors of the discs in it; negative where the discs overlap too much to
/// leave a void, and for a triangle that has turned over. m^2.
template <class T>
T void_area(vec<T, 2> const& a, vec<T, 2> const& b, vec<T, 2> const& c, T const& ra, T const& rb,
            T const& rc) noexcept {
    auto const ab = b - a, bc = c - b, ca = a - c;
    T const twice = cross(ab, -ca);
    T const height = abs(twice);
    T const sectors = ra * ra * detail::upper_angle(height, -dot(ab, ca)) +
                      rb * rb * detail::upper_angle(height, -dot(bc, ab)) +
                      rc * rc * detail::upper_angle(height, -dot(ca, bc));
    return (twice - sectors) * T(value_t<T>(0.5));
}

/// Pore volume V_p, m^3: the void times the thickness, not less than `floor`.
template <class T>
T pore_volume(vec<T, 2> const& a, vec<T, 2> const& b, vec<T, 2> const& c, T const& ra, T const& rb, T const& rc,
              T const& thickness, T const& floor) noexcept {
    return max(void_area(a, b, c, ra, rb, rc) * thickness, floor);
}

/// Where the joint of two particles lies between their centres: 0 at i, 1 at j.
///
/// The joint is the point of equal power with respect to both discs, (d^2 + r_i^2 - r_j^2) / (2 d^2): where the discs
/// touch it is the contact point (r_i over r_i + r_j), and at any gap or overlap it is the one point for which eq. 16's
/// chords are the derivatives of the pore volume. The edges of the regular triangulation cross there as well.
template <class T>
constexpr T joint_share(vec<T, 2> const& xi, vec<T, 2> const& xj, T const& ri, T const& rj) noexcept {
    T const half = T(value_t<T>(0.5));
    return half + half * ((ri - rj) * (ri + rj)) / squared_norm(xj - xi);
}

/// Joint of two particles, m; see joint_share().
template <class T>
constexpr vec<T, 2> joint_point(vec<T, 2> const& xi, vec<T, 2> const& xj, T const& ri, T const& rj) noexcept {
    return xi + (xj - xi) * joint_share(xi, xj, ri, rj);
}

/// Eq. 16 for particle i in the pore of i, j, k (counter-clockwise): the force, in N, of a pressure of 1 Pa on the
/// chord between the joints of i with j and with k, outwards from the pore, over the thickness.
///
/// It is the derivative of the pore's volume by the position of i, at any gap (as long as the volume is above its
/// floor): the work of the pressure on the particles is that of the pore's change of volume. A volume does not change
/// when its pore is moved or turned, so the three forces of a pore have no sum and no moment. They act through the
/// centres: a pressure on a smooth disc does not turn it.
template <class T>
constexpr vec<T, 2> pore_traction(vec<T, 2> const& xi, vec<T, 2> const& xj, vec<T, 2> const& xk, T const& ri,
                                  T const& rj, T const& rk, T const& thickness) noexcept {
    auto const next = (xj - xi) * joint_share(xi, xj, ri, rj);
    auto const last = (xk - xi) * joint_share(xi, xk, ri, rk);
    return perpendicular(last - next) * thickness;
}

} // namespace lacuna
