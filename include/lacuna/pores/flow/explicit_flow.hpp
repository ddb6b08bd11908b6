// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/laws/aperture.hpp>
#include <lacuna/pores/flow/flow.hpp>
#include <lacuna/pores/flow/flow_base.hpp>
#include <lacuna/pores/flow/flow_parameters.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// The paper's explicit scheme, eq. 14 to 16: first all flows from the old pressures, then all pressures.
///
/// A pore's pressure never falls below `minimum_pressure`. The volume that the liquid does not fill is stored as
/// vapour. It must close before the pressure rises again, so mass is conserved.
///
/// Memory is allocated in the first step of a network, and in the first step with another number of threads. Results
/// are the same bits for any number of threads.
template <class Real, int Dim, aperture_law Aperture>
class explicit_flow_solver : public flow_base<Real, Dim, flow_parameters<Aperture>> {
    using base = flow_base<Real, Dim, flow_parameters<Aperture>>;

public:
    using parameters = flow_parameters<Aperture>;
    using network_type = pore_network<Real, Dim>;
    /// Largest number of substeps for `substeps` = 0. Use implicit_flow for a run that needs more.
    static constexpr int most_substeps = 100000;

    /// Rigid pores: a bare network, whose volumes and apertures stay constant.
    /// \throws std::invalid_argument for parameters out of range.
    explicit_flow_solver(parameters const& p, network_type network) : base(p, std::move(network)) {}

    /// Pores of a packing in its present geometry. Initial apertures are those of pairs that touch without force (in
    /// space: of pairs without force at their present distance).
    /// \param thickness out of the plane, m; > 0; in space 1
    /// \param points centres of all particles, m; \param radii of all particles, m
    /// \throws std::invalid_argument for parameters out of range.
    explicit_flow_solver(parameters const& p, network_type network, Real thickness, points_view<Real, Dim> points,
                         Real const* radii)
        : base(p, std::move(network), thickness, points, radii) {}

    /// Continues from another network and ledger: an earlier state of the same mesh, or those of a new mesh (then call
    /// map_throats() again). Volumes, apertures and conductances are used unchanged.
    void restore(network_type network, flow_ledger<Real> const& ledger) {
        this->restore_state(std::move(network), ledger);
    }

    /// One step of dt [s]: new geometry and apertures, flows of all active throats from the old pressures (eq. 14), new
    /// pressures of all pores (eq. 15), and the forces of the new pressures (eq. 16). In a step of 0 s pressures follow
    /// the volumes, and nothing flows.
    /// \tparam WithLedger whether to update ledger()
    /// \param particles records of all particles, as in particle_store
    /// \param normal_forces of the pairs, N, positive in tension; the first is 0
    /// \param tractions receives the force of the pores on every particle, N: the record {F_x, F_y, 0, 0}, in space
    ///        {F_x, F_y, F_z, 0} and a record of zeros. May be nullptr.
    /// \throws std::invalid_argument if `substeps` = 0 and the step needs more than most_substeps
    template <bool WithLedger>
    void step(particle_column<Real> const& particles, Real const* normal_forces, Real dt, int threads = 1,
              record_column<Real>* tractions = nullptr) {
        if (this->network_.bare()) {
            if (tractions) tractions->assign(tractions->size(), record<Real>(Real(0)));
            return advance<WithLedger>(dt, threads);
        }
        this->template begin_step<WithLedger>();
        bool const flowing = this->flows() && dt > Real(0);
        bool const at_once = this->parameters_.substeps == 1;
        bool const transient = at_once && this->can_stream(threads);
        this->set_force_retention(transient);
        if (transient && !WithLedger) {
            this->fused_step(particles.data(), normal_forces, dt, flowing, tractions);
        } else if (at_once || !flowing) {
            if (flowing) this->template compute_flows<true>(particles.data(), normal_forces, threads);
            this->template advance_pressures<true, WithLedger>(particles.data(), dt, Real(1), flowing, threads,
                                                               tractions);
        } else {
            this->update_geometry(particles.data(), threads);
            this->template compute_flows<true>(particles.data(), normal_forces, threads);
            this->template take_substeps<WithLedger>(count_substeps(dt), dt, threads, [&](bool first, Real, Real) {
                if (!first) this->template compute_flows<false>(nullptr, nullptr, threads);
            });
            this->apply_pressures(tractions, threads);
        }
        this->end_step(dt);
    }
    /// One step of dt [s] with constant volumes and apertures, without forces: the step of rigid pores.
    template <bool WithLedger = true>
    void advance(Real dt, int threads = 1) {
        this->template begin_step<WithLedger>();
        this->template take_substeps<WithLedger>(count_substeps(dt), dt, threads, [&](bool, Real, Real) {
            this->template compute_flows<false>(nullptr, nullptr, threads);
        });
        this->end_step(dt);
    }

    /// Largest safe dt of a step, s: flow_critical_time_step(), or the limit of the clusters of pores, times the number
    /// of substeps. Infinite for `substeps` = 0, which takes as many as are safe.
    Real critical_time_step() const noexcept {
        int const count = this->parameters_.substeps;
        return count > 0 ? Real(count) * this->substep_limit() : std::numeric_limits<Real>::infinity();
    }
private:
    int count_substeps(Real dt) const {
        if (this->parameters_.substeps > 0) return this->parameters_.substeps;
        // The limit uses the volumes after the step; 1 % covers their change during the step.
        double const count = std::ceil(1.01 * double(dt) / double(this->substep_limit()));
        if (!(count <= most_substeps))
            refuse("time_step", to_text(double(dt)) + " s",
                   "at most " + to_text(most_substeps * double(this->substep_limit()) / 1.01) +
                       " s here: a longer one needs more than " + std::to_string(most_substeps) +
                       " substeps of explicit flow; implicit flow needs one");
        return count > 1 ? int(count) : 1;
    }
};
LACUNA_END_PACKS

/// Flow policy: explicit_flow_solver with a chosen aperture law.
template <aperture_law Aperture>
struct explicit_flow_with {
    using parameters = flow_parameters<Aperture>;
    template <class Real, int Dim>
    using solver = explicit_flow_solver<Real, Dim, Aperture>;
};

/// Flow policy: the paper's explicit scheme with the aperture from the contact force.
using explicit_flow = explicit_flow_with<contact_force_aperture>;

} // namespace lacuna
