// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include <lacuna/core/aggregate.hpp>
#include <lacuna/core/dual.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/laws/pair_motion.hpp>

/// \file
/// Requirements on a pair law. Each requirement is a separate concept, so a compiler names the one that a law violates.
/// A formula must accept plain numbers, packs (the time step uses them) and dual numbers (the bound of the time step
/// differentiates with them).

namespace lacuna {

namespace detail {

template <class>
inline constexpr bool is_fixed_array = false;
template <class T, std::size_t N>
inline constexpr bool is_fixed_array<std::array<T, N>> = true;

/// True if a member consists of T only: it is T, a vec of T, or a trivially copyable aggregate of such members.
template <class Member, class T>
constexpr bool consists_of() {
    if constexpr (std::is_same_v<Member, T> || (std::is_empty_v<Member> && std::is_class_v<Member>))
        return true;
    else if constexpr (is_vec<Member>)
        return std::is_same_v<Member, vec<T, Member::size()>>;
    else if constexpr (!std::is_class_v<Member> || !std::is_aggregate_v<Member> ||
                       !std::is_trivially_copyable_v<Member> || is_fixed_array<Member>)
        return false;
    else
        return decltype(with_members(std::declval<Member&>(), [](auto&... member) {
            return std::bool_constant<(consists_of<std::remove_cvref_t<decltype(member)>, T>() && ...)>();
        }))::value;
}

/// The scalar types, besides double, that a formula must accept.
using law_pack = pack<double, native_width<double>>;
using law_dual = dual<double, 2>;

/// `material` is a struct with `validate(std::string const& name)`.
template <class Law>
concept law_material = std::default_initializable<typename Law::material> &&
    requires(typename Law::material const& material, std::string const& name) { material.validate(name); };
template <class Law>
concept law_parameters = requires {
    typename Law::template parameters<double>;
    typename Law::template parameters<law_pack>;
    typename Law::template parameters<law_dual>;
};
template <class Law, int Dim>
concept law_history = requires {
    typename Law::template history<double, Dim>;
    typename Law::template history<law_pack, Dim>;
    typename Law::template history<law_dual, Dim>;
};
/// The pair tables store rows of T: a member of another type would be lost.
template <class Law>
concept law_scalar_parameters = consists_of<typename Law::template parameters<law_pack>, law_pack>();
template <class Law, int Dim>
concept law_scalar_history = consists_of<typename Law::template history<law_pack, Dim>, law_pack>();
template <class Law>
concept law_combine = requires(typename Law::material const& material) {
    { Law::combine(material, material, 1.0) } -> std::same_as<typename Law::template parameters<double>>;
};
template <class Law, int Dim, class T>
concept law_initial = requires(T const& distance) {
    { Law::template initial<T, Dim>(distance, distance) } -> std::same_as<typename Law::template history<T, Dim>>;
};
/// The formula exists, and each member of its response has the right type.
template <class Law, int Dim, class T>
concept law_evaluate = requires(typename Law::template parameters<T> const& parameters,
                                pair_motion<T, Dim> const& motion,
                                typename Law::template history<T, Dim> const& history) {
    Law::evaluate(parameters, motion, history);
    { Law::evaluate(parameters, motion, history).normal_force } -> std::convertible_to<T>;
    { Law::evaluate(parameters, motion, history).shear_force } -> std::convertible_to<vec<T, shear_dim<Dim>>>;
    { Law::evaluate(parameters, motion, history).history } ->
        std::convertible_to<typename Law::template history<T, Dim>>;
};
/// Both energies, or none of them: force_response.
template <class Law, int Dim, class T>
concept law_energies =
    !requires(typename Law::template parameters<T> const& parameters, pair_motion<T, Dim> const& motion,
              typename Law::template history<T, Dim> const& history) {
        Law::evaluate(parameters, motion, history).stored_energy;
    } || requires(typename Law::template parameters<T> const& parameters, pair_motion<T, Dim> const& motion,
                  typename Law::template history<T, Dim> const& history) {
        { Law::evaluate(parameters, motion, history).stored_energy } -> std::convertible_to<T>;
        { Law::evaluate(parameters, motion, history).dissipated_energy } -> std::convertible_to<T>;
    };
template <class Law, int Dim, class T>
concept law_broken = requires(typename Law::template parameters<T> const& parameters, pair_motion<T, Dim> const& motion,
                              typename Law::template history<T, Dim> const& history) {
    { Law::evaluate(parameters, motion, history).broken } -> std::convertible_to<mask_t<T>>;
    { Law::evaluate(parameters, motion, history).broken_in_tension } -> std::convertible_to<mask_t<T>>;
};
template <class Law, class T>
concept law_constant_stiffness = requires(typename Law::template parameters<T> const& parameters) {
    { Law::stiffness(parameters) } -> std::convertible_to<T>;
};
template <class Law, int Dim, class T>
concept law_present_stiffness =
    requires(typename Law::template parameters<T> const& parameters, pair_motion<T, Dim> const& motion,
             typename Law::template history<T, Dim> const& history) {
        { Law::stiffness(parameters, motion, history) } -> std::convertible_to<T>;
    };
/// The law has at least one of the two forms of `stiffness`; see dashpot_stiffness().
template <class Law, int Dim, class T>
concept law_stiffness_form = law_present_stiffness<Law, Dim, T> || law_constant_stiffness<Law, T>;
template <class Law, int Dim>
concept law_hand_over =
    requires(typename Law::template parameters<double> const& parameters, pair_motion<double, Dim> const& motion,
             vec<double, shear_dim<Dim>> const& shear) {
        { Law::hand_over(parameters, motion, 1.0, shear) } -> std::same_as<typename Law::template history<double, Dim>>;
    };
/// Applies to laws that carry moments only; see carries_moment.
template <class Law, int Dim, class T>
concept law_moments =
    !carries_moment<Law> || requires(typename Law::template parameters<T> const& parameters,
                                     pair_motion<T, Dim> const& motion, pair_rotation<T, Dim> const& rotation,
                                     typename Law::template history<T, Dim> const& history) {
        { history.bending_moment } -> std::convertible_to<vec<T, rotation_dim<Dim>>>;
        {
            Law::evaluate(parameters, motion, rotation, history).bending_moment
        } -> std::convertible_to<vec<T, rotation_dim<Dim>>>;
        { Law::evaluate(parameters, motion, rotation, history).twisting_moment } -> std::convertible_to<T>;
    };
template <class Law, int Dim>
concept law_rotational_stiffness =
    !carries_moment<Law> || requires(typename Law::template parameters<double> const& parameters) {
        { Law::template rotational_stiffness<Dim>(parameters, 1.0, 1.0, 1.0) } ->
            std::convertible_to<moment_stiffness<double>>;
    };

template <class Law, int Dim, class T>
concept law_formula = law_evaluate<Law, Dim, T> && law_energies<Law, Dim, T> && law_moments<Law, Dim, T>;

template <class Law, int Dim>
concept pair_law = law_material<Law> && law_parameters<Law> && law_history<Law, Dim> && law_scalar_parameters<Law> &&
    law_scalar_history<Law, Dim> && law_combine<Law> && law_initial<Law, Dim, double> &&
    law_initial<Law, Dim, law_dual> && law_formula<Law, Dim, double> && law_formula<Law, Dim, law_pack> &&
    law_formula<Law, Dim, law_dual> && law_stiffness_form<Law, Dim, double> && law_stiffness_form<Law, Dim, law_pack> &&
    law_rotational_stiffness<Law, Dim>;

} // namespace detail

/// A law for two particles in contact. It has
///   - `material`: an aggregate with the input values of one material, and `validate(std::string const& name)`;
///   - `parameters<T>`: an aggregate of T only, the formula's input; made by `combine(material, material, thickness)`;
///   - `history<T, Dim>`: an aggregate of T (and vec of T) only. `initial<T, Dim>(distance, touching_distance)` returns
///     the history at zero force. The engine rotates a member `shear_force` with the pair. A pair stays in the table
///     while a member `touching_distance` exceeds the sum of the radii; else it stays up to that sum plus a skin;
///   - `evaluate(parameters<T>, pair_motion<T, Dim>, history<T, Dim>) -> pair_response`, or force_response: the
///     formula;
///   - `stiffness(parameters)`: the largest tangent stiffness of the normal force, N/m. A law whose tangent grows with
///     the overlap has `stiffness(parameters, pair_motion, history)` instead: see dashpot_stiffness() and
///     require_stated_stiffness();
///   - `hand_over(parameters, pair_motion, normal_force, shear_force)`: the history of a contact that takes over these
///     forces from a bond that has just failed in shear.
/// law_defaults offers all but `material`, `parameters`, `history` and the formula.
template <class Law, int Dim>
concept contact_law = detail::pair_law<Law, Dim> && detail::law_hand_over<Law, Dim>;

/// A law for two bonded particles: a contact law without `hand_over`. Its response says whether the bond fails.
template <class Law, int Dim>
concept bond_law = detail::pair_law<Law, Dim> && detail::law_broken<Law, Dim, double> &&
    detail::law_broken<Law, Dim, detail::law_pack>;

namespace detail {
/// Instantiates a formula for packs, so that the compiler refuses a bad one at the law's slot and not deep in the step.
template <class Law, int Dim, class T>
void use_formula(typename Law::template parameters<T> const& parameters, pair_motion<T, Dim> const& motion,
                 typename Law::template history<T, Dim> const& history) {
    Law::evaluate(parameters, motion, history);
}
template <class Law, int Dim>
inline constexpr bool instantiates_formula = (static_cast<void>(&use_formula<Law, Dim, law_pack>), true);
} // namespace detail

} // namespace lacuna
