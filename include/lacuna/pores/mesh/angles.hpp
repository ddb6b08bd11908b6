// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <numbers>

#include <lacuna/core/scalar.hpp>

/// \file
/// Angles for scalar types without an inverse tangent (packs, dual numbers), and several inverses with one division.

namespace lacuna {

namespace detail {

/// Angle of a vector (x, y) with y >= 0: a multiple of pi/4 plus or minus the inverse tangent of above / below, where
/// |above / below| <= tan(pi/8). The division is left to the caller, who can combine several into one.
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
    /// The inverse tangent is a polynomial that interpolates it at the Chebyshev points of z^2 for |z| <= tan(pi/8).
    /// Its error is below 6e-17, less than that of the arithmetic.
    T angle(T const& z) const noexcept {
        using V = value_t<T>;
        T s = z * z, s2 = s * s;
        // Two terms at a time: half as many dependent multiplications as with Horner's scheme.
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

/// Replaces five numbers by their inverses. A double's range allows for the product of all five, so that one division
/// is enough; narrower types take five. (A pack's division takes as long as ten multiplications.)
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

} // namespace lacuna
