// SPDX-License-Identifier: BSD-3-Clause
#include "chosen_flow.hpp"

#include <limits>
#include <utility>

namespace lacuna_run {

template <class Real, int Dim>
chosen_flow::solver<Real, Dim>::solver(parameters const& p, network_type network, Real thickness, points_type points,
                                       Real const* radii)
    : parameters_(p) {
    if (p.kind == flow_kind::explicit_steps)
        chosen_.template emplace<1>(p, std::move(network), thickness, points, radii);
    else if (p.kind == flow_kind::implicit_steps)
        chosen_.template emplace<2>(p, std::move(network), thickness, points, radii);
}

template <class Real, int Dim>
chosen_flow::solver<Real, Dim>::solver(parameters const& p, network_type network) : parameters_(p) {
    if (p.kind == flow_kind::explicit_steps)
        chosen_.template emplace<1>(p, std::move(network));
    else
        chosen_.template emplace<2>(p, std::move(network));
}

template <class Real, int Dim>
void chosen_flow::solver<Real, Dim>::map(lookup_type const& lookup) {
    std::visit([&](auto& one) { one.map_throats(lookup); }, chosen_);
}

template <class Real, int Dim>
void chosen_flow::solver<Real, Dim>::refresh_apertures(particles_type const& positions, Real const* normal_forces,
                                                       int threads) {
    std::visit([&](auto& one) { one.refresh_apertures(positions, normal_forces, threads); }, chosen_);
}

template <class Real, int Dim>
void chosen_flow::solver<Real, Dim>::take_step(bool with_ledger, particles_type const& positions,
                                               Real const* normal_forces, Real dt, int threads, records* tractions) {
    std::visit(
        [&](auto& one) {
            if (with_ledger)
                one.template step<true>(positions, normal_forces, dt, threads, tractions);
            else
                one.template step<false>(positions, normal_forces, dt, threads, tractions);
        },
        chosen_);
}

template <class Real, int Dim>
void chosen_flow::solver<Real, Dim>::advance(Real dt, int threads) {
    std::visit(
        [&](auto& one) {
            if constexpr (requires { one.template advance<true>(dt, threads); })
                one.template advance<true>(dt, threads);
        },
        chosen_);
}

template <class Real, int Dim>
std::array<lacuna::vec<Real, 2>, 3> chosen_flow::solver<Real, Dim>::pore_tractions(std::size_t pore, points_type points,
                                                                                   Real const* radii) const {
    return std::visit(
        [&](auto const& one) -> std::array<lacuna::vec<Real, 2>, 3> {
            if constexpr (requires { one.pore_tractions(pore, points, radii); })
                return one.pore_tractions(pore, points, radii);
            else
                return {};
        },
        chosen_);
}

template <class Real, int Dim>
Real chosen_flow::solver<Real, Dim>::critical_time_step() const {
    return std::visit([](auto const& one) { return Real(one.critical_time_step()); }, chosen_);
}
template <class Real, int Dim>
Real chosen_flow::solver<Real, Dim>::mean_throat_limit() const {
    return std::visit(
        [](auto const& one) {
            if constexpr (requires { one.mean_throat_limit(); })
                return Real(one.mean_throat_limit());
            else
                return std::numeric_limits<Real>::infinity();
        },
        chosen_);
}
template <class Real, int Dim>
Real chosen_flow::solver<Real, Dim>::storage_energy() const {
    return std::visit([](auto const& one) { return Real(one.storage_energy()); }, chosen_);
}
template <class Real, int Dim>
lacuna::flow_ledger<Real> const& chosen_flow::solver<Real, Dim>::ledger() const {
    return std::visit([](auto const& one) -> lacuna::flow_ledger<Real> const& { return one.ledger(); }, chosen_);
}
template <class Real, int Dim>
typename chosen_flow::solver<Real, Dim>::network_type const& chosen_flow::solver<Real, Dim>::network() const {
    return std::visit([](auto const& one) -> network_type const& { return one.network(); }, chosen_);
}
template <class Real, int Dim>
std::size_t chosen_flow::solver<Real, Dim>::deactivate_slow_throats() {
    return std::visit([&](auto& one) { return std::size_t(one.deactivate_slow_throats()); }, chosen_);
}

template <class Real, int Dim>
void chosen_flow::solver<Real, Dim>::restore(network_type network, lacuna::flow_ledger<Real> const& ledger) {
    std::visit(
        [&](auto& one) {
            if constexpr (requires { one.restore(std::move(network), ledger); })
                one.restore(std::move(network), ledger);
        },
        chosen_);
}

template class chosen_flow::solver<double, 2>;
template class chosen_flow::solver<float, 2>;

} // namespace lacuna_run
