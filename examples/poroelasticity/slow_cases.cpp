// SPDX-License-Identifier: BSD-3-Clause
#include "cases.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <lacuna/core/text.hpp>
#include <lacuna/equilibrium.hpp>

#include "cryer.hpp"
#include "slow_bodies.hpp"
#include "terzaghi.hpp"

namespace poroelasticity {

namespace {

std::string text(char const* format, double value) { return lacuna::formatted(format, value); }

/// A run in slow time, with the account of its fluid.
class slow_run {
public:
    slow_run(outcome& o, simulator& sim, double tau, double last, programs::terminal_progress& progress)
        : o_(o), sim_(sim), rest_(sim), fluid_(sim.flow().network(), sim.settings().flow.bulk_modulus), tau_(tau),
          last_(last), progress_(progress) {
        progress.begin(1, sim.size());
    }
    /// Goes on to a dimensionless time. \return whether it got there
    bool reach(double time) {
        if (!o_.should_continue()) return false;
        auto const found = rest_.advance_to(
            time * tau_, {.first_step = 1e-7 * tau_, .tolerance = 1e-4}, [&](double now, lacuna::slow_result const& r) {
                fluid_.add_slow_step(sim_.flow().network(), r.time_step);
                progress_.expect(double(++o_.steps) * std::log1p(1e5 * last_) / std::log1p(1e5 * now / tau_));
                progress_.passed(o_.steps);
                return o_.should_continue();
            });
        if (!found.finished() && !o_.stopped)
            throw std::runtime_error("no equilibrium at T = " + text("%g", sim_.time() / tau_));
        return found.finished();
    }
    void close() {
        if (fluid_.outflow() > 0) o_.add("mass_balance_error", fluid_.error(), 0);
        o_.particles = sim_.size();
        o_.pores = sim_.flow().network().pores();
    }

private:
    outcome& o_;
    simulator& sim_;
    lacuna::equilibrium<porous_model> rest_;
    fluid_account fluid_;
    double tau_, last_;
    programs::terminal_progress& progress_;
};

/// Adds the largest difference of a curve from its closed form.
void add_worst_difference(outcome& o, std::string const& name, outcome_curve const& c) {
    double worst = 0;
    for (auto const& p : c.points) worst = std::max(worst, std::fabs(p.value - p.reference));
    if (!c.points.empty()) o.add(name, worst, 0);
}
/// The given times, and times evenly spaced between the first and the last on a logarithmic axis.
std::vector<double> times_with(std::vector<double> named, int count) {
    auto all = logarithmic_times(named.front(), named.back(), count);
    for (double const t : named)
        if (std::none_of(all.begin(), all.end(), [&](double a) { return std::fabs(a / t - 1) < 1e-6; }))
            all.push_back(t);
    std::sort(all.begin(), all.end());
    return all;
}
bool is_named(std::vector<double> const& named, double time) {
    return std::any_of(named.begin(), named.end(), [&](double t) { return std::fabs(time / t - 1) < 1e-6; });
}

} // namespace

outcome run_slow_terzaghi(bool quick, programs::terminal_progress& progress) {
    terzaghi_setup setup;
    setup.layers = quick ? 20 : 40;
    setup.cells = quick ? 1 : 3;
    terzaghi_column column(setup);
    consolidation const exact(consolidation::shape::slab, 0);
    double const tau = std::pow(column.body().length(), 2) / column.medium().diffusivity();
    outcome o;
    o.name = "terzaghi";
    o.title = "Terzaghi in slow time: column of " + std::to_string(setup.layers) + " layers of pores";
    o.x_label = "T = c t / H²";
    std::vector<double> const named{0.001, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 10};
    outcome_curve settlement{"degree of consolidation U", {}}, base{"pressure at the base / load", {}};
    slow_run run(o, column.sim(), tau, named.back(), progress);
    for (double const time : times_with(named, 41)) {
        if (!run.reach(time)) break;
        settlement.points.push_back({time, column.consolidation_degree(), 1 - exact.mean(time)});
        base.points.push_back({time, layer_pressure(column.sim(), column.body(), 0) / column.load(),
                               exact.pressure(0, time)});
        if (is_named({0.01, 0.1, 1}, time))
            o.add("U(T=" + text("%g", time) + ")", settlement.points.back().value, settlement.points.back().reference);
        if (o.field.pores.empty() && time > 0.19)
            o.field = field_of(column.sim(), setup.medium.radius / 2, text("T = %.2f", time));
    }
    add_worst_difference(o, "U_difference", settlement);
    add_worst_difference(o, "base_pressure_difference/load", base);
    run.close();
    o.curves = {settlement, base};
    return o;
}

outcome run_slow_mandel(bool quick, programs::terminal_progress& progress) {
    mandel_body slab(quick ? 12 : 24, quick ? 1 : 6);
    auto const& medium = slab.medium();
    consolidation const exact(consolidation::shape::slab, medium.mean_coupling());
    outcome o;
    o.name = "mandel";
    o.title = "Mandel in slow time: slab between rigid plates, Poisson's ratio " + text("%g", medium.poisson());
    o.x_label = "T = c t / L²";
    std::vector<double> const named{0.001, 0.01, 0.1, 0.5, 1, 10};
    outcome_curve middle{"pressure in the middle / undrained pressure", {}};
    slow_run run(o, slab.sim(), slab.tau(), named.back(), progress);
    double highest = 0;
    for (double const time : times_with(named, quick ? 33 : 65)) {
        if (!run.reach(time)) break;
        middle.points.push_back({time, slab.middle_pressure(), exact.pressure(0, time)});
        if (is_named({0.1, 0.5, 1}, time))
            o.add("pressure(T=" + text("%g", time) + ")", middle.points.back().value, middle.points.back().reference);
        if (middle.points.back().value <= highest) continue;
        highest = middle.points.back().value;
        o.field = field_of(slab.sim(), medium.radius / 2, text("T = %.3f: the peak", time));
    }
    if (!o.stopped) o.add("peak_pressure", highest, exact.peak().pressure);
    add_worst_difference(o, "middle_pressure_difference/p0", middle);
    run.close();
    o.curves = {middle};
    return o;
}

outcome run_slow_cryer(bool quick, programs::terminal_progress& progress) {
    cryer_setup setup;
    setup.radius = quick ? 8 : 30;
    setup.medium.shear_stiffness = setup.medium.normal_stiffness;
    cryer_disc disc(setup);
    auto const& medium = disc.medium();
    consolidation const exact(consolidation::shape::disc, medium.mean_coupling(), 0, 60);
    outcome o;
    o.name = "cryer";
    o.title = "Cryer in slow time: disc under pressure all around, Poisson's ratio 0";
    o.x_label = "T = c t / R²";
    std::vector<double> const named{0.001, 0.01, 0.1, 0.5, 1, 10};
    outcome_curve middle{"pressure in the middle / load", {}};
    slow_run run(o, disc.sim(), disc.radius() * disc.radius() / medium.diffusivity(), named.back(), progress);
    hold_middle(disc.sim(), disc.packing());
    double highest = 0;
    for (double const time : times_with(named, quick ? 33 : 65)) {
        if (!run.reach(time)) break;
        middle.points.push_back({time, disc.middle_pressure(), exact.pressure(0, time)});
        if (is_named({0.1, 0.5, 1}, time))
            o.add("pressure(T=" + text("%g", time) + ")", middle.points.back().value, middle.points.back().reference);
        if (middle.points.back().value <= highest) continue;
        highest = middle.points.back().value;
        o.field = field_of(disc.sim(), 0, text("T = %.3f: the peak", time));
    }
    if (!o.stopped) o.add("peak_pressure", highest, exact.peak().pressure);
    add_worst_difference(o, "middle_pressure_difference/load", middle);
    run.close();
    o.curves = {middle};
    return o;
}

outcome run_creep(bool quick, programs::terminal_progress& progress) {
    cartilage_column column(quick ? 20 : 80, false);
    consolidation const exact(consolidation::shape::slab, 0);
    outcome o;
    o.name = "creep";
    o.title = "Creep: cartilage of " + text("%g", 1e3 * cartilage_column::thickness) + " mm under a constant load";
    o.x_label = "t / s";
    outcome_curve settlement{"settlement / final settlement", {}}, base{"pressure at the base / load", {}};
    std::vector<double> const named{1, 10, 100, 1000, 10000};
    double const tau = column.tau();
    slow_run run(o, column.sim(), tau, named.back() / tau, progress);
    for (double const time : times_with(named, 41)) {
        if (!run.reach(time / tau)) break;
        settlement.points.push_back({time, column.strain() / cartilage_column::final_strain,
                                     1 - exact.mean(time / tau)});
        base.points.push_back({time, column.base_pressure() / column.load(), exact.pressure(0, time / tau)});
        if (is_named(named, time))
            o.add("settlement(t=" + text("%g", time) + "s)", settlement.points.back().value,
                  settlement.points.back().reference);
        if (o.field.pores.empty() && time > 900)
            o.field = field_of(column.sim(), column.medium().radius / 2, text("t = %.0f s", time));
    }
    add_worst_difference(o, "settlement_difference", settlement);
    add_worst_difference(o, "base_pressure_difference/load", base);
    run.close();
    o.curves = {settlement, base};
    return o;
}

outcome run_relaxation(bool quick, programs::terminal_progress& progress) {
    cartilage_column column(quick ? 20 : 80, true);
    constexpr double ramp = 0.05;
    outcome o;
    o.name = "relaxation";
    o.title = "Relaxation: cartilage of " + text("%g", 1e3 * cartilage_column::thickness) + " mm, compressed and held";
    o.x_label = "T = c t / h²";
    outcome_curve stress{"stress / (modulus strain)", {}};
    std::vector<double> const named{0.01, 0.025, 0.05, 0.06, 0.1, 0.2, 0.5, 1};
    slow_run run(o, column.sim(), column.tau(), named.back(), progress);
    column.move_top(cartilage_column::final_strain / (ramp * column.tau()));
    for (double const time : times_with(named, 41)) {
        if (!run.reach(time)) break;
        if (is_named({ramp}, time)) column.move_top(0);
        stress.points.push_back({time, column.base_stress(), relaxing_stress(time, ramp)});
        if (is_named(named, time))
            o.add("stress(T=" + text("%g", time) + ")", stress.points.back().value, stress.points.back().reference);
        if (is_named({ramp}, time))
            o.field = field_of(column.sim(), column.medium().radius / 2, "at the peak of the stress");
    }
    add_worst_difference(o, "stress_difference", stress);
    run.close();
    o.curves = {stress};
    return o;
}

} // namespace poroelasticity
