// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/text.hpp>
#include <lacuna/draw/picture.hpp>
#include <lacuna/equilibrium.hpp>
#include <lacuna/observe/progress.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "cartilage/common/interruption.hpp"
#include "cartilage/run/damage_count.hpp"
#include "cartilage/run/equilibrium_run.hpp"
#include "cartilage/run/load_specimen.hpp"
#include "cartilage/run/run_scene.hpp"

namespace cartilage {

/// Loads one specimen of one model from equilibrium to equilibrium.
template <class Model>
class load_program {
public:
    load_program(specimen const& s, equilibrium_request const& r, lacuna::run_directory* out, std::FILE* progress)
        : specimen_(s), request_(r), out_(out), sim_(load_specimen<Model>(s, r.model)),
          rest_(*sim_, settings_of(r, furthest)), damage_(s), progress_(progress_of(r, progress)) {
        std::vector<int> groups;
        for (auto const& bond : s.discs.bonds) {
            int const one = s.fibre[std::size_t(bond[0])], other = s.fibre[std::size_t(bond[1])];
            groups.push_back(one == other ? one : -1);
        }
        rest_.group_bonds(std::move(groups));
    }

    equilibrium_run const& run() {
        if (out_) out_->keep();
        auto const start = std::chrono::steady_clock::now();
        double const highest = request_.model.load_MPa, small = small_share * highest;
        // A specimen that is loose is so at any load.
        probe(small);
        if (result_.held) follow({small, highest, request_.steps});
        if (result_.ended.empty()) result_.ended = "limit";
        result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        progress_.finish(step_, note());
        count();
        return result_;
    }

    /// The scene of the present damage.
    lacuna::scene picture() const {
        options o = request_.model;
        o.load_MPa = result_.load_MPa;
        lacuna::scene scene = present_damage(*sim_, specimen_, o, result_.cracks);
        scene.subtitle += result_.ended == "mechanism" ? ", a mechanism" : ", equilibrium";
        if (!result_.crack_MPa.empty())
            scene.captions.push_back(lacuna::formatted("first at %.4g MPa", result_.crack_MPa.front()));
        return scene;
    }

private:
    static constexpr double small_share = 1.0 / 400; // of the highest load
    static constexpr double tolerance = 1e-3;   // of the largest force

    // Motion of a mechanism at constant load, in radii. Gaps are 0.02 radii, elastic displacements at the small load
    // far below 0.001.
    static constexpr double furthest = 0.3, furthest_at_small_load = 0.1;

    static lacuna::equilibrium_parameters settings_of(equilibrium_request const& r, double motion) {
        lacuna::equilibrium_parameters p;
        p.largest_motion = motion;
        p.tolerance = tolerance;
        p.iterations = r.iterations;
        p.failures = r.failures;
        p.pores = r.drained ? lacuna::pore_condition::drained : lacuna::pore_condition::sealed;
        return p;
    }
    static lacuna::progress_options progress_of(equilibrium_request const& r, std::FILE* sink) {
        lacuna::progress_options p;
        p.sink = sink;
        p.steps = r.steps;
        p.unit = nullptr;
        p.terminal = lacuna::is_terminal(sink);
        return p;
    }

    void set_load(double load_MPa) {
        for (auto const id : specimen_.loaded) sim_->apply(std::size_t(id), load_on(id, load_MPa));
    }
    /// Seeks the equilibrium at a small load at once.
    void probe(double load_MPa) {
        set_load(load_MPa);
        auto settings = settings_of(request_, furthest_at_small_load);
        settings.failures = lacuna::failure_choice::first;
        lacuna::equilibrium<Model> small(*sim_, settings);
        lacuna::equilibrium_result const found = small.solve();
        result_.held = found.reached();
        result_.factorisations += found.factorisations;
        record(small.events(), load_MPa, load_MPa);
        note_end(found);
    }
    /// Follows one stage and records it.
    void follow(lacuna::load_stage const& stage) {
        double last_MPa = stage.from;
        auto const set = [&](double load_MPa) {
            if (lacuna::stop_signal() != 0) throw interruption();
            set_load(load_MPa);
            last_MPa = load_MPa;
        };
        try {
            lacuna::load_path const path = rest_.follow(stage, set, [&](lacuna::load_point const& p) {
                record(rest_.events(), p.value);
                return on_equilibrium(p);
            });
            record(rest_.events(), path.value);
            result_.factorisations += path.factorisations;
            note_end(path.last);
        } catch (interruption const&) {
            record(rest_.events(), last_MPa);
            result_.ended = "interrupted";
        }
    }
    /// Takes over how the last solve ended.
    void note_end(lacuna::equilibrium_result const& last) {
        result_.unbalanced = last.largest_force > 0 ? last.unbalanced / last.largest_force : 0;
        result_.trials = last.trials;
        recorded_ = 0;
        if (last.outcome == lacuna::equilibrium_outcome::mechanism) result_.ended = "mechanism";
        if (last.outcome == lacuna::equilibrium_outcome::not_converged) result_.ended = "not_converged";
    }
    lacuna::vec<double, 2> load_on(std::int32_t id, double load_MPa) const {
        choices const& c = request_.model.choices;
        double const radius = specimen_.discs.radius[std::size_t(id)];
        return {0, -lacuna::traction_force(load_MPa * 1e6, radius, specimen_.thickness, traction_area_of(c.load_area))};
    }
    /// \return whether to go on
    bool on_equilibrium(lacuna::load_point const& p) {
        if (p.value > small_share * request_.model.load_MPa) ++step_;
        if (out_ && request_.model.picture_every > 0 && step_ > 0 && step_ % request_.model.picture_every == 0) {
            char name[40];
            std::snprintf(name, sizeof name, "damage-%09lld", step_);
            lacuna::save_damage(out_->file(name), picture());
        }
        progress_.update(step_, note());
        if (damage_.complete) result_.ended = "complete";
        return result_.ended.empty();
    }
    /// Takes over the breaks up to the present load. \param unit of the events' loads, MPa
    template <class Events>
    void record(Events const& events, double load_MPa, double unit = 1) {
        result_.load_MPa = load_MPa;
        for (; recorded_ < events.size(); ++recorded_) {
            result_.cracks.push_back(crack_of(specimen_, events[recorded_]));
            result_.crack_MPa.push_back(unit * events[recorded_].load);
            damage_.add(result_.cracks.back().fibre, result_.crack_MPa.back());
        }
    }
    std::string note() const {
        return lacuna::formatted("%.4g MPa, ", result_.load_MPa) + "broken " + std::to_string(result_.cracks.size());
    }
    void count() {
        run_result counted;
        counted.cracks = result_.cracks;
        sort_cracks(specimen_, counted);
        result_.fibres_cut = counted.fibres_cut;
        for (std::size_t l = 0; l < counted.layers.size(); ++l)
            result_.layers.push_back({counted.layers[l], damage_.layers_cut()[l]});
        // Breaks while the particles of a mechanism move are no strength.
        if (!result_.held) return;
        result_.first_crack_MPa = damage_.first_crack;
        result_.capacity_MPa = damage_.first_layer_and_another;
        if (auto const* first = damage_.first_layer()) result_.capacity_half_MPa = first->half_broken_time;
        result_.complete_MPa = damage_.complete;
    }

    specimen const& specimen_;
    equilibrium_request const& request_;
    lacuna::run_directory* out_;
    std::unique_ptr<lacuna::simulation<Model>> sim_;
    lacuna::equilibrium<Model> rest_;
    damage_count damage_;
    lacuna::progress_reporter<> progress_;
    equilibrium_run result_;
    long long step_ = 0;
    std::size_t recorded_ = 0; // breaks of the present stage
};

template <class Model>
equilibrium_run find_strength_of(specimen const& s, equilibrium_request const& r, lacuna::run_directory* out,
                                 std::FILE* progress, lacuna::scene* damage) {
    load_program<Model> program(s, r, out, progress);
    equilibrium_run result = program.run();
    if (damage) *damage = program.picture();
    return result;
}

} // namespace cartilage
