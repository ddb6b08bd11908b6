// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

using namespace lacuna;
using point = vec<double, 2>;
using solver = explicit_flow::solver<double, 2>;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

solver::parameters parameters(double merge) {
    solver::parameters p;
    p.bulk_modulus = 1000;
    p.conductivity = 1;
    p.skip_ratio = infinity;
    p.aperture = {0.1, 1, 1};
    p.merge_conductance = merge;
    return p;
}

/// A line of bare pores: volumes, conductances between them (apertures of throats of length 1), a reservoir at its end.
solver line(std::vector<double> const& volumes, std::vector<double> const& conductances, double merge,
            double drain = 0, double reservoir = 0) {
    std::vector<bare_throat<double>> throats;
    for (std::size_t k = 0; k < conductances.size(); ++k)
        throats.push_back({std::int32_t(k), std::int32_t(k + 1), 1.0, std::cbrt(conductances[k])});
    if (drain > 0) throats.push_back({std::int32_t(volumes.size() - 1), -1, 1.0, std::cbrt(drain), reservoir});
    return {parameters(merge), make_bare_network<double>(volumes, throats)};
}

double content(solver const& flow) {
    auto const& net = flow.network();
    double sum = 0;
    for (std::size_t p = 0; p < net.pores(); ++p)
        sum += net.volume[p] * (1 + net.pressure[p] / flow.settings().bulk_modulus) - net.vapour_of(p);
    return sum;
}

/// Discs on a disturbed lattice, some apart, some overlapping.
struct body {
    std::vector<point> x;
    std::vector<double> r;
    body(std::uint64_t seed, int rows, int columns) {
        std::mt19937_64 engine(seed);
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                x.push_back({2 * j + (i % 2) + 0.4 * (uniform(engine) - 0.5),
                             std::sqrt(3.0) * i + 0.4 * (uniform(engine) - 0.5)});
                r.push_back(0.8 + 0.3 * uniform(engine));
            }
    }
    solver flow(solver::parameters const& p) const {
        auto const top = [](auto const& throat) -> throat_boundary<double> {
            return {throat.side == body_side::top ? boundary_kind::drained : boundary_kind::sealed, 0.3};
        };
        auto const points = view_points(x);
        return {p, make_pore_network(triangulate_body(points, r.data()), points, r.data(), top), 1.0, points, r.data()};
    }
    particle_column<double> records() const {
        particle_column<double> column;
        column.resize(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) {
            column.at(i, 0) = x[i][0];
            column.at(i, 1) = x[i][1];
            column.at(i, 3) = r[i];
        }
        return column;
    }
    static constexpr double no_force[4] = {0, 0, 0, 0};
};

} // namespace

TEST_CASE("two pores that join take the mean of their pressures, weighted with the volumes") {
    auto flow = line({0.5, 2.0, 1.0}, {10.0, 0.001}, 5.0);
    flow.set_pressure(0, 4);
    flow.set_pressure(1, -1);
    flow.set_pressure(2, 7);
    double const before = content(flow), energy = flow.storage_energy();
    REQUIRE(flow.clusters().clusters() == 1);
    REQUIRE(flow.clusters().label(1) == 0);
    REQUIRE(flow.clusters().label(2) == 2);
    flow.advance(0);
    // 9d: p_merged = sum V_i p_i / sum V_i
    REQUIRE_THAT(flow.network().pressure[0], WithinRel((0.5 * 4 - 2) / 2.5, 1e-15) || WithinAbs(0, 1e-15));
    REQUIRE(flow.network().pressure[0] == flow.network().pressure[1]);
    REQUIRE(flow.network().pressure[2] == 7);
    REQUIRE_THAT(content(flow), WithinRel(before, 1e-15));
    // The mixing costs V_1 V_2 (p_1 - p_2)^2 / (V_1 + V_2) / 2 K_f.
    REQUIRE_THAT(flow.ledger().dissipation, WithinRel(0.5 * 2 * 25 / 2.5 / 2000, 1e-14));
    REQUIRE_THAT(energy - flow.storage_energy(), WithinRel(flow.ledger().dissipation, 1e-12));
}

TEST_CASE("two merged pores empty into a reservoir like one of their volume") {
    // p = r + (p_0 - r) (1 - K_f C dt / V)^n for the volume of both, to rounding; and the step may be as long as V
    // allows.
    double const c = 0.01, r = 0.4;
    auto flow = line({0.5, 2.0}, {10.0}, 5.0, c, r);
    REQUIRE_THAT(flow.critical_time_step(), WithinRel(2.5 / (1000 * c), 1e-12));
    REQUIRE_THAT(line({0.5, 2.0}, {10.0}, infinity, c, r).critical_time_step(), WithinRel(0.5 / (1000 * 10), 1e-12));
    flow.set_pressure(0, 3);
    flow.set_pressure(1, 3);
    double const dt = 0.02, start = content(flow);
    for (int n = 1; n <= 50; ++n) {
        double const energy = flow.storage_energy();
        auto const old = flow.ledger();
        flow.advance(dt);
        auto const& now = flow.ledger();
        double const p = r + (3 - r) * std::pow(1 - 1000 * c * dt / 2.5, n);
        REQUIRE_THAT(flow.network().pressure[0], WithinRel(p, 1e-12));
        REQUIRE(flow.network().pressure[1] == flow.network().pressure[0]);
        REQUIRE_THAT(now.mass_residual, WithinAbs(0, 1e-15));
        REQUIRE_THAT(flow.storage_energy() - energy,
                     WithinAbs(now.reservoir_work - old.reservoir_work - (now.dissipation - old.dissipation), 1e-15));
    }
    REQUIRE_THAT(content(flow) - start, WithinRel(flow.ledger().boundary_inflow, 1e-10));
}

TEST_CASE("merging is the limit of a throat of ever larger conductance") {
    std::vector<double> const volumes{1, 0.7, 0.4, 1.3, 0.9};
    auto const run = [&](double middle, double merge, double dt) {
        auto flow = line(volumes, {0.003, 0.002, middle, 0.004}, merge, 0.001, 0.5);
        for (std::size_t k = 0; k < 5; ++k) flow.set_pressure(k, std::cos(double(k)));
        flow.set_pressure(3, flow.network().pressure[2]);
        auto const steps = std::lround(0.1 / dt);
        for (long n = 0; n < steps; ++n) flow.advance(dt);
        std::vector<double> p(flow.network().pressure.begin(), flow.network().pressure.end());
        return p;
    };
    double const dt = 1e-5;
    auto const merged = run(1.0, 0.5, dt);
    REQUIRE(merged[2] == merged[3]);
    double last = infinity;
    for (double const conductance : {0.2, 2.0, 20.0}) {
        auto const whole = run(conductance, infinity, dt);
        double error = 0;
        for (std::size_t k = 0; k < 5; ++k) error = std::max(error, std::fabs(whole[k] - merged[k]));
        // The difference decreases with the resistance.
        if (last < infinity) REQUIRE_THAT(last / error, WithinRel(10.0, 0.2));
        last = error;
    }
    REQUIRE(last < 1e-4);
}

TEST_CASE("an infinite threshold changes no bit, and neither does one that no throat exceeds") {
    body const b(5, 8, 9);
    auto plain = b.flow(parameters(infinity)), high = b.flow(parameters(1e9));
    REQUIRE(high.clusters().clusters() == 0);
    std::mt19937_64 engine(2);
    for (std::size_t k = 0; k < plain.network().pores(); ++k) {
        double const p = uniform(engine);
        plain.set_pressure(k, p);
        high.set_pressure(k, p);
    }
    double const dt = 0.5 * plain.critical_time_step();
    REQUIRE(high.critical_time_step() == plain.critical_time_step());
    for (int n = 0; n < 20; ++n) {
        plain.step<true>(b.records(), body::no_force, dt);
        high.step<true>(b.records(), body::no_force, dt);
    }
    REQUIRE(plain.network().pressure == high.network().pressure);
    REQUIRE(plain.ledger().dissipation == high.ledger().dissipation);
}

TEST_CASE("a moving packing: clusters join and split, mass and energy balance, also where the fluid tears") {
    for (bool const tears : {false, true})
        for (int const substeps : {1, 3}) {
            body b(7, 7, 8);
            auto p = parameters(0.01);
            p.substeps = substeps;
            if (tears) p.minimum_pressure = -0.05;
            auto flow = b.flow(p);
            std::mt19937_64 engine(3);
            for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
            auto const rest = b.x;
            std::size_t least = 1000000, most = 0;
            double vapour_seen = 0;
            double const dt = 1e-4;
            for (int n = 0; n < 60; ++n) {
                for (std::size_t i = 0; i < b.x.size(); ++i)
                    b.x[i] =
                        rest[i] + point{std::sin(0.3 * n + 0.3 * double(i)), std::cos(0.2 * n + 0.7 * double(i))} * 0.1;
                auto const old = flow.network();
                auto const totals = flow.ledger();
                double const energy = flow.storage_energy();
                flow.step<true>(b.records(), body::no_force, dt);
                auto const& net = flow.network();
                auto const& l = flow.ledger();
                // Initial state of this step's clusters: the mean of their pores' pressures, after vapour has closed.
                std::vector<double> volume(net.pores()), pressure(net.pores()), vapour(net.pores());
                for (std::size_t k = 0; k < net.pores(); ++k) {
                    auto const c = flow.clusters().label(k);
                    volume[c] += old.volume[k];
                    pressure[c] += old.volume[k] * old.pressure[k];
                    vapour[c] += old.vapour_of(k);
                }
                double balance = 0, gross = 0;
                for (std::size_t k = 0; k < net.pores(); ++k) {
                    double const grown = net.volume[k] - old.volume[k];
                    auto const c = flow.clusters().label(k);
                    double const wanted = (pressure[c] - 1000 * vapour[c]) / volume[c];
                    double const mixed = std::max(wanted, p.minimum_pressure);
                    double const left = (mixed - wanted) / 1000 * old.volume[k];
                    balance += net.volume[k] * (net.pressure[k] - mixed) / 1000 + grown - (net.vapour_of(k) - left);
                    gross += std::fabs(grown) + net.volume[k];
                    vapour_seen = std::max(vapour_seen, net.vapour_of(k));
                }
                double const inflow = l.boundary_inflow - totals.boundary_inflow;
                // With substeps the intermediate pressures and volumes are not known here.
                if (substeps == 1) REQUIRE_THAT(balance - inflow, WithinAbs(0, 1e-12 * gross));
                REQUIRE_THAT(l.mass_residual, WithinAbs(0, 1e-12 * l.gross_volume));
                double const gained = (l.reservoir_work - totals.reservoir_work) -
                                      (l.dissipation - totals.dissipation) - (l.pressure_work - totals.pressure_work) +
                                      (l.vapour_work - totals.vapour_work) + (l.prefactor_work - totals.prefactor_work);
                REQUIRE_THAT(flow.storage_energy() - energy, WithinAbs(gained, 1e-12 * (1 + energy)));
                for (std::size_t k = 0; k < net.pores(); ++k)
                    REQUIRE(net.pressure[k] == net.pressure[flow.clusters().label(k)]);
                least = std::min(least, flow.clusters().members().size());
                most = std::max(most, flow.clusters().members().size());
            }
            REQUIRE(least < most);
            REQUIRE((vapour_seen > 0) == tears);
        }
}

TEST_CASE("pores that separate keep their pressure") {
    body b(9, 5, 5);
    auto flow = b.flow(parameters(0.01));
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, double(k));
    for (int n = 0; n < 2; ++n) flow.step<true>(b.records(), body::no_force, 1e-9);
    REQUIRE(flow.clusters().clusters() > 0);
    auto const before = flow.network().pressure;
    // A force closes the throats in this step; the clusters split at the beginning of the next.
    std::vector<double> const squeeze{0, -1e9};
    flow.map_throats([](int, int) { return 1; });
    flow.step<true>(b.records(), squeeze.data(), 1e-9);
    flow.step<true>(b.records(), squeeze.data(), 1e-9);
    REQUIRE(flow.clusters().clusters() == 0);
    for (std::size_t k = 0; k < flow.network().pores(); ++k)
        REQUIRE_THAT(flow.network().pressure[k], WithinRel(before[k], 1e-4));
}

TEST_CASE("forces of a cluster are those of its pressure") {
    body const b(11, 6, 6);
    auto flow = b.flow(parameters(0.01));
    std::mt19937_64 engine(3);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
    for (int n = 0; n < 2; ++n) flow.step<true>(b.records(), body::no_force, 1e-6);
    REQUIRE(flow.clusters().members().size() > 4);
    std::vector<point> expected(b.x.size(), point{});
    auto const& net = flow.network();
    for (std::size_t k = 0; k < net.pores(); ++k) {
        if (net.volume[k] <= 1.000001e-3 * net.size[k]) continue; // at its least volume: no force
        auto const push = flow.pore_tractions(k, view_points(b.x), b.r.data());
        for (std::size_t c = 0; c < 3; ++c) expected[std::size_t(net.corner[c][k])] += push[c] * net.pressure[k];
    }
    record_column<double> force;
    force.resize(b.x.size());
    flow.step<false>(b.records(), body::no_force, 0, 1, &force);
    for (std::size_t i = 0; i < b.x.size(); ++i)
        for (int axis = 0; axis < 2; ++axis) REQUIRE_THAT(force.at(i, axis), WithinAbs(expected[i][axis], 1e-12));
}

TEST_CASE("a restored state with clusters continues with the same bits, and a bad threshold is refused") {
    body const b(13, 6, 6);
    auto flow = b.flow(parameters(0.01));
    std::mt19937_64 engine(4);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
    for (int n = 0; n < 5; ++n) flow.step<true>(b.records(), body::no_force, 1e-5);
    auto later = b.flow(parameters(0.01));
    later.restore(flow.network(), flow.ledger());
    for (int n = 0; n < 5; ++n) {
        flow.step<true>(b.records(), body::no_force, 1e-5);
        later.step<true>(b.records(), body::no_force, 1e-5);
    }
    REQUIRE(later.network().pressure == flow.network().pressure);
    REQUIRE(later.ledger().dissipation == flow.ledger().dissipation);
    REQUIRE_THROWS_WITH(b.flow(parameters(0)), contains_text("flow.merge_conductance = 0"));
    REQUIRE_THROWS_WITH(b.flow(parameters(std::nan(""))), contains_text("flow.merge_conductance"));
}

TEST_CASE("implicit flow: merged pores are one, and follow the explicit clusters as the step shrinks") {
    using implicit_solver = implicit_flow::solver<double, 2>;
    body const b(17, 6, 7);
    auto p = parameters(0.01);
    implicit_solver::parameters q;
    static_cast<solver::parameters&>(q) = p;
    auto const points = view_points(b.x);
    double last = infinity;
    for (int const steps : {20, 200}) {
        implicit_solver other(q, make_pore_network(triangulate_body(points, b.r.data()), points, b.r.data()), 1.0,
                              points, b.r.data());
        solver sealed(p, make_pore_network(triangulate_body(points, b.r.data()), points, b.r.data()), 1.0, points,
                      b.r.data());
        for (std::size_t k = 0; k < other.network().pores(); ++k) {
            double const pressure = std::sin(double(k));
            other.set_pressure(k, pressure);
            sealed.set_pressure(k, pressure);
        }
        double const before = content(sealed);
        double const dt = 0.02 / steps;
        for (int n = 0; n < steps; ++n) {
            other.step<true>(b.records(), body::no_force, dt);
            sealed.step<true>(b.records(), body::no_force, dt);
        }
        auto const& net = other.network();
        REQUIRE(other.clusters().members().size() > 4);
        double error = 0, after = 0;
        for (std::size_t k = 0; k < net.pores(); ++k) {
            REQUIRE(net.pressure[k] == net.pressure[other.clusters().label(k)]);
            error = std::max(error, std::fabs(net.pressure[k] - sealed.network().pressure[k]));
            after += net.volume[k] * (1 + net.pressure[k] / 1000);
        }
        REQUIRE_THAT(after, WithinRel(before, 1e-12));
        if (last < infinity) REQUIRE_THAT(last / error, WithinRel(10.0, 0.3));
        last = error;
    }
}
