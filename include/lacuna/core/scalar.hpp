// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <concepts>

#include <lacuna/core/standard.hpp>

/// \file
/// The functions in which laws are written, for plain numbers. core/pack.hpp and core/dual.hpp define the same
/// functions for a row of numbers and for a number with derivatives. A formula that uses only these functions works
/// with all three.

namespace lacuna {

/// The result type of comparing two T: bool for plain and dual numbers, a lane mask for packs.
template <class T>
struct mask_of {
    using type = bool;
};
template <class T>
using mask_t = typename mask_of<T>::type;

/// The number type inside a scalar type: double for double, pack<double, 8> and dual<double, 2>.
template <class T>
struct value_of {
    using type = T;
};
template <class T>
using value_t = typename value_of<T>::type;

/// condition ? a : b, lane by lane.
template <std::floating_point T>
constexpr T select(bool condition, T a, T b) noexcept {
    return condition ? a : b;
}
template <std::floating_point T>
T sqrt(T x) noexcept {
    return std::sqrt(x);
}
template <std::floating_point T>
T exp(T x) noexcept {
    return std::exp(x);
}
template <std::floating_point T>
T abs(T x) noexcept {
    return std::fabs(x);
}
template <std::floating_point T>
constexpr T min(T a, T b) noexcept {
    return b < a ? b : a;
}
template <std::floating_point T>
constexpr T max(T a, T b) noexcept {
    return a < b ? b : a;
}
/// True if the condition holds in any lane; all(): in all lanes.
constexpr bool any(bool condition) noexcept { return condition; }
constexpr bool all(bool condition) noexcept { return condition; }

} // namespace lacuna
