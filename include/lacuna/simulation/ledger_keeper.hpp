// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include <lacuna/interactions/pair_loop.hpp>
#include <lacuna/motion/symplectic_euler.hpp>
#include <lacuna/observe/energy_ledger.hpp>
#include <lacuna/pores/flow/flow.hpp>

namespace lacuna {

/// Keeps the energy ledger of a run from what its parts report in each step.
template <class Real>
class ledger_keeper {
public:
    energy_ledger const& ledger() const noexcept { return ledger_; }

    /// The next step that is kept begins a new ledger.
    void close() noexcept { open_ = false; }

    /// Work done at once from outside, J: velocities given to particles.
    void book_work(double work) noexcept {
        if (!open_) return;
        ledger_.external += work;
        ledger_.prescribed += work;
        work_ahead_ += work;
        held_ahead_ += work;
    }

    /// Enters one step. Work is booked in halves: with the force before and the force after each displacement.
    /// \param pairs of bonds, contacts and walls
    /// \param fracture taken out by bonds that failed in this step in tension, in shear, J
    /// \param before, dt length of the step before and of this one, s
    /// \param flow nullptr without fluid
    /// \param wall_power of moving walls, with their velocities before and after, W
    /// \param complete whether all laws state their energies
    /// \param own_power of the model's own forces, the same, W
    template <class Flow>
    void keep(pair_energy const& pairs, std::array<double, 2> const& fracture,
              std::span<motion_report<Real> const> reports, double before, double dt, Flow const* flow,
              std::array<double, 2> const& wall_power = {}, std::array<double, 2> const& own_power = {},
              bool complete = true) {
        motion_report<Real> total;
        for (auto const& r : reports) {
            total.kinetic += r.kinetic;
            total.rotation += r.rotation;
            total.held_before += r.held_before;
            total.held_after += r.held_after;
            total.load_before += r.load_before;
            total.load_after += r.load_after;
            total.damping_before += r.damping_before;
            total.damping_after += r.damping_after;
        }
        total.held_before += wall_power[0];
        total.held_after += wall_power[1];
        total.load_before += wall_power[0] + own_power[0];
        total.load_after += wall_power[1] + own_power[1];
        bool const first = !open_;
        if (first) {
            ledger_ = {};
            work_ahead_ = held_ahead_ = damping_ahead_ = 0;
            open_ = true;
        }
        ledger_.complete = complete;
        ledger_.kinetic = total.kinetic;
        ledger_.rotation = total.rotation;
        ledger_.strain = pairs.stored;
        ledger_.bond_strain = pairs.in_bonds;
        if (flow) keep_fluid(*flow, first);
        if (first) {
            ledger_.initial = ledger_.kinetic + ledger_.strain + ledger_.fluid_storage;
        } else {
            ledger_.friction += pairs.dissipated;
            ledger_.damping += pairs.damped + damping_ahead_ - 0.5 * before * total.damping_before;
            ledger_.fracture += fracture[0] + fracture[1];
            ledger_.shear_fracture += fracture[1];
            ledger_.external = work_ahead_ + 0.5 * before * total.load_before;
            ledger_.prescribed = held_ahead_ + 0.5 * before * total.held_before;
        }
        work_ahead_ = ledger_.external + 0.5 * dt * total.load_after;
        held_ahead_ = ledger_.prescribed + 0.5 * dt * total.held_after;
        damping_ahead_ = -0.5 * dt * total.damping_after;
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(ledger_, fluid_start_, work_ahead_, held_ahead_, damping_ahead_, open_);
    }

private:
    template <class Flow>
    void keep_fluid(Flow const& flow, bool first) {
        auto const& now = flow.ledger();
        if (first) fluid_start_ = now;
        ledger_.fluid_storage = double(flow.storage_energy());
        ledger_.fluid_work = double(now.pressure_work - fluid_start_.pressure_work);
        ledger_.fluid_viscous = double(now.dissipation - fluid_start_.dissipation);
        ledger_.fluid_remesh = -double(now.remesh_energy - fluid_start_.remesh_energy);
        ledger_.fluid_outflow = -double(now.reservoir_work - fluid_start_.reservoir_work) -
                                double(now.vapour_work - fluid_start_.vapour_work) -
                                double(now.prefactor_work - fluid_start_.prefactor_work);
    }

    energy_ledger ledger_;
    flow_ledger<Real> fluid_start_;
    double work_ahead_ = 0, held_ahead_ = 0, damping_ahead_ = 0;
    bool open_ = false;
};

} // namespace lacuna
