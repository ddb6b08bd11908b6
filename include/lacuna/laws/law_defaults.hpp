// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include <lacuna/core/aggregate.hpp>
#include <lacuna/core/dual.hpp>
#include <lacuna/core/fields.hpp>
#include <lacuna/laws/law_concepts.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// How the values of two materials become that of their pair.
enum class combine_rule {
    series,  ///< 2 / (1/a + 1/b): two springs in series, each twice as stiff as its own; 0 if one is 0
    mean,    ///< (a + b) / 2
    smaller, ///< the smaller one
    larger   ///< the larger one
};

/// The value of a pair of materials.
inline double combined(combine_rule rule, double a, double b) noexcept {
    switch (rule) {
    case combine_rule::series: return a > 0 && b > 0 ? 2 / (1 / a + 1 / b) : 0.0;
    case combine_rule::mean: return (a + b) / 2;
    case combine_rule::smaller: return b < a ? b : a;
    case combine_rule::larger: break;
    }
    return a < b ? b : a;
}

namespace detail {
/// Whether the values of a material are those of the law's parameters, one by one.
template <class Law>
concept law_has_same_fields = requires {
    requires std::is_aggregate_v<typename Law::material>;
    requires consists_of<typename Law::material, double>();
    requires sizeof(typename Law::material) == sizeof(typename Law::template parameters<double>);
};
} // namespace detail

/// What a law need not write itself: `struct my_law : lacuna::law_defaults<my_law> { ... };`. A law that declares one
/// of these members hides the default.
template <class Law>
struct law_defaults {
    /// One rule for all values of a material, or a std::array with one for each.
    static constexpr combine_rule combined_by = combine_rule::series;

    /// Combines two materials value by value, by the law's `combined_by`. For laws whose parameters are the material's
    /// values.
    template <class L = Law>
        requires detail::law_has_same_fields<L>
    static typename L::template parameters<double> combine(typename L::material const& a, typename L::material const& b,
                                                           double /*thickness*/) {
        constexpr std::size_t count = sizeof(a) / sizeof(double);
        std::array<double, count> of_a{}, of_b{};
        __builtin_memcpy(&of_a, &a, sizeof a);
        __builtin_memcpy(&of_b, &b, sizeof b);
        for (std::size_t f = 0; f < count; ++f) {
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(L::combined_by)>, combine_rule>)
                of_a[f] = combined(L::combined_by, of_a[f], of_b[f]);
            else
                of_a[f] = combined(L::combined_by[f], of_a[f], of_b[f]);
        }
        typename L::template parameters<double> result;
        __builtin_memcpy(static_cast<void*>(&result), &of_a, sizeof result);
        return result;
    }

    /// All zero, but for a member `touching_distance` or `rest_length`, which is the distance: no force at the start.
    template <class T, int Dim, class L = Law>
    static typename L::template history<T, Dim> initial(T distance, T /*touching_distance*/) {
        typename L::template history<T, Dim> h{};
        if constexpr (requires { h.touching_distance; }) h.touching_distance = distance;
        if constexpr (requires { h.rest_length; }) h.rest_length = distance;
        return h;
    }

    /// Where a bond fails in shear, the contact starts without a normal force at the present distance, or at the sum of
    /// the radii if that is less. A member `shear_force` carries the bond's shear force on.
    template <class P, class T, int Dim, class L = Law>
    static typename L::template history<T, Dim> hand_over(P const& /*parameters*/, pair_motion<T, Dim> const& m,
                                                          T /*normal_force*/,
                                                          vec<T, shear_dim<Dim>> const& shear_force) {
        auto h = L::template initial<T, Dim>(min(m.distance, m.touching_distance()), m.touching_distance());
        if constexpr (requires { h.shear_force; }) h.shear_force = shear_force;
        return h;
    }

    /// The formula's own derivative of the normal force by the distance, in the present state, N/m. A law whose
    /// unloading is stiffer than its loading states the larger value itself: `stiffness(parameters)`.
    template <class T, int Dim, class P, class H, class L = Law>
    static T stiffness(P const& parameters, pair_motion<T, Dim> const& m, H const& history) {
        using number = dual<T, 1>;
        auto const constant = [](T x) { return number(x); };
        pair_motion<number, Dim> motion{};
        motion.distance = number::variable(m.distance, 0);
        motion.radius_i = number(m.radius_i);
        motion.radius_j = number(m.radius_j);
        auto const p = convert_fields<number, T, typename L::template parameters<number>>(parameters, constant);
        auto const h = convert_fields<number, T, typename L::template history<number, Dim>>(history, constant);
        return abs(L::evaluate(p, motion, h).normal_force.derivative[0]);
    }
};

} // namespace lacuna
