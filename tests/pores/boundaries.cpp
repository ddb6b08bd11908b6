// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>

using namespace lacuna;
using bodies::body;
using bodies::point;

namespace {

using explicit_bare = explicit_flow_with<constant_aperture>::solver<double, 2>;
using implicit_bare = implicit_flow_with<constant_aperture>::solver<double, 2>;
using throats = std::vector<bare_throat<double>>;

template <class Solver>
Solver solver_of(pore_network<double, 2> net) {
    typename Solver::parameters p;
    p.bulk_modulus = p.conductivity = 1;
    return {p, std::move(net)};
}

flow_source pressure_source(std::string name, double value) {
    return {std::move(name), flow_source_kind::pressure, value};
}

/// Sum of the volumes of all sources.
template <class Solver>
double total_volume(Solver const& flow) {
    double sum = 0;
    for (auto const& s : flow.network().sources) sum += s.volume;
    return sum;
}

} // namespace

TEMPLATE_TEST_CASE("two pores: a source, a held pressure, and the volume through each", "", explicit_bare,
                   implicit_bare) {
    // Pore 0 is fed by q = 0.3 and joined to pore 1, held at p = 2, by C = 0.5: p_0 -> 2 + q / C = 2.6, and the excess
    // decays as exp(-t C / V) with V = 4.
    auto net = make_bare_network<double>({4, 1}, {{0, 1, 2, 1}});
    REQUIRE(inject(net, "pump", 0, 0.3) == 0);
    REQUIRE(hold_pressure(net, "tank", 1, 2.0) == 1);
    auto flow = solver_of<TestType>(net);
    double const dt = 1e-3;
    for (int i = 0; i < 5000; ++i) flow.advance(dt);
    REQUIRE_THAT(flow.network().pressure[1], WithinAbs(2, 0));
    REQUIRE_THAT(flow.network().pressure[0], WithinRel(2.6 * (1 - std::exp(-0.625)), 2e-4));
    REQUIRE_THAT(flow.network().sources[0].volume, WithinRel(1.5, 1e-12));
    REQUIRE_THAT(flow.network().sources[0].rate, WithinRel(0.3, 1e-9));
    // The tank supplied the content of the pores less the pumped volume.
    double const stored = 4 * flow.network().pressure[0] + 2;
    REQUIRE_THAT(flow.network().sources[1].volume, WithinRel(stored - 1.5, 1e-11));
    REQUIRE_THAT(flow.ledger().boundary_inflow, WithinRel(stored, 1e-11));
    // The work of the sources is stored or dissipated.
    REQUIRE_THAT(flow.ledger().reservoir_work, WithinRel(flow.storage_energy() + flow.ledger().dissipation, 1e-11));
    for (int i = 0; i < 200000; ++i) flow.advance(10 * dt);
    REQUIRE_THAT(flow.network().pressure[0], WithinRel(2.6, 1e-10));
    REQUIRE_THAT(flow.network().sources[1].rate, WithinRel(-0.3, 1e-7));

    // Later the pump is reversed, and the tank emptied.
    flow.set_source(0, -0.1);
    flow.set_source(1, 0.0);
    for (int i = 0; i < 200000; ++i) flow.advance(10 * dt);
    REQUIRE_THAT(flow.network().pressure[0], WithinRel(-0.2, 1e-9));
    REQUIRE(flow.network().pressure[1] == 0);
    REQUIRE_THAT(flow.network().sources[1].rate, WithinRel(0.1, 1e-7));
}

TEMPLATE_TEST_CASE("a line between two reservoirs: the same flux in and out", "", explicit_bare, implicit_bare) {
    // 9 throats of C = 1 between pores, and 2 of C = 1/2 at the ends: resistance 9 + 4.
    throats list;
    for (int i = 0; i < 9; ++i) list.push_back({i, i + 1, 1, 1});
    list.push_back({0, -1, 2, 1, 26.0, 0});
    list.push_back({9, -1, 2, 1, 0.0, 1});
    auto flow = solver_of<TestType>(make_bare_network(std::vector<double>(10, 1.0), list,
                                                      {pressure_source("left", 26), pressure_source("right", 0)}));
    for (int i = 0; i < 20000; ++i) flow.advance(0.4);
    auto const& sources = flow.network().sources;
    REQUIRE_THAT(sources[0].rate, WithinRel(2.0, 1e-10));
    REQUIRE_THAT(sources[1].rate, WithinRel(-2.0, 1e-10));
    for (int i = 0; i < 10; ++i)
        REQUIRE_THAT(flow.network().pressure[std::size_t(i)], WithinRel(22 - 2.0 * i, 1e-10));
    REQUIRE_THAT(total_volume(flow), WithinRel(flow.ledger().boundary_inflow, 1e-9));
    // The pores hold the sum of their pressures, 130.
    REQUIRE_THAT(total_volume(flow), WithinRel(130.0, 1e-7));
    flow.set_source(0, 0.0);
    for (int i = 0; i < 20000; ++i) flow.advance(0.4);
    REQUIRE_THAT(total_volume(flow), WithinAbs(0, 1e-6));
    for (double const p : flow.network().pressure) REQUIRE_THAT(p, WithinAbs(0, 1e-10));
}

TEST_CASE("Darcy flow through a triangular lattice of discs, from side to side and into a side") {
    using solver = implicit_flow_with<constant_aperture>::solver<double, 2>;
    typename solver::parameters p;
    p.bulk_modulus = 1000;
    p.conductivity = 1;
    p.aperture.aperture = 0.1;
    double const c = 1e-3 / 2;
    auto const steady = [&](int columns, auto const& rules) {
        auto const b = bodies::triangular(5, columns);
        solver flow(p, b.network(rules), 1.0, b.points(), b.r.data());
        for (int i = 0; i < 60; ++i) flow.advance(1e3 * flow_critical_time_step(flow.network(), 1000.0));
        return flow;
    };
    auto const rules = flow_boundaries(reservoir("bottom", on_side{body_side::bottom}, 7.0),
                                       reservoir("top", on_side{body_side::top}, 0.0));
    auto const narrow = steady(30, rules), wide = steady(31, rules);
    auto const flux = [](solver const& flow) {
        auto const& sources = flow.network().sources;
        REQUIRE_THAT(sources[0].rate, WithinRel(-sources[1].rate, 1e-10));
        // The work of the reservoirs is dissipated in the throats.
        auto const& net = flow.network();
        double lost = 0;
        for (std::size_t t = 0; t < net.open_throats(); ++t) lost += net.flow[t] * net.flow[t] / net.conductance[t];
        REQUIRE_THAT(lost, WithinRel(7.0 * sources[0].rate, 1e-9));
        return sources[0].rate;
    };
    // One column more, in the middle where the ends have no influence. It is 5 throats along rows in series with 4
    // pairs of slanting ones between them: 5 / C + 4 / (2 C) = 7 / C. (In the limit of many rows 3 / (2 C) for each
    // sqrt(3) R of height and 2 R of width: the conductivity C / sqrt(3) of the honeycomb.)
    REQUIRE_THAT(flux(wide) - flux(narrow), WithinRel(c, 1e-9));

    // The same flux is injected at the bottom instead of a reservoir there.
    double const q = flux(wide);
    auto const fed = steady(31, flow_boundaries(injection("bottom", on_side{body_side::bottom}, q),
                                                reservoir("top", on_side{body_side::top}, 0.0)));
    REQUIRE_THAT(fed.network().sources[0].rate, WithinRel(q, 1e-10));
    REQUIRE_THAT(fed.network().sources[1].rate, WithinRel(-q, 1e-9));
}

TEST_CASE("a loaded surface is chosen by its particles, and rules are tried in order") {
    auto const b = bodies::triangular(4, 6);
    std::vector<std::uint8_t> loaded(b.x.size(), 0);
    for (std::size_t i = 0; i < b.x.size(); ++i)
        loaded[i] = b.x[i][1] > 5 && b.x[i][0] > 3 ? 1 : 0;
    REQUIRE(std::count(loaded.begin(), loaded.end(), 1) == 3);
    auto const net = b.network(flow_boundaries(reservoir("platen", between_chosen{loaded}, 3.0),
                                               reservoir("rest of the top", on_side{body_side::top}, 1.0),
                                               injection("left", on_side{body_side::left}, 2e-3)));
    REQUIRE(net.sources.size() == 3);
    REQUIRE(find_source(net, "left") == 2);
    REQUIRE_THROWS_WITH(find_source(net, "right"), contains_text("flow source = right"));
    int under = 0, beside = 0;
    for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t) {
        auto const chosen = [&](std::size_t side) { return loaded[std::size_t(net.throat_particle[side][t])] != 0; };
        bool const both = chosen(0) && chosen(1);
        REQUIRE(net.throat_source(t) == (both ? 0 : 1));
        REQUIRE(net.reservoir_pressure(t) == (both ? 3.0 : 1.0));
        ++(both ? under : beside);
    }
    REQUIRE(under == 2);
    REQUIRE(beside == 2);
    double share = 0;
    for (double const s : net.sources[2].shares) share += s;
    REQUIRE_THAT(share, WithinRel(1.0, 1e-14));
    for (auto const pore : net.sources[2].pores) {
        double least = 1e9;
        for (auto const& c : net.corner) least = std::min(least, b.x[std::size_t(c[std::size_t(pore)])][0]);
        REQUIRE(least <= 1);
    }
}

TEST_CASE("sources at points, and initial pressures") {
    auto const b = bodies::triangular(5, 6);
    auto net = b.network();
    // A point in the triangle of discs 0, 1 and the one above them, and a point far outside.
    auto const inside = find_pore(net, b.points(), point{1, 0.5});
    REQUIRE_THAT(norm(pore_middle(net, inside, b.points()) - point{1, 1 / std::sqrt(3.0)}), WithinAbs(0, 1e-12));
    auto const outside = find_pore(net, b.points(), point{-50, -50});
    for (std::size_t k = 0; k < net.pores(); ++k)
        REQUIRE(norm(pore_middle(net, outside, b.points()) - point{-50, -50}) <=
                norm(pore_middle(net, k, b.points()) - point{-50, -50}) + 1e-12);
    auto const s = hold_pressure_at(net, b.points(), "gauge", {1, 0.5}, 4.0);
    REQUIRE(net.sources[s].pores.front() == std::int32_t(inside));
    inject_at(net, b.points(), "well", {7, 5}, 0.5);
    set_pressures(net, b.points(), [](point const& at) { return 10 * at[1]; });
    auto p = body::settings<explicit_flow::solver<double, 2>>();
    p.initial_pressure = 1;
    explicit_flow::solver<double, 2> const flow(p, net, 1.0, b.points(), b.r.data());
    for (std::size_t k = 0; k < net.pores(); ++k)
        REQUIRE_THAT(flow.network().pressure[k], WithinRel(1 + 10 * pore_middle(net, k, b.points())[1], 1e-13));
    REQUIRE_THROWS_WITH(set_pressures(net, b.points(), [](point const&) { return std::nan(""); }),
                        contains_text("initial pressure of pore 0"));
    p.minimum_pressure = 0;
    set_pressures(net, b.points(), [](point const&) { return -3.0; });
    REQUIRE_THROWS_WITH((explicit_flow::solver<double, 2>(p, net, 1.0, b.points(), b.r.data())),
                        contains_text("initial pressure of pore 0 = -2: must be >= minimum_pressure"));
}

TEMPLATE_TEST_CASE("mass and energy balance with sources while the packing moves", "", explicit_flow, implicit_flow) {
    using solver = typename TestType::template solver<double, 2>;
    bool const tears = std::is_same_v<TestType, explicit_flow> && GENERATE(false, true);
    int const substeps = GENERATE(1, 3);
    auto p = body::settings<solver>();
    p.substeps = substeps;
    if (tears) p.minimum_pressure = -0.5;
    auto const rest = bodies::scattered(43, 6, 8, 0.75, 1.0);
    auto net = rest.network(flow_boundaries(reservoir("top", on_side{body_side::top}, 0.3),
                                            injection("bottom", on_side{body_side::bottom}, 0.02)));
    // Two in the same pore, and one more beside a pore that the bottom feeds.
    inject(net, "sink", 20, -0.01);
    inject(net, "well", 20, 0.004);
    hold_pressure(net, "gauge", 30, 0.2);
    REQUIRE(std::count(net.sources[1].pores.begin(), net.sources[1].pores.end(), 20) == 0);
    solver flow(p, net, 1.0, rest.points(), rest.r.data());
    auto b = rest;
    flow.refresh_apertures(b.records(), body::no_force);
    double const dt = 0.4 * flow_critical_time_step(flow.network(), p.bulk_modulus) * substeps;
    for (int step = 1; step < 200; ++step) {
        bodies::stir(b, rest, 0.01 * step);
        flow.set_source(4, 0.2 + 0.001 * step);
        auto const before = flow.network();
        auto const totals = flow.ledger();
        double const energy = flow.storage_energy();
        flow.template step<true>(b.records(), body::no_force, dt);
        auto const& now = flow.network();
        double content = 0, came = 0;
        for (std::size_t k = 0; k < now.pores(); ++k)
            content += now.volume[k] - before.volume[k] - (now.vapour_of(k) - before.vapour_of(k)) +
                       (substeps == 1 ? now.volume[k] * (now.pressure[k] - before.pressure[k]) / p.bulk_modulus : 0);
        for (std::size_t s = 0; s < 5; ++s) came += now.sources[s].volume - before.sources[s].volume;
        double const gross = flow.ledger().gross_volume;
        if (substeps == 1) REQUIRE_THAT(content - came, WithinAbs(0, 1e-12 * gross));
        REQUIRE_THAT(flow.ledger().mass_residual, WithinAbs(0, 1e-12 * gross));
        REQUIRE_THAT(flow.ledger().boundary_inflow - totals.boundary_inflow, WithinAbs(came, 1e-12 * gross));
        REQUIRE(now.pressure[30] == 0.2 + 0.001 * step);
        REQUIRE_THAT(now.sources[1].rate, WithinRel(0.02, 1e-8));
        REQUIRE_THAT(now.sources[2].rate, WithinRel(-0.01, 1e-8));
        auto const& l = flow.ledger();
        double const gained = (l.reservoir_work - totals.reservoir_work) - (l.dissipation - totals.dissipation) -
                              (l.pressure_work - totals.pressure_work) + (l.vapour_work - totals.vapour_work) +
                              (l.prefactor_work - totals.prefactor_work);
        REQUIRE_THAT(flow.storage_energy() - energy, WithinAbs(gained, 1e-11 * (1 + energy)));
    }
    // The forces are those of the pressures after the exchange with the sources.
    std::vector<point> expected(rest.x.size());
    for (std::size_t k = 0; k < flow.network().pores(); ++k) {
        auto const push = flow.pore_tractions(k, b.points(), b.r.data());
        for (std::size_t c = 0; c < 3; ++c)
            expected[std::size_t(flow.network().corner[c][k])] += push[c] * flow.network().pressure[k];
    }
    auto const force = b.tractions(flow);
    for (std::size_t i = 0; i < expected.size(); ++i) REQUIRE_THAT(norm(force[i] - expected[i]), WithinAbs(0, 1e-11));
}

TEST_CASE("boundaries out of range are refused by name") {
    auto const b = bodies::triangular(4, 5);
    REQUIRE_THROWS_WITH(reservoir("top", on_side{body_side::top}, std::nan("")), contains_text("flow source top"));
    REQUIRE_THROWS_WITH(injection("top", on_side{body_side::top}, INFINITY), contains_text("flow source top"));
    auto const nowhere = [](auto const&) { return false; };
    REQUIRE_THROWS_WITH(b.network(flow_boundaries(reservoir("nowhere", nowhere, 0.0))),
                        contains_text("flow source = nowhere: must be at some throat of the boundary"));
    auto net = b.network(flow_boundaries(reservoir("top", on_side{body_side::top}, 1.0)));
    REQUIRE_THROWS_WITH(inject(net, "well", net.pores(), 1.0), contains_text("pore of flow source well"));
    REQUIRE_THROWS_WITH(hold_pressure(net, "well", 0, INFINITY), contains_text("flow source well"));
    REQUIRE_THROWS_WITH(inject_at(net, b.points(), "well", {std::nan(""), 0}, 1.0), contains_text("point = nan"));
    using solver = explicit_flow::solver<double, 2>;
    auto const p = body::settings<solver>();
    solver flow(p, net, 1.0, b.points(), b.r.data());
    REQUIRE_THROWS_WITH(flow.set_source(1, 0.0), contains_text("flow source = 1: must be a source of the network"));
    REQUIRE_THROWS_WITH(flow.set_source(0, std::nan("")), contains_text("flow source top = nan"));
    REQUIRE_THROWS_WITH(flow.set_pressure(net.pores(), 0.0), contains_text("must be a pore of the network"));
    REQUIRE_THROWS_WITH(flow.set_pressure(0, std::nan("")), contains_text("pressure of pore 0 = nan"));
    auto twice = net;
    hold_pressure(twice, "one", 3, 0.0);
    hold_pressure(twice, "other", 3, 0.0);
    REQUIRE_THROWS_WITH(solver(p, twice, 1.0, b.points(), b.r.data()), contains_text("flow source = other"));
    inject(net, "top", 3, 0.0);
    REQUIRE_THROWS_WITH(solver(p, net, 1.0, b.points(), b.r.data()), contains_text("a name given once"));
    REQUIRE_THROWS_WITH(make_bare_network<double>({1}, {{0, -1, 1, 1, 0.0, 2}}, {pressure_source("x", 0)}),
                        contains_text("source of a throat = 2"));
    auto low = p;
    low.minimum_pressure = -1;
    auto held = b.network();
    hold_pressure(held, "deep", 3, -2.0);
    REQUIRE_THROWS_WITH(solver(low, held, 1.0, b.points(), b.r.data()),
                        contains_text("flow source deep = -2: must be >= minimum_pressure"));
}
