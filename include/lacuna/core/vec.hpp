// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/core/scalar.hpp>

namespace lacuna {

/// A vector of N scalars of any kind (plain number, pack, dual): a position, a velocity, a force.
///
/// It is not an Eigen matrix on purpose: laws instantiate it with packs and duals, where every temporary and the
/// compile time count. Its functions have no loops: a variable index, even in a loop that is unrolled later, makes
/// compilers store the components in memory.
template <class T, int N>
struct vec {
    static_assert(N >= 1 && N <= 4);
    T element[std::size_t(N)];

    constexpr T& operator[](int i) noexcept { return element[i]; }
    constexpr T const& operator[](int i) const noexcept { return element[i]; }
    constexpr T* data() noexcept { return element; }
    constexpr T const* data() const noexcept { return element; }
    static constexpr int size() noexcept { return N; }

    friend constexpr vec operator+(vec const& a, vec const& b) noexcept {
        if constexpr (N == 1)
            return vec{{a[0] + b[0]}};
        else if constexpr (N == 2)
            return vec{{a[0] + b[0], a[1] + b[1]}};
        else if constexpr (N == 3)
            return vec{{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
        else
            return vec{{a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}};
    }
    friend constexpr vec operator-(vec const& a, vec const& b) noexcept {
        if constexpr (N == 1)
            return vec{{a[0] - b[0]}};
        else if constexpr (N == 2)
            return vec{{a[0] - b[0], a[1] - b[1]}};
        else if constexpr (N == 3)
            return vec{{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
        else
            return vec{{a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]}};
    }
    friend constexpr vec operator-(vec const& a) noexcept {
        if constexpr (N == 1)
            return vec{{-a[0]}};
        else if constexpr (N == 2)
            return vec{{-a[0], -a[1]}};
        else if constexpr (N == 3)
            return vec{{-a[0], -a[1], -a[2]}};
        else
            return vec{{-a[0], -a[1], -a[2], -a[3]}};
    }
    friend constexpr vec operator*(vec const& a, T const& s) noexcept {
        if constexpr (N == 1)
            return vec{{a[0] * s}};
        else if constexpr (N == 2)
            return vec{{a[0] * s, a[1] * s}};
        else if constexpr (N == 3)
            return vec{{a[0] * s, a[1] * s, a[2] * s}};
        else
            return vec{{a[0] * s, a[1] * s, a[2] * s, a[3] * s}};
    }
    friend constexpr vec operator*(T const& s, vec const& a) noexcept { return a * s; }
    friend constexpr vec operator/(vec const& a, T const& s) noexcept { return a * (T(1) / s); }
    constexpr vec& operator+=(vec const& b) noexcept { return *this = *this + b; }
    constexpr vec& operator-=(vec const& b) noexcept { return *this = *this - b; }
    constexpr vec& operator*=(T const& s) noexcept { return *this = *this * s; }
    friend constexpr bool operator==(vec const& a, vec const& b) noexcept
        requires std::floating_point<T>
    {
        for (int i = 0; i < N; ++i)
            if (!(a[i] == b[i])) return false;
        return true;
    }
};

template <class T, int N>
constexpr T dot(vec<T, N> const& a, vec<T, N> const& b) noexcept {
    if constexpr (N == 1)
        return a[0] * b[0];
    else if constexpr (N == 2)
        return a[0] * b[0] + a[1] * b[1];
    else if constexpr (N == 3)
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    else
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}
template <class T, int N>
constexpr T squared_norm(vec<T, N> const& a) noexcept {
    return dot(a, a);
}
template <class T, int N>
T norm(vec<T, N> const& a) noexcept {
    if constexpr (N == 1)
        return abs(a[0]);
    else
        return sqrt(dot(a, a));
}
/// Out-of-plane component of the cross product of two vectors in the plane.
template <class T>
constexpr T cross(vec<T, 2> const& a, vec<T, 2> const& b) noexcept {
    return a[0] * b[1] - a[1] * b[0];
}
template <class T>
constexpr vec<T, 3> cross(vec<T, 3> const& a, vec<T, 3> const& b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// The vector rotated by +90 degrees.
template <class T>
constexpr vec<T, 2> perpendicular(vec<T, 2> const& a) noexcept {
    return {-a[1], a[0]};
}
/// Component by component: condition ? a : b.
template <class T, int N>
constexpr vec<T, N> select(mask_t<T> const& condition, vec<T, N> const& a, vec<T, N> const& b) noexcept {
    if constexpr (N == 1)
        return {{select(condition, a[0], b[0])}};
    else if constexpr (N == 2)
        return {{select(condition, a[0], b[0]), select(condition, a[1], b[1])}};
    else
        return {{select(condition, a[0], b[0]), select(condition, a[1], b[1]), select(condition, a[2], b[2])}};
}
/// The vector, shortened to length `limit` where it is longer (limit >= 0).
template <class T, int N>
vec<T, N> clip_norm(vec<T, N> const& a, T const& limit) noexcept {
    if constexpr (N == 1) {
        return {max(-limit, min(limit, a[0]))};
    } else {
        T const length = norm(a);
        auto const over = length > limit;
        return select(over, a * (limit / select(over, length, T(1))), a);
    }
}

/// The same vector in another scalar type.
template <class To, class From, int N>
constexpr vec<To, N> convert(vec<From, N> const& a) noexcept {
    vec<To, N> r{};
    for (int i = 0; i < N; ++i) r[i] = To(a[i]);
    return r;
}

/// Number of components of a rotation, spin or torque: one in the plane, three in space.
template <int Dim>
inline constexpr int rotation_dim = Dim == 2 ? 1 : 3;

/// Number of components of a shear force: in 2D its signed value along the tangent, in 3D a vector in space.
template <int Dim>
inline constexpr int shear_dim = Dim == 2 ? 1 : 3;

} // namespace lacuna
