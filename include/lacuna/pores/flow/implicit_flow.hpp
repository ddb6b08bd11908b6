// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/aggregate.hpp>
#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/laws/aperture.hpp>
#include <lacuna/pores/flow/flow.hpp>
#include <lacuna/pores/flow/flow_base.hpp>
#include <lacuna/pores/flow/flow_parameters.hpp>
#include <lacuna/pores/network/pore_network.hpp>
#include <lacuna/pores/flow/pressure_system.hpp>

namespace lacuna {

/// Parameters of the implicit scheme: those of the fluid and its throats, and tolerances of the linear solver.
template <aperture_law Aperture>
struct implicit_flow_parameters : flow_parameters<Aperture> {
    /// An earlier factorisation serves as preconditioner until a pore's volume, a throat's conductance or the time step
    /// has changed by more than this share; >= 0, < 1. With 0 any change leads to a new factorisation.
    double factorisation_tolerance = 0.2;
    /// Largest residual of the equations, as a pressure over the largest pressure in the network; > 0, < 1. Mass is
    /// conserved to rounding for any value.
    double solver_tolerance = 1e-10;

    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name) const {
        flow_parameters<Aperture>::validate(name);
        if (this->minimum_pressure > -std::numeric_limits<double>::infinity())
            refuse(name + ".minimum_pressure", this->minimum_pressure,
                   "-infinity with implicit flow: a fluid that tears needs explicit_flow");
        if (!(factorisation_tolerance >= 0 && factorisation_tolerance < 1))
            refuse(name + ".factorisation_tolerance", factorisation_tolerance, ">= 0 and < 1");
        if (!(solver_tolerance > 0 && solver_tolerance < 1))
            refuse(name + ".solver_tolerance", solver_tolerance, "> 0 and < 1");
    }
    /// Its members, by name; see core/aggregate.hpp.
    template <class Visit>
    void for_each_named(Visit const& visit) {
        for_each_named_member(static_cast<flow_parameters<Aperture>&>(*this), visit);
        visit("factorisation_tolerance", factorisation_tolerance);
        visit("solver_tolerance", solver_tolerance);
    }
};

LACUNA_BEGIN_PACKS
/// Backward Euler for the paper's eq. 14 and 15. All flows follow from the new pressures, which solve
///
///   (V / K_f + dt L) p_new = V / K_f p_old + dt (sources) - dV,
///
/// where L is the Laplacian of the network, weighted with the conductances; those of drained throats add to its
/// diagonal. The scheme is stable for any step, and of first order. No pressure leaves the range of the old pressures
/// and those of the reservoirs. (The paper has the explicit scheme only.)
///
/// The equations are solved for the change of the pressures, and the flows are corrected by that change. So the
/// rounding error of a flow is relative to the flow, not to the pressures whose difference drives it. Pressures then
/// follow from the flows as in the explicit scheme, so mass is conserved to rounding. In a step of R times the explicit
/// limit, pressure differences between neighbours have a relative rounding error of R times 1e-16.
///
/// Below `solver_tolerance` the result depends on the factorisation in use. A checkpoint therefore stores the numbers
/// that were factorised.
///
/// Memory is allocated when a topology is analysed and when numbers are factorised, in no other step. The equations are
/// solved on one thread and in double precision, for float too: results are the same bits for any number of threads.
template <class Real, int Dim, aperture_law Aperture>
class implicit_flow_solver : public flow_base<Real, Dim, implicit_flow_parameters<Aperture>> {
    using base = flow_base<Real, Dim, implicit_flow_parameters<Aperture>>;

public:
    using parameters = implicit_flow_parameters<Aperture>;
    using network_type = pore_network<Real, Dim>;

    /// Rigid pores: a bare network, whose volumes and apertures stay constant.
    /// \throws std::invalid_argument for parameters out of range.
    implicit_flow_solver(parameters const& p, network_type network) : base(p, std::move(network)) { prepare(); }

    /// Pores of a packing in its present geometry. Initial apertures are those of pairs that touch without force (in
    /// space: of pairs without force at their present distance).
    /// \param thickness out of the plane, m; > 0; in space 1
    /// \param points centres of all particles, m; \param radii of all particles, m
    /// \throws std::invalid_argument for parameters out of range.
    implicit_flow_solver(parameters const& p, network_type network, Real thickness, points_view<Real, Dim> points,
                         Real const* radii)
        : base(p, std::move(network), thickness, points, radii) {
        prepare();
    }

    /// Continues from another network and ledger: an earlier state of the same mesh, or those of a new mesh (then call
    /// map_throats() again). Volumes, apertures and conductances are used unchanged.
    void restore(network_type network, flow_ledger<Real> const& ledger) {
        if (this->restore_state(std::move(network), ledger))
            mark_held();
        else
            prepare();
    }

    /// One step of dt [s]: new geometry and apertures, new pressures, and their forces (eq. 16). In a step of 0 s
    /// pressures follow the volumes, and nothing flows.
    /// \tparam WithLedger whether to update ledger()
    /// \param particles, normal_forces, tractions as in explicit_flow_solver::step()
    template <bool WithLedger>
    void step(particle_column<Real> const& particles, Real const* normal_forces, Real dt, int threads = 1,
              record_column<Real>* tractions = nullptr) {
        if (this->network_.bare()) {
            if (tractions) tractions->assign(tractions->size(), record<Real>(Real(0)));
            return advance<WithLedger>(dt, threads);
        }
        this->template begin_step<WithLedger>();
        bool const flowing = this->flows() && dt > Real(0);
        this->set_force_retention(false);
        if (flowing) {
            this->update_geometry(particles.data(), threads);
            this->template compute_flows<true>(particles.data(), normal_forces, threads);
            this->template take_substeps<WithLedger>(
                count_substeps(), dt, threads, [&](bool, Real part, Real share) { solve_flows(part, share); });
            this->apply_pressures(tractions, threads);
        } else {
            this->template advance_pressures<true, WithLedger>(particles.data(), dt, Real(1), false, threads,
                                                               tractions);
        }
        this->end_step(dt);
    }
    /// One step of dt [s] with constant volumes and apertures, without forces: the step of rigid pores.
    template <bool WithLedger = true>
    void advance(Real dt, int threads = 1) {
        this->template begin_step<WithLedger>();
        this->template take_substeps<WithLedger>(
            count_substeps(), dt, threads, [&](bool, Real part, Real share) { solve_flows(part, share); });
        this->end_step(dt);
    }

    /// Infinity, s: any step is stable.
    Real critical_time_step() const noexcept { return std::numeric_limits<Real>::infinity(); }

    /// Numbers of analyses of a topology, of factorisations, and of iterations, summed over all steps.
    pressure_system::counters const& solver_counters() const noexcept { return system_.done(); }
    /// Residual of the equations in the last step, as a pressure over the largest pressure in the network.
    double solver_residual() const noexcept { return left_; }

    template <class Archive>
    void serialize(Archive& ar) {
        base::serialize(ar);
        ar(system_, left_);
    }

private:
    int count_substeps() const noexcept { return std::max(this->parameters_.substeps, 1); }

    void prepare() {
        auto const& net = this->network_;
        system_.analyse(net.pores(), net.throat_pore, net.open_throats());
        pressure_.resize(net.pores());
        residual_.resize(net.pores());
        change_.resize(net.pores());
        flow_.resize(net.open_throats());
        mark_held();
    }
    void mark_held() {
        std::fill(system_.held().begin(), system_.held().end(), char(0));
        for (auto const& f : this->exchange_.pores())
            if (holds(f)) system_.held()[f.pore] = 1;
    }
    template <class Fed>
    bool holds(Fed const& f) const noexcept {
        return this->network_.sources[f.source].kind == flow_source_kind::pressure;
    }

    /// Writes the flows that belong to the pressures after dt [s] into the network.
    /// \param share share of the change from old_volume to volume that takes particles in this time
    void solve_flows(Real time_step, Real share) {
        auto& net = this->network_;
        double const dt = double(time_step);
        for (std::size_t i = 0; i < net.pores(); ++i) {
            double const old = double(net.old_volume[i]), volume = double(net.volume[i]);
            system_.content()[i] = (share < Real(1) ? old + (volume - old) * double(share) : volume) /
                                   this->parameters_.bulk_modulus;
            pressure_[i] = double(net.pressure[i]);
        }
        for (std::size_t t = 0; t < net.open_throats(); ++t)
            system_.leak()[t] = net.inactive[t] ? 0.0 : dt * double(net.conductance[t]);
        for (auto const& f : this->exchange_.pores())
            if (holds(f)) pressure_[f.pore] = net.sources[f.source].value;
        for (std::size_t t = 0; t < net.open_throats(); ++t)
            flow_[t] = net.inactive[t] ? 0.0 : double(net.conductance[t]) * (far_pressure(t) - pressure_[near(t)]);
        system_.prepare(this->parameters_.factorisation_tolerance);
        double const tolerance = this->parameters_.solver_tolerance;
        left_ = compute_residual(dt, double(share));
        for (int round = 0; round < 4 && !(left_ <= tolerance); ++round) {
            double const before = left_;
            // The last resort is a new factorisation.
            if (round == 3) system_.factorise();
            system_.solve(residual_, change_, 0.1 * tolerance * scale_);
            for (std::size_t i = 0; i < net.pores(); ++i) pressure_[i] += change_[i];
            for (std::size_t t = 0; t < net.open_throats(); ++t) {
                if (net.inactive[t]) continue;
                double const far = t < net.interior_throats ? change_[std::size_t(net.throat_pore[1][t])] : 0.0;
                flow_[t] += double(net.conductance[t]) * (far - change_[near(t)]);
            }
            left_ = compute_residual(dt, double(share));
            // Only rounding is left.
            if (round > 0 && left_ > 0.5 * before) break;
        }
        for (std::size_t t = 0; t < net.open_throats(); ++t) net.flow[t] = Real(flow_[t]);
    }

    /// Computes the residual of the equations for the present flows and pressures.
    /// \return its largest entry, as a pressure over the largest pressure in the network
    double compute_residual(double dt, double share) noexcept {
        auto const& net = this->network_;
        auto const& content = system_.content();
        scale_ = 0;
        for (std::size_t i = 0; i < net.pores(); ++i) {
            double const old = double(net.pressure[i]);
            double grown = double(net.volume[i]) - double(net.old_volume[i]);
            if (share < 1) grown *= share;
            residual_[i] = -grown - content[i] * (pressure_[i] - old);
            scale_ = std::max({scale_, std::fabs(old), std::fabs(pressure_[i])});
        }
        for (std::size_t t = 0; t < net.open_throats(); ++t) {
            residual_[near(t)] += flow_[t] * dt;
            if (t < net.interior_throats)
                residual_[std::size_t(net.throat_pore[1][t])] -= flow_[t] * dt;
            else
                scale_ = std::max(scale_, std::fabs(double(net.reservoir_pressure(t))));
        }
        for (auto const& f : this->exchange_.pores())
            if (!holds(f)) residual_[f.pore] += net.sources[f.source].value * f.share * dt;
        double most = 0;
        for (std::size_t i = 0; i < net.pores(); ++i) {
            if (system_.held()[i]) residual_[i] = 0;
            most = std::max(most, std::fabs(residual_[i]) / content[i]);
        }
        return most > 0 ? most / scale_ : 0;
    }

    std::size_t near(std::size_t throat) const noexcept { return std::size_t(this->network_.throat_pore[0][throat]); }
    double far_pressure(std::size_t throat) const noexcept {
        auto const& net = this->network_;
        return throat < net.interior_throats ? pressure_[std::size_t(net.throat_pore[1][throat])]
                                             : double(net.reservoir_pressure(throat));
    }

    pressure_system system_;
    std::vector<double> pressure_, residual_, change_, flow_;
    double left_ = 0, scale_ = 0;
};
LACUNA_END_PACKS

/// Flow policy: implicit_flow_solver with a chosen aperture law.
template <aperture_law Aperture>
struct implicit_flow_with {
    using parameters = implicit_flow_parameters<Aperture>;
    template <class Real, int Dim>
    using solver = implicit_flow_solver<Real, Dim, Aperture>;
};

/// Flow policy: backward Euler with the aperture from the contact force.
using implicit_flow = implicit_flow_with<contact_force_aperture>;

} // namespace lacuna
