// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <lacuna/equilibrium.hpp>
#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "poroelasticity/closed_forms.hpp"
#include "poroelasticity/column.hpp"
#include "poroelasticity/terzaghi.hpp"
#include "reference.hpp"
#include "scratch_directory.hpp"
#include "simulation/setups.hpp"

using namespace setups;
using poroelasticity::consolidation;

namespace {

using equilibrium = lacuna::equilibrium<poroelasticity::porous_model>;
using simulator = poroelasticity::simulator;

constexpr double loose = -never;

/// What a column is made of, and how it is held.
struct column_options {
    int layers = 20, cells = 1;
    double bulk_modulus = 1e9;       ///< of the fluid, Pa; that of the lattice is 1e6
    double conductance = 1e-6;       ///< m^3/(s Pa)
    double minimum_pressure = loose; ///< Pa
    double pressure = 0;             ///< at the start, Pa
    double top_pressure = 0;         ///< of the reservoir, Pa
    bool holds_top = false;
    int weak_bond = -1; ///< its normal force at failure is weak_force
    double weak_force = 0;
};

/// A column between mirrors on a sealed base. Its top is drained.
struct column_run {
    poroelasticity::lattice_medium medium;
    poroelasticity::column body;
    simulator sim;
    std::vector<std::size_t> top;

    explicit column_run(column_options const& o)
        : medium(make_medium(o)), body(poroelasticity::make_column(o.layers + 1, o.cells, medium.radius, 1)),
          sim(body.packing, parameters(o)) {
        for (std::size_t i = 0; i < sim.size(); ++i) {
            bool const at_top = body.row[i] == o.layers;
            sim.fix(i, {.x = true,
                        .y = body.row[i] == 0 || (o.holds_top && at_top),
                        .z = false,
                        .rotation = body.side[i] != 0});
            if (at_top) top.push_back(i);
        }
        sim.fill_pores(poroelasticity::column_pores(body, {.far_pressure = o.top_pressure}));
    }

    void press(double stress, double ramp_time = 0) {
        for (auto const i : top) sim.apply(i, {0, -stress * 2 * medium.radius * body.share(i)}, 0.0, ramp_time);
    }
    double height() const { return body.length(); }
    /// H^2 / c, s.
    double tau() const { return height() * height() / medium.diffusivity(); }
    double settlement() const { return height() - sim.position(top[0])[1]; }
    /// Pressure of the layer at the base, Pa.
    double base_pressure() const { return poroelasticity::layer_pressure(sim, body, 0); }
    /// Compressive stress in the layer at the base: of the lattice, which all rows share, and of the fluid, Pa.
    double base_stress() const {
        std::size_t above = 0;
        while (body.row[above] != 1) ++above;
        double const strain = 1 - sim.position(above)[1] / medium.layer();
        return medium.oedometric() * strain + base_pressure();
    }
    /// Volume of fluid in the pores at pressure 0, m^3.
    double fluid() const {
        auto const& net = sim.flow().network();
        double sum = 0;
        for (std::size_t p = 0; p < net.pores(); ++p)
            sum += (net.volume[p] - net.vapour_of(p)) * std::exp(net.pressure[p] / sim.settings().flow.bulk_modulus);
        return sum;
    }

private:
    static poroelasticity::lattice_medium make_medium(column_options const& o) {
        poroelasticity::lattice_medium m;
        m.bulk_modulus = o.bulk_modulus;
        m.conductance = o.conductance;
        return m;
    }
    simulator::parameters parameters(column_options const& o) const {
        auto p = poroelasticity::porous_parameters(medium, o.pressure);
        p.flow.minimum_pressure = o.minimum_pressure;
        if (o.weak_bond >= 0) {
            p.bonds.resize(body.packing.bonds.size());
            p.bonds[std::size_t(o.weak_bond)].tensile_force = o.weak_force;
        }
        return p;
    }
};

/// Positions and pressures.
std::vector<double> state_of(simulator const& sim) {
    std::vector<double> all;
    for (std::size_t k = 0; k < sim.size(); ++k) {
        all.push_back(sim.position(k)[0]);
        all.push_back(sim.position(k)[1]);
    }
    for (auto const p : sim.flow().network().pressure) all.push_back(p);
    return all;
}

} // namespace

TEST_CASE("Terzaghi's column consolidates in slow time from early to late times", "[equilibrium][slow][reference]") {
    poroelasticity::terzaghi_setup setup;
    poroelasticity::terzaghi_column column(setup);
    equilibrium rest(column.sim());
    double const tau = column.body().length() * column.body().length() / column.medium().diffusivity();
    consolidation const exact(consolidation::shape::slab, 0);
    long long steps = 0;
    for (char const* const time : {"0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1"}) {
        double const t = std::stod(time);
        auto const found = rest.advance_to(t * tau, {.first_step = 1e-6 * tau});
        REQUIRE(found.finished());
        REQUIRE(found.unbalanced < 1e-5 * found.largest_force);
        REQUIRE(found.error < 5e-4);
        steps += found.steps;
        REQUIRE_THAT(column.sim().time(), WithinRel(t * tau, 1e-12));
        REQUIRE_THAT(column.consolidation_degree(), WithinAbs(reference("6a.terzaghi_U", time), 0.01));
        double const base = poroelasticity::layer_pressure(column.sim(), column.body(), 0) / column.load();
        REQUIRE_THAT(base, WithinAbs(reference("6a.terzaghi_base_p", time), 0.01));
    }
    REQUIRE(steps < 300);
    // A million times the time of consolidation, in steps that still grow.
    auto const late = rest.advance_to(1e6 * tau);
    REQUIRE(late.finished());
    REQUIRE(late.steps < 150);
    REQUIRE_THAT(column.consolidation_degree(), WithinAbs(1, 1e-4));
    for (auto const p : column.sim().flow().network().pressure)
        REQUIRE_THAT(p, WithinAbs(0, 1e-6 * column.load()));
}

TEST_CASE("slow time is of first order: a tolerance a quarter as large halves the error", "[equilibrium][slow]") {
    consolidation const exact(consolidation::shape::slab, 0);
    std::vector<double> degree;
    for (double const tolerance : {1.6e-3, 4e-4, 1e-4, 6e-6}) {
        column_run c({.layers = 6, .bulk_modulus = 1e6, .pressure = 15});
        c.press(15);
        equilibrium rest(c.sim);
        REQUIRE(rest.advance(0.2 * c.tau(), {.first_step = 1e-5 * c.tau(), .growth = 2, .tolerance = tolerance})
                    .finished());
        degree.push_back(c.settlement());
    }
    double const first = degree[0] - degree[3], second = degree[1] - degree[3], third = degree[2] - degree[3];
    REQUIRE(std::fabs(first) < 0.02 * degree[3]);
    REQUIRE_THAT(second / first, WithinAbs(0.5, 0.15));
    REQUIRE_THAT(third / second, WithinAbs(0.5, 0.15));
}

TEST_CASE("a held displacement relaxes: the stress of confined compression peaks and falls",
          "[equilibrium][slow][reference]") {
    column_run c({.layers = 40, .holds_top = true});
    double const ramp = 0.05 * c.tau(), strain = 1e-3;
    for (auto const i : c.top) c.sim.set_velocity(i, {0, -strain * c.height() / ramp});
    equilibrium rest(c.sim);
    lacuna::slow_time_parameters const p{.first_step = 1e-5 * c.tau()};
    auto const stress = [&] { return c.base_stress() / (c.medium.oedometric() * strain); };
    auto const check = [&](char const* time, double within) {
        REQUIRE(rest.advance_to(std::stod(time) * c.tau(), p).finished());
        double const wanted = reference("7.dimensionless", "relax sigma/(H_A eps0), t0=0.05 tau", time);
        REQUIRE_THAT(stress(), WithinRel(wanted, within));
    };
    check("0.01", 0.03);
    check("0.025", 0.02);
    check("0.05", 0.015);
    REQUIRE_THAT(c.settlement(), WithinRel(strain * c.height(), 1e-9));
    for (auto const i : c.top) {
        REQUIRE_THAT(c.sim.velocity(i)[1], WithinRel(-strain * c.height() / ramp, 1e-12));
        c.sim.set_velocity(i, {0, 0});
    }
    check("0.06", 0.02);
    check("0.1", 0.01);
    check("0.2", 0.01);
    check("0.5", 0.01);
    check("1", 0.005);
    REQUIRE_THAT(c.settlement(), WithinRel(strain * c.height(), 1e-9));
}

TEST_CASE("loads that rise act with their value at the end of a slow step", "[equilibrium][slow]") {
    column_run c({.layers = 20});
    double const ramp = 0.1, load = 1e3;
    consolidation const exact(consolidation::shape::slab, 0, ramp);
    c.press(load, ramp * c.tau());
    equilibrium rest(c.sim);
    double const final = load * c.height() / c.medium.oedometric();
    for (double const t : {0.05, 0.1, 0.2, 0.6}) {
        REQUIRE(rest.advance_to(t * c.tau(), {.first_step = 1e-5 * c.tau()}).finished());
        double const risen = std::min(t / ramp, 1.0);
        REQUIRE_THAT(c.settlement() / final, WithinAbs(risen - exact.mean(t), 0.01));
        REQUIRE_THAT(c.base_pressure() / load, WithinAbs(exact.pressure(0, t), 0.01));
    }
}

TEST_CASE("slow time without conductance is solve() with sealed pores, after all time it is solve() with drained ones",
          "[equilibrium][slow]") {
    double const load = 100;
    for (bool const sealed : {true, false}) {
        column_options const o{.layers = 6, .cells = 2, .bulk_modulus = 1e7, .conductance = sealed ? 0.0 : 1e-6};
        column_run one(o), other(o);
        one.press(load);
        other.press(load, 1.0);
        equilibrium solved(one.sim, {.tolerance = 1e-7,
                                     .pores = sealed ? lacuna::pore_condition::sealed
                                                     : lacuna::pore_condition::drained});
        REQUIRE(solved.solve().reached());
        equilibrium slow(other.sim, {.tolerance = 1e-7});
        REQUIRE(slow.advance(sealed ? 2.0 : 100 * other.tau(), {.first_step = 0.01}).finished());
        auto const a = state_of(one.sim), b = state_of(other.sim);
        double const length = other.settlement(), pressure = sealed ? load : 1.0;
        for (std::size_t k = 0; k < a.size(); ++k) {
            bool const is_length = k < 2 * one.sim.size();
            REQUIRE_THAT(b[k], WithinAbs(a[k], 1e-4 * (is_length ? length : pressure)));
        }
        REQUIRE(length > (sealed ? 5e-7 : 5e-5) * one.height());
    }
}

TEST_CASE("the fluid of slow time balances to rounding, and so does its energy", "[equilibrium][slow]") {
    column_run c({.layers = 10, .cells = 2, .bulk_modulus = 1e6, .pressure = 100});
    c.press(2e3);
    equilibrium rest(c.sim);
    double energy = c.sim.flow().storage_energy(), whole = energy;
    auto before = c.sim.flow().ledger();
    std::vector<double> volume(c.sim.flow().network().volume.begin(), c.sim.flow().network().volume.end()),
        pressure(c.sim.flow().network().pressure.begin(), c.sim.flow().network().pressure.end());
    double out = 0;
    long long checked = 0;
    auto const check = [&](double, lacuna::slow_result const& now) {
        auto const& net = c.sim.flow().network();
        auto const& ledger = c.sim.flow().ledger();
        double flowed = 0;
        for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t) flowed += net.flow[t] * now.time_step;
        double gained = 0, scale = 0;
        for (std::size_t p = 0; p < net.pores(); ++p) {
            gained += net.volume[p] * std::expm1((net.pressure[p] - pressure[p]) / 1e6) + (net.volume[p] - volume[p]);
            scale += volume[p];
            volume[p] = net.volume[p];
            pressure[p] = net.pressure[p];
        }
        out -= flowed;
        // The first step follows a change without flow.
        if (checked > 0) {
            REQUIRE_THAT(gained - flowed, WithinAbs(0, 1e-14 * scale));
            REQUIRE_THAT(ledger.mass_residual, WithinAbs(0, 1e-14 * scale));
            double const stored = c.sim.flow().storage_energy();
            auto const moved = [&](auto member) { return ledger.*member - before.*member; };
            using account = lacuna::flow_ledger<double>;
            double const dissipated = moved(&account::dissipation);
            REQUIRE(dissipated > 0);
            REQUIRE_THAT(stored - energy, WithinAbs(moved(&account::reservoir_work) - dissipated -
                                                        moved(&account::pressure_work) +
                                                        moved(&account::vapour_work) +
                                                        moved(&account::prefactor_work),
                                                    1e-13 * whole));
        }
        energy = c.sim.flow().storage_energy();
        whole = std::max(whole, energy);
        before = ledger;
        ++checked;
    };
    auto const found = rest.advance(3 * c.tau(), {.first_step = 1e-4 * c.tau()}, check);
    REQUIRE(found.finished());
    REQUIRE(checked == found.steps);
    REQUIRE_THAT(c.sim.flow().network().sources[0].volume, WithinRel(-out, 1e-12));
    REQUIRE_THAT(c.sim.flow().ledger().boundary_inflow, WithinRel(-out, 1e-12));
}

TEST_CASE("sources feed pores in slow time: a rate to the last drop, a pressure as long as it is held",
          "[equilibrium][slow]") {
    // Fluid fed into the base leaves at the top: the pressure falls along the column by rate / conductance, a layer of
    // this column being one throat wide.
    double const rate = 1e-4;
    poroelasticity::lattice_medium const medium;
    auto const body = poroelasticity::make_column(11, 1, medium.radius, 1);
    for (bool const is_rate : {true, false}) {
        simulator sim(body.packing, poroelasticity::porous_parameters(medium, 0));
        for (std::size_t i = 0; i < sim.size(); ++i)
            sim.fix(i, {.x = true, .y = body.row[i] == 0, .z = false, .rotation = body.side[i] != 0});
        std::size_t fed = 0, source = 0;
        sim.fill_pores([&](lacuna::points_view<double, 2> x, double const* r) {
            auto net = poroelasticity::column_pores(body, {})(x, r);
            fed = lacuna::find_pore(net, x, {0.5, 0.3});
            source = is_rate ? lacuna::inject(net, "feed", fed, rate) : lacuna::hold_pressure(net, "feed", fed, 500.0);
            return net;
        });
        equilibrium rest(sim);
        auto const& net = sim.flow().network();
        double const duration = 1e4;
        REQUIRE(rest.advance(duration, {.first_step = 1e-3}).finished());
        if (is_rate)
            REQUIRE_THAT(net.sources[source].volume, WithinRel(rate * duration, 1e-12));
        else
            REQUIRE(net.pressure[fed] == 500.0);
        // Steady: what the feed gives leaves at the top.
        double out = 0;
        for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t) out -= net.flow[t];
        REQUIRE_THAT(net.sources[source].rate, WithinRel(is_rate ? rate : out, 1e-6));
        REQUIRE_THAT(out, WithinRel(net.sources[source].rate, 1e-6));
        double const fall = poroelasticity::layer_pressure(sim, body, 4) - poroelasticity::layer_pressure(sim, body, 6);
        REQUIRE_THAT(fall, WithinRel(out * 2 * medium.layer() / (medium.permeability() * 2 * medium.radius), 0.01));
    }
}

TEST_CASE("a liquid that tears in slow time opens voids, which close before the pressure rises",
          "[equilibrium][slow]") {
    // Sealed and pulled: the same state as solve().
    column_options o{.layers = 4, .cells = 2, .bulk_modulus = 1e7, .conductance = 0, .minimum_pressure = -10};
    column_run one(o), other(o);
    one.press(-300);
    other.press(-300, 1.0);
    equilibrium solved(one.sim, {.tolerance = 1e-9}), slow(other.sim, {.tolerance = 1e-9});
    REQUIRE(solved.solve().reached());
    REQUIRE(slow.advance(1.5, {.first_step = 0.01}).finished());
    auto const& net = other.sim.flow().network();
    for (std::size_t p = 0; p < net.pores(); ++p) {
        REQUIRE(net.vapour[p] > 0);
        REQUIRE(net.pressure[p] == -10);
        REQUIRE_THAT(net.vapour[p], WithinRel(one.sim.flow().network().vapour[p], 1e-3));
    }
    // Drained: fluid is drawn in and fills the voids. Then the pressure rises to that of the reservoir.
    o.conductance = 1e-6;
    column_run wet(o);
    wet.press(-300);
    equilibrium rest(wet.sim);
    double const full = wet.fluid();
    std::size_t torn = 0;
    auto const watch = [&](double, lacuna::slow_result const&) {
        std::size_t now = 0;
        auto const& n = wet.sim.flow().network();
        for (std::size_t p = 0; p < n.pores(); ++p) {
            REQUIRE(n.pressure[p] >= -10);
            REQUIRE((n.vapour[p] == 0 || n.pressure[p] == -10));
            now += n.vapour[p] > 0;
        }
        torn = std::max(torn, now);
    };
    REQUIRE(rest.advance(100 * wet.tau(), {.first_step = 1e-4 * wet.tau()}, watch).finished());
    REQUIRE(torn > 4);
    for (auto const v : wet.sim.flow().network().vapour) REQUIRE(v == 0);
    for (auto const p : wet.sim.flow().network().pressure) REQUIRE_THAT(p, WithinAbs(0, 0.001));
    REQUIRE_THAT(wet.fluid() - full, WithinRel(wet.sim.flow().network().sources[0].volume, 1e-4));
    REQUIRE_THAT(-wet.settlement(), WithinRel(300 * wet.height() / wet.medium.oedometric(), 0.01));
}

TEST_CASE("a bond fails in slow time when the fluid has left it enough of the load", "[equilibrium][slow][fracture]") {
    poroelasticity::lattice_medium const medium;
    auto const body = poroelasticity::make_column(21, 2, medium.radius, 1);
    int weak = -1;
    for (std::size_t b = 0; b < body.packing.bonds.size() && weak < 0; ++b) {
        auto const& ends = body.packing.bonds[b];
        auto const i = std::size_t(ends[0]), j = std::size_t(ends[1]);
        if (body.row[i] == 0 && body.row[j] == 1 && body.side[i] == 0) weak = int(b);
    }
    REQUIRE(weak >= 0);
    // Pulled by `load`, the lattice at the base carries load - |p|. Its strain is that over M, of which a bond at 60
    // degrees takes 3/4.
    double const load = 100, strain = 0.5 * load / medium.oedometric();
    double const force = medium.normal_stiffness * 0.75 * strain * 2 * medium.radius;
    column_run c({.layers = 20, .cells = 2, .weak_bond = weak, .weak_force = force});
    c.press(-load);
    equilibrium rest(c.sim);
    consolidation const exact(consolidation::shape::slab, 0);
    double low = 0.1, high = 1; // when the pressure at the base is half of the load
    for (int n = 0; n < 60; ++n) {
        double const middle = 0.5 * (low + high);
        (exact.pressure(0.5 / 20, middle) > 0.5 ? low : high) = middle;
    }
    auto const found = rest.advance(20 * c.tau(), {.first_step = 1e-5 * c.tau()});
    INFO("outcome " << int(found.outcome) << " at T = " << c.sim.time() / c.tau());
    REQUIRE(found.finished());
    REQUIRE(found.broken == 1);
    REQUIRE(rest.events().size() == 1);
    REQUIRE(rest.events()[0].bond == weak);
    REQUIRE_THAT(rest.events()[0].time / c.tau(), WithinRel(low, 0.02));
    REQUIRE(found.unbalanced < 1e-5 * found.largest_force);
    REQUIRE(-c.settlement() > load * c.height() / c.medium.oedometric());
}

TEST_CASE("a run in slow time that is resumed from a checkpoint has the same bits", "[equilibrium][slow]") {
    scratch_directory const scratch;
    std::string const file = (scratch.path / "slow.bin").string();
    column_options const o{.layers = 8, .cells = 2, .bulk_modulus = 1e6};
    auto const set_up = [&](column_run& c) {
        c.press(50, 0.3 * c.tau());
        c.sim.run(3); // prescribed velocities and a step before
    };
    column_run whole(o);
    set_up(whole);
    lacuna::slow_time_parameters const p{.first_step = 1e-4 * whole.tau()};
    double const end = 2 * whole.tau();
    equilibrium rest(whole.sim);
    long long steps = 0;
    REQUIRE(rest.advance_to(end, p, [&](double, lacuna::slow_result const& now) {
                    if (now.steps == 20) lacuna::save_checkpoint(file, whole.sim, rest.history());
                    steps = now.steps;
                }).finished());
    whole.sim.run(5);

    column_run resumed(o);
    set_up(resumed);
    equilibrium again(resumed.sim);
    lacuna::load_checkpoint(file, resumed.sim, again.history());
    REQUIRE(resumed.sim.time() < 0.5 * end);
    auto const found = again.advance_to(end, p);
    REQUIRE(found.finished());
    REQUIRE(found.steps == steps - 20);
    resumed.sim.run(5);
    REQUIRE(state_of(whole.sim) == state_of(resumed.sim));
    REQUIRE(lacuna::state_hash(whole.sim) == lacuna::state_hash(resumed.sim));
}

TEST_CASE("steps in time go on where slow time ended", "[equilibrium][slow]") {
    poroelasticity::terzaghi_setup setup;
    setup.layers = 20;
    setup.slowness = 400;
    poroelasticity::terzaghi_column column(setup);
    equilibrium rest(column.sim());
    double const tau = column.body().length() * column.body().length() / column.medium().diffusivity();
    consolidation const exact(consolidation::shape::slab, 0);
    REQUIRE(rest.advance(0.1 * tau, {.first_step = 1e-5 * tau}).finished());
    double const before = column.consolidation_degree();
    while (column.time() < 0.11) column.sim().step();
    double const after = column.consolidation_degree();
    REQUIRE_THAT(after - before, WithinRel(exact.mean(0.1) - exact.mean(column.time()), 0.05));
    // And back.
    REQUIRE(rest.advance_to(0.2 * tau, {.first_step = 1e-5 * tau}).finished());
    REQUIRE_THAT(column.consolidation_degree(), WithinAbs(1 - exact.mean(0.2), 0.01));
}

TEST_CASE("bad requests in slow time are refused", "[equilibrium][slow]") {
    column_run c({.layers = 4});
    equilibrium rest(c.sim);
    auto const refusal = [&](lacuna::slow_time_parameters const& p, double duration = 1.0) {
        return thrown_by([&] { rest.advance(duration, p); });
    };
    REQUIRE_THAT(refusal({}, 0.0), contains_text("duration = 0"));
    REQUIRE_THAT(refusal({.first_step = 0}), contains_text("slow_time.first_step = 0: must be > 0"));
    REQUIRE_THAT(refusal({.first_step = 1, .largest_step = 0.5}),
                 contains_text("slow_time.largest_step = 0.5: must be >= first_step"));
    REQUIRE_THAT(refusal({.first_step = 1, .smallest_step = 2}), contains_text("slow_time.smallest_step = 2"));
    REQUIRE_THAT(refusal({.growth = 1}), contains_text("slow_time.growth = 1: must be > 1"));
    REQUIRE_THAT(refusal({.tolerance = 0}), contains_text("slow_time.tolerance = 0"));
    REQUIRE_THAT(refusal({.steps = 0}), contains_text("slow_time.steps = 0"));
    REQUIRE_THAT(thrown_by([&] { rest.advance_to(-1); }), contains_text("end_time = -1"));
    // An observer stops a run.
    auto const found = rest.advance(1.0, {.first_step = 1e-3},
                                    [](double, lacuna::slow_result const& now) { return now.steps < 3; });
    REQUIRE(found.outcome == lacuna::slow_outcome::stopped);
    REQUIRE(found.steps == 3);
}
