// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include <lacuna/core/aggregate.hpp>
#include <lacuna/model.hpp>

/// \file
/// Compile-time checks of a model. A faulty model gives one message, which names the slot and the member.

namespace lacuna::detail {

/// Refuses a member that the tables of a law cannot store: Member is its type, Name spells its name.
template <class Member, auto Name>
constexpr bool refuse_member() {
    static_assert(std::is_void_v<Member>, "each member of a law's parameters and history must be T or vec<T, N>: the "
                                          "tables keep nothing else");
    return true;
}

#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wundefined-var-template"
#pragma clang diagnostic ignored "-Wundefined-internal"
#endif
/// Number of the first member of an aggregate that does not consist of T.
template <class Aggregate, class T>
constexpr std::size_t first_odd_member() {
    return decltype(with_members(std::declval<Aggregate&>(), [](auto&... member) {
        constexpr std::size_t found = [] {
            std::size_t next = 0;
            bool none = true;
            ((none = none && consists_of<std::remove_cvref_t<decltype(member)>, T>(), next += none), ...);
            return next;
        }();
        return std::integral_constant<std::size_t, found>();
    }))::value;
}
template <class Aggregate, class T>
inline constexpr auto odd_member =
    spelled_address{address_of_member<first_odd_member<Aggregate, T>()>(unmade<Aggregate>.value)};
template <class Aggregate, class T>
using odd_member_type = std::remove_cvref_t<decltype(*odd_member<Aggregate, T>.to)>;
#if defined(__clang__)
#pragma clang diagnostic pop
#endif

template <class Aggregate>
inline constexpr bool is_plain = std::is_aggregate_v<Aggregate> && std::is_trivially_copyable_v<Aggregate>;

struct contact_law_slot;
struct bond_law_slot;
/// States which part a law lacks; the template arguments name the law.
template <class Law, int Dim, class Slot>
constexpr bool explain_law() {
    constexpr bool never = std::is_void_v<Law>, bond = std::is_same_v<Slot, bond_law_slot>;
    if constexpr (!law_material<Law>)
        static_assert(never, "the law needs: struct material { ...; void validate(std::string const& name) const; }");
    else if constexpr (!law_parameters<Law>)
        static_assert(never, "the law needs: template <class T> struct parameters");
    else if constexpr (!law_history<Law, Dim>)
        static_assert(never, "the law needs: template <class T, int Dim> struct history");
    else if constexpr (!is_plain<typename Law::template parameters<law_pack>> ||
                       !is_plain<typename Law::template history<law_pack, Dim>>)
        static_assert(
            never,
            "a law's parameters and history must be plain aggregates: no constructor, private member or container");
    else if constexpr (!law_scalar_parameters<Law>)
        return refuse_member<odd_member_type<typename Law::template parameters<law_pack>, law_pack>,
                             odd_member<typename Law::template parameters<law_pack>, law_pack>>();
    else if constexpr (!law_scalar_history<Law, Dim>)
        return refuse_member<odd_member_type<typename Law::template history<law_pack, Dim>, law_pack>,
                             odd_member<typename Law::template history<law_pack, Dim>, law_pack>>();
    else if constexpr (!law_combine<Law>)
        static_assert(
            never,
            "the law needs: static parameters<double> combine(material const&, material const&, double thickness)");
    else if constexpr (!law_initial<Law, Dim, double> || !law_initial<Law, Dim, law_dual>)
        static_assert(
            never,
            "the law needs, for every T: static history<T, Dim> initial<T, Dim>(T distance, T touching_distance)");
    else if constexpr (!law_evaluate<Law, Dim, double>)
        static_assert(never,
                      "the law needs: static pair_response (of bonds bond_response) evaluate(parameters<T> const&, "
                      "pair_motion<T, Dim> const&, history<T, Dim> const&)");
    else if constexpr (!law_evaluate<Law, Dim, law_pack> || !law_evaluate<Law, Dim, law_dual>)
        static_assert(never, "the law's evaluate() must take every scalar type T: packs and dual numbers too");
    else if constexpr (!law_energies<Law, Dim, double>)
        static_assert(never,
                      "the law's answer needs both stored_energy and dissipated_energy, T, or none: force_response");
    else if constexpr (!law_moments<Law, Dim, double> || !law_moments<Law, Dim, law_pack> ||
                       !law_moments<Law, Dim, law_dual>)
        static_assert(never,
                      "a law that carries moments needs: bending_moment in its history, and evaluate(parameters<T>, "
                      "pair_motion<T, Dim>, pair_rotation<T, Dim>, history<T, Dim>) that answers with_moments");
    else if constexpr (!law_stiffness_form<Law, Dim, double> || !law_stiffness_form<Law, Dim, law_pack>)
        static_assert(never,
                      "the law needs, for every T: static T stiffness(parameters<T> const&), or with pair_motion and "
                      "history behind");
    else if constexpr (!law_rotational_stiffness<Law, Dim>)
        static_assert(
            never,
            "a law that carries moments needs: static moment_stiffness<T> rotational_stiffness<Dim>(parameters<T> "
            "const&, T radius_i, T radius_j, T distance)");
    else if constexpr (bond && !(law_broken<Law, Dim, double> && law_broken<Law, Dim, law_pack>))
        static_assert(
            never,
            "the bond law's evaluate() needs: an answer with broken and broken_in_tension, mask_t<T>: bond_response");
    else if constexpr (!bond && !law_hand_over<Law, Dim>)
        static_assert(
            never, "the contact law needs: static history<T, Dim> hand_over(parameters<T> const&, pair_motion<T, Dim> "
                   "const&, T normal_force, vec<T, shear_dim<Dim>> const& shear_force)");
    return true;
}
/// States which part a damping policy lacks.
template <class Policy>
constexpr bool explain_damping() {
    constexpr bool never = std::is_void_v<Policy>;
    if constexpr (!damping_parameters<Policy>)
        static_assert(never,
                      "the damping needs: struct parameters { ...; void validate(std::string const& name) const; }");
    else if constexpr (!damping_flags<Policy>)
        static_assert(never, "the damping needs: static constexpr bool acts_on_pairs, acts_on_particles");
    else if constexpr (!damping_particle_force<Policy, double> || !damping_particle_force<Policy, pack<double, 4>>)
        static_assert(
            never, "the damping needs, for every T: static T particle_force(parameters const&, T force, T velocity)");
    else if constexpr (!damping_inertial_force<Policy, double> || !damping_inertial_force<Policy, pack<double, 4>>)
        static_assert(never,
                      "a damping with needs_inertia needs, for every T: static T particle_force(parameters const&, T "
                      "force, T velocity, T inertia), and static double drag_rate(parameters const&)");
    else if constexpr (!damping_policy<Policy>)
        static_assert(never,
                      "a damping that acts_on_pairs needs, for every T: static T pair_force(parameters const&, T "
                      "stiffness, T mass_i, T mass_j, T normal_rate)");
    return true;
}
template <class Policy, int Dim, class Real>
constexpr bool explain_flow() {
    constexpr bool never = std::is_void_v<Policy>;
    if constexpr (flow_policy<Policy, Dim, Real>) {
        return true;
    } else if constexpr (!flow_parameters_slot<Policy>) {
        static_assert(never,
                      "the flow needs: struct parameters { ...; void validate(std::string const& name) const; }");
    } else if constexpr (!flow_solver_slot<Policy, Real, Dim>) {
        static_assert(never,
                      "the flow needs: template <class Real, int Dim> class solver, copyable, made from (parameters, "
                      "pore_network<Real, Dim>, Real thickness, points_view<Real, Dim>, Real const* radii)");
    } else {
        using solver = typename Policy::template solver<Real, Dim>;
        if constexpr (!flow_settings<solver>)
            static_assert(never, "the flow's solver needs: settings() with interval, bulk_modulus, minimum_pressure "
                                 "and minimum_volume_fraction");
        else if constexpr (!flow_network<solver, Real, Dim>)
            static_assert(never, "the flow's solver needs: pore_network<Real, Dim> const& network() const");
        else if constexpr (!flow_map_throats<solver>)
            static_assert(never, "the flow's solver needs: template <class Lookup> void map_throats(Lookup const&)");
        else if constexpr (!flow_refresh_apertures<solver, Real>)
            static_assert(never, "the flow's solver needs: void refresh_apertures(particle_column<Real> const&, Real "
                                 "const* normal_forces)");
        else if constexpr (!flow_deactivate_slow_throats<solver>)
            static_assert(never, "the flow's solver needs: deactivate_slow_throats()");
        else if constexpr (!(flow_step<solver, Real, true> && flow_step<solver, Real, false>))
            static_assert(never,
                          "the flow's solver needs: template <bool WithLedger> void step(particle_column<Real> "
                          "const&, Real const* normal_forces, Real dt, int threads, record_column<Real>* tractions)");
        else if constexpr (!flow_time_step<solver>)
            static_assert(never, "the flow's solver needs: Real critical_time_step() const");
        else if constexpr (!flow_tractions<solver, Real, Dim>)
            static_assert(never, "the flow's solver needs: pore_tractions(std::size_t pore, points_view<Real, Dim>, "
                                 "Real const* radii) const");
        else if constexpr (!flow_energies<solver, Real>)
            static_assert(never, "the flow's solver needs: Real storage_energy() const and flow_ledger<Real> const& "
                                 "ledger() const");
        else if constexpr (!flow_restore<solver, Real, Dim>)
            static_assert(never, "the flow's solver needs: void restore(pore_network<Real, Dim>, flow_ledger<Real> "
                                 "const&)");
        else if constexpr (!flow_serialize<solver>)
            static_assert(never, "the flow's solver needs: template <class Archive> void serialize(Archive&)");
    }
    return true;
}
template <class Policy, int Dim, class Real>
constexpr bool explain_forces() {
    constexpr bool never = std::is_void_v<Policy>;
    if constexpr (!forces_parameters<Policy>)
        static_assert(
            never, "the forces need: struct parameters { ...; void validate(std::string const& name) const; }, default "
                   "constructible; see body_force");
    else if constexpr (!is_callable_force<Policy, Dim>)
        static_assert(never,
                      "a body force must be callable as: vec<double, dim> force(acted_particle<dim> const&) const");
    else if constexpr (!forces_term<Policy, Real, Dim>)
        static_assert(
            never, "the forces need: template <class Real, int Dim> class term, copyable, made from parameters, with "
                   "bool active() const");
    else if constexpr (!forces_members<Policy, Real, Dim>)
        static_assert(never,
                      "the forces' term needs: add_forces(particle_store<Real, Dim> const&, double time, int threads, "
                      "record_column<Real>&), vec<Real, Dim> force(std::size_t) const, double power(store) const");
    return true;
}
template <class Policy, int Dim>
constexpr bool explain_integrator() {
    constexpr bool fits = integrator<Policy, Dim>;
    static_assert(
        fits, "the integrator needs: static void advance<WithEnergy, Damping>(particle_store<Real, Dim>&, std::size_t "
              "first, int count, Real dt, PairForce const&, Damping::parameters const&, record_column<Real> const* "
              "extra, motion_report<Real>&)");
    return true;
}
template <class Policy, int Dim>
constexpr bool explain_domain() {
    constexpr bool never = std::is_void_v<Policy>;
    if constexpr (!domain_flag<Policy>)
        static_assert(never, "the domain needs: static constexpr bool periodic");
    else if constexpr (!domain_parameters<Policy, Dim>)
        static_assert(
            never,
            "the domain needs: template <int Dim> struct parameters { void validate(std::string const& name) const; }");
    else if constexpr (!domain_period<Policy, Dim>)
        static_assert(never, "a periodic domain needs: vec<double, Dim> period in its parameters");
    return true;
}
template <class Search>
constexpr bool explain_search() {
    constexpr bool never = std::is_void_v<Search>;
    if constexpr (!(std::default_initializable<Search> && std::copyable<Search>))
        static_assert(never, "the search must be default constructible and copyable");
    else if constexpr (!search_types<Search>)
        static_assert(never, "the search needs: using real_type, static constexpr int dim");
    else if constexpr (!search_build<Search>)
        static_assert(never, "the search needs: void build(points_view const&, real_type cutoff)");
    else if constexpr (!search_pairs<Search>)
        static_assert(never, "the search needs: void pairs(std::vector<neighbor_pair>&) const");
    else if constexpr (!search_touching_pairs<Search>)
        static_assert(never,
                      "the search needs: void touching_pairs(points_view const&, std::span<real_type const> radii, "
                      "real_type margin, std::vector<neighbor_pair>&)");
    return true;
}

template <class M>
concept has_all_slots = requires {
    { M::dim } -> std::convertible_to<int>;
    typename M::real;
    typename M::contact_law;
    typename M::bond_law;
    typename M::damping;
    typename M::flow;
    typename M::forces;
    typename M::integrator;
    typename M::domain;
    typename M::template search<double, 2>;
};

template <class M>
constexpr bool explain_slots() {
    constexpr bool complete = has_all_slots<M>;
    static_assert(complete, "a model starts from default_model: struct my_model : lacuna::default_model<2> { ... };");
    if constexpr (has_all_slots<M>) {
        static_assert(plane_or_space<M::dim>, "a model's dim must be 2 or 3");
        static_assert(std::floating_point<typename M::real>, "a model's real must be float or double");
    }
    return true;
}
template <class M>
concept good_slots = has_all_slots<M> && plane_or_space<M::dim> && std::floating_point<typename M::real>;
/// The model itself if its slots are good, else a default model.
template <class M>
using with_slots = std::conditional_t<good_slots<M>, M, default_model<2>>;

} // namespace lacuna::detail
