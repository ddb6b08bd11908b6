// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

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

/// A flow solver of a model, the slot filled by explicit_flow, implicit_flow and no_flow:
///   - `parameters`: an aggregate with defaults and `validate(std::string const& name)`; those of a fluid have
///     `interval` and `bulk_modulus`, and its solver returns them as settings();
///   - `solver<Real, Dim>`: made from (parameters, network, thickness, points, radii). step() is called once per step, and
///     writes what the pores exert on the particles; map_throats() whenever the pairs' places in memory change. A step
///     of 0 s lets pressures follow the volumes, and nothing flow.
template <class Policy>
concept flow_policy = requires(typename Policy::parameters const& parameters,
                               typename Policy::template solver<double, 2>& solver,
                               typename Policy::template solver<double, 2> const& view,
                               body_column<double> const& place, double const* normal_forces,
                               record_column<double>& extra) {
    parameters.validate("flow");
    solver.map_throats(detail::any_pair_lookup{});
    solver.refresh_apertures(place, normal_forces, 1);
    solver.template step<true>(place, normal_forces, 1.0, 1, &extra);
    solver.template step<false>(place, normal_forces, 1.0, 1, &extra);
    { view.critical_time_step() } -> std::convertible_to<double>;
    { view.equation_19_time_step() } -> std::convertible_to<double>;
    { view.storage_energy() } -> std::convertible_to<double>;
    { view.ledger() } -> std::convertible_to<flow_ledger<double>>;
    { view.network() } -> std::convertible_to<pore_network<double, 2> const&>;
    { solver.skip_idle_throats(1.0) } -> std::convertible_to<std::size_t>;
};

/// No fluid: a dry body. Its network is empty and its steps do nothing.
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
        void refresh_apertures(body_column<Real> const&, Real const*, int = 1) noexcept {}
        /// Writes zeros.
        template <bool WithLedger>
        void step(body_column<Real> const&, Real const*, Real, int = 1, record_column<Real>* tractions = nullptr) noexcept {
            if (tractions) std::fill(tractions->data(), tractions->data() + 4 * tractions->size(), Real(0));
        }
        Real critical_time_step() const noexcept { return std::numeric_limits<Real>::infinity(); }
        Real equation_19_time_step() const noexcept { return std::numeric_limits<Real>::infinity(); }
        Real storage_energy() const noexcept { return Real(0); }
        flow_ledger<Real> const& ledger() const noexcept { return ledger_; }
        pore_network<Real, Dim> const& network() const noexcept { return network_; }
        std::size_t skip_idle_throats(Real) noexcept { return 0; }
        template <class Archive>
        void serialize(Archive&) noexcept {}

    private:
        pore_network<Real, Dim> network_;
        flow_ledger<Real> ledger_;
    };
};

} // namespace lacuna
