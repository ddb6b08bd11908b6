// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/vec.hpp>
#include <lacuna/pores/geometry.hpp>

/// \file
/// Formulas of pores in space, over a scalar type T (plain number, pack, dual number). A pore is the tetrahedron of
/// four particle centres less the sectors of the spheres in it; a throat is a facet less the sectors of the discs that
/// its plane cuts out of the three spheres.

namespace lacuna {

/// Volume of the tetrahedron a, b, c, d; positive when a, b, c turn counter-clockwise as seen from d. m^3.
template <class T>
constexpr T tetrahedron_volume(vec<T, 3> const& a, vec<T, 3> const& b, vec<T, 3> const& c,
                               vec<T, 3> const& d) noexcept {
    return dot(cross(b - a, c - a), d - a) / T(value_t<T>(6));
}

/// Area of a triangle in space, not negative. m^2.
template <class T>
T triangle_area(vec<T, 3> const& a, vec<T, 3> const& b, vec<T, 3> const& c) noexcept {
    return norm(cross(b - a, c - a)) * T(value_t<T>(0.5));
}

/// Solid angle under which the triangle of one, two, three is seen from `corner`, sr; 0 to 2 pi.
///
/// A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30 (1983) 125:
///   tan(Omega / 2) = |u . (v x w)| / (uvw + (u . v) w + (v . w) u + (w . u) v)
template <class T>
T solid_angle(vec<T, 3> const& corner, vec<T, 3> const& one, vec<T, 3> const& two, vec<T, 3> const& three) noexcept {
    auto const u = one - corner, v = two - corner, w = three - corner;
    T const nu = norm(u), nv = norm(v), nw = norm(w);
    T const below = nu * nv * nw + dot(u, v) * nw + dot(v, w) * nu + dot(w, u) * nv;
    return T(value_t<T>(2)) * detail::upper_angle(abs(dot(u, cross(v, w))), below);
}

/// Volume of the tetrahedron less the four spherical sectors r^3 Omega / 3 in it; negative where the spheres overlap too
/// much to leave a void, and for a tetrahedron that has turned over. m^3. Not a number where two centres coincide.
template <class T>
T void_volume(vec<T, 3> const& a, vec<T, 3> const& b, vec<T, 3> const& c, vec<T, 3> const& d, T const& ra, T const& rb,
              T const& rc, T const& rd) noexcept {
    T const sectors = ra * ra * ra * solid_angle(a, b, c, d) + rb * rb * rb * solid_angle(b, c, d, a) +
                      rc * rc * rc * solid_angle(c, d, a, b) + rd * rd * rd * solid_angle(d, a, b, c);
    return tetrahedron_volume(a, b, c, d) - sectors / T(value_t<T>(3));
}

/// Pore volume V_p, m^3: the void, not less than `floor`.
template <class T>
T pore_volume(vec<T, 3> const& a, vec<T, 3> const& b, vec<T, 3> const& c, vec<T, 3> const& d, T const& ra, T const& rb,
              T const& rc, T const& rd, T const& floor) noexcept {
    return max(void_volume(a, b, c, d, ra, rb, rc, rd), floor);
}

/// The section of a facet throat.
template <class T>
struct facet_shape {
    T area;             ///< of the triangle of the centres, m^2
    T void_area;        ///< what the spheres leave of it, m^2; negative where they overlap too much
    T hydraulic_radius; ///< void_area over the length of the arcs that bound it, m
};

/// Section of the throat between three spheres. Not a number where two centres coincide or all radii are 0.
template <class T>
facet_shape<T> measure_facet(vec<T, 3> const& a, vec<T, 3> const& b, vec<T, 3> const& c, T const& ra, T const& rb,
                             T const& rc) noexcept {
    T const half(value_t<T>(0.5));
    auto const angle = [](vec<T, 3> const& corner, vec<T, 3> const& one, vec<T, 3> const& other) {
        auto const u = one - corner, v = other - corner;
        return detail::upper_angle(norm(cross(u, v)), dot(u, v));
    };
    T const arc_a = ra * angle(a, b, c), arc_b = rb * angle(b, c, a), arc_c = rc * angle(c, a, b);
    facet_shape<T> shape;
    shape.area = triangle_area(a, b, c);
    shape.void_area = shape.area - half * (ra * arc_a + rb * arc_b + rc * arc_c);
    shape.hydraulic_radius = shape.void_area / (arc_a + arc_b + arc_c);
    return shape;
}

} // namespace lacuna
