// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <lacuna/core/vec.hpp>
#include <lacuna/pores/mesh/angles.hpp>

/// \file
/// Formulas of pores for a scalar type T (plain number, pack, dual number).
///   - In the plane a pore is the triangle of three particle centres, counter-clockwise, less the sectors of the discs
///     in it. The thickness is in m.
///   - In space a pore is the tetrahedron of four centres less the sectors of the spheres in it. A throat is a facet
///     less the sectors of the three circles in which its plane cuts the spheres.

namespace lacuna {

/// Area of the triangle a, b, c, m^2; positive when counter-clockwise.
template <class T>
constexpr T triangle_area(vec<T, 2> const& a, vec<T, 2> const& b, vec<T, 2> const& c) noexcept {
    return cross(b - a, c - a) * T(value_t<T>(0.5));
}

/// Angle of a triangle at `corner`, between the directions to the other two corners, rad; 0 to pi.
template <class T>
T corner_angle(vec<T, 2> const& corner, vec<T, 2> const& one, vec<T, 2> const& other) noexcept {
    auto const u = one - corner, v = other - corner;
    return detail::upper_angle(abs(cross(u, v)), dot(u, v));
}

/// Void of a pore between three discs, and the force of its pressure on each disc.
template <class T>
struct pore_shape {
    T void_area;           ///< m^2; see void_area()
    vec<T, 2> traction[3]; ///< on each corner, for 1 Pa and a thickness of 1 m; see pore_traction()
};

/// Void and tractions of a pore in the plane, from one formula. Not a number where two centres coincide.
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
    // The three angles sum to pi: the third needs no inverse tangent.
    T sectors = qc * T(V(3.14159265358979323846264338327950288)) + (qa - qc) * at_a.angle(at_a.above * per_a) +
                (qb - qc) * at_b.angle(at_b.above * per_b);
    // Joints of a with b, b with c and a with c, relative to a.
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

/// Area of the triangle less the three sectors of the discs in it, m^2. Negative where the discs overlap too much to
/// leave a void, and for an inverted triangle. Not a number where two centres coincide.
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

/// Position of the joint of two discs on the line of their centres: 0 at i, 1 at j.
///
/// The joint is the point of equal power with respect to both discs, (d^2 + r_i^2 - r_j^2) / (2 d^2). Where the discs
/// touch, it is the contact point, r_i / (r_i + r_j). At any gap or overlap it is the only point for which the chords
/// of the paper's eq. 16 are the derivatives of the pore volume. The radical axis of the discs, on which their common
/// edge of the power diagram lies, crosses the line of centres there as well.
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

/// The paper's eq. 16 for particle i in the pore of i, j, k (counter-clockwise), N: the force of a pressure of 1 Pa on
/// the chord between the joints of i with j and i with k, times the thickness, directed outwards from the pore.
///
/// The force is the derivative of the pore's volume with respect to the position of i, at any gap, while the volume is
/// above its floor. So the work of the pressure on the particles equals its work on the change of volume. Translation
/// and rotation leave the volume unchanged, so the three forces of a pore have zero sum and zero moment. They act
/// through the centres: pressure on a smooth disc exerts no torque.
template <class T>
vec<T, 2> pore_traction(vec<T, 2> const& xi, vec<T, 2> const& xj, vec<T, 2> const& xk, T const& ri, T const& rj,
                        T const& rk, T const& thickness) noexcept {
    return measure_pore(xi, xj, xk, ri, rj, rk).traction[0] * thickness;
}

/// Volume of the tetrahedron a, b, c, d, m^3; positive when a, b, c are counter-clockwise as seen from d.
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

/// Solid angle at a corner, sr. \param triple |u . (v x w)| of the three edge vectors \param u, v, w their lengths
/// \param uv, vw, wu their scalar products
template <class T>
T solid_angle(T const& triple, T const& u, T const& v, T const& w, T const& uv, T const& vw, T const& wu) noexcept {
    return T(value_t<T>(2)) * upper_angle(triple, u * v * w + uv * w + vw * u + wu * v);
}

} // namespace detail

/// Solid angle of the triangle one, two, three as seen from `corner`, sr; 0 to 2 pi.
///
/// A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30 (1983) 125:
///   tan(Omega / 2) = |u . (v x w)| / (uvw + (u . v) w + (v . w) u + (w . u) v)
template <class T>
T solid_angle(vec<T, 3> const& corner, vec<T, 3> const& one, vec<T, 3> const& two, vec<T, 3> const& three) noexcept {
    auto const u = one - corner, v = two - corner, w = three - corner;
    return detail::solid_angle(abs(dot(u, cross(v, w))), norm(u), norm(v), norm(w), dot(u, v), dot(v, w), dot(w, u));
}

/// Void of a pore between four spheres, and the force of its pressure on each sphere.
template <class T>
struct tetrahedron_shape {
    T void_volume;         ///< m^3; see void_volume()
    vec<T, 3> traction[4]; ///< on each corner, for 1 Pa: derivative of the void by the corner's position, m^2
};

namespace detail {

/// Change of the weighted dihedral angles along the sides of a facet ijk when its corner k moves along the facet's
/// normal, times twice the facet's area. See measure_pore().
/// \param at_i, at_j scalar products of the sides that meet at corners i and j
/// \param ij, ik, jk weight of each side over its length
template <class T>
T folding(T const& at_i, T const& at_j, T const& ij, T const& ik, T const& jk) noexcept {
    return at_i * (ij - ik) + at_j * (ij - jk);
}

} // namespace detail

/// Void and tractions of a pore in space. Not a number where two centres coincide or three lie on a line.
///
/// A sector is r^3 Omega / 3. Its solid angle Omega is the sum of the three dihedral angles at the corner less pi. So
/// the sectors sum to (r_i^3 + r_j^3) theta_ij / 3 over all edges, plus a constant.
///
/// Derivatives: in a facet ijk the dihedral angle theta_ij changes with the position of k along the facet's normal, by
/// the edge's length over twice the facet's area. Its derivatives by i and j follow from invariance under rigid motion.
/// So each facet adds a vector along its normal to each of its corners, and these three sum to zero. The tractions of a
/// pore have zero sum and zero moment.
template <class T>
tetrahedron_shape<T> measure_pore(vec<T, 3> const& a, vec<T, 3> const& b, vec<T, 3> const& c, vec<T, 3> const& d,
                                  T const& ra, T const& rb, T const& rc, T const& rd) noexcept {
    using V = value_t<T>;
    vec<T, 3> ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
    T lab = norm(ab), lac = norm(ac), lad = norm(ad), lbc = norm(bc), lbd = norm(bd), lcd = norm(cd);
    // Outward facet normals of length twice the area, named after the opposite corner.
    vec<T, 3> at_a = cross(bc, bd), at_b = cross(ad, ac), at_c = cross(ab, ad), at_d = cross(ac, ab);
    T triple = -dot(at_d, ad), height = abs(triple);

    // Scalar products of two edges at a corner: a_bc is that of ab and ac.
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
    shape.void_volume = triple * T(V(1.0 / 6)) - sectors * third;
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

/// \name measure_pore() for arrays of centres and radii, in the plane and in space
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

/// Void of a pore from its shape: an area in the plane, m^2; a volume in space, m^3.
template <class T>
T const& void_of(pore_shape<T> const& shape) noexcept {
    return shape.void_area;
}
template <class T>
T const& void_of(tetrahedron_shape<T> const& shape) noexcept {
    return shape.void_volume;
}

/// Volume of the tetrahedron less the four spherical sectors r^3 Omega / 3 in it, m^3. Negative where the spheres
/// overlap too much to leave a void, and for an inverted tetrahedron. Not a number where two centres coincide.
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
    T void_area;        ///< area less the sectors of the spheres, m^2; negative where they overlap too much
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
