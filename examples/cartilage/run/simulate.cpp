// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/observe/growing_file.hpp>
#include <lacuna/draw/picture.hpp>
#include <lacuna/observe/progress.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "cartilage/run/cartilage_model.hpp"
#include "cartilage/run/ending.hpp"
#include "cartilage/run/results.hpp"
#include "cartilage/run/run_output.hpp"
#include "cartilage/run/run_scene.hpp"

namespace cartilage {

namespace {

/// Observes a run: records cracks and the largest pore pressure, shows progress, draws pictures, and ends the run.
class watch {
public:
    static constexpr lacuna::stage stages = lacuna::stage::start | lacuna::stage::step | lacuna::stage::breakage;
    static constexpr bool needs_energy = true;

    watch(specimen const& s, options const& o, lacuna::run_directory& out, lacuna::progress_options const& progress,
          ending& end, run_result& result)
        : specimen_(s), options_(o), out_(out), log_(out.file("cracks.csv"), crack_heading()), progress_(progress),
          ending_(end), result_(result) {}

    template <class Event, class Simulation>
    void on_break(Event const& event, Simulation const&) {
        result_.cracks.push_back(crack_of(specimen_, event));
        log_.add(crack_line(result_.cracks.back()));
    }

    template <class Simulation>
    lacuna::run_control on_step(Simulation const& sim) {
        if constexpr (requires { sim.flow().network(); }) {
            auto const& pressure = sim.flow().network().pressure;
            if (!pressure.empty()) {
                double const highest = *std::max_element(pressure.begin(), pressure.end());
                result_.peak_pore_pressure = std::max(result_.peak_pore_pressure.value_or(highest), highest);
            }
        }
        if (options_.picture_every > 0 && sim.steps() % options_.picture_every == 0) {
            char name[40];
            std::snprintf(name, sizeof name, "damage-%09lld", sim.steps());
            lacuna::save_damage(out_.file(name), picture_of(sim, specimen_, options_, result_.cracks));
        }
        progress_.update(sim.steps(), "broken " + std::to_string(result_.cracks.size()));
        if (lacuna::stop_signal() != 0) {
            result_.interrupted = true;
            result_.ended = "interrupted";
            return lacuna::run_control::stop;
        }
        double const last_break = result_.cracks.empty() ? 0.0 : result_.cracks.back().time;
        bool const quiet = ending_.is_quiet(sim.energy().kinetic, sim.time(), last_break);
        if (quiet) result_.ended = "quiet";
        return quiet || ending_.is_over(sim.time()) ? lacuna::run_control::stop : lacuna::run_control::go_on;
    }
    template <class Simulation>
    void on_start(Simulation const& sim) {
        result_.time_step = sim.time_step();
        result_.time_step_limit = sim.limits().critical();
        out_.keep();
        log_.begin();
    }

    /// Writes all cracks to the file. Needed for an unstable run as well.
    void flush() { log_.flush(); }
    void finish(long long steps) { progress_.finish(steps, "broken " + std::to_string(result_.cracks.size())); }

private:
    specimen const& specimen_;
    options const& options_;
    lacuna::run_directory& out_;
    lacuna::growing_file log_;
    lacuna::progress_reporter<> progress_;
    ending& ending_;
    run_result& result_;
};

template <class Model>
run_result follow(specimen const& s, options const& o, lacuna::run_directory& out, std::FILE* progress,
                  lacuna::scene& damage) {
    auto const loaded = load_specimen<Model>(s, o);
    lacuna::simulation<Model>& sim = *loaded;

    run_result result;
    result.specimen = report_of(s);
    ending end(o);
    long long const steps = end.steps(sim.resolve_time_step());
    result.ended = end.at_longest();

    lacuna::progress_options progress_settings;
    progress_settings.sink = progress;
    progress_settings.steps = steps;
    progress_settings.particles = static_cast<long long>(sim.size());
    progress_settings.terminal = lacuna::is_terminal(progress);
    watch observer(s, o, out, progress_settings, end, result);

    auto const start = std::chrono::steady_clock::now();
    try {
        sim.run(progress_settings.steps, observer);
    } catch (lacuna::unstable_run const&) {
        observer.flush();
        throw;
    }
    observer.flush();
    result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    observer.finish(sim.steps());

    result.steps = sim.steps();
    result.end_time = sim.time();
    auto const& e = sim.energy();
    result.energy = {{"kinetic", e.kinetic},
                     {"strain", e.strain},
                     {"friction", e.friction},
                     {"damping", e.damping},
                     {"fracture", e.fracture},
                     {"fluid_storage", e.fluid_storage},
                     {"fluid_viscous", e.fluid_viscous},
                     {"fluid_outflow", e.fluid_outflow},
                     {"external", e.external},
                     {"initial", e.initial}};
    result.energy_residual = e.residual();
    sort_cracks(s, result);
    damage = picture_of(sim, s, o, result.cracks);
    return result;
}

} // namespace

run_result simulate(specimen const& s, options const& o, lacuna::run_directory& out, std::FILE* progress,
                    lacuna::scene& damage) {
    return visit_model(o.choices, o.dry, [&]<class Model>(std::type_identity<Model>) {
        return follow<Model>(s, o, out, progress, damage);
    });
}

} // namespace cartilage
