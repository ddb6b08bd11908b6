// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include <lacuna/interactions/pair_loop.hpp>
#include <lacuna/motion/symplectic_euler.hpp>
#include <lacuna/observe/energy_ledger.hpp>
#include <lacuna/pores/flow/flow.hpp>

namespace lacuna {

/// Updates the energy ledger of a run from the energies that its parts report in each step.
template <class Real>
class ledger_keeper {
public:
    energy_ledger const& ledger() const noexcept { return ledger_; }

    /// Ends the ledger: the next keep() begins a new one.
    void close() noexcept { started_ = false; }

    /// Adds external work done between two steps, J: velocities given to particles.
    void book_work(double work) noexcept {
        if (!started_) return;
        ledger_.external += work;
        ledger_.prescribed += work;
        work_ahead_ += work;
        held_ahead_ += work;
    }

    /// Adds one step. Work counts in halves: with the force before and the force after each displacement.
    /// \param pairs energies of bonds, contacts and walls
    /// \param fracture energy taken out by bonds that failed in this step: in tension, then in shear, J
    /// \param before, dt lengths of the last step and of this one, s
    /// \param flow nullptr without fluid
    /// \param wall_power power of moving walls, with their velocities before and after the step, W
    /// \param own_power power of the model's own forces, with velocities before and after the step, W
    /// \param complete whether all laws state their energies
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
        bool const first = !started_;
        if (first) {
            ledger_ = {};
            work_ahead_ = held_ahead_ = damping_ahead_ = 0;
            started_ = true;
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
        ar(ledger_, fluid_start_, work_ahead_, held_ahead_, damping_ahead_, started_);
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
    // First half of the next step's work, J; work_ahead_ and held_ahead_ include the totals of the ledger.
    double work_ahead_ = 0, held_ahead_ = 0, damping_ahead_ = 0;
    bool started_ = false;
};

} // namespace lacuna
