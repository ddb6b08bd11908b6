// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/snapshots.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "cartilage/run/cartilage_model.hpp"
#include "cartilage/run/load_run_watch.hpp"
#include "cartilage/run/run_scene.hpp"

namespace cartilage {

namespace {

constexpr double layer_thickness = 10e-6; // m, about three particles
constexpr double fine_interval = 0.05e-9; // s, between profiles while the first waves pass
constexpr double fine_until = 2e-9;       // s
constexpr double coarse_ratio = 1.25;     // of the times of later profiles

/// Means over horizontal layers of the unloaded specimen.
class layer_means {
public:
    explicit layer_means(specimen const& s)
        : top_(s.height), count_(std::max(1, int(std::lround(s.height / layer_thickness)))),
          thickness_(s.height / count_), volume_(s.length * thickness_ * s.thickness) {}

    template <class Simulation>
    front_profile of(Simulation const& sim, std::size_t broken) const {
        front_profile f;
        f.time = sim.time();
        f.broken = broken;
        for (int k = 0; k < count_; ++k) f.depth.push_back((k + 0.5) * thickness_);
        f.stress.assign(std::size_t(count_), 0.0);
        add_stress(sim, sim.pairs().bonds(), f.stress);
        add_stress(sim, sim.pairs().contacts(), f.stress);
        if constexpr (requires { sim.flow().network(); }) f.pore_pressure = pressures(sim);
        return f;
    }

private:
    int layer_at(double y) const { return std::clamp(int(std::floor((top_ - y) / thickness_)), 0, count_ - 1); }

    /// Adds the mean vertical stress of each layer, Pa: the sum of force times branch vector over the layer's volume. A
    /// branch that crosses several layers counts in each with its part inside.
    template <class Simulation, class Law, class Real>
    void add_stress(Simulation const& sim, lacuna::pair_table<Law, Real, 2> const& pairs,
                    std::vector<double>& stress) const {
        auto const& store = sim.particles();
        for (std::size_t slot = 0; slot < pairs.slots(); ++slot) {
            if (pairs.is_padding(slot, store.size())) continue;
            auto const offset = sim.pairs().find_force(pairs.i(slot), pairs.j(slot));
            if (offset < 0) continue;
            double const force = double(sim.pairs().force_column()[offset + 1]);
            double const from = double(store.position(std::size_t(pairs.i(slot)))[1]);
            double const to = double(store.position(std::size_t(pairs.j(slot)))[1]);
            double const low = std::min(from, to), high = std::max(from, to);
            for (int k = layer_at(high); k <= layer_at(low); ++k) {
                // The first layer extends above its top and the last one below its bottom.
                double const ceiling = k == 0 ? high : top_ - k * thickness_;
                double const floor = k == count_ - 1 ? low : top_ - (k + 1) * thickness_;
                double const part = std::min(high, ceiling) - std::max(low, floor);
                if (part > 0) stress[std::size_t(k)] += (to > from ? 1 : -1) * force * part / volume_;
            }
        }
    }

    template <class Simulation>
    std::vector<double> pressures(Simulation const& sim) const {
        auto const& network = sim.flow().network();
        std::vector<double> mean(std::size_t(count_), 0.0), volume(std::size_t(count_), 0.0);
        for (std::size_t p = 0; p < network.pores(); ++p) {
            auto const k = std::size_t(layer_at(lacuna::pore_middle(network, p, sim.particles().positions())[1]));
            mean[k] += double(network.volume[p]) * double(network.pressure[p]);
            volume[k] += double(network.volume[p]);
        }
        for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = volume[k] > 0 ? mean[k] / volume[k] : 0.0;
        return mean;
    }

    double top_;
    int count_;
    double thickness_, volume_;
};

/// Records profiles of a run: at short intervals while the first waves pass, then at growing intervals, and at the
/// first break.
class front_watch {
public:
    static constexpr lacuna::stage stages = lacuna::stage::step | lacuna::stage::breakage;

    front_watch(specimen const& s, std::vector<front_profile>& out) : specimen_(s), means_(s), out_(out) {}

    template <class Event, class Simulation>
    void on_break(Event const& event, Simulation const&) {
        cracks_.push_back(crack_of(specimen_, event));
    }
    template <class Simulation>
    void on_step(Simulation const& sim) {
        bool const first_break = !seen_break_ && !cracks_.empty();
        bool const due = sim.time() >= next_ * (1 - 1e-12);
        if (!due && !first_break) return;
        seen_break_ = seen_break_ || first_break;
        out_.push_back(means_.of(sim, cracks_.size()));
        while (sim.time() >= next_ * (1 - 1e-12))
            next_ = next_ < fine_until * (1 - 1e-9) ? next_ + fine_interval : next_ * coarse_ratio;
    }

    std::vector<crack_record> const& cracks() const { return cracks_; }

private:
    specimen const& specimen_;
    layer_means means_;
    std::vector<front_profile>& out_;
    std::vector<crack_record> cracks_;
    double next_ = fine_interval;
    bool seen_break_ = false;
};

template <class Model>
void follow(specimen const& s, options const& o, snapshot& shot) {
    options with_forces = o;
    with_forces.pair_forces = true; // for the stress profiles
    auto const loaded = load_specimen<Model>(s, with_forces);
    lacuna::simulation<Model>& sim = *loaded;
    load_run_watch watch(s, o);
    front_watch fronts(s, shot.fronts);
    shot.run = watch.follow(criterion::end, sim, watch.rule().steps(sim.resolve_time_step()), fronts);
    shot.damage = picture_of(sim, s, o, fronts.cracks());
}

} // namespace

std::vector<paper_picture> const& paper_pictures() {
    using lacuna::cartilage_zone;
    static std::vector<paper_picture> const pictures{{"10", cartilage_zone::surface, 50},
                                                     {"11", cartilage_zone::deep, 58},
                                                     {"12", cartilage_zone::whole, 49}};
    return pictures;
}

snapshot take_snapshot(paper_picture const& picture, options o) {
    o.what = command::run;
    o.zone = picture.zone;
    o.load_MPa = picture.load_MPa;
    specimen const s = build_specimen(o);
    snapshot shot;
    shot.zone = o.zone;
    shot.seed = o.seed;
    shot.figure = picture.figure;
    visit_model(o.choices, o.dry, [&]<class Model>(std::type_identity<Model>) { follow<Model>(s, o, shot); });
    return shot;
}

} // namespace cartilage
