// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>

using namespace lacuna;

namespace {

using solver = explicit_flow_with<constant_aperture>::solver<double, 2>;
using throats = std::vector<bare_throat<double>>;

/// Bare pores with K_f = 1 and k = 1: C = a^3 / l, and tau = V / C.
solver make_solver(std::vector<double> const& volumes, throats const& list) {
    solver::parameters p;
    p.bulk_modulus = 1;
    p.conductivity = 1;
    return {p, make_bare_network(volumes, list)};
}

throats line_of(int count) {
    throats list;
    for (int i = 0; i + 1 < count; ++i) list.push_back({i, i + 1, 1, 1});
    return list;
}

throats ring_of(std::vector<double> const& apertures) {
    throats list;
    int const n = int(apertures.size());
    for (int i = 0; i < n; ++i) list.push_back({i, (i + 1) % n, 1, apertures[std::size_t(i)]});
    return list;
}

/// Largest error against the reference after time t, in steps of dt.
double error_of(solver flow, double t, double dt, std::vector<double> const& expected) {
    int const steps = int(std::lround(t / dt));
    for (int i = 0; i < steps; ++i) flow.advance(dt);
    double error = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        error = std::max(error, std::fabs(flow.network().pressure[i] / expected[i] - 1));
    return error;
}

/// Largest pressure after `steps` steps, from alternating pressures: the fastest mode of a line or ring.
double growth(solver flow, double dt, int steps) {
    for (std::size_t i = 0; i < flow.network().pores(); ++i) flow.set_pressure(i, i % 2 ? -1 : 1);
    for (int s = 0; s < steps; ++s) flow.advance(dt);
    double largest = 0;
    for (double const p : flow.network().pressure) largest = std::max(largest, std::fabs(p));
    return largest;
}

} // namespace

TEST_CASE("a sealed pulse spreads along a line of pores") {
    auto flow = make_solver(std::vector<double>(10, 1.0), line_of(10));
    flow.set_pressure(0, 1);
    // Forward Euler's error is dt lambda^2 t / 2 per mode. At t = 1 it is large relative to the tiny pressures of far
    // pores, so that time is run in finer steps.
    REQUIRE(error_of(flow, 1, 1e-5, reference_list("5a.sealed_pulse_t=1")) < 1e-3);
    REQUIRE(error_of(flow, 5, 1e-4, reference_list("5a.sealed_pulse_t=5")) < 1e-3);
    REQUIRE(error_of(flow, 20, 1e-3, reference_list("5a.sealed_pulse_t=20")) < 1e-4);
    for (std::string const t : {"1", "5", "20"}) {
        auto const expected = reference_list("5a.sealed_pulse_t=" + t);
        auto run = flow;
        for (int i = 0; i < 1000 * std::stoi(t); ++i) run.advance(1e-3);
        for (std::size_t i = 0; i < 10; ++i) REQUIRE_THAT(run.network().pressure[i], WithinAbs(expected[i], 2e-4));
    }
}

TEST_CASE("the scheme is of first order in time") {
    auto flow = make_solver(std::vector<double>(10, 1.0), line_of(10));
    flow.set_pressure(0, 1);
    auto const expected = reference_list("5a.sealed_pulse_t=5");
    double const coarse = error_of(flow, 5, 4e-3, expected), middle = error_of(flow, 5, 2e-3, expected),
                 fine = error_of(flow, 5, 1e-3, expected);
    REQUIRE_THAT(std::log2(coarse / middle), WithinAbs(1, 0.02));
    REQUIRE_THAT(std::log2(middle / fine), WithinAbs(1, 0.02));
}

TEST_CASE("twenty steps of forward Euler, all flows from the old pressures") {
    auto flow = make_solver(std::vector<double>(10, 1.0), line_of(10));
    flow.set_pressure(0, 1);
    for (int i = 0; i < 20; ++i) flow.advance(0.25);
    auto const expected = reference_list("5a.sealed_pulse_FE_dt0.25_n20");
    // Beyond the reference's twelve digits: the same scheme with exact binary fractions, by hand.
    std::vector<double> p(10, 0.0);
    p[0] = 1;
    for (int i = 0; i < 20; ++i) {
        auto const old = p;
        for (std::size_t k = 0; k < 10; ++k) {
            if (k > 0) p[k] += 0.25 * (old[k - 1] - old[k]);
            if (k < 9) p[k] += 0.25 * (old[k + 1] - old[k]);
        }
    }
    for (std::size_t k = 0; k < 10; ++k) {
        REQUIRE_THAT(flow.network().pressure[k], WithinRel(expected[k], 3e-12));
        REQUIRE_THAT(flow.network().pressure[k], WithinRel(p[k], 1e-14));
    }
}

TEST_CASE("a line of pores drains through its end") {
    auto list = line_of(10);
    list.push_back({9, -1, 1, 1});
    auto flow = make_solver(std::vector<double>(10, 1.0), list);
    for (std::size_t i = 0; i < 10; ++i) flow.set_pressure(i, 1);
    REQUIRE(error_of(flow, 20, 1e-3, reference_list("5a.drained_right_t=20")) < 1e-4);
    REQUIRE(flow.network().location[9] == pore_location::drained);
    REQUIRE(flow.network().location[0] == pore_location::interior);
}

TEST_CASE("a reservoir fills the pores to its pressure and no further") {
    auto list = line_of(4);
    list.push_back({0, -1, 2, 1.3, 5.0});
    auto flow = make_solver({1, 2, 0.5, 1}, list);
    double const dt = flow.critical_time_step();
    for (int i = 0; i < 5000; ++i) {
        flow.advance(dt);
        for (double const p : flow.network().pressure) REQUIRE((p >= 0 && p <= 5 * (1 + 1e-14)));
    }
    for (double const p : flow.network().pressure) REQUIRE_THAT(p, WithinRel(5.0, 1e-9));
    // 4.5 m^3 of pores at K_f = 1 Pa took 5 Pa each.
    REQUIRE_THAT(flow.ledger().boundary_inflow, WithinRel(22.5, 1e-9));
    REQUIRE_THAT(flow.storage_energy(), WithinRel(4.5 * 25 / 2, 1e-9));
    REQUIRE_THAT(flow.ledger().reservoir_work, WithinRel(5 * 22.5, 1e-9));
    // Half of the work of a constant pressure is dissipated.
    REQUIRE_THAT(flow.ledger().dissipation, WithinRel(4.5 * 25 / 2, 1e-8));
}

TEST_CASE("time step limits of a line of pores") {
    auto const flow = make_solver(std::vector<double>(10, 1.0), line_of(10));
    double const limit = reference("5b.stability_line", "dt_true/tau");
    REQUIRE_THAT(flow.critical_time_step(), WithinRel(reference("5b.stability_line", "dt_eq19/tau (N=2)"), 1e-14));
    REQUIRE_THAT(flow.mean_throat_limit(), WithinRel(reference("5b.stability_line", "dt_eq19/tau (N=2)"), 1e-14));
    REQUIRE(growth(flow, 0.999 * limit, 20000) <= 1.3);
    REQUIRE(growth(flow, 1.001 * limit, 20000) > 1e3);
}

TEST_CASE("time step limits of rings, and of unequal apertures") {
    std::string const id = "5b.dt_eq19_vs_true";
    auto const equal = make_solver(std::vector<double>(6, 1.0), ring_of(std::vector<double>(6, 1.0)));
    REQUIRE_THAT(equal.critical_time_step(), WithinRel(reference(id, "ring of 6", 0), 1e-14));
    REQUIRE_THAT(equal.mean_throat_limit(), WithinRel(reference(id, "ring of 6", 0), 1e-14));
    REQUIRE(growth(equal, 0.999 * reference(id, "ring of 6", 1), 20000) <= 1.0);
    REQUIRE(growth(equal, 1.001 * reference(id, "ring of 6", 1), 20000) > 1e3);

    std::string const name = "ring of 6, apertures (1,2,1,3,1,2)";
    auto const unequal = make_solver(std::vector<double>(6, 1.0), ring_of({1, 2, 1, 3, 1, 2}));
    REQUIRE_THAT(unequal.critical_time_step(), WithinRel(reference(id, name, "min_i V/(K_f sum C)"), 1e-10));
    REQUIRE(growth(unequal, unequal.critical_time_step(), 20000) <= 1.0);
    REQUIRE(growth(unequal, 0.999 * reference(id, name, "true 2/lambda_max"), 20000) <= 2.0);
    REQUIRE(growth(unequal, 1.001 * reference(id, name, "true 2/lambda_max"), 20000) > 1e3);
    // The pore between apertures 1 and 3: a = 2, N = 2, so V / (2 * 8); beyond the true limit.
    REQUIRE_THAT(unequal.mean_throat_limit(), WithinRel(1.0 / 16, 1e-14));
    REQUIRE(growth(unequal, unequal.mean_throat_limit(), 100) > 1e3);
}

TEST_CASE("volumes, lengths and constants enter the limits as they should") {
    solver::parameters p;
    p.bulk_modulus = 2e9;
    p.conductivity = 1e-9;
    // C = 1e-9 * 8e-18 / 4e-6 = 2e-21; both throats at pore 0: V / (K_f 2 C) = 3e-18 / 8e-12.
    solver const flow(p, make_bare_network<double>({3e-18, 5e-18}, {{0, 1, 4e-6, 2e-6}, {0, -1, 4e-6, 2e-6}}));
    REQUIRE_THAT(flow.network().conductance[0], WithinRel(2e-21, 1e-13));
    REQUIRE_THAT(flow.critical_time_step(), WithinRel(3.75e-7, 1e-13));
    REQUIRE_THAT(flow.mean_throat_limit(), WithinRel(3.75e-7, 1e-13));
    solver const still(p, make_bare_network<double>({1e-18}, {}));
    REQUIRE(still.critical_time_step() == std::numeric_limits<double>::infinity());
}

TEST_CASE("conductivity of a honeycomb of pores is the same in both directions") {
    double const expected = reference("5c.honeycomb_conductivity", "K/C (isotropic)");
    auto const settle = [](solver flow) {
        double const dt = flow.critical_time_step();
        for (int i = 0; i < 4000; ++i) flow.advance(dt);
        double in = 0, out = 0;
        auto const& net = flow.network();
        for (std::size_t t = net.interior_throats; t < net.throats(); ++t)
            (net.reservoir_pressure(t) > 0 ? in : out) += net.flow[t];
        REQUIRE_THAT(in, WithinRel(-out, 1e-9));
        return in;
    };
    int const rows = 6, columns = 4;

    // Along one direction of edges: rows of zigzags joined by upright edges. Each column begins and ends with an
    // upright edge to a reservoir. A column is sqrt(3) edge lengths wide; `rows` zigzags of height 1/2 and rows + 1
    // upright edges of height 1 lie above each other.
    auto const low = [](int r, int c) { return 2 * (r * columns + (c + columns) % columns); };
    throats upright;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            int const bottom = low(r, c), top = bottom + 1;
            upright.push_back({bottom, top, 1, 1});
            upright.push_back({low(r, c + 1), top, 1, 1});
            if (r + 1 < rows) upright.push_back({top, low(r + 1, c), 1, 1});
            if (r == 0) upright.push_back({bottom, -1, 1, 1, 1.0});
            if (r + 1 == rows) upright.push_back({top, -1, 1, 1, 0.0});
        }
    double const along = settle(make_solver(std::vector<double>(std::size_t(2 * rows * columns), 1.0), upright));
    double const height = rows + 1 + 0.5 * rows, width = std::sqrt(3.0) * columns;
    REQUIRE_THAT(along * height / width, WithinRel(expected, 1e-8));

    // Across it: zigzag chains, sqrt(3)/2 per edge, 1.5 apart, joined by cross edges without flow.
    int const chains = 4, links = 12;
    auto const at = [](int c, int k) { return (c + chains) % chains * links + k; };
    throats across;
    for (int c = 0; c < chains; ++c)
        for (int k = 0; k < links; ++k) {
            if (k + 1 < links) across.push_back({at(c, k), at(c, k + 1), 1, 1});
            if ((c + k) % 2 == 0) across.push_back({at(c, k), at(c + 1, k), 1, 1});
            if (k == 0) across.push_back({at(c, k), -1, 1, 1, 1.0});
            if (k + 1 == links) across.push_back({at(c, k), -1, 1, 1, 0.0});
        }
    double const through = settle(make_solver(std::vector<double>(std::size_t(chains * links), 1.0), across));
    REQUIRE_THAT(through * (links + 1) * std::sqrt(0.75) / (1.5 * chains), WithinRel(expected, 1e-8));
}

TEST_CASE("an infinite honeycomb's limit is a third, and eq. 19 says so") {
    // The complete bipartite net of three and three pores: every pore has three neighbours, lambda_max = 6.
    throats list;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) list.push_back({a, 3 + b, 1, 1});
    auto flow = make_solver(std::vector<double>(6, 1.0), list);
    double const limit = reference("5b.dt_eq19_vs_true", "honeycomb (triangular pores, periodic)", 1);
    REQUIRE_THAT(flow.critical_time_step(), WithinRel(limit, 1e-11));
    REQUIRE_THAT(flow.mean_throat_limit(),
                 WithinRel(reference("5b.dt_eq19_vs_true", "honeycomb (triangular pores, periodic)", 0), 1e-11));
    for (std::size_t i = 0; i < 6; ++i) flow.set_pressure(i, i < 3 ? 1 : -1);
    auto stable = flow, unstable = flow;
    for (int i = 0; i < 10000; ++i) {
        stable.advance(0.999 * limit);
        unstable.advance(1.001 * limit);
    }
    REQUIRE(std::fabs(stable.network().pressure[0]) < 1);
    REQUIRE(std::fabs(unstable.network().pressure[0]) > 1e3);
}

TEST_CASE("sealed pores keep their fluid to rounding") {
    std::mt19937_64 engine(23);
    auto const uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
    std::vector<double> volumes;
    for (int i = 0; i < 50; ++i) volumes.push_back(0.5 + uniform());
    throats list;
    for (int i = 0; i < 120; ++i) {
        int const a = int(50 * uniform()), b = int(50 * uniform());
        if (a != b) list.push_back({a, b, 0.5 + uniform(), 0.2 + uniform()});
    }
    auto flow = make_solver(volumes, list);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < 50; ++i) {
        flow.set_pressure(i, uniform());
        before += volumes[i] * flow.network().pressure[i];
    }
    double const energy = flow.storage_energy();
    for (int i = 0; i < 1000; ++i) {
        flow.advance(0.9 * flow.critical_time_step());
        REQUIRE_THAT(flow.ledger().mass_residual, WithinAbs(0, 1e-12));
    }
    for (std::size_t i = 0; i < 50; ++i) after += volumes[i] * flow.network().pressure[i];
    REQUIRE_THAT(after, WithinRel(before, 1e-13));
    REQUIRE(flow.ledger().dissipation > 0);
    REQUIRE_THAT(flow.storage_energy() + flow.ledger().dissipation, WithinRel(energy, 1e-12));
}

TEST_CASE("throats that let nothing through within the run are skipped and reported") {
    solver::parameters p;
    p.bulk_modulus = 1;
    p.conductivity = 1;
    p.skip_ratio = 100;
    // Step limits 2 / (C (1/V + 1/V)) = 1 / C: 1 for the first, 1000 for the second (a = 0.1), 125 for the reservoir.
    solver flow(p, make_bare_network<double>({1, 1, 1}, {{0, 1, 1, 1}, {1, 2, 1, 0.1}, {2, -1, 1, 0.2, 4.0}}));
    REQUIRE(flow.deactivate_slow_throats(11) == 0);
    REQUIRE(flow.deactivate_slow_throats(9) == 1);
    REQUIRE(flow.network().inactive[0] == 0);
    REQUIRE(flow.network().inactive[1] == 1);
    // The reservoir throat has one pore: 2 / (0.008 * 1) = 250.
    REQUIRE(flow.network().inactive[2] == 0);
    REQUIRE(flow.deactivate_slow_throats(2) == 2);
    flow.set_pressure(1, 1);
    flow.advance(0.25);
    REQUIRE_THAT(flow.network().pressure[0], WithinRel(0.25, 1e-15));
    REQUIRE(flow.network().pressure[2] == 0);
    REQUIRE_THAT(flow.critical_time_step(), WithinRel(1.0, 1e-15));
    REQUIRE(flow.deactivate_slow_throats(1e-9) == 3);
    REQUIRE(flow.critical_time_step() == std::numeric_limits<double>::infinity());
    REQUIRE_THROWS_WITH(flow.deactivate_slow_throats(0.0), contains_text("duration"));

    p.skip_ratio = std::numeric_limits<double>::infinity();
    solver all(p, make_bare_network<double>({1, 1}, {{0, 1, 1, 1e-3}}));
    REQUIRE(all.deactivate_slow_throats(1e-12) == 0);
}

TEST_CASE("parameters and bare networks out of range are refused by name") {
    explicit_flow::parameters p;
    REQUIRE_NOTHROW(p.validate("flow"));
    auto const refused = [&](auto change, std::string const& text) {
        auto bad = p;
        change(bad);
        REQUIRE_THROWS_WITH(bad.validate("flow"), contains_text(text));
    };
    refused([](auto& q) { q.bulk_modulus = 0; }, "flow.bulk_modulus = 0: must be > 0");
    refused([](auto& q) { q.conductivity = -1; }, "flow.conductivity");
    refused([](auto& q) { q.minimum_volume_fraction = 0; }, "flow.minimum_volume_fraction");
    refused([](auto& q) { q.minimum_pressure = 1; }, "flow.minimum_pressure");
    refused([](auto& q) { q.minimum_pressure = -1, q.initial_pressure = -2; }, "flow.initial_pressure");
    refused([](auto& q) { q.skip_ratio = 0; }, "flow.skip_ratio");
    refused([](auto& q) { q.aperture.gap_factor = 2; }, "flow.aperture.gap_factor");
    std::vector<vec<double, 2>> const none;
    REQUIRE_THROWS_WITH((explicit_flow::solver<double, 2>(p, make_bare_network<double>({1}, {}), std::nan(""),
                                                          view_points(none), nullptr)),
                        contains_text("thickness"));
    REQUIRE_THROWS_WITH(make_bare_network<double>({1, -1}, {}), contains_text("volume of pore 1"));
    REQUIRE_THROWS_WITH(make_bare_network<double>({1, 1}, {{0, 2, 1, 1}}), contains_text("throat 0.second = 2"));
    REQUIRE_THROWS_WITH(make_bare_network<double>({1, 1}, {{1, 1, 1, 1}}), contains_text("throat 0.second = 1"));
    REQUIRE_THROWS_WITH(make_bare_network<double>({1, 1}, {{0, 1, 0, 1}}), contains_text("throat 0.length"));
}

TEST_CASE("flow policies fit their slot") {
    REQUIRE(flow_policy<explicit_flow>);
    REQUIRE(flow_policy<explicit_flow_with<constant_aperture>>);
    REQUIRE(flow_policy<no_flow>);
    REQUIRE_FALSE(flow_policy<constant_aperture>);
}
