// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include <lacuna/core/points.hpp>
#include <lacuna/core/state.hpp>
#include <lacuna/pores/flow/tractions.hpp>
#include <lacuna/pores/mesh/no_pores.hpp>
#include <lacuna/pores/network/network_shape.hpp>
#include <lacuna/pores/remesh/transfer_fluid.hpp>
#include <lacuna/pores/remesh/remesh.hpp>

namespace lacuna {

/// Makes a new mesh of the pores once the present one does not fit the particles any more.
/// \tparam Flow the flow solver
template <class Flow, class Real, int Dim>
class remesher {
public:
    using network_type = pore_network<Real, Dim>;

    /// Stores a copy of the callable that made the first network. With remesh_rule::never it stores nothing, and
    /// remesh() does nothing.
    template <class Make, class Pairs>
    void start(remesh_parameters const& parameters, Make const& make, Real thickness, Flow const& flow,
               points_view<Real, Dim> points, Real const* radii, Pairs const& pairs) {
        parameters_ = parameters;
        thickness_ = thickness;
        maker_.reset();
        if (parameters.rule == remesh_rule::never) return;
        using maker = std::decay_t<Make>; // a pointer if Make is a function
        maker_ = std::make_shared<maker const>(make);
        make_ = [](void const* stored, points_view<Real, Dim> x, Real const* r) -> network_type {
            return (*static_cast<maker const*>(stored))(x, r);
        };
        store_positions(points);
        accept(flow, points, radii, pairs);
    }

    /// Whether remesh() may replace the mesh.
    bool on() const noexcept { return maker_ != nullptr; }

    /// Checks the mesh after every `interval` steps, and gives the flow solver a new one if necessary. The forces of
    /// the pressures on the particles change with the next step of the flow, not here.
    /// \param number number of the step
    /// \return whether the mesh has changed; then the throats must be mapped to the pairs again
    /// \throws std::invalid_argument if no network can be made from the positions of the particles
    template <class Pairs>
    bool remesh(Flow& flow, points_view<Real, Dim> points, Real const* radii, Pairs const& pairs, long long number) {
        if (!maker_ || (number + 1) % parameters_.interval != 0) return false;
        auto const& p = flow.settings();
        auto const& old = flow.network();
        bool needed =
            watch_.unfit(old, points, radii, thickness_, Real(p.minimum_volume_fraction), visit(pairs, points.size()));
        needed = needed || (parameters_.on_broken_bond && pairs.bonds().size() != bonds_);
        if (!needed) return false;
        auto network = make_(maker_.get(), points, radii);
        if (network.pores() == 0) refuse_no_pores(points, radii);
        bool const another = network.corner != old.corner;
        if (another) {
            keep_sizes(old, network);
            auto replacement = Flow(p, std::move(network), thickness_, points, radii).network();
            auto const report = transfer_fluid(old, replacement, points, p.bulk_modulus, p.minimum_pressure);
            auto ledger = flow.ledger();
            ++ledger.remeshes;
            ledger.remesh_energy += storage_energy(replacement, p.bulk_modulus) - flow.storage_energy();
            ledger.remesh_volume += Real(report.volume);
            ledger.remesh_residual = Real(report.residual);
            ledger.remesh_content = Real(report.content);
            ledger.boundary_inflow -= Real(report.lost);
            flow.restore(std::move(replacement), ledger);
            store_positions(points);
        }
        accept(flow, points, radii, pairs);
        return another;
    }

    /// Writes the positions of the particles from which the present mesh was made; the shape of the pores follows from
    /// them. Or reads them and gives the flow solver that network. The flow solver itself writes and reads the fluid in
    /// it.
    /// \throws std::runtime_error if the pores differ from the saved ones, and as the callable that makes the network
    template <class Archive>
    void archive(Archive& ar, Flow& flow, Real const* radii) {
        ar(fixed_length{made_at_});
        if constexpr (Archive::is_loading::value) {
            for (auto const& x : made_at_)
                for (int axis = 0; axis < Dim; ++axis)
                    require_state(std::isfinite(x[axis]), "where its pores were made");
            auto const positions = view_points(made_at_);
            auto network = make_(maker_.get(), positions, radii), saved = network;
            archive_shape(ar, saved);
            require_state(same_shape(saved, network), "its pores were made in another way");
            require_state(saved.size.size() == network.size.size(), "the sizes of its pores");
            for (Real const size : saved.size)
                require_state(size > Real(0) && std::isfinite(size), "the size of a pore");
            network.size = saved.size;
            flow.restore(Flow(flow.settings(), std::move(network), thickness_, positions, radii).network(),
                         flow.ledger());
        } else {
            archive_shape(ar, flow.network());
        }
        watch_.archive(ar, flow.network(), made_at_.size());
        ar(bonds_);
    }

private:
    void store_positions(points_view<Real, Dim> points) {
        made_at_.resize(points.size());
        for (std::size_t k = 0; k < points.size(); ++k) made_at_[k] = points[k];
    }
    template <class Pairs>
    static auto visit(Pairs const& pairs, std::size_t count) {
        return [&pairs, count](auto const& use) {
            auto const each = [&](auto const& table) {
                for (std::size_t s = 0; s < table.slots(); ++s)
                    if (!table.is_padding(s, count)) use(table.i(s), table.j(s));
            };
            each(pairs.bonds());
            each(pairs.contacts());
        };
    }
    template <class Pairs>
    void accept(Flow const& flow, points_view<Real, Dim> points, Real const* radii, Pairs const& pairs) {
        bonds_ = pairs.bonds().size();
        watch_.accept(flow.network(), points, radii, thickness_, Real(flow.settings().minimum_volume_fraction),
                      visit(pairs, points.size()));
    }

    remesh_parameters parameters_{};
    std::shared_ptr<void const> maker_;
    network_type (*make_)(void const*, points_view<Real, Dim>, Real const*) = nullptr;
    mesh_watch<Real> watch_;
    std::vector<vec<Real, Dim>> made_at_; // centres of the particles when the present mesh was made
    Real thickness_ = Real(1);
    std::size_t bonds_ = 0;
};

/// In 3D pores keep their mesh; simulation_parameters::validate() refuses other rules.
template <class Flow, class Real>
class remesher<Flow, Real, 3> {
public:
    template <class... Arguments>
    void start(Arguments const&...) noexcept {}
    bool on() const noexcept { return false; }
    template <class... Arguments>
    bool remesh(Arguments&&...) noexcept {
        return false;
    }
    template <class... Arguments>
    void archive(Arguments&&...) noexcept {}
};

} // namespace lacuna
