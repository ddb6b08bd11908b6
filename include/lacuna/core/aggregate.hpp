// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include <lacuna/core/vec.hpp>

/// \file
/// The members of an aggregate, one by one: what parameters and states consist of, without a list of their names
/// that could forget one.

namespace lacuna {

namespace detail {

/// Stands for a value of any type, in a question to the compiler alone.
struct any_value {
    template <class T>
    operator T() const noexcept;
};
template <class A, std::size_t... I>
constexpr bool takes(std::index_sequence<I...>) {
    return requires { A{(void(I), any_value{})...}; };
}
template <class A, std::size_t N = 0>
constexpr std::size_t count_members() {
    if constexpr (takes<A>(std::make_index_sequence<N + 1>{}))
        return count_members<A, N + 1>();
    else
        return N;
}

template <class T>
inline constexpr bool is_vec = false;
template <class T, int N>
inline constexpr bool is_vec<vec<T, N>> = true;

} // namespace detail

/// Calls visit(member) for each member of an aggregate, in their order; for the components of a vec.
/// \tparam A an aggregate without base classes and arrays of C, of at most 24 members
template <class A, class Visit>
void for_each_member(A& value, Visit const& visit) {
    using type = std::remove_const_t<A>;
    auto const each = [&](auto&... member) { (visit(member), ...); };
    if constexpr (detail::is_vec<type>) {
        for (int k = 0; k < type::size(); ++k) visit(value[k]);
    } else {
        constexpr std::size_t n = detail::count_members<type>();
        static_assert(n <= 24, "for_each_member: more members than it knows");
        if constexpr (n == 1) {
            auto& [a] = value;
            each(a);
        } else if constexpr (n == 2) {
            auto& [a, b] = value;
            each(a, b);
        } else if constexpr (n == 3) {
            auto& [a, b, c] = value;
            each(a, b, c);
        } else if constexpr (n == 4) {
            auto& [a, b, c, d] = value;
            each(a, b, c, d);
        } else if constexpr (n == 5) {
            auto& [a, b, c, d, e] = value;
            each(a, b, c, d, e);
        } else if constexpr (n == 6) {
            auto& [a, b, c, d, e, f] = value;
            each(a, b, c, d, e, f);
        } else if constexpr (n == 7) {
            auto& [a, b, c, d, e, f, g] = value;
            each(a, b, c, d, e, f, g);
        } else if constexpr (n == 8) {
            auto& [a, b, c, d, e, f, g, h] = value;
            each(a, b, c, d, e, f, g, h);
        } else if constexpr (n == 9) {
            auto& [a, b, c, d, e, f, g, h, i] = value;
            each(a, b, c, d, e, f, g, h, i);
        } else if constexpr (n == 10) {
            auto& [a, b, c, d, e, f, g, h, i, j] = value;
            each(a, b, c, d, e, f, g, h, i, j);
        } else if constexpr (n == 11) {
            auto& [a, b, c, d, e, f, g, h, i, j, k] = value;
            each(a, b, c, d, e, f, g, h, i, j, k);
        } else if constexpr (n == 12) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l);
        } else if constexpr (n == 13) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m);
        } else if constexpr (n == 14) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o);
        } else if constexpr (n == 15) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p);
        } else if constexpr (n == 16) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q);
        } else if constexpr (n == 17) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r);
        } else if constexpr (n == 18) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s);
        } else if constexpr (n == 19) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t);
        } else if constexpr (n == 20) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u);
        } else if constexpr (n == 21) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v);
        } else if constexpr (n == 22) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w);
        } else if constexpr (n == 23) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x);
        } else if constexpr (n == 24) {
            auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y] = value;
            each(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y);
        }
    }
}

} // namespace lacuna
