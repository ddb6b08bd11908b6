// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/energy_ledger.hpp>
#include <lacuna/observe/observer.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "cartilage/common/interruption.hpp"
#include "cartilage/run/criterion.hpp"
#include "cartilage/run/damage_count.hpp"
#include "cartilage/run/ending.hpp"
#include "cartilage/run/load_run.hpp"
#include "cartilage/run/results.hpp"

namespace cartilage {

inline constexpr double largest_residual = 0.01;     // of the ledger, over its largest term
inline constexpr double largest_jump = 0.1;          // of the kinetic energy, over the ledger's largest term
inline constexpr long long first_checked_step = 100; // earlier steps start from rest, so that every change is a jump
inline constexpr long long pore_check_interval = 16; // steps

/// The energy ledger of a run in samples, because a ledger in every step would cost a third of the run's time. A sample
/// is a number of consecutive steps with a ledger. Its residual is scaled to all steps up to the next sample.
class ledger_samples {
public:
    static constexpr long long period = 256, length = 32;
    static constexpr bool has(long long step) { return step < period || step % period < length; }

    /// Adds the ledger after a step for which has() is true.
    void add(lacuna::energy_ledger const& ledger, long long step) {
        largest_ = std::max(largest_, ledger.largest());
        jump_ = !begins(step) && step > first_checked_step ? std::fabs(ledger.kinetic - kinetic_) : 0;
        kinetic_ = ledger.kinetic;
        sample_residual_ = ledger.residual() * (step <= period + length ? 1 : double(period) / length);
        if (has(step + 1)) return;
        earlier_residual_ += sample_residual_;
        sample_residual_ = 0;
    }
    /// Signed residual of the ledger so far, over its largest term.
    double residual() const { return largest_ > 0 ? (earlier_residual_ + sample_residual_) / largest_ : 0; }
    /// Change of the kinetic energy in the last step, over the largest term of the ledger.
    double jump() const { return largest_ > 0 ? jump_ / largest_ : 0; }

private:
    static bool begins(long long step) { return step == 0 || !has(step - 1); }

    double largest_ = 0, kinetic_ = 0, jump_ = 0;
    double earlier_residual_ = 0, sample_residual_ = 0; // J
};

/// Follows a run at one load. It counts the damage, decides whether the criterion is met, and marks the run as invalid
/// if its energy ledger or kinetic energy are wrong or the library stops it as unstable.
class load_run_watch {
public:
    static constexpr lacuna::stage stages = lacuna::stage::step | lacuna::stage::breakage;
    bool needs_energy_in(long long step) const { return ledger_samples::has(step); }

    /// \param s has to outlive this
    load_run_watch(specimen const& s, options const& o) : specimen_(s), ending_(o), damage_(s) {
        result_.load_MPa = o.load_MPa;
    }

    ending const& rule() const { return ending_; }
    load_run const& result() const { return result_; }

    /// Runs until the criterion is met or the run is over, with further observers. \throws interruption
    template <class Simulation, class... Observers>
    load_run const& follow(criterion c, Simulation& sim, long long steps, Observers&... others) {
        criterion_ = c;
        result_.ended.clear();
        try {
            if (!is_met()) sim.run(steps, *this, others...);
        } catch (lacuna::unstable_run const& unstable) {
            result_.invalid = unstable.what();
        }
        if (result_.invalid)
            result_.ended = "invalid";
        else if (result_.ended.empty())
            result_.ended = is_met() ? name_of(c) : ending_.at_longest();
        update_result(sim.time());
        return result_;
    }

    template <class Event, class Simulation>
    void on_break(Event const& event, Simulation const&) {
        crack_record const c = crack_of(specimen_, event);
        result_.cracks.push_back({c.time, c.position[0] - specimen_.left, c.position[1], c.shear, c.fibre});
        damage_.add(c.fibre, c.time);
        broke_ = true;
    }

    template <class Simulation>
    lacuna::run_control on_step(Simulation const& sim) {
        if (lacuna::stop_signal() != 0) throw interruption();
        // At every break, even if the run does not stop there: the result must not depend on where it stops.
        if (broke_ || sim.steps() % pore_check_interval == 0) update_peak_pressure(sim);
        broke_ = false;
        double const time = sim.time();
        bool quiet = false;
        if (long long const step = sim.steps() - 1; ledger_samples::has(step)) {
            energy_.add(sim.energy(), step);
            double const last_break = result_.cracks.empty() ? 0.0 : result_.cracks.back().time;
            quiet = ending_.is_quiet(sim.energy().kinetic, time, last_break);
            if (energy_.jump() > largest_jump)
                result_.invalid = "kinetic energy jumps at " + lacuna::to_text(time) + " s";
            else if (std::fabs(energy_.residual()) > largest_residual)
                result_.invalid = "energy ledger is open by " + lacuna::to_text(energy_.residual()) +
                                  " of its largest term at " + lacuna::to_text(time) + " s";
        }
        if (quiet)
            result_.ended = "quiet";
        else if (ending_.is_over(time))
            result_.ended = ending_.at_longest();
        else if (is_met())
            result_.ended = name_of(criterion_);
        return result_.ended.empty() && !result_.invalid ? lacuna::run_control::go_on : lacuna::run_control::stop;
    }

private:
    bool is_met() const {
        switch (criterion_) {
        case criterion::first_crack: return damage_.first_crack.has_value();
        case criterion::capacity: return damage_.first_layer() && damage_.first_layer()->half_broken_time;
        case criterion::complete: return damage_.complete.has_value();
        default: return false;
        }
    }

    /// Copies the present damage to the result.
    void update_result(double time) {
        result_.end_time = time;
        result_.energy_residual_fraction = energy_.residual();
        result_.first_crack_time = damage_.first_crack;
        result_.complete_time = damage_.complete;
        result_.broken_fraction = damage_.broken_fraction();
        result_.cut_fraction = damage_.cut_fraction();
        result_.layers = damage_.layers();
        if (auto const* first = damage_.first_layer()) {
            result_.capacity_time = first->half_broken_time;
            result_.first_layer_fraction = first->bonds == 0 ? 0.0 : double(first->broken) / double(first->bonds);
        }
    }
    template <class Simulation>
    void update_peak_pressure([[maybe_unused]] Simulation const& sim) {
        if constexpr (requires { sim.flow().network(); })
            for (double const p : sim.flow().network().pressure)
                result_.peak_pore_pressure = std::max(result_.peak_pore_pressure, p);
    }

    specimen const& specimen_;
    ending ending_;
    damage_count damage_;
    criterion criterion_ = criterion::end;
    load_run result_;
    ledger_samples energy_;
    bool broke_ = false; // a bond broke in this step
};

} // namespace cartilage
