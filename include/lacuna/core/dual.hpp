// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/core/scalar.hpp>

namespace lacuna {

/// A number with its derivatives by N variables (forward differentiation). It gives the exact tangent of a law.
template <class T, int N>
struct dual {
    T value{};
    T derivative[std::size_t(N)]{};

    constexpr dual() = default;
    constexpr dual(T v) noexcept : value(v) {} // NOLINT: a plain number is a dual with zero derivatives
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
    friend constexpr bool operator<(dual const& a, dual const& b) noexcept { return a.value < b.value; }
    friend constexpr bool operator>(dual const& a, dual const& b) noexcept { return a.value > b.value; }
    friend constexpr bool operator<=(dual const& a, dual const& b) noexcept { return a.value <= b.value; }
    friend constexpr bool operator>=(dual const& a, dual const& b) noexcept { return a.value >= b.value; }
};

template <class T, int N>
struct value_of<dual<T, N>> {
    using type = T;
};

template <class T, int N>
constexpr dual<T, N> select(bool condition, dual<T, N> const& a, dual<T, N> const& b) noexcept {
    return condition ? a : b;
}
template <class T, int N>
dual<T, N> sqrt(dual<T, N> const& a) noexcept {
    dual<T, N> r(std::sqrt(a.value));
    for (int i = 0; i < N; ++i) r.derivative[i] = r.value > T(0) ? a.derivative[i] / (T(2) * r.value) : T(0);
    return r;
}
template <class T, int N>
dual<T, N> exp(dual<T, N> const& a) noexcept {
    dual<T, N> r(std::exp(a.value));
    for (int i = 0; i < N; ++i) r.derivative[i] = r.value * a.derivative[i];
    return r;
}
template <class T, int N>
dual<T, N> abs(dual<T, N> const& a) noexcept {
    return a.value < T(0) ? -a : a;
}
template <class T, int N>
constexpr dual<T, N> min(dual<T, N> const& a, dual<T, N> const& b) noexcept {
    return b < a ? b : a;
}
template <class T, int N>
constexpr dual<T, N> max(dual<T, N> const& a, dual<T, N> const& b) noexcept {
    return a < b ? b : a;
}

} // namespace lacuna
