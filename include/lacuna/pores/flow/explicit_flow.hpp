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
/// The paper's explicit scheme, eq. 14 to 16: all flows from the old pressures, then all pressures.
///
/// A pore's pressure below `minimum_pressure` is held there; the volume that the liquid does not fill is remembered
/// as vapour, which closes before the pressure rises again, so that no mass is made.
///
/// Memory is allocated in the first step of a network, and the first on another number of threads. The same bits for any
/// number of threads.
template <class Real, int Dim, aperture_law Aperture>
class explicit_flow_solver : public flow_base<Real, Dim, flow_parameters<Aperture>> {
    using base = flow_base<Real, Dim, flow_parameters<Aperture>>;

public:
    using parameters = flow_parameters<Aperture>;
    using network_type = pore_network<Real, Dim>;
    /// What `substeps` = 0 takes at most; a run that needs more wants implicit_flow.
    static constexpr int most_substeps = 100000;

    /// Rigid pores: a bare network, whose volumes and apertures stay as given.
    /// \throws std::invalid_argument for parameters out of range.
    explicit_flow_solver(parameters const& p, network_type network) : base(p, std::move(network)) {}

    /// Pores of a body, at its present geometry and the apertures of pairs at zero force that touch (in space: pairs at
    /// zero force where they are).
    /// \param thickness of the body, out of the plane, m; > 0; in space 1
    /// \param points centres, m; \param radii m: of all particles
    /// \throws std::invalid_argument for parameters out of range.
    explicit_flow_solver(parameters const& p, network_type network, Real thickness, points_view<Real, Dim> points,
                         Real const* radii)
        : base(p, std::move(network), thickness, points, radii) {}

    /// Goes on from another network and ledger: earlier ones of the same body, or those of a new mesh (then
    /// map_throats() anew). Volumes, apertures and conductances are taken as they are.
    void restore(network_type network, flow_ledger<Real> const& ledger) {
        this->restore_state(std::move(network), ledger);
    }

    /// One step of dt [s] of a body: new geometry and apertures, eq. 14 for all throats that are not skipped from the
    /// old pressures, eq. 15 for all pores, eq. 16's forces from the new pressures. Within a step of 0 s pressures
    /// follow the volumes, and nothing flows.
    /// \tparam WithLedger also keeps ledger()
    /// \param tractions gets what the pores exert on every particle: the record {F_x, F_y, 0, 0}, in space {F_x, F_y,
    ///        F_z, 0} and a record of zeros, N; nullptr: nobody wants it
    /// \throws std::invalid_argument when `substeps` = 0 and the step takes more than most_substeps
    template <bool WithLedger>
    void step(body_column<Real> const& place, Real const* normal_forces, Real dt, int threads = 1,
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
            this->fused_step(place.data(), normal_forces, dt, flowing, tractions);
        } else if (at_once || !flowing) {
            if (flowing) this->template compute_flows<true>(place.data(), normal_forces, threads);
            this->template advance_pressures<true, WithLedger>(place.data(), dt, Real(1), flowing, threads, tractions);
        } else {
            this->update_geometry(place.data(), threads);
            this->template compute_flows<true>(place.data(), normal_forces, threads);
            this->template take_substeps<WithLedger>(count_substeps(dt), dt, threads, [&](bool first, Real, Real) {
                if (!first) this->template compute_flows<false>(nullptr, nullptr, threads);
            });
            this->apply_pressures(tractions, threads);
        }
        this->end_step(dt);
    }
    /// The same with volumes and apertures as they are, and without forces: the step of rigid pores.
    template <bool WithLedger = true>
    void advance(Real dt, int threads = 1) {
        this->template begin_step<WithLedger>();
        this->template take_substeps<WithLedger>(count_substeps(dt), dt, threads, [&](bool, Real, Real) {
            this->template compute_flows<false>(nullptr, nullptr, threads);
        });
        this->end_step(dt);
    }

    /// Largest safe dt of a step, s, as pores/flow/flow_time_step.hpp has it, times the substeps: skipped throats do not
    /// count. Infinite where substeps are as many as are safe.
    Real critical_time_step() const noexcept {
        int const count = this->parameters_.substeps;
        return count > 0 ? Real(count) * this->substep_limit() : std::numeric_limits<Real>::infinity();
    }
private:
    int count_substeps(Real dt) const {
        if (this->parameters_.substeps > 0) return this->parameters_.substeps;
        // The limit is that of the volumes after the step; 1 % covers their change within it.
        double const count = std::ceil(1.01 * double(dt) / double(this->substep_limit()));
        if (!(count <= most_substeps))
            refuse("time_step", to_text(double(dt)) + " s",
                   "at most " + to_text(most_substeps * double(this->substep_limit()) / 1.01) + " s here: more takes more than " +
                       std::to_string(most_substeps) + " explicit steps of the fluid in one; implicit flow takes one");
        return count > 1 ? int(count) : 1;
    }
};
LACUNA_END_PACKS

/// Flow policy: explicit_flow_solver with an aperture law of one's choice.
template <aperture_law Aperture>
struct explicit_flow_with {
    using parameters = flow_parameters<Aperture>;
    template <class Real, int Dim>
    using solver = explicit_flow_solver<Real, Dim, Aperture>;
};

/// Flow policy: the paper's explicit scheme with the aperture from the contact force.
using explicit_flow = explicit_flow_with<contact_force_aperture>;

} // namespace lacuna
