// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <type_traits>

#include <lacuna/core/scalar.hpp>

namespace lacuna {

/// A number with its derivatives by N variables (forward differentiation). It gives the exact tangent of a law.
template <class T, int N>
struct dual {
    T value{};
    T derivative[std::size_t(N)]{};

    constexpr dual() = default;
    constexpr dual(T v) noexcept : value(v) {} // NOLINT: a plain number is a dual with zero derivatives
    constexpr dual(value_t<T> v) noexcept // NOLINT: so is one for all lanes of a pack
        requires(!std::is_same_v<T, value_t<T>>)
        : value(v) {}
    /// The variable number `index`, with value v and derivative 1 by itself.
    static constexpr dual variable(T v, int index) noexcept {
        dual r(v);
        r.derivative[index] = T(1);
        return r;
    }

    friend constexpr dual operator+(dual a, dual const& b) noexcept {
        a.value += b.value;
        for (int i = 0; i < N; ++i) a.derivative[i] += b.derivative[i];
        return a;
    }
    friend constexpr dual operator-(dual a, dual const& b) noexcept {
        a.value -= b.value;
        for (int i = 0; i < N; ++i) a.derivative[i] -= b.derivative[i];
        return a;
    }
    friend constexpr dual operator-(dual a) noexcept {
        a.value = -a.value;
        for (int i = 0; i < N; ++i) a.derivative[i] = -a.derivative[i];
        return a;
    }
    friend constexpr dual operator*(dual const& a, dual const& b) noexcept {
        dual r(a.value * b.value);
        for (int i = 0; i < N; ++i) r.derivative[i] = a.derivative[i] * b.value + a.value * b.derivative[i];
        return r;
    }
    friend constexpr dual operator/(dual const& a, dual const& b) noexcept {
        dual r(a.value / b.value);
        for (int i = 0; i < N; ++i) r.derivative[i] = (a.derivative[i] - r.value * b.derivative[i]) / b.value;
        return r;
    }
    constexpr dual& operator+=(dual const& b) noexcept { return *this = *this + b; }
    constexpr dual& operator-=(dual const& b) noexcept { return *this = *this - b; }
    constexpr dual& operator*=(dual const& b) noexcept { return *this = *this * b; }
    friend constexpr mask_t<T> operator<(dual const& a, dual const& b) noexcept { return a.value < b.value; }
    friend constexpr mask_t<T> operator>(dual const& a, dual const& b) noexcept { return a.value > b.value; }
    friend constexpr mask_t<T> operator<=(dual const& a, dual const& b) noexcept { return a.value <= b.value; }
    friend constexpr mask_t<T> operator>=(dual const& a, dual const& b) noexcept { return a.value >= b.value; }
};

template <class T, int N>
struct value_of<dual<T, N>> {
    using type = value_t<T>;
};
template <class T, int N>
struct mask_of<dual<T, N>> {
    using type = mask_t<T>;
};

template <class T, int N>
constexpr dual<T, N> select(mask_t<T> const& condition, dual<T, N> const& a, dual<T, N> const& b) noexcept {
    dual<T, N> r(select(condition, a.value, b.value));
    for (int i = 0; i < N; ++i) r.derivative[i] = select(condition, a.derivative[i], b.derivative[i]);
    return r;
}
template <class T, int N>
dual<T, N> sqrt(dual<T, N> const& a) noexcept {
    dual<T, N> r(sqrt(a.value));
    for (int i = 0; i < N; ++i) r.derivative[i] = select(r.value > T(0), a.derivative[i] / (T(2) * r.value), T(0));
    return r;
}
template <class T, int N>
dual<T, N> exp(dual<T, N> const& a) noexcept {
    dual<T, N> r(exp(a.value));
    for (int i = 0; i < N; ++i) r.derivative[i] = r.value * a.derivative[i];
    return r;
}
template <class T, int N>
dual<T, N> abs(dual<T, N> const& a) noexcept {
    return select(a.value < T(0), -a, a);
}
template <class T, int N>
constexpr dual<T, N> min(dual<T, N> const& a, dual<T, N> const& b) noexcept {
    return select(b < a, b, a);
}
template <class T, int N>
constexpr dual<T, N> max(dual<T, N> const& a, dual<T, N> const& b) noexcept {
    return select(a < b, b, a);
}

} // namespace lacuna
