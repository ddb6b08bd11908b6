// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <lacuna/core/aggregate.hpp>
#include <lacuna/core/error.hpp>

namespace lacuna {

/// The member in which two values differ, and its text in each.
struct difference {
    std::string path; ///< "materials[0].contact.friction"
    std::string first, second;
};

namespace detail {

template <class T>
inline constexpr bool is_list = false;
template <class T, class Allocator>
inline constexpr bool is_list<std::vector<T, Allocator>> = true;
template <class T, std::size_t N>
inline constexpr bool is_list<std::array<T, N>> = true;
template <class T, int N>
inline constexpr bool is_list<vec<T, N>> = true;
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// The text of one value.
/// \param none text of an empty optional
template <class T>
std::string value_text(T const& value, std::string_view none) {
    if constexpr (requires { std::string(word_of(value)); })
        return std::string(word_of(value)); // an enumeration; argument-dependent lookup finds the function
    else if constexpr (std::is_same_v<T, bool>)
        return value ? "true" : "false";
    else if constexpr (std::is_enum_v<T>)
        return std::to_string(static_cast<long long>(value));
    else if constexpr (std::is_integral_v<T>)
        return std::to_string(value);
    else if constexpr (std::is_floating_point_v<T>)
        return to_text(double(value));
    else if constexpr (is_optional<T>)
        return value ? value_text(*value, none) : std::string(none);
    else if constexpr (std::is_convertible_v<T const&, std::string_view>)
        return "\"" + std::string(std::string_view(value)) + "\"";
    else
        return "given";
}

} // namespace detail

/// The first difference of two values of one type, member by member and entry by entry. Two not-a-numbers are equal.
/// \param path of the values, the beginning of the path in the result
/// \param none text of an empty optional
template <class T>
std::optional<difference> first_difference(T const& a, T const& b, std::string const& path,
                                           std::string_view none = "none") {
    auto const differ = [&] { return difference{path, detail::value_text(a, none), detail::value_text(b, none)}; };
    if constexpr (std::is_floating_point_v<T>) {
        if (a == b || (a != a && b != b)) return {};
        return differ();
    } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, std::string>) {
        if (a == b) return {};
        return differ();
    } else if constexpr (detail::is_optional<T>) {
        if (a && b) return first_difference(*a, *b, path, none);
        if (!a && !b) return {};
        return differ();
    } else if constexpr (detail::is_list<T>) {
        std::size_t const n = std::size_t(a.size()), m = std::size_t(b.size());
        using index = std::conditional_t<requires { T::size(); }, int, std::size_t>;
        for (std::size_t k = 0; k < n && k < m; ++k)
            if (auto found = first_difference(a[index(k)], b[index(k)], path + "[" + std::to_string(k) + "]", none))
                return found;
        if (n == m) return {};
        return difference{path, std::to_string(n) + " entries", std::to_string(m) + " entries"};
    } else {
        std::vector<void const*> others;
        for_each_named_member(const_cast<T&>(b), [&](std::string_view, auto& member) { others.push_back(&member); });
        std::optional<difference> found;
        std::size_t next = 0;
        for_each_named_member(const_cast<T&>(a), [&](std::string_view name, auto& member) {
            auto const& other = *static_cast<std::remove_reference_t<decltype(member)> const*>(others[next++]);
            if (!found)
                found = first_difference(member, other, path + (path.empty() ? "" : ".") + std::string(name), none);
        });
        return found;
    }
}

} // namespace lacuna
