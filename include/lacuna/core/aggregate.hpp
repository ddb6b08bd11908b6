// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include <lacuna/core/vec.hpp>

/// \file
/// Visits the members of an aggregate, with their names. Parameters and states need no list of members, which could be
/// incomplete. C++ cannot decompose a struct whose base class has members: such a struct lists them itself, in
/// `template <class Visit> void for_each_named(Visit const& visit)`, by calls visit("name", member).

namespace lacuna {

namespace detail {

/// Converts to any type, in unevaluated expressions only.
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

/// Calls use(members...) with all members of an aggregate, in their order.
/// \tparam A an aggregate of at most 24 members, without base classes and C arrays
template <class A, class Use>
constexpr decltype(auto) with_members(A& value, Use const& use) {
    constexpr std::size_t n = detail::count_members<std::remove_const_t<A>>();
    static_assert(n <= 24, "with_members: more members than it knows");
    if constexpr (n == 0) {
        return use();
    } else if constexpr (n == 1) {
        auto& [a] = value;
        return use(a);
    } else if constexpr (n == 2) {
        auto& [a, b] = value;
        return use(a, b);
    } else if constexpr (n == 3) {
        auto& [a, b, c] = value;
        return use(a, b, c);
    } else if constexpr (n == 4) {
        auto& [a, b, c, d] = value;
        return use(a, b, c, d);
    } else if constexpr (n == 5) {
        auto& [a, b, c, d, e] = value;
        return use(a, b, c, d, e);
    } else if constexpr (n == 6) {
        auto& [a, b, c, d, e, f] = value;
        return use(a, b, c, d, e, f);
    } else if constexpr (n == 7) {
        auto& [a, b, c, d, e, f, g] = value;
        return use(a, b, c, d, e, f, g);
    } else if constexpr (n == 8) {
        auto& [a, b, c, d, e, f, g, h] = value;
        return use(a, b, c, d, e, f, g, h);
    } else if constexpr (n == 9) {
        auto& [a, b, c, d, e, f, g, h, i] = value;
        return use(a, b, c, d, e, f, g, h, i);
    } else if constexpr (n == 10) {
        auto& [a, b, c, d, e, f, g, h, i, j] = value;
        return use(a, b, c, d, e, f, g, h, i, j);
    } else if constexpr (n == 11) {
        auto& [a, b, c, d, e, f, g, h, i, j, k] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k);
    } else if constexpr (n == 12) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l);
    } else if constexpr (n == 13) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m);
    } else if constexpr (n == 14) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o);
    } else if constexpr (n == 15) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p);
    } else if constexpr (n == 16) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q);
    } else if constexpr (n == 17) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r);
    } else if constexpr (n == 18) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s);
    } else if constexpr (n == 19) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t);
    } else if constexpr (n == 20) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u);
    } else if constexpr (n == 21) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v);
    } else if constexpr (n == 22) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w);
    } else if constexpr (n == 23) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x);
    } else if constexpr (n == 24) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y] = value;
        return use(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y);
    }
}

namespace detail {

struct any_visit {
    template <class T>
    void operator()(std::string_view, T&) const noexcept;
};
/// True if a struct lists its members itself.
template <class A>
concept names_its_members = requires(A& value) { value.for_each_named(any_visit{}); };

/// Stands in for an archive in `serialize` and lists its members.
template <class Visit>
struct member_lister {
    using is_loading = std::false_type;
    using is_saving = std::true_type;
    Visit const& visit;
    int next = 0;
    template <class... Members>
    void operator()(Members&... member) {
        (visit(std::string_view("member " + std::to_string(next++)), member), ...);
    }
};

// __PRETTY_FUNCTION__ contains a member's name if a template argument is the member's address. No value of A is ever
// constructed.
template <class A>
struct named_object {
    A value;
};
#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wundefined-var-template"
#pragma clang diagnostic ignored "-Wundefined-internal"
#endif
template <class A>
extern named_object<A> const unmade;
template <class Pointer>
struct spelled_address {
    Pointer to;
};
template <class Pointer>
spelled_address(Pointer) -> spelled_address<Pointer>;
template <std::size_t I, class A>
constexpr auto address_of_member(A const& value) {
    return with_members(value, [](auto const&... member) { return std::get<I>(std::tuple{&member...}); });
}
template <auto Address>
constexpr std::string_view last_name() {
    std::string_view text = __PRETTY_FUNCTION__;
    // "... Address = ...{(& unmade<A>.named_object<A>::value.A::name)}; ...]" or "... {&unmade.value.name}]"
    text = text.substr(0, text.rfind('}'));
    while (text.back() == ')') text.remove_suffix(1);
    std::size_t first = text.size();
    auto const is_part = [](char c) {
        return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    };
    while (first > 0 && is_part(text[first - 1])) --first;
    return text.substr(first);
}
template <class A, std::size_t... I>
constexpr std::array<std::string_view, sizeof...(I)> names_of(std::index_sequence<I...>) {
    return {last_name<spelled_address{address_of_member<I>(unmade<A>.value)}>()...};
}
#if defined(__clang__)
#pragma clang diagnostic pop
#endif

} // namespace detail

/// Calls visit(member) for each member of an aggregate, or each component of a vec, in their order.
/// \tparam A see with_members(); or a struct that names its members itself
template <class A, class Visit>
void for_each_member(A& value, Visit const& visit) {
    using type = std::remove_const_t<A>;
    if constexpr (detail::is_vec<type>) {
        for (int k = 0; k < type::size(); ++k) visit(value[k]);
    } else if constexpr (detail::names_its_members<type>) {
        value.for_each_named([&](std::string_view, auto& member) { visit(member); });
    } else {
        with_members(value, [&](auto&... member) { (visit(member), ...); });
    }
}

/// The names of an aggregate's members, in the order of their declaration.
/// \tparam A see with_members()
template <class A>
constexpr auto member_names() {
    return detail::names_of<A>(std::make_index_sequence<detail::count_members<A>()>{});
}

/// Calls visit(name, member) for each member of an aggregate, in their order. Members of a struct that has `serialize`
/// but no list of names are called "member 0", "member 1" and so on.
template <class A, class Visit>
void for_each_named_member(A& value, Visit const& visit) {
    if constexpr (detail::names_its_members<std::remove_const_t<A>>) {
        value.for_each_named(visit);
    } else if constexpr (requires(detail::member_lister<Visit>& list) { value.serialize(list); }) {
        detail::member_lister<Visit> list{visit};
        value.serialize(list);
    } else {
        constexpr auto names = member_names<std::remove_const_t<A>>();
        std::size_t next = 0;
        for_each_member(value, [&](auto& member) { visit(std::string_view(names[next++]), member); });
    }
}

} // namespace lacuna
