// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <numbers>

#include <lacuna/core/vec.hpp>

/// \file
/// Formulas of pores in the plane, over a scalar type T (plain number, pack, dual number). A pore is the triangle of
/// three particle centres, counter-clockwise, less the sectors of the discs in it; t is the thickness in m.

namespace lacuna {

namespace detail {

/// Angle of a vector (x, y) with y >= 0, as base plus or minus the inverse tangent of above / below, a ratio of at most
/// tan(pi/8). Kept apart so that several divisions can be made in one.
template <class T>
struct reduced_angle {
    T above, below;
    mask_t<T> steep, middle, obtuse;

    reduced_angle(T const& y, T const& x) noexcept {
        using V = value_t<T>;
        T ax = abs(x);
        steep = ax < y;
        obtuse = x < T(V(0));
        T low = min(ax, y), high = max(ax, y);
        middle = low > T(V(0.41421356237309503)) * high;
        above = select(middle, low - high, low);
        below = select(middle, low + high, high);
    }
    /// \param z above / below
    ///
    /// A law's scalar type has no inverse tangent. The polynomial interpolates it at Chebyshev's points of z^2 for
    /// |z| <= tan(pi/8); its error, below 6e-17, is less than that of the arithmetic.
    T angle(T const& z) const noexcept {
        using V = value_t<T>;
        T s = z * z, s2 = s * s;
        // By pairs of terms: a chain half as long as one by one.
        T p = T(V(2.2748939747779046e-2)) * s + T(V(-4.483218628995374e-2));
        p = p * s2 + (T(V(5.7362969593526145e-2)) * s + T(V(-6.649607953399717e-2)));
        p = p * s2 + (T(V(7.691054614825647e-2)) * s + T(V(-9.090852527088297e-2)));
        p = p * s2 + (T(V(1.1111109635603796e-1)) * s + T(V(-1.428571426608229e-1)));
        p = p * s2 + (T(V(1.9999999999898324e-1)) * s + T(V(-3.333333333333325e-1)));
        T core = z + z * (s * p);
        V half_turn = std::numbers::pi_v<V>;
        T octant = select(middle, T(half_turn / 4) + core, core);
        T quadrant = select(steep, T(half_turn / 2) - octant, octant);
        return select(obtuse, T(half_turn) - quadrant, quadrant);
    }
};

/// Angle of the vector (x, y) with y >= 0, from 0 to pi; 0 for the zero vector.
template <class T>
T upper_angle(T const& y, T const& x) noexcept {
    reduced_angle<T> a(y, x);
    T zero(value_t<T>(0));
    return a.angle(a.above / select(a.below > zero, a.below, T(value_t<T>(1))));
}

/// Replaces five numbers by their inverses, with one division where the range of the numbers allows for a product of
/// five (a pack's division takes as long as ten multiplications).
template <class T>
void invert(T& a, T& b, T& c, T& d, T& e) noexcept {
    using V = value_t<T>;
    if constexpr (std::numeric_limits<V>::max_exponent10 < 300) {
        T one(V(1));
        a = one / a, b = one / b, c = one / c, d = one / d, e = one / e;
    } else {
        T ab = a * b, cd = c * d;
        T abe = ab * e;
        T all = T(V(1)) / (abe * cd);
        T for_cd = all * abe, for_abe = all * cd;
        T for_ab = for_abe * e;
        e = for_abe * ab;
        T a_old = a, c_old = c;
        a = for_ab * b;
        b = for_ab * a_old;
        c = for_cd * d;
        d = for_cd * c_old;
    }
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

/// What the three discs at the corners of a pore leave.
template <class T>
struct pore_shape {
    T void_area;           ///< m^2; see void_area()
    vec<T, 2> traction[3]; ///< on each corner, for 1 Pa and a thickness of 1 m; see pore_traction()
};

/// Void and tractions of a pore together: the formula of both. Not a number where two centres coincide.
template <class T>
pore_shape<T> measure_pore(vec<T, 2> const& a, vec<T, 2> const& b, vec<T, 2> const& c, T const& ra, T const& rb,
                           T const& rc) noexcept {
    using V = value_t<T>;
    T half(V(0.5));
    vec<T, 2> ab = b - a, bc = c - b, ca = a - c;
    T twice = cross(ca, ab);
    T height = abs(twice);
    detail::reduced_angle<T> at_a(height, -dot(ca, ab)), at_b(height, -dot(ab, bc));
    T per_ab = squared_norm(ab), per_bc = squared_norm(bc), per_ca = squared_norm(ca);
    T per_a = at_a.below, per_b = at_b.below;
    detail::invert(per_ab, per_bc, per_ca, per_a, per_b);

    T qa = ra * ra, qb = rb * rb, qc = rc * rc;
    // The third angle is the rest of pi.
    T sectors = qc * T(V(3.14159265358979323846264338327950288)) + (qa - qc) * at_a.angle(at_a.above * per_a) +
                (qb - qc) * at_b.angle(at_b.above * per_b);
    // The joints of a with b, b with c and a with c, as seen from a.
    vec<T, 2> joint_ab = ab * (half + half * ((qa - qb) * per_ab));
    vec<T, 2> joint_bc = ab + bc * (half + half * ((qb - qc) * per_bc));
    vec<T, 2> joint_ca = ca * (half * ((qc - qa) * per_ca) - half);

    pore_shape<T> shape;
    shape.void_area = (twice - sectors) * half;
    shape.traction[0] = perpendicular(joint_ca - joint_ab);
    shape.traction[1] = perpendicular(joint_ab - joint_bc);
    shape.traction[2] = perpendicular(joint_bc - joint_ca);
    return shape;
}

/// Area of the triangle less the three sectors of the discs in it; negative where the discs overlap too much to
/// leave a void, and for a triangle that has turned over. m^2. Not a number where two centres coincide.
template <class T>
T void_area(vec<T, 2> const& a, vec<T, 2> const& b, vec<T, 2> const& c, T const& ra, T const& rb,
            T const& rc) noexcept {
    return measure_pore(a, b, c, ra, rb, rc).void_area;
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
vec<T, 2> pore_traction(vec<T, 2> const& xi, vec<T, 2> const& xj, vec<T, 2> const& xk, T const& ri, T const& rj,
                        T const& rk, T const& thickness) noexcept {
    return measure_pore(xi, xj, xk, ri, rj, rk).traction[0] * thickness;
}

} // namespace lacuna
