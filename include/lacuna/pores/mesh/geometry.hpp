// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <lacuna/core/vec.hpp>
#include <lacuna/pores/mesh/angles.hpp>

/// \file
/// Formulas of pores, over a scalar type T (plain number, pack, dual number). In the plane a pore is the triangle of
/// three particle centres, counter-clockwise, less the sectors of the discs in it; t is the thickness in m. In space it
/// is the tetrahedron of four centres less the sectors of the spheres in it; a throat is a facet less the sectors of the
/// discs that its plane cuts out of the three spheres.

namespace lacuna {

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

namespace detail {

/// Solid angle at a corner: `twisted` the triple product of its edges' vectors, their lengths and their products.
template <class T>
T solid_angle(T const& twisted, T const& u, T const& v, T const& w, T const& uv, T const& vw, T const& wu) noexcept {
    return T(value_t<T>(2)) * upper_angle(twisted, u * v * w + uv * w + vw * u + wu * v);
}

} // namespace detail

/// Solid angle under which the triangle of one, two, three is seen from `corner`, sr; 0 to 2 pi.
///
/// A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30 (1983) 125:
///   tan(Omega / 2) = |u . (v x w)| / (uvw + (u . v) w + (v . w) u + (w . u) v)
template <class T>
T solid_angle(vec<T, 3> const& corner, vec<T, 3> const& one, vec<T, 3> const& two, vec<T, 3> const& three) noexcept {
    auto const u = one - corner, v = two - corner, w = three - corner;
    return detail::solid_angle(abs(dot(u, cross(v, w))), norm(u), norm(v), norm(w), dot(u, v), dot(v, w), dot(w, u));
}

/// What the four spheres at the corners of a pore leave.
template <class T>
struct tetrahedron_shape {
    T void_volume;         ///< m^3; see void_volume()
    vec<T, 3> traction[4]; ///< on each corner, for 1 Pa: the derivative of the void by the corner's place, m^2
};

namespace detail {

/// How much the dihedral angles along the sides of a facet, weighted, change when its corner k moves along the facet's
/// normal, times twice the facet's area: see measure_pore().
/// \param at_i, at_j products of the sides that meet in the corners i and j; \param ij, ik, jk weights over lengths
template <class T>
T folding(T const& at_i, T const& at_j, T const& ij, T const& ik, T const& jk) noexcept {
    return at_i * (ij - ik) + at_j * (ij - jk);
}

} // namespace detail

/// Void and tractions of a pore in space together. Not a number where two centres coincide or three lie on a line.
///
/// A sector is r^3 Omega / 3, the solid angle Omega the sum of the three dihedral angles at the corner less pi: the
/// sectors are the sum over the edges of (r_i^3 + r_j^3) theta_ij / 3, but for a constant. The dihedral angle along the
/// edge ij changes with the corner k of a facet ijk by the edge's length over twice the facet's area, along the facet's
/// normal; with i and j by what keeps it at rigid motions. So each facet adds a vector along its normal to each of its
/// corners, and these three have no sum. The tractions of a pore have no sum and no moment.
template <class T>
tetrahedron_shape<T> measure_pore(vec<T, 3> const& a, vec<T, 3> const& b, vec<T, 3> const& c, vec<T, 3> const& d,
                                  T const& ra, T const& rb, T const& rc, T const& rd) noexcept {
    using V = value_t<T>;
    vec<T, 3> ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
    T lab = norm(ab), lac = norm(ac), lad = norm(ad), lbc = norm(bc), lbd = norm(bd), lcd = norm(cd);
    // Outwards, twice the area long; named after the opposite corner.
    vec<T, 3> at_a = cross(bc, bd), at_b = cross(ad, ac), at_c = cross(ab, ad), at_d = cross(ac, ab);
    T twisted = -dot(at_d, ad), height = abs(twisted);

    // Products of the two edges from a corner: a_bc is that of ab and ac.
    T a_bc = dot(ab, ac), a_cd = dot(ac, ad), a_bd = dot(ab, ad);
    T b_ac = -dot(ab, bc), b_ad = -dot(ab, bd), b_cd = dot(bc, bd);
    T c_ab = dot(ac, bc), c_ad = -dot(ac, cd), c_bd = -dot(bc, cd);
    T d_ab = dot(ad, bd), d_ac = dot(ad, cd), d_bc = dot(bd, cd);

    T qa = ra * ra * ra, qb = rb * rb * rb, qc = rc * rc * rc, qd = rd * rd * rd;
    T sectors = qa * detail::solid_angle(height, lab, lac, lad, a_bc, a_cd, a_bd) +
                qb * detail::solid_angle(height, lab, lbc, lbd, b_ac, b_cd, b_ad) +
                qc * detail::solid_angle(height, lac, lbc, lcd, c_ab, c_bd, c_ad) +
                qd * detail::solid_angle(height, lad, lbd, lcd, d_ab, d_bc, d_ac);

    T mab = (qa + qb) / lab, mac = (qa + qc) / lac, mad = (qa + qd) / lad;
    T mbc = (qb + qc) / lbc, mbd = (qb + qd) / lbd, mcd = (qc + qd) / lcd;
    T third = T(V(1.0 / 3));
    vec<T, 3> of_a = at_a * (third / squared_norm(at_a)), of_b = at_b * (third / squared_norm(at_b));
    vec<T, 3> of_c = at_c * (third / squared_norm(at_c)), of_d = at_d * (third / squared_norm(at_d));
    T sixth = T(V(-1.0 / 6));
    tetrahedron_shape<T> shape;
    shape.void_volume = twisted * T(V(1.0 / 6)) - sectors * third;
    shape.traction[0] = at_a * sixth - of_b * detail::folding(c_ad, d_ac, mcd, mac, mad) -
                        of_c * detail::folding(b_ad, d_ab, mbd, mab, mad) -
                        of_d * detail::folding(b_ac, c_ab, mbc, mab, mac);
    shape.traction[1] = at_b * sixth - of_a * detail::folding(c_bd, d_bc, mcd, mbc, mbd) -
                        of_c * detail::folding(a_bd, d_ab, mad, mab, mbd) -
                        of_d * detail::folding(a_bc, c_ab, mac, mab, mbc);
    shape.traction[2] = at_c * sixth - of_a * detail::folding(b_cd, d_bc, mbd, mbc, mcd) -
                        of_b * detail::folding(a_cd, d_ac, mad, mac, mcd) -
                        of_d * detail::folding(a_bc, b_ac, mab, mac, mbc);
    shape.traction[3] = at_d * sixth - of_a * detail::folding(b_cd, c_bd, mbc, mbd, mcd) -
                        of_b * detail::folding(a_cd, c_ad, mac, mad, mcd) -
                        of_c * detail::folding(a_bd, b_ad, mab, mad, mbd);
    return shape;
}

/// \name A pore by its corners, in the plane and in space
/// \{
template <class T>
pore_shape<T> measure_simplex(std::array<vec<T, 2>, 3> const& x, std::array<T, 3> const& r) noexcept {
    return measure_pore(x[0], x[1], x[2], r[0], r[1], r[2]);
}
template <class T>
tetrahedron_shape<T> measure_simplex(std::array<vec<T, 3>, 4> const& x, std::array<T, 4> const& r) noexcept {
    return measure_pore(x[0], x[1], x[2], x[3], r[0], r[1], r[2], r[3]);
}
/// \}

/// Volume of the tetrahedron less the four spherical sectors r^3 Omega / 3 in it; negative where the spheres overlap
/// too much to leave a void, and for a tetrahedron that has turned over. m^3. Not a number where two centres coincide.
template <class T>
T void_volume(vec<T, 3> const& a, vec<T, 3> const& b, vec<T, 3> const& c, vec<T, 3> const& d, T const& ra, T const& rb,
              T const& rc, T const& rd) noexcept {
    return measure_pore(a, b, c, d, ra, rb, rc, rd).void_volume;
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
