// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>

using namespace lacuna;
using bodies::body;
using bodies::point;

namespace {

std::set<std::size_t> rim_of(pore_network<double, 2> const& net) {
    std::set<std::size_t> rim;
    for (std::size_t t = net.interior_throats; t < net.throats(); ++t)
        for (std::size_t side = 0; side < 2; ++side) rim.insert(std::size_t(net.throat_particle[side][t]));
    return rim;
}

} // namespace

TEMPLATE_TEST_CASE("a uniform pressure between sealed discs stays, and exerts no force on inner ones", "",
                   explicit_flow, implicit_flow) {
    using solver = typename TestType::template solver<double, 2>;
    // Discs of equal and unequal radii, some touching, some apart or overlapping.
    bool const equal = GENERATE(true, false);
    auto const b = equal ? bodies::triangular(7, 8) : bodies::scattered(91, 7, 8, 0.6, 0.95);
    auto p = body::settings<solver>();
    p.substeps = GENERATE(1, 4);
    p.initial_pressure = 3;
    auto flow = b.flow<solver>(p);
    double const dt = 0.2 * flow_critical_time_step(flow.network(), p.bulk_modulus);
    for (int s = 0; s < 20; ++s) flow.template step<true>(b.records(), body::no_force, dt);
    for (double const q : flow.network().pressure) REQUIRE_THAT(q, WithinRel(3.0, 1e-13));
    auto const force = b.tractions(flow);
    auto const rim = rim_of(flow.network());
    REQUIRE(rim.size() < b.x.size());
    point sum{};
    double moment = 0, virial = 0, least = 1e9;
    for (std::size_t i = 0; i < b.x.size(); ++i) {
        sum += force[i];
        moment += cross(b.x[i], force[i]);
        virial += dot(b.x[i], force[i]);
        if (rim.count(i))
            least = std::min(least, norm(force[i]));
        else
            REQUIRE_THAT(norm(force[i]), WithinAbs(0, 1e-12));
    }
    REQUIRE(least > 0.1);
    REQUIRE_THAT(norm(sum), WithinAbs(0, 1e-12));
    REQUIRE_THAT(moment, WithinAbs(0, 1e-10));
    // Equal radii: the virial is 2 p times the area of all triangles.
    double area = 0;
    for (double const a : flow.network().size) area += a;
    if (equal) REQUIRE_THAT(virial, WithinRel(2 * 3.0 * area, 1e-12));
}

TEMPLATE_TEST_CASE("along a finite path pressures do the work p dV on the discs", "", explicit_flow, implicit_flow) {
    using solver = typename TestType::template solver<double, 2>;
    bool const touching = GENERATE(true, false);
    auto const rest = touching ? bodies::triangular(6, 7) : bodies::scattered(92, 6, 7, 0.6, 0.9);
    auto p = body::settings<solver>();
    // A fluid so soft that volumes do not change its pressures, and throats without conductance.
    p.bulk_modulus = 1e-12;
    p.conductivity = 0;
    auto const path = [&](int steps) {
        auto flow = rest.flow<solver>(p);
        auto const& net = flow.network();
        std::vector<double> pressure;
        for (std::size_t k = 0; k < net.pores(); ++k) flow.set_pressure(k, 1 + 0.5 * std::sin(double(k)));
        auto const start = net.volume;
        auto b = rest, before = rest;
        flow.template step<true>(b.records(), body::no_force, 1e-3);
        auto force = b.tractions(flow);
        double work = 0;
        for (int s = 1; s <= steps; ++s) {
            before.x = b.x;
            // Rotated as a whole, sheared and stirred.
            double const t = double(s) / steps, c = std::cos(0.3 * t), n = std::sin(0.3 * t);
            for (std::size_t i = 0; i < b.x.size(); ++i) {
                point const x{rest.x[i][0] + 0.02 * t * rest.x[i][1], rest.x[i][1] * (1 + 0.01 * t)};
                b.x[i] = point{c * x[0] - n * x[1], n * x[0] + c * x[1]} +
                         point{std::sin(3 * t + double(i)) - std::sin(double(i)), 0} * 0.02;
            }
            flow.template step<true>(b.records(), body::no_force, 1e-3);
            auto const next = b.tractions(flow);
            for (std::size_t i = 0; i < b.x.size(); ++i) work += dot(force[i] + next[i], b.x[i] - before.x[i]) / 2;
            force = next;
        }
        double on_pores = 0, least = 1e9;
        for (std::size_t k = 0; k < net.pores(); ++k) {
            on_pores += (1 + 0.5 * std::sin(double(k))) * (net.volume[k] - start[k]);
            least = std::min(least, net.volume[k]);
        }
        REQUIRE(least > 1e-3);
        REQUIRE(std::fabs(on_pores) > 0.1);
        REQUIRE_THAT(flow.ledger().pressure_work, WithinRel(on_pores, 1e-9));
        return std::fabs(work / on_pores - 1);
    };
    double const coarse = path(20), fine = path(40);
    INFO("relative difference " << coarse << " and " << fine);
    if (touching) {
        // For equal radii a pore's sectors sum to half a disc: its volume is quadratic, and the trapezoidal rule exact.
        REQUIRE(coarse < 1e-11);
        REQUIRE(fine < 1e-11);
    } else {
        REQUIRE(fine < 1e-3);
        REQUIRE_THAT(std::log2(coarse / fine), WithinAbs(2, 0.1));
    }
}
