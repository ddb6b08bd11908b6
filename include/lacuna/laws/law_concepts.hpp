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
/// What a law of a pair must have. Each requirement is a concept of its own, so that a compiler names the one that a law
/// does not meet. A formula is asked for plain numbers, for packs, as the step uses it, and for dual numbers, as the bound
/// of the time step does.

namespace lacuna {

namespace detail {

template <class>
inline constexpr bool is_fixed_array = false;
template <class T, std::size_t N>
inline constexpr bool is_fixed_array<std::array<T, N>> = true;

/// Whether a member consists of T: it is T, a vec of T or a plain aggregate of such.
template <class Member, class T>
constexpr bool consists_of() {
    if constexpr (std::is_same_v<Member, T> || (std::is_empty_v<Member> && std::is_class_v<Member>))
        return true;
    else if constexpr (is_vec<Member>)
        return std::is_same_v<Member, vec<T, Member::size()>>;
    else if constexpr (!std::is_class_v<Member> || !std::is_aggregate_v<Member> || !std::is_trivially_copyable_v<Member> ||
                       is_fixed_array<Member>)
        return false;
    else
        return decltype(with_members(std::declval<Member&>(), [](auto&... member) {
            return std::bool_constant<(consists_of<std::remove_cvref_t<decltype(member)>, T>() && ...)>();
        }))::value;
}

/// The packs with which a formula is asked.
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
/// The tables keep rows of T: a member of another type would be lost.
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
/// The formula and each member of its answer.
template <class Law, int Dim, class T>
concept law_evaluate = requires(typename Law::template parameters<T> const& parameters, pair_motion<T, Dim> const& motion,
                                typename Law::template history<T, Dim> const& history) {
    Law::evaluate(parameters, motion, history);
    { Law::evaluate(parameters, motion, history).normal_force } -> std::convertible_to<T>;
    { Law::evaluate(parameters, motion, history).shear_force } -> std::convertible_to<vec<T, shear_dim<Dim>>>;
    { Law::evaluate(parameters, motion, history).history } -> std::convertible_to<typename Law::template history<T, Dim>>;
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
/// One of the two forms of `stiffness`; see dashpot_stiffness().
template <class Law, int Dim, class T>
concept law_stiffness_form = law_present_stiffness<Law, Dim, T> || law_constant_stiffness<Law, T>;
template <class Law, int Dim>
concept law_hand_over =
    requires(typename Law::template parameters<double> const& parameters, pair_motion<double, Dim> const& motion,
             vec<double, shear_dim<Dim>> const& shear) {
        { Law::hand_over(parameters, motion, 1.0, shear) } -> std::same_as<typename Law::template history<double, Dim>>;
    };
/// Of laws that carry moments; see carries_moment.
template <class Law, int Dim, class T>
concept law_moments =
    !carries_moment<Law> || requires(typename Law::template parameters<T> const& parameters,
                                     pair_motion<T, Dim> const& motion, pair_rotation<T, Dim> const& turn,
                                     typename Law::template history<T, Dim> const& history) {
        { history.bending_moment } -> std::convertible_to<vec<T, rotation_dim<Dim>>>;
        { Law::evaluate(parameters, motion, turn, history).bending_moment } -> std::convertible_to<vec<T, rotation_dim<Dim>>>;
        { Law::evaluate(parameters, motion, turn, history).twisting_moment } -> std::convertible_to<T>;
    };
template <class Law, int Dim>
concept law_rotational_stiffness =
    !carries_moment<Law> || requires(typename Law::template parameters<double> const& parameters) {
        { Law::template rotational_stiffness<Dim>(parameters, 1.0, 1.0, 1.0) } -> std::convertible_to<moment_stiffness<double>>;
    };

template <class Law, int Dim, class T>
concept law_formula = law_evaluate<Law, Dim, T> && law_moments<Law, Dim, T>;

template <class Law, int Dim>
concept pair_law = law_material<Law> && law_parameters<Law> && law_history<Law, Dim> && law_scalar_parameters<Law> &&
    law_scalar_history<Law, Dim> && law_combine<Law> && law_initial<Law, Dim, double> &&
    law_initial<Law, Dim, law_dual> && law_formula<Law, Dim, double> && law_formula<Law, Dim, law_pack> &&
    law_formula<Law, Dim, law_dual> && law_stiffness_form<Law, Dim, double> && law_stiffness_form<Law, Dim, law_pack> &&
    law_rotational_stiffness<Law, Dim>;

} // namespace detail

/// A law of two particles in contact. It has
///   - `material`: an aggregate of what one material contributes, with `validate(std::string const& name)`;
///   - `parameters<T>`: an aggregate of T only, what the formula reads, made by `combine(material, material, thickness)`;
///   - `history<T, Dim>`: an aggregate of T (and vec of T) only; a member `shear_force` turns with the pair;
///     `initial<T, Dim>(distance, touching_distance)` is its state at zero force; while a member `touching_distance` is
///     larger than the sum of the radii the pair stays in the table, else up to that sum and a skin;
///   - `evaluate(parameters<T>, pair_motion<T, Dim>, history<T, Dim>) -> pair_response`: the formula;
///   - `stiffness(parameters)`, the most that the tangent of the normal force becomes, or, of a law whose tangent grows with
///     the overlap, `stiffness(parameters, pair_motion, history)`: see dashpot_stiffness() and require_stated_stiffness();
///   - `hand_over(parameters, pair_motion, normal_force, shear_force)`: the state that carries on the given forces of a
///     bond that has just failed in shear.
template <class Law, int Dim>
concept contact_law = detail::pair_law<Law, Dim> && detail::law_hand_over<Law, Dim>;

/// A law of two bonded particles: as a contact law without `hand_over`, and its answer says whether the bond fails.
template <class Law, int Dim>
concept bond_law = detail::pair_law<Law, Dim> && detail::law_broken<Law, Dim, double> && detail::law_broken<Law, Dim, detail::law_pack>;

namespace detail {
/// What a formula does to packs, so that one that cannot is refused where the law is named and not deep in the step.
template <class Law, int Dim, class T>
void use_formula(typename Law::template parameters<T> const& parameters, pair_motion<T, Dim> const& motion,
                 typename Law::template history<T, Dim> const& history) {
    Law::evaluate(parameters, motion, history);
}
template <class Law, int Dim>
inline constexpr bool instantiates_formula = (static_cast<void>(&use_formula<Law, Dim, law_pack>), true);
} // namespace detail

} // namespace lacuna
