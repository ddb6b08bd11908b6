// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <lacuna/core/points.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/pores/flow/flow_ledger.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

namespace detail {
struct any_pair_lookup {
    std::int64_t operator()(std::int32_t, std::int32_t) const { return 0; }
};
} // namespace detail

struct no_flow;

namespace detail {
template <class Policy>
concept flow_parameters_slot = std::default_initializable<typename Policy::parameters> &&
    std::copyable<typename Policy::parameters> &&
    requires(typename Policy::parameters const& p, std::string const& name) { p.validate(name); };
template <class Policy, class Real, int Dim>
concept flow_solver_slot =
    std::copyable<typename Policy::template solver<Real, Dim>> &&
    std::constructible_from<typename Policy::template solver<Real, Dim>, typename Policy::parameters const&,
                            pore_network<Real, Dim>, Real, points_view<Real, Dim>, Real const*>;
template <class Solver>
concept flow_settings = requires(Solver const& view) {
    { view.settings().interval } -> std::convertible_to<int>;
    { view.settings().bulk_modulus } -> std::convertible_to<double>;
    { view.settings().minimum_pressure } -> std::convertible_to<double>;
    { view.settings().minimum_volume_fraction } -> std::convertible_to<double>;
};
template <class Solver, class Real, int Dim>
concept flow_network = requires(Solver const& view) {
    { view.network() } -> std::same_as<pore_network<Real, Dim> const&>;
};
template <class Solver>
concept flow_map_throats = requires(Solver& solver) { solver.map_throats(any_pair_lookup{}); };
template <class Solver, class Real>
concept flow_refresh_apertures = requires(Solver& solver, particle_column<Real> const& particles,
                                          Real const* normal_forces) {
    solver.refresh_apertures(particles, normal_forces);
};
template <class Solver>
concept flow_deactivate_slow_throats = requires(Solver& solver) { solver.deactivate_slow_throats(); };
template <class Solver, class Real, bool WithLedger>
concept flow_step = requires(Solver& solver, particle_column<Real> const& particles, Real const* normal_forces, Real dt,
                             record_column<Real>* out) {
    solver.template step<WithLedger>(particles, normal_forces, dt, 1, out);
};
template <class Solver>
concept flow_time_step = requires(Solver const& view) {
    { view.critical_time_step() } -> std::convertible_to<double>;
};
template <class Solver, class Real, int Dim>
concept flow_tractions = requires(Solver const& view, points_view<Real, Dim> points, Real const* radii) {
    {
        view.pore_tractions(std::size_t(0), points, radii)
        } -> std::convertible_to<std::array<vec<Real, Dim>, std::size_t(Dim) + 1>>;
};
template <class Solver, class Real>
concept flow_energies = requires(Solver const& view) {
    { view.storage_energy() } -> std::convertible_to<double>;
    { view.ledger() } -> std::convertible_to<flow_ledger<Real>>;
};
template <class Solver, class Real, int Dim>
concept flow_restore = requires(Solver& solver, pore_network<Real, Dim> network, flow_ledger<Real> const& ledger) {
    solver.restore(std::move(network), ledger);
};
struct any_archive {
    using is_loading = std::false_type;
    template <class... Members>
    void operator()(Members&&...) const {}
};
template <class Solver>
concept flow_serialize = requires(Solver& solver, any_archive& ar) { solver.serialize(ar); };

template <class Solver, class Real, int Dim>
concept flow_solver = flow_settings<Solver> && flow_network<Solver, Real, Dim> && flow_map_throats<Solver> &&
    flow_refresh_apertures<Solver, Real> && flow_deactivate_slow_throats<Solver> && flow_step<Solver, Real, true> &&
    flow_step<Solver, Real, false> && flow_time_step<Solver> && flow_tractions<Solver, Real, Dim> &&
    flow_energies<Solver, Real> && flow_restore<Solver, Real, Dim> && flow_serialize<Solver>;
} // namespace detail

/// Requirements on the flow policy of a model. Policies are explicit_flow, implicit_flow and no_flow. A policy has
///   - `parameters`: an aggregate with defaults and `validate(std::string const& name)`;
///   - `solver<Real, Dim>`: copyable, constructed from (parameters, network, thickness, points, radii).
///
/// The solver has
///   - `settings()`: its parameters. They have `interval` (fluid flows in one of so many steps, for the time of all),
///     `bulk_modulus`, Pa, and for remeshing `minimum_pressure`, Pa, and `minimum_volume_fraction`, 1.
///   - `network()`: the pores and throats in their present state.
///   - `step<WithLedger>(particles, normal_forces, dt, threads, tractions)`: called once per step; writes the forces of
///     the pores on the particles. In a step of 0 s pressures follow the volumes, and nothing flows.
///   - `map_throats(lookup)`: called whenever the pairs are stored in another order; may do nothing.
///   - `refresh_apertures(particles, normal_forces)` and `deactivate_slow_throats()`: called at the start and whenever
///     pairs or pores have changed; both may do nothing.
///   - `critical_time_step()` of the flow alone, s, and `pore_tractions(pore, points, radii)`, the forces on the pore's
///     corners for 1 Pa in it, N. The bound of the time step gets the stiffness of the fluid from them.
///   - `storage_energy()`, J, and `ledger()`: for the energy ledger.
///   - `restore(network, ledger)`: continues with another mesh.
///   - `serialize(archive)`: archives the state that a run changes (core/state.hpp).
///
/// If it has `mean_throat_limit()`, time_step_limits report it.
template <class Policy, int Dim = 2, class Real = double>
concept flow_policy = detail::flow_parameters_slot<Policy> &&
    (std::same_as<Policy, no_flow> || (detail::flow_solver_slot<Policy, Real, Dim> &&
                                       detail::flow_solver<typename Policy::template solver<Real, Dim>, Real, Dim>));

/// Flow policy of a dry packing: the network is empty, and steps do nothing.
struct no_flow {
    struct parameters {
        void validate(std::string const&) const {}
    };

    template <class Real, int Dim>
    class solver {
    public:
        solver() = default;
        solver(parameters const&, pore_network<Real, Dim> const&, Real, points_view<Real, Dim>, Real const*) {}
        template <class Lookup>
        void map_throats(Lookup const&) noexcept {}
        void refresh_apertures(particle_column<Real> const&, Real const*, int = 1) noexcept {}
        /// Writes zeros to `tractions`.
        template <bool WithLedger>
        void step(particle_column<Real> const&, Real const*, Real, int = 1,
                  record_column<Real>* tractions = nullptr) noexcept {
            if (tractions) std::fill(tractions->data(), tractions->data() + 4 * tractions->size(), Real(0));
        }
        Real critical_time_step() const noexcept { return std::numeric_limits<Real>::infinity(); }
        Real storage_energy() const noexcept { return Real(0); }
        flow_ledger<Real> const& ledger() const noexcept { return ledger_; }
        pore_network<Real, Dim> const& network() const noexcept { return network_; }
        std::size_t deactivate_slow_throats() noexcept { return 0; }
        template <class Archive>
        void serialize(Archive&) noexcept {}

    private:
        pore_network<Real, Dim> network_;
        flow_ledger<Real> ledger_;
    };
};

} // namespace lacuna
