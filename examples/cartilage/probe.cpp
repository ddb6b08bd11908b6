// SPDX-License-Identifier: BSD-3-Clause
#include "probe.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "aftermath.hpp"
#include "cartilage_model.hpp"
#include "ending.hpp"
#include "simulate.hpp"

namespace cartilage {

namespace {

constexpr double largest_residual = 0.01; // of the ledger's largest term
constexpr double largest_jump = 0.1;      // of the kinetic energy in one step, over the ledger's largest term
constexpr long long settled = 100;        // steps: from rest, every term of the first ones is a jump
constexpr long long between_looks = 16;   // steps

/// Counts the damage of fibres and layers as it comes.
class damage_count {
public:
    explicit damage_count(specimen const& s) : cut_(s.fibres.size(), 0), layer_of_(s.fibres.size()) {
        std::map<std::pair<int, int>, study_layer> by_place;
        for (auto const& fibre : s.fibres) {
            study_layer& layer = by_place[{int(fibre.zone), fibre.layer}];
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
    void add(study_crack const& crack) {
        if (crack.fibre < 0) return;
        ++broken_;
        cut_count_ += cut_[std::size_t(crack.fibre)] == 0;
        cut_[std::size_t(crack.fibre)] = 1;
        study_layer& layer = layers_[layer_of_[std::size_t(crack.fibre)]];
        ++layer.broken;
        if (!layer.half_broken_time && 2 * layer.broken >= layer.bonds) layer.half_broken_time = crack.time;
        if (!first_crack_time) first_crack_time = crack.time;
        if (!complete_time && 10 * cut_count_ >= 9 * cut_.size()) complete_time = crack.time;
    }

    std::vector<study_layer> const& layers() const { return layers_; }
    /// In every zone the first layer is first among the layers of the zone nearest to the surface.
    study_layer const* first_layer() const { return layers_.empty() ? nullptr : &layers_.front(); }
    double broken_fraction() const { return bonds_ == 0 ? 0.0 : double(broken_) / double(bonds_); }
    double cut_fraction() const { return cut_.empty() ? 0.0 : double(cut_count_) / double(cut_.size()); }

    std::optional<double> first_crack_time, complete_time;

private:
    std::vector<char> cut_;
    std::size_t cut_count_ = 0;
    std::vector<std::size_t> layer_of_;
    std::vector<study_layer> layers_;
    int bonds_ = 0, broken_ = 0;
};

/// Follows a run: its damage, its guards, and whether the answer that is sought is certain.
class probe_watch {
public:
    static constexpr lacuna::stage stages = lacuna::stage::step | lacuna::stage::breakage;
    static constexpr bool needs_energy = true;

    probe_watch(specimen const& s, options const& o) : specimen_(s), ending_(o), damage_(s) {}

    void seek(question q) { sought_ = q; }

    template <class Event, class Simulation>
    void on_break(Event const& event, Simulation const&) {
        crack_record const c = crack_of(specimen_, event);
        result_.cracks.push_back({c.time, c.position[0], c.position[1], c.shear, c.fibre});
        damage_.add(result_.cracks.back());
    }

    template <class Simulation>
    lacuna::run_control on_step(Simulation const& sim) {
        if (stop_is_requested()) throw interruption();
        auto const& energy = sim.energy();
        double const last_break = result_.cracks.empty() ? 0.0 : result_.cracks.back().time;
        if (ending_.is_quiet(energy.kinetic, sim.time(), last_break))
            result_.ended = "quiet";
        else if (ending_.is_over(sim.time()))
            result_.ended = ending_.at_longest();
        else if (is_answered())
            result_.ended = name_of(sought_);
        bool const ends = !result_.ended.empty();
        if (ends || sim.steps() % between_looks == 0) look(sim);
        bool const jumps = sim.steps() > settled &&
                           std::fabs(energy.kinetic - kinetic_) > largest_jump * energy.largest();
        kinetic_ = energy.kinetic;
        if (jumps) result_.invalid = "kinetic energy jumps at " + lacuna::to_text(sim.time()) + " s";
        return ends || result_.invalid ? lacuna::run_control::stop : lacuna::run_control::go_on;
    }

    ending const& rule() const { return ending_; }
    bool is_answered() const {
        switch (sought_) {
        case question::first_crack: return damage_.first_crack_time.has_value();
        case question::capacity: return damage_.first_layer() && damage_.first_layer()->half_broken_time;
        case question::complete: return damage_.complete_time.has_value();
        default: return false;
        }
    }

    probe& result() { return result_; }
    /// The damage as it stands.
    void settle(double time) {
        result_.end_time = time;
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

private:
    template <class Simulation>
    void look(Simulation const& sim) {
        if constexpr (requires { sim.flow().network(); })
            for (double const p : sim.flow().network().pressure)
                result_.peak_pore_pressure = std::max(result_.peak_pore_pressure, p);
        auto const& energy = sim.energy();
        double const largest = energy.largest();
        result_.energy_residual_fraction = largest > 0 ? energy.residual() / largest : 0.0;
        if (std::fabs(result_.energy_residual_fraction) > largest_residual && !result_.invalid)
            result_.invalid = "energy ledger opens by " + lacuna::to_text(result_.energy_residual_fraction) +
                              " of its largest term at " + lacuna::to_text(sim.time()) + " s";
    }

    specimen const& specimen_;
    ending ending_;
    damage_count damage_;
    question sought_ = question::end;
    probe result_;
    double kinetic_ = 0;
};

template <class Model>
class model_run final : public probe_run {
public:
    model_run(specimen const& s, options const& o)
        : sim_(s.discs, model_parameters<Model>(s, o.specimen().contact_tolerance)), watch_(s, o) {
        set_up(sim_, s, o.load_MPa * 1e6);
        double const steps = std::ceil(watch_.rule().longest() / sim_.time_step() * (1 - 1e-12));
        if (!(steps < 1e15)) throw usage_error("duration: too many steps");
        steps_ = std::max(1LL, static_cast<long long>(steps));
        watch_.result().load_MPa = o.load_MPa;
    }

    probe ask(question q) override {
        probe& result = watch_.result();
        if (result.invalid || result.whole() || (asked_ && *asked_ >= q)) return result;
        asked_ = q;
        watch_.seek(q);
        result.ended.clear();
        try {
            // With the same last step in mind each time it is the same run, bit for bit, as one without a halt.
            if (!watch_.is_answered()) sim_.run(steps_ - sim_.steps(), watch_);
        } catch (lacuna::unstable_run const& unstable) {
            result.invalid = unstable.what();
        }
        if (result.invalid)
            result.ended = "invalid";
        else if (result.ended.empty())
            result.ended = watch_.is_answered() ? name_of(q) : watch_.rule().at_longest();
        watch_.settle(sim_.time());
        return result;
    }

private:
    lacuna::simulation<Model> sim_;
    probe_watch watch_;
    std::optional<question> asked_;
    long long steps_ = 0;
};

} // namespace

char const* name_of(question q) {
    switch (q) {
    case question::first_crack: return "first_crack";
    case question::capacity: return "capacity";
    case question::complete: return "complete";
    default: return "end";
    }
}

bool answers(probe const& p, question q) {
    if (p.invalid) return false;
    switch (q) {
    case question::first_crack: return p.first_crack_time.has_value();
    case question::capacity: return p.capacity_time.has_value();
    case question::complete: return p.complete_time.has_value();
    default: return p.whole();
    }
}

std::unique_ptr<probe_run> start_probe(specimen const& s, options const& o) {
    if (o.dry) return std::make_unique<model_run<dry_model>>(s, o);
    return std::make_unique<model_run<wet_model>>(s, o);
}

} // namespace cartilage
