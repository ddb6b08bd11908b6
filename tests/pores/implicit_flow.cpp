// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "reference.hpp"

#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>

using namespace lacuna;
using bodies::body;
using bodies::uniform;

namespace {

using bare_solver = implicit_flow_with<constant_aperture>::solver<double, 2>;
using implicit_solver = implicit_flow::solver<double, 2>;
using explicit_solver = explicit_flow::solver<double, 2>;
using throats = std::vector<bare_throat<double>>;

/// Bare pores with K_f = 1 and k = 1: C = a^3 / l, and tau = V / C.
bare_solver make_bare(std::vector<double> const& volumes, throats const& list, double tolerance = 0.2) {
    bare_solver::parameters p;
    p.bulk_modulus = p.conductivity = 1;
    p.factorisation_tolerance = tolerance;
    return {p, make_bare_network(volumes, list)};
}

throats line_of(int count) {
    throats list;
    for (int i = 0; i + 1 < count; ++i) list.push_back({i, i + 1, 1, 1});
    return list;
}

/// Solves a full system by Gaussian elimination with pivoting.
std::vector<double> eliminate(std::vector<std::vector<double>> a, std::vector<double> b) {
    std::size_t const n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t best = k;
        for (std::size_t i = k; i < n; ++i)
            if (std::fabs(a[i][k]) > std::fabs(a[best][k])) best = i;
        std::swap(a[k], a[best]);
        std::swap(b[k], b[best]);
        for (std::size_t i = k + 1; i < n; ++i) {
            double const f = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

/// Backward Euler's new pressures from the definition.
template <class Network>
std::vector<double> by_elimination(Network const& before, Network const& after, double bulk_modulus, double dt) {
    std::size_t const n = before.pores();
    std::vector<std::vector<double>> a(n, std::vector<double>(n, 0.0));
    std::vector<double> b(n);
    for (std::size_t i = 0; i < n; ++i) {
        a[i][i] = after.volume[i] / bulk_modulus;
        b[i] = a[i][i] * before.pressure[i] - (after.volume[i] - before.volume[i]);
    }
    for (std::size_t t = 0; t < after.open_throats(); ++t) {
        auto const i = std::size_t(after.throat_pore[0][t]);
        double const leak = dt * after.conductance[t];
        a[i][i] += leak;
        if (t < after.interior_throats) {
            auto const j = std::size_t(after.throat_pore[1][t]);
            a[j][j] += leak;
            a[i][j] -= leak;
            a[j][i] -= leak;
        } else {
            b[i] += leak * after.reservoir_pressure(t);
        }
    }
    return eliminate(a, b);
}

double error_at_5(int steps) {
    auto flow = make_bare(std::vector<double>(10, 1.0), line_of(10));
    flow.set_pressure(0, 1);
    for (int i = 0; i < steps; ++i) flow.advance(5.0 / steps);
    auto const expected = reference_list("5a.sealed_pulse_t=5");
    double error = 0;
    for (std::size_t i = 0; i < 10; ++i)
        error = std::max(error, std::fabs(flow.network().pressure[i] / expected[i] - 1));
    return error;
}

constexpr auto drained_top = [](auto const& throat) -> throat_boundary<double> {
    return {throat.side == body_side::top ? boundary_kind::drained : boundary_kind::sealed, 0.3};
};

/// Flow in a packing stirred for 1 s in a number of steps, always from the same pressures.
template <class Solver>
Solver stirred(int steps, typename Solver::parameters const& p, int threads = 1) {
    auto const rest = bodies::scattered(71, 6, 8, 0.7, 0.95);
    auto flow = rest.flow<Solver>(p, drained_top);
    std::mt19937_64 engine(9);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
    auto b = rest;
    for (int s = 1; s <= steps; ++s) {
        bodies::stir(b, rest, double(s) / steps, 0.002);
        flow.template step<true>(b.records(), body::no_force, 1.0 / steps, threads);
    }
    return flow;
}

} // namespace

TEST_CASE("implicit: a pulse in a line converges to the matrix exponential at first order") {
    double const coarse = error_at_5(500), middle = error_at_5(1000), fine = error_at_5(2000);
    REQUIRE(fine < 2e-3);
    REQUIRE_THAT(std::log2(coarse / middle), WithinAbs(1, 0.02));
    REQUIRE_THAT(std::log2(middle / fine), WithinAbs(1, 0.02));

    auto list = line_of(10);
    list.push_back({9, -1, 1, 1});
    auto flow = make_bare(std::vector<double>(10, 1.0), list);
    for (std::size_t i = 0; i < 10; ++i) flow.set_pressure(i, 1);
    for (int i = 0; i < 20000; ++i) flow.advance(1e-3);
    auto const expected = reference_list("5a.drained_right_t=20");
    for (std::size_t i = 0; i < 10; ++i) REQUIRE_THAT(flow.network().pressure[i], WithinRel(expected[i], 1e-4));
}

TEST_CASE("implicit: a step is the solution of its equations") {
    auto const tolerance = GENERATE(0.0, 0.5);
    auto p = body::settings<implicit_solver>();
    p.factorisation_tolerance = tolerance;
    auto const rest = bodies::scattered(72, 5, 7, 0.6, 1.0);
    auto flow = rest.flow<implicit_solver>(p, drained_top);
    std::mt19937_64 engine(2);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
    auto b = rest;
    for (int s = 1; s <= 20; ++s) {
        auto const before = flow.network();
        bodies::stir(b, rest, 0.1 * s);
        double const dt = 30 * flow_critical_time_step(before, p.bulk_modulus);
        flow.step<true>(b.records(), body::no_force, dt);
        auto const expected = by_elimination(before, flow.network(), p.bulk_modulus, dt);
        double largest = 0;
        for (double const q : expected) largest = std::max(largest, std::fabs(q));
        for (std::size_t k = 0; k < expected.size(); ++k)
            REQUIRE_THAT(flow.network().pressure[k], WithinAbs(expected[k], 1e-9 * largest));
        for (std::size_t t = 0; t < before.open_throats(); ++t) {
            auto const& net = flow.network();
            double const far = t < net.interior_throats ? expected[std::size_t(net.throat_pore[1][t])] : 0.3;
            double const q = net.conductance[t] * (far - expected[std::size_t(net.throat_pore[0][t])]);
            REQUIRE_THAT(net.flow[t], WithinAbs(q, 1e-9 * largest * net.conductance[t]));
        }
        REQUIRE(flow.solver_residual() < 1e-10);
    }
}

TEST_CASE("implicit and explicit agree as the step shrinks, at first order") {
    auto const p = body::settings<explicit_solver>();
    auto const q = body::settings<implicit_solver>();
    auto const apart = [&](int steps) {
        auto const one = stirred<explicit_solver>(steps, p);
        auto const other = stirred<implicit_solver>(steps, q);
        double most = 0;
        for (std::size_t k = 0; k < one.network().pores(); ++k)
            most = std::max(most, std::fabs(one.network().pressure[k] - other.network().pressure[k]));
        return most;
    };
    auto const flow = stirred<explicit_solver>(1, p);
    int const least = int(2 / flow.critical_time_step()) + 1;
    double const coarse = apart(least), middle = apart(2 * least), fine = apart(4 * least);
    INFO(least << " steps and more: " << coarse << ", " << middle << ", " << fine << " Pa apart");
    REQUIRE_THAT(std::log2(coarse / middle), WithinAbs(1, 0.1));
    REQUIRE_THAT(std::log2(middle / fine), WithinAbs(1, 0.05));
}

TEST_CASE("implicit: mass and energy balance in every step of a moving packing, however long") {
    double const times = GENERATE(0.5, 30.0, 1e3, 1e6);
    auto p = body::settings<implicit_solver>();
    auto const rest = bodies::scattered(41, 9, 12, 0.75, 1.05);
    auto flow = rest.flow<implicit_solver>(p, drained_top);
    auto b = rest;
    std::mt19937_64 engine(3);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
    for (int step = 1; step < 60; ++step) {
        bodies::stir(b, rest, 0.01 * step);
        double const dt = times * flow_critical_time_step(flow.network(), p.bulk_modulus);
        auto const before = flow.network();
        auto const totals = flow.ledger();
        double const energy = flow.storage_energy();
        flow.step<true>(b.records(), body::no_force, dt);
        auto const& net = flow.network();
        double content = 0, gross = 0, inflow = 0;
        for (std::size_t k = 0; k < net.pores(); ++k) {
            double const grown = net.volume[k] - before.volume[k];
            content += net.volume[k] * (net.pressure[k] - before.pressure[k]) / p.bulk_modulus + grown;
            gross += std::fabs(grown);
        }
        for (std::size_t t = 0; t < net.open_throats(); ++t) {
            gross += std::fabs(net.flow[t]) * dt;
            if (t >= net.interior_throats) inflow += net.flow[t] * dt;
        }
        REQUIRE_THAT(content - inflow, WithinAbs(0, 1e-12 * gross));
        REQUIRE_THAT(flow.ledger().mass_residual, WithinAbs(0, 1e-12 * gross));
        REQUIRE_THAT(flow.ledger().gross_volume, WithinRel(gross, 1e-10));
        auto const& l = flow.ledger();
        double const parts[] = {l.reservoir_work - totals.reservoir_work, l.dissipation - totals.dissipation,
                                l.pressure_work - totals.pressure_work, l.prefactor_work - totals.prefactor_work};
        REQUIRE_THAT(flow.storage_energy() - energy,
                     WithinAbs(parts[0] - parts[1] - parts[2] + parts[3],
                               1e-12 * (energy + std::fabs(parts[0]) + std::fabs(parts[1]) + std::fabs(parts[2]))));
    }
}

TEST_CASE("implicit: a rigid network is analysed and factorised once") {
    auto list = line_of(30);
    list.push_back({0, -1, 1, 1, 2.0});
    auto flow = make_bare(std::vector<double>(30, 1.0), list, 0.0);
    for (int i = 0; i < 50; ++i) flow.advance(3.0);
    REQUIRE(flow.solver_counters().analyses == 1);
    REQUIRE(flow.solver_counters().factorisations == 1);
    // With an exact factorisation a step takes one iteration.
    REQUIRE(flow.solver_counters().iterations == 50);
    flow.advance(4.0);
    REQUIRE(flow.solver_counters().factorisations == 2);
    flow.restore(flow.network(), flow.ledger());
    REQUIRE(flow.solver_counters().analyses == 1);
    flow.restore(make_bare(std::vector<double>(3, 1.0), line_of(3)).network(), {});
    flow.advance(4.0);
    REQUIRE(flow.solver_counters().analyses == 2);
    REQUIRE(flow.solver_counters().factorisations == 3);
}

TEST_CASE("implicit: coefficients are factorised again after a change above the tolerance") {
    auto p = body::settings<implicit_solver>();
    p.factorisation_tolerance = 0.2;
    auto const rest = bodies::triangular(6, 8);
    auto flow = rest.flow<implicit_solver>(p);
    double const v0 = flow.network().volume[0];
    double const dt = 50 * flow_critical_time_step(flow.network(), p.bulk_modulus);
    flow.set_pressure(0, 1.0);
    auto b = rest;
    // At a strain e the gaps are 2 e, and conductances rise by (1 + 20 e)^3 / ...; volumes by a known amount.
    auto const stretch = [&](double e) {
        for (std::size_t i = 0; i < b.x.size(); ++i) b.x[i] = rest.x[i] * (1 + e);
        flow.step<true>(b.records(), body::no_force, dt);
        return flow.solver_counters().factorisations;
    };
    REQUIRE(stretch(0) == 1);
    // (1 + 2e/0.1)^3 = 1.197 at e = 0.00309: below the tolerance; the volume rises by less.
    REQUIRE(stretch(0.001) == 1);
    REQUIRE(stretch(0.00309) == 1);
    REQUIRE(flow.network().volume[0] < 1.2 * v0);
    REQUIRE(flow.solver_residual() < 1e-10);
    REQUIRE(flow.solver_counters().iterations > 3);
    // 1.203 at e = 0.00318.
    REQUIRE(stretch(0.00318) == 2);
    REQUIRE(stretch(0.00318) == 2);
    REQUIRE(flow.solver_counters().analyses == 1);
}

TEST_CASE("implicit: steps far above the explicit limit stay within the range of the pressures") {
    double const times = GENERATE(1.0, 1e3, 1e6);
    auto p = body::settings<implicit_solver>();
    auto const rest = bodies::scattered(37, 9, 12, 0.6, 0.9);
    auto flow = rest.flow<implicit_solver>(p, drained_top);
    std::mt19937_64 engine(5);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, 0.3 + uniform(engine));
    double const dt = times * flow_critical_time_step(flow.network(), p.bulk_modulus);
    double highest = 1.3, first = 0;
    for (int s = 0; s < 100; ++s) {
        flow.advance(dt);
        double most = 0;
        for (double const q : flow.network().pressure) {
            REQUIRE(q > 0.3 - 1e-9);
            most = std::max(most, q);
        }
        REQUIRE(most < highest + 1e-9);
        highest = most;
        if (s == 0) first = most;
    }
    REQUIRE(highest < first);
    if (times >= 1e3)
        for (double const q : flow.network().pressure) REQUIRE_THAT(q, WithinAbs(0.3, 1e-8));
    REQUIRE(flow.critical_time_step() == std::numeric_limits<double>::infinity());

    // The explicit scheme leaves the range even in steps of a thousandth of that.
    auto const fast = rest.flow<explicit_solver>(body::settings<explicit_solver>(), drained_top);
    REQUIRE(fast.critical_time_step() == flow_critical_time_step(flow.network(), p.bulk_modulus));
}

TEST_CASE("implicit: conductances that change by a factor of a million are followed") {
    // Apertures go from 0.1 to 10 and back: conductances change by a factor of a million between steps.
    auto p = body::settings<implicit_solver>();
    auto b = bodies::triangular(5, 6);
    auto const rest = b;
    auto flow = b.flow<implicit_solver>(p);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, double(k % 7));
    double const dt = flow_critical_time_step(flow.network(), p.bulk_modulus);
    for (int s = 0; s < 6; ++s) {
        for (std::size_t i = 0; i < b.x.size(); ++i) b.x[i] = rest.x[i] * (s % 2 ? 1 : 6);
        auto const before = flow.network();
        flow.step<true>(b.records(), body::no_force, dt);
        auto const expected = by_elimination(before, flow.network(), p.bulk_modulus, dt);
        for (std::size_t k = 0; k < expected.size(); ++k)
            REQUIRE_THAT(flow.network().pressure[k], WithinAbs(expected[k], 1e-6 * std::fabs(expected[k])));
        REQUIRE_THAT(flow.ledger().mass_residual, WithinAbs(0, 1e-12 * flow.ledger().gross_volume));
    }
    REQUIRE(flow.solver_counters().factorisations == 6);
}

TEST_CASE("implicit: tractions are those of the pressures, threads change no bit") {
    auto const p = body::settings<implicit_solver>();
    auto const one = stirred<implicit_solver>(20, p);
    auto rest = bodies::scattered(71, 6, 8, 0.7, 0.95);
    auto moved = rest;
    bodies::stir(moved, rest, 1.0, 0.002);
    auto const forces = moved.tractions(one);
    std::vector<bodies::point> expected(rest.x.size());
    for (std::size_t k = 0; k < one.network().pores(); ++k) {
        auto const push = one.pore_tractions(k, moved.points(), moved.r.data());
        for (std::size_t c = 0; c < 3; ++c)
            expected[std::size_t(one.network().corner[c][k])] += push[c] * one.network().pressure[k];
    }
    double largest = 0;
    for (auto const& f : expected) largest = std::max(largest, norm(f));
    REQUIRE(largest > 0.1);
    for (std::size_t i = 0; i < expected.size(); ++i)
        REQUIRE_THAT(norm(forces[i] - expected[i]), WithinAbs(0, 1e-12 * largest));
    for (int threads : {2, 3}) {
        auto const many = stirred<implicit_solver>(20, p, threads);
        REQUIRE(many.network().pressure == one.network().pressure);
        REQUIRE(many.ledger().dissipation == one.ledger().dissipation);
    }
}

TEST_CASE("implicit: single precision follows double") {
    auto const b = bodies::triangular(4, 5);
    std::vector<vec<float, 2>> x;
    std::vector<float> r(b.r.size(), 1.0f);
    for (auto const& y : b.x) x.push_back({float(y[0]), float(y[1])});
    implicit_flow_parameters<constant_aperture> p;
    p.bulk_modulus = 1000;
    p.conductivity = 1;
    p.aperture.aperture = 0.1;
    auto flow = implicit_flow_with<constant_aperture>::solver<double, 2>(p, b.network(), 1.0, b.points(), b.r.data());
    implicit_flow_with<constant_aperture>::solver<float, 2> single(
        p, make_pore_network(triangulate_body(view_points(x), r.data()), view_points(x), r.data()), 1.0f,
        view_points(x), r.data());
    REQUIRE(single.network().corner == flow.network().corner);
    flow.set_pressure(0, 1);
    single.set_pressure(0, 1);
    double const dt = 20 * flow_critical_time_step(flow.network(), 1000.0);
    float const none[4] = {0, 0, 0, 0};
    for (int s = 0; s < 10; ++s) {
        flow.step<true>(b.records(), body::no_force, dt);
        single.step<true>(b.records<float>(), none, float(dt));
    }
    for (std::size_t k = 0; k < flow.network().pores(); ++k)
        REQUIRE_THAT(double(single.network().pressure[k]), WithinAbs(flow.network().pressure[k], 1e-4));
}

TEST_CASE("implicit: parameters out of range are refused by name, and the policy fits its slot") {
    REQUIRE(flow_policy<implicit_flow>);
    REQUIRE(flow_policy<implicit_flow_with<constant_aperture>>);
    implicit_flow::parameters p;
    REQUIRE_NOTHROW(p.validate("flow"));
    auto const refused = [&](auto change, std::string const& text) {
        auto bad = p;
        change(bad);
        REQUIRE_THROWS_WITH(bad.validate("flow"), contains_text(text));
    };
    refused([](auto& q) { q.minimum_pressure = -1; }, "flow.minimum_pressure = -1: must be -infinity");
    refused([](auto& q) { q.factorisation_tolerance = 1; }, "flow.factorisation_tolerance = 1");
    refused([](auto& q) { q.factorisation_tolerance = -0.1; }, "flow.factorisation_tolerance");
    refused([](auto& q) { q.solver_tolerance = 0; }, "flow.solver_tolerance = 0");
    refused([](auto& q) { q.bulk_modulus = 0; }, "flow.bulk_modulus");
}
