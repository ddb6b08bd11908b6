// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <Eigen/Eigenvalues>

#include <lacuna/pores/flow/explicit_flow.hpp>

using namespace lacuna;
using bodies::body;
using bodies::uniform;

namespace {

using bare_solver = explicit_flow_with<constant_aperture>::solver<double, 2>;

bare_solver::parameters unit() {
    bare_solver::parameters p;
    p.bulk_modulus = p.conductivity = 1;
    return p;
}

/// 2 / lambda_max of the matrix K_f / V_i (sum_j C_ij (p_i - p_j)), from its symmetric form.
double exact_limit(pore_network<double, 2> const& net, double bulk_modulus) {
    auto const n = Eigen::Index(net.pores());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t t = 0; t < net.open_throats(); ++t) {
        auto const i = Eigen::Index(net.throat_pore[0][t]), j = Eigen::Index(net.throat_pore[1][t]);
        a(i, i) += net.conductance[t];
        if (j < 0) continue;
        a(j, j) += net.conductance[t];
        a(i, j) -= net.conductance[t];
        a(j, i) -= net.conductance[t];
    }
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            a(i, j) *= bulk_modulus / std::sqrt(net.volume[std::size_t(i)] * net.volume[std::size_t(j)]);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const solver(a, Eigen::EigenvaluesOnly);
    return 2 / solver.eigenvalues()[n - 1];
}

/// Largest magnitude of a pressure after a number of steps, from random pressures within +-1.
template <class Solver>
double growth(Solver flow, double dt, int steps) {
    std::mt19937_64 engine(77);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, 2 * uniform(engine) - 1);
    for (int s = 0; s < steps; ++s) flow.advance(dt);
    double most = 0;
    for (double const p : flow.network().pressure) most = std::max(most, std::fabs(p));
    return most;
}

} // namespace

TEST_CASE("the flow's step limit is below that of the exact eigenvalues, and eq. 19 is not") {
    int unsafe = 0;
    double closest = 0, farthest = 10;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        std::mt19937_64 engine(seed);
        std::vector<double> volumes;
        for (int i = 0; i < 40; ++i) volumes.push_back(0.2 + uniform(engine));
        std::vector<bare_throat<double>> list;
        for (int i = 0; i + 1 < 40; ++i) list.push_back({i, i + 1, 0.5 + uniform(engine), 0.2 + uniform(engine)});
        for (int k = 0; k < 25; ++k) {
            int const a = int(40 * uniform(engine)), b = int(40 * uniform(engine));
            if (a != b) list.push_back({a, b, 0.5 + uniform(engine), 0.2 + 2 * uniform(engine)});
        }
        for (int k = 0; k < 4; ++k) list.push_back({int(40 * uniform(engine)), -1, 1, 0.5 + uniform(engine)});
        bare_solver const flow(unit(), make_bare_network(volumes, list));
        double const exact = exact_limit(flow.network(), 1), ours = flow.critical_time_step();
        REQUIRE(ours <= exact * (1 + 1e-12));
        closest = std::max(closest, ours / exact);
        farthest = std::min(farthest, ours / exact);
        if (flow.mean_throat_limit() > exact) {
            ++unsafe;
            REQUIRE(growth(flow, 1.001 * exact, 20000) > 1);
        }
        REQUIRE(growth(flow, ours, 2000) <= 1);
    }
    INFO("ours over exact from " << farthest << " to " << closest << ", eq. 19 unsafe in " << unsafe << " of 40");
    REQUIRE(closest > 0.8);
    // Gershgorin's circle is at most twice too wide.
    REQUIRE(farthest >= 0.5 - 1e-12);
    REQUIRE(unsafe > 0);
}

TEST_CASE("one wide throat: eq. 19 with the mean aperture blows up, the rigorous limit holds") {
    // Two pores joined by apertures 2 and 0.1, 0.1, each pore with two narrow throats to further pores: mean 2.2 / 3.
    std::vector<bare_throat<double>> const list{{0, 1, 1, 2},   {0, 2, 1, 0.1}, {0, 3, 1, 0.1},
                                                {1, 4, 1, 0.1}, {1, 5, 1, 0.1}};
    bare_solver const flow(unit(), make_bare_network(std::vector<double>(6, 1.0), list));
    double const mean = 2.2 / 3;
    REQUIRE_THAT(flow.mean_throat_limit(), WithinRel(1 / (3 * mean * mean * mean), 1e-13));
    REQUIRE_THAT(flow.critical_time_step(), WithinRel(1 / 8.002, 1e-13));
    double const exact = exact_limit(flow.network(), 1);
    // The pair swings with 2 C / V = 16, slightly more for the narrow throats.
    REQUIRE_THAT(exact, WithinRel(1.0 / 8, 1e-3));
    REQUIRE(flow.mean_throat_limit() > 6 * exact);
    REQUIRE(growth(flow, flow.mean_throat_limit(), 30) > 1e10);
    REQUIRE(growth(flow, 1.001 * exact, 20000) > 1e6);
    REQUIRE(growth(flow, flow.critical_time_step(), 20000) <= 1);
}

TEST_CASE("the limit of the pores of a packing, with apertures from gaps") {
    auto const b = bodies::scattered(19, 8, 9, 0.7, 0.98);
    using solver = explicit_flow::solver<double, 2>;
    auto flow = b.flow<solver>(body::settings<solver>());
    flow.refresh_apertures(b.records(), body::no_force);
    double const exact = exact_limit(flow.network(), 1000);
    REQUIRE(flow.critical_time_step() <= exact);
    REQUIRE(flow.critical_time_step() >= 0.5 * exact);
    REQUIRE(growth(flow, flow.critical_time_step(), 5000) <= 1);
    REQUIRE(growth(flow, 1.01 * exact, 20000) > 1e3);
}

TEST_CASE("substeps give the same as as many steps of rigid pores") {
    auto p = unit();
    auto const net = make_bare_network<double>({1, 2, 3}, {{0, 1, 1, 1}, {1, 2, 1, 0.7}, {2, -1, 1, 0.5, 4.0}});
    bare_solver many(p, net);
    p.substeps = 5;
    bare_solver one(p, net);
    REQUIRE_THAT(one.critical_time_step(), WithinRel(5 * many.critical_time_step(), 1e-14));
    for (int s = 0; s < 20; ++s) {
        one.advance(0.5);
        for (int k = 0; k < 5; ++k) many.advance(0.1);
    }
    for (std::size_t k = 0; k < 3; ++k)
        REQUIRE_THAT(one.network().pressure[k], WithinRel(many.network().pressure[k], 1e-14));
    REQUIRE_THAT(one.ledger().dissipation, WithinRel(many.ledger().dissipation, 1e-13));
    REQUIRE_THAT(one.ledger().boundary_inflow, WithinRel(many.ledger().boundary_inflow, 1e-13));
    REQUIRE_THAT(one.network().sources[0].volume, WithinRel(many.network().sources[0].volume, 1e-13));
}

TEST_CASE("substeps take equal parts of the change of volume") {
    using solver = explicit_flow::solver<double, 2>;
    body b;
    b.x = {{0, 0}, {2, 0}, {1, std::sqrt(3.0)}, {3, std::sqrt(3.0)}};
    b.r.assign(4, 0.8);
    auto const pressed = [&](int substeps) {
        auto p = body::settings<solver>();
        p.substeps = substeps;
        auto flow = b.flow<solver>(p);
        double const before = flow.network().volume[0];
        auto moved = b;
        for (auto& x : moved.x) x = x * 1.1;
        flow.step<true>(moved.records(), body::no_force, 1e-9);
        double const after = flow.network().volume[0];
        // Both pores are alike, so nothing flows. By hand, from one volume to the next.
        double expected = 0;
        for (int k = 1; k <= substeps; ++k)
            expected -= 1000 * (after - before) / substeps / (before + (after - before) * k / substeps);
        REQUIRE_THAT(flow.network().pressure[0], WithinRel(expected, 1e-12));
        REQUIRE(flow.network().old_volume == flow.network().volume);
        REQUIRE_THAT(flow.ledger().mass_residual, WithinAbs(0, 1e-13 * flow.ledger().gross_volume));
        return flow.network().pressure[0] / std::log(after / before);
    };
    REQUIRE(std::fabs(pressed(1) / -1000 - 1) > 0.1);
    REQUIRE_THAT(pressed(2000), WithinRel(-1000.0, 1e-3));
}

TEST_CASE("as many substeps as are safe") {
    auto p = unit();
    std::vector<bare_throat<double>> list;
    for (int i = 0; i + 1 < 20; ++i) list.push_back({i, i + 1, 1, 0.5 + 0.1 * (i % 7)});
    auto const net = make_bare_network(std::vector<double>(20, 1.0), list);
    bare_solver const plain(p, net);
    double const dt = 50 * plain.critical_time_step();
    REQUIRE(growth(plain, dt, 10) > 1e10);
    p.substeps = 0;
    bare_solver const safe(p, net);
    REQUIRE(safe.critical_time_step() == std::numeric_limits<double>::infinity());
    REQUIRE(growth(safe, dt, 10) <= 1);
    p.substeps = 51;
    REQUIRE(growth(bare_solver(p, net), dt, 10) == growth(safe, dt, 10));
    auto far = safe;
    REQUIRE_THROWS_AS(far.advance(1e6 * dt), std::invalid_argument); // names the step and its limit
    REQUIRE_THROWS_WITH(far.advance(1e6 * dt),
                        contains_text("time_step = ") && contains_text("implicit flow needs one"));

    p.substeps = -1;
    REQUIRE_THROWS_WITH(p.validate("flow"), contains_text("flow.substeps = -1: must be from 0"));
    p.substeps = 1;
    p.interval = 0;
    REQUIRE_THROWS_WITH(p.validate("flow"), contains_text("flow.interval = 0: must be from 1"));
}

TEST_CASE("in a step of 0 s pressures follow volumes, and nothing flows") {
    using solver = explicit_flow::solver<double, 2>;
    auto const rest = bodies::scattered(13, 5, 6, 0.7, 0.95);
    auto flow = rest.flow<solver>(body::settings<solver>());
    std::mt19937_64 engine(3);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
    auto const before = flow.network();
    auto b = rest;
    bodies::stir(b, rest, 0.3);
    flow.step<true>(b.records(), body::no_force, 0);
    for (std::size_t k = 0; k < before.pores(); ++k) {
        double const v = flow.network().volume[k];
        REQUIRE(v != before.volume[k]);
        double const expected = before.pressure[k] - 1000 / v * (v - before.volume[k]);
        REQUIRE_THAT(flow.network().pressure[k], WithinAbs(expected, 1e-11));
    }
    REQUIRE(flow.ledger().dissipation == 0);
}
