// SPDX-License-Identifier: BSD-3-Clause
#include "cases.hpp"

#include <algorithm>

#include <lacuna/core/text.hpp>

#include "cryer.hpp"
#include "darcy.hpp"
#include "mandel.hpp"
#include "terzaghi.hpp"

namespace poroelasticity {

namespace {

std::string text(char const* format, double value) { return lacuna::formatted(format, value); }

void add_mass(outcome& o, fluid_account const& fluid) { o.add("mass_balance_error", fluid.error(), 0); }

template <class Simulation>
void add_size(outcome& o, Simulation const& sim) {
    o.particles = sim.size();
    o.pores = sim.flow().network().pores();
    o.steps = sim.steps();
}

/// Shows the progress of a run that ends at time `last` and is now at time `now`.
template <class Simulation>
void show(programs::terminal_progress& progress, Simulation const& sim, double now, double last) {
    if (sim.steps() == 1) progress.begin(1, sim.size());
    progress.expect(double(sim.steps()) * last / now);
    progress.passed(sim.steps());
}
/// Shows the progress of a flow whose error falls by a constant factor per step, from 1 to `least`.
template <class Simulation>
void show_error(programs::terminal_progress& progress, Simulation const& sim, double error, double least) {
    double const share = std::clamp(std::log(error) / std::log(least), 1e-3, 1.0);
    show(progress, sim, std::isfinite(share) ? share : 1e-3, 1);
}

/// Adds the point of a curve with the largest relative error.
void add_worst(outcome& o, std::string const& name, outcome_curve const& c) {
    if (c.points.empty()) return; // stopped before the first point
    outcome_curve::point worst = c.points.front();
    auto const error = [](outcome_curve::point const& p) { return std::fabs(p.value / p.reference - 1); };
    for (auto const& p : c.points)
        if (error(p) > error(worst)) worst = p;
    o.add(name, worst.value, worst.reference);
}

} // namespace

outcome run_terzaghi(bool quick, programs::terminal_progress& progress) {
    terzaghi_setup setup;
    setup.layers = quick ? 20 : 40;
    setup.cells = quick ? 1 : 3;
    setup.slowness = quick ? 400 : 800;
    terzaghi_column column(setup);
    consolidation const exact(consolidation::shape::slab, 0);
    fluid_account fluid(column.sim().flow().network(), setup.medium.bulk_modulus);

    outcome o;
    o.name = "terzaghi";
    o.title = "Terzaghi: column of " + std::to_string(setup.layers) + " layers of pores, drained at its top";
    o.x_label = "T = c t / H²";
    outcome_curve settlement{"degree of consolidation U", {}}, base{"pressure at the base / load", {}};
    constexpr double last = 1;
    for (double const time : logarithmic_times(0.01, last, 41)) {
        while (o.should_continue() && column.time() < time * (1 - 1e-9)) {
            column.sim().step();
            show(progress, column.sim(), column.time(), last);
            fluid.add_step(column.sim().flow().network(), column.sim().time_step());
        }
        if (column.sim().steps() == 0) break;
        double const now = column.time(), u = column.consolidation_degree();
        settlement.points.push_back({now, u, 1 - exact.mean(now)});
        base.points.push_back({now, layer_pressure(column.sim(), column.body(), 0) / column.load(),
                               exact.pressure(0, now)});
        for (double const named : {0.01, 0.1, 1.0})
            if (!o.stopped && std::fabs(time - named) < 1e-9 * named)
                o.add("U(T=" + text("%g", named) + ")", u, settlement.points.back().reference);
        if (o.field.pores.empty() && time > 0.19)
            o.field = field_of(column.sim(), setup.medium.radius / 2, text("T = %.2f", now));
        if (o.stopped) break;
    }
    add_worst(o, "U_worst", settlement);
    add_worst(o, "base_pressure_worst", base);
    add_mass(o, fluid);
    o.curves = {settlement, base};
    add_size(o, column.sim());
    return o;
}

outcome run_mandel(bool quick, programs::terminal_progress& progress) {
    mandel_setup setup;
    setup.half_layers = quick ? 12 : 24;
    setup.cells = quick ? 1 : 6;
    mandel_slab slab(setup);
    auto const& medium = slab.medium();
    consolidation const exact(consolidation::shape::slab, medium.mean_coupling(), setup.ramp);
    fluid_account fluid(slab.sim().flow().network(), setup.medium.bulk_modulus);

    outcome o;
    o.name = "mandel";
    o.title = "Mandel: slab between rigid plates, drained at both sides, Poisson's ratio " +
              text("%g", medium.poisson());
    o.x_label = "T = c t / L²";
    outcome_curve middle{"pressure in the middle / undrained pressure", {}};
    double highest = 0, when = 0;
    double const last = quick ? 0.2 : 0.3;
    for (double const time : logarithmic_times(0.02, last, 33)) {
        while (o.should_continue() && slab.time() < time * (1 - 1e-9)) {
            slab.step();
            show(progress, slab.sim(), slab.time(), last);
            fluid.add_step(slab.sim().flow().network(), slab.sim().time_step());
            if (slab.sim().steps() % 20 != 0 || slab.time() < 0.02) continue;
            double const p = slab.middle_pressure();
            if (p > highest) {
                highest = p;
                when = slab.time();
                o.field = field_of(slab.sim(), setup.medium.radius / 2, text("T = %.3f: the peak", when));
            }
        }
        if (slab.sim().steps() == 0) break;
        middle.points.push_back({slab.time(), slab.middle_pressure(), exact.pressure(0, slab.time())});
        if (o.stopped) break;
    }
    if (!o.stopped) {
        o.add("peak_pressure", highest, exact.peak().pressure);
        o.add("peak_time", when, exact.peak().time);
    }
    add_worst(o, "middle_pressure_worst", middle);
    add_mass(o, fluid);
    o.curves = {middle};
    add_size(o, slab.sim());
    return o;
}

outcome run_cryer(bool quick, programs::terminal_progress& progress) {
    cryer_setup setup;
    setup.radius = quick ? 8 : 20;
    setup.medium.shear_stiffness = setup.medium.normal_stiffness;
    cryer_disc disc(setup);
    auto const& medium = disc.medium();
    consolidation const exact(consolidation::shape::disc, medium.mean_coupling(), 0, 60);
    fluid_account fluid(disc.sim().flow().network(), setup.medium.bulk_modulus);

    outcome o;
    o.name = "cryer";
    o.title = "Cryer: disc under pressure all around, drained at its rim, Poisson's ratio " +
              text("%g", std::fabs(medium.poisson()) < 1e-12 ? 0.0 : medium.poisson());
    o.x_label = "T = c t / R²";
    outcome_curve middle{"pressure in the middle / load", {}};
    double highest = 0, when = 0;
    double const last = quick ? 0.1 : 0.3;
    for (double const time : logarithmic_times(0.005, last, 34)) {
        while (o.should_continue() && disc.time() < time * (1 - 1e-9)) {
            disc.sim().step();
            show(progress, disc.sim(), disc.time(), last);
            fluid.add_step(disc.sim().flow().network(), disc.sim().time_step());
            double const p = disc.middle_pressure();
            if (p <= highest) continue;
            highest = p;
            when = disc.time();
        }
        if (disc.sim().steps() == 0) break;
        middle.points.push_back({disc.time(), disc.middle_pressure(), exact.pressure(0, disc.time())});
        if (disc.time() < 0.07) o.field = field_of(disc.sim(), 0, text("T = %.3f", disc.time()));
        if (o.stopped) break;
    }
    if (!o.stopped) {
        o.add("peak_pressure", highest, exact.peak().pressure);
        o.add("peak_time", when, exact.peak().time);
    }
    add_worst(o, "middle_pressure_worst", middle);
    add_mass(o, fluid);
    o.curves = {middle};
    add_size(o, disc.sim());
    return o;
}

namespace {

constexpr double steady_error = 1e-10; // relative difference between inflow and outflow of a steady state

/// Mean pressures of slices across the flow, from the run and from the direct solution. Also adds the largest error.
outcome_curve pressure_profile(outcome& o, darcy_body const& body, darcy_body::steady_state const& steady, int slices) {
    auto const& net = body.sim().flow().network();
    double const inlet = body.setup().pressure;
    outcome_curve profile{"mean pressure across the flow / pressure on the left", {}};
    std::vector<outcome_curve::point> sum(std::size_t(slices), {0, 0, 0});
    std::vector<double> area(std::size_t(slices), 0.0);
    double farthest = 0, left = body.packing().position.front()[0];
    for (auto const& x : body.packing().position) left = std::min(left, x[0]);
    for (std::size_t k = 0; k < net.pores(); ++k) {
        double const along = (pore_middle(net, k, body.sim().particles().positions())[0] - left) / body.extent(0);
        auto const slice = std::size_t(std::clamp(int(along * slices), 0, slices - 1));
        area[slice] += net.size[k];
        sum[slice].x += net.size[k] * along;
        sum[slice].value += net.size[k] * net.pressure[k] / inlet;
        sum[slice].reference += net.size[k] * steady.pressure[k] / inlet;
        farthest = std::max(farthest, std::fabs(net.pressure[k] - steady.pressure[k]) / inlet);
    }
    for (std::size_t s = 0; s < sum.size(); ++s)
        profile.points.push_back({sum[s].x / area[s], sum[s].value / area[s], sum[s].reference / area[s]});
    o.add("largest_pressure_error/pressure", farthest, 0);
    return profile;
}

/// Adds the permeability of the triangular lattice. \return false if a signal stopped it
bool add_lattice_permeability(outcome& o, bool quick, programs::terminal_progress& progress) {
    lattice_medium const medium;
    lattice_flow lattice(quick ? 8 : 16, 2, medium, 1e3);
    auto const lattice_error = [&] { return std::fabs(lattice.permeability(0) / lattice.permeability(1) - 1); };
    do {
        lattice.sim().step();
        show_error(progress, lattice.sim(), lattice_error(), steady_error);
    } while (o.should_continue() && !(lattice_error() < steady_error));
    if (o.stopped) {
        add_size(o, lattice.sim());
        return false;
    }
    o.add("permeability_lattice/C", lattice.permeability(1) / medium.conductance,
          medium.permeability() / medium.conductance);
    return true;
}

} // namespace

outcome run_darcy(bool quick, programs::terminal_progress& progress) {
    outcome o;
    o.name = "darcy";
    o.x_label = "x / length";
    o.logarithmic = false;
    if (!add_lattice_permeability(o, quick, progress)) return o;

    darcy_setup setup;
    if (quick) setup.length = 12, setup.height = 10;
    darcy_body body(setup);
    o.title = "Darcy: steady flow from left to right through a random packing of bonded discs";
    fluid_account fluid(body.sim().flow().network(), setup.medium.bulk_modulus);
    auto const body_error = [&] { return std::fabs(body.outflow() / body.inflow() - 1); };
    do {
        body.sim().step();
        fluid.add_step(body.sim().flow().network(), body.sim().time_step());
        show_error(progress, body.sim(), body_error(), steady_error);
    } while (o.should_continue() && !(body_error() < steady_error) && body.sim().steps() < 2000);
    if (o.stopped) {
        add_mass(o, fluid);
        add_size(o, body.sim());
        return o;
    }
    auto const steady = body.solve();
    o.add("permeability_random", body.permeability(body.inflow()), body.permeability(steady.flow));
    o.add("outflow/inflow", body.outflow() / body.inflow(), 1);
    o.curves = {pressure_profile(o, body, steady, quick ? 8 : 20)};
    add_mass(o, fluid);
    o.field = field_of(body.sim(), 0, "steady state");
    add_size(o, body.sim());
    return o;
}

} // namespace poroelasticity
