// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/energy_ledger.hpp>
#include <lacuna/observe/observer.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "cartilage/common/interruption.hpp"
#include "cartilage/run/criterion.hpp"
#include "cartilage/run/ending.hpp"
#include "cartilage/run/load_run.hpp"
#include "cartilage/run/results.hpp"

namespace cartilage {

inline constexpr double largest_opening = 0.01; // of the ledger, over its largest term
inline constexpr double largest_jump = 0.1;     // of the kinetic energy in one step, over the ledger's largest term
inline constexpr long long settled = 100;       // steps: from rest, every term of the first ones is a jump
inline constexpr long long between_looks = 16;  // steps

/// The energy ledger of a run, kept in samples: to keep it in every step would cost a third of the run's time. A sample
/// is a row of steps in which the ledger is kept; what it opens by stands for all steps until the next one.
class ledger_samples {
public:
    static constexpr long long period = 256, length = 32;
    static constexpr bool has(long long step) { return step < period || step % period < length; }

    /// The ledger after a step that has() one.
    void add(lacuna::energy_ledger const& ledger, long long step) {
        largest_ = std::max(largest_, ledger.largest());
        jump_ = !begins(step) && step > settled ? std::fabs(ledger.kinetic - kinetic_) : 0;
        kinetic_ = ledger.kinetic;
        here_ = ledger.residual() * (step <= period + length ? 1 : double(period) / length);
        if (has(step + 1)) return;
        before_ += here_;
        here_ = 0;
    }
    /// By how much the ledger has opened so far, over its largest term; with its sign.
    double opening() const { return largest_ > 0 ? (before_ + here_) / largest_ : 0; }
    /// By how much the kinetic energy changed in the last step, the same way.
    double jump() const { return largest_ > 0 ? jump_ / largest_ : 0; }

private:
    static bool begins(long long step) { return step == 0 || !has(step - 1); }

    double largest_ = 0, kinetic_ = 0, jump_ = 0;
    double before_ = 0, here_ = 0; // J: by earlier samples, by this one
};

/// Counts the damage of fibres and layers as it comes.
class damage_count {
public:
    explicit damage_count(specimen const& s) : cut_(s.fibres.size(), 0), layer_of_(s.fibres.size()) {
        std::map<std::pair<int, int>, load_run::layer_damage> by_place;
        for (auto const& fibre : s.fibres) {
            load_run::layer_damage& layer = by_place[{int(fibre.zone), fibre.layer}];
            layer.zone = lacuna::to_string(fibre.zone);
            layer.layer = fibre.layer;
            layer.bonds += int(fibre.bonds.size());
            bonds_ += int(fibre.bonds.size());
        }
        for (std::size_t f = 0; f < s.fibres.size(); ++f) {
            auto const place = by_place.find({int(s.fibres[f].zone), s.fibres[f].layer});
            layer_of_[f] = std::size_t(std::distance(by_place.begin(), place));
        }
        for (auto const& [place, layer] : by_place) layers_.push_back(layer);
    }

    /// Bonds beside those of fibres are not part of the damage.
    void add(load_run::crack const& crack) {
        if (crack.fibre < 0) return;
        ++broken_;
        cut_count_ += cut_[std::size_t(crack.fibre)] == 0;
        cut_[std::size_t(crack.fibre)] = 1;
        load_run::layer_damage& layer = layers_[layer_of_[std::size_t(crack.fibre)]];
        ++layer.broken;
        if (!layer.half_broken_time && 2 * layer.broken >= layer.bonds) layer.half_broken_time = crack.time;
        if (!first_crack_time) first_crack_time = crack.time;
        if (!complete_time && 10 * cut_count_ >= 9 * cut_.size()) complete_time = crack.time;
    }

    std::vector<load_run::layer_damage> const& layers() const { return layers_; }
    /// In every zone the first layer is first among the layers of the zone nearest to the surface.
    load_run::layer_damage const* first_layer() const { return layers_.empty() ? nullptr : &layers_.front(); }
    double broken_fraction() const { return bonds_ == 0 ? 0.0 : double(broken_) / double(bonds_); }
    double cut_fraction() const { return cut_.empty() ? 0.0 : double(cut_count_) / double(cut_.size()); }

    std::optional<double> first_crack_time, complete_time;

private:
    std::vector<char> cut_;
    std::size_t cut_count_ = 0;
    std::vector<std::size_t> layer_of_;
    std::vector<load_run::layer_damage> layers_;
    int bonds_ = 0, broken_ = 0;
};

/// Follows a run at one load: its damage, its guards (the energy, and what the library throws), and whether the criterion
/// is met.
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

    /// Runs until the criterion is met or the run is over, with further observers beside. \throws interruption
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
        settle(sim.time());
        return result_;
    }

    template <class Event, class Simulation>
    void on_break(Event const& event, Simulation const&) {
        crack_record const c = crack_of(specimen_, event);
        result_.cracks.push_back({c.time, c.position[0] - specimen_.left, c.position[1], c.shear, c.fibre});
        damage_.add(result_.cracks.back());
        broke_ = true;
    }

    template <class Simulation>
    lacuna::run_control on_step(Simulation const& sim) {
        if (lacuna::stop_signal() != 0) throw interruption();
        // With every break, whether the run halts there or not: it must not leave a trace in the result.
        if (broke_ || sim.steps() % between_looks == 0) look_at_pores(sim);
        broke_ = false;
        double const time = sim.time();
        bool quiet = false;
        if (long long const step = sim.steps() - 1; ledger_samples::has(step)) {
            energy_.add(sim.energy(), step);
            double const last_break = result_.cracks.empty() ? 0.0 : result_.cracks.back().time;
            quiet = ending_.is_quiet(sim.energy().kinetic, time, last_break);
            if (energy_.jump() > largest_jump)
                result_.invalid = "kinetic energy jumps at " + lacuna::to_text(time) + " s";
            else if (std::fabs(energy_.opening()) > largest_opening)
                result_.invalid = "energy ledger opens by " + lacuna::to_text(energy_.opening()) +
                                  " of its largest term until " + lacuna::to_text(time) + " s";
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
        case criterion::first_crack: return damage_.first_crack_time.has_value();
        case criterion::capacity: return damage_.first_layer() && damage_.first_layer()->half_broken_time;
        case criterion::complete: return damage_.complete_time.has_value();
        default: return false;
        }
    }

    /// The damage as it stands.
    void settle(double time) {
        result_.end_time = time;
        result_.energy_residual_fraction = energy_.opening();
        result_.first_crack_time = damage_.first_crack_time;
        result_.complete_time = damage_.complete_time;
        result_.broken_fraction = damage_.broken_fraction();
        result_.cut_fraction = damage_.cut_fraction();
        result_.layers = damage_.layers();
        if (auto const* first = damage_.first_layer()) {
            result_.capacity_time = first->half_broken_time;
            result_.first_layer_fraction = first->bonds == 0 ? 0.0 : double(first->broken) / double(first->bonds);
        }
    }
    template <class Simulation>
    void look_at_pores([[maybe_unused]] Simulation const& sim) {
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
    bool broke_ = false;
};

} // namespace cartilage
