// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <vector>

#include <lacuna/equilibrium.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

struct wet : plane {
    using flow = lacuna::explicit_flow;
    using damping = lacuna::local_damping;
};

/// A bonded lattice with bumps, its lowest row fixed, its pores full.
struct block {
    static constexpr int columns = 6, rows = 6;
    lacuna::simulation<wet> sim;

    explicit block(double minimum_pressure = -never)
        : sim(
              [] {
                  auto p = lattice(columns, rows, true);
                  for (std::size_t k = 0; k < p.size(); ++k) p.position[k][0] += 0.02 * noise(k, 1);
                  return p;
              }(),
              [&] {
                  auto p = springs<wet>(1e9, 1e9);
                  p.flow.bulk_modulus = 2.2e9;
                  p.flow.minimum_pressure = minimum_pressure;
                  p.damping.factor = 0.7;
                  return p;
              }()) {
        for (std::size_t k = 0; k < columns; ++k) sim.fix(k);
        sim.fill_pores([](lacuna::points_view<double, 2> x, double const* r) {
            return lacuna::make_pore_network(lacuna::triangulate_body(x, r), x, r, [](auto const&) {
                return lacuna::throat_boundary<double>{lacuna::boundary_kind::sealed, 0.0};
            });
        });
    }
    void press(double force) {
        for (std::size_t k = columns * (rows - 1); k < columns * rows; ++k) sim.apply(k, {0, -force});
    }
    std::vector<double> volumes() const {
        auto const& net = sim.flow().network();
        std::vector<double> v;
        for (std::size_t p = 0; p < net.pores(); ++p) {
            auto const at = [&](std::size_t c) { return sim.particles().position(std::size_t(net.corner[c][p])); };
            v.push_back(lacuna::void_area(at(0), at(1), at(2), 0.5, 0.5, 0.5));
        }
        return v;
    }
};

} // namespace

TEST_CASE("sealed pores carry a load: p = p_0 + K_f ln(V_0 / V), in any number of load steps", "[equilibrium][pores]") {
    std::vector<double> whole;
    for (int const steps : {1, 4}) {
        block b;
        auto const before = b.volumes();
        lacuna::equilibrium<wet> eq(b.sim, {.tolerance = 1e-8});
        for (int n = 1; n <= steps; ++n) {
            b.press(1e6 * n / steps);
            auto const found = eq.solve();
            REQUIRE(found.reached());
            REQUIRE(found.unbalanced <= 1e-8 * found.largest_force);
        }
        auto const after = b.volumes();
        auto const& pressure = b.sim.flow().network().pressure;
        double largest = 0;
        for (std::size_t p = 0; p < after.size(); ++p) {
            REQUIRE_THAT(pressure[p], WithinAbs(2.2e9 * std::log(before[p] / after[p]), 1e-2));
            largest = std::max(largest, std::fabs(pressure[p]));
            if (steps == 1)
                whole.push_back(pressure[p]);
            else
                REQUIRE_THAT(pressure[p], WithinAbs(whole[p], 1e-3 * std::fabs(whole[p]) + 10));
        }
        REQUIRE(largest > 1e5);
        // The engine finds the same state at rest: nothing moves in steps.
        auto const rest = b.sim.position(35);
        b.sim.run(300);
        REQUIRE(norm(b.sim.position(35) - rest) < 1e-9);
    }
}

TEST_CASE("drained pores leave the load to the bonds, and their pressure stays", "[equilibrium][pores]") {
    block sealed, drained;
    double sink[2];
    for (bool const drains : {false, true}) {
        auto& b = drains ? drained : sealed;
        b.press(1e6);
        lacuna::equilibrium<wet> eq(
            b.sim, {.pores = drains ? lacuna::pore_condition::drained : lacuna::pore_condition::sealed});
        double const before = b.sim.position(33)[1];
        REQUIRE(eq.solve().reached());
        sink[drains] = before - b.sim.position(33)[1];
        if (drains)
            for (std::size_t p = 0; p < b.sim.flow().network().pores(); ++p)
                REQUIRE(b.sim.flow().network().pressure[p] == 0);
    }
    REQUIRE(sink[1] > 1.02 * sink[0]);
    REQUIRE(sink[0] > 0);
}

TEST_CASE("a liquid that tears holds its least pressure in equilibrium", "[equilibrium][pores]") {
    block b(-1e4);
    b.press(-1e6); // pulls
    lacuna::equilibrium<wet> eq(b.sim);
    REQUIRE(eq.solve().reached());
    auto const& net = b.sim.flow().network();
    std::size_t torn = 0;
    for (std::size_t p = 0; p < net.pores(); ++p) {
        REQUIRE(net.pressure[p] >= -1e4);
        torn += net.vapour_of(p) > 0;
        if (net.vapour_of(p) > 0) REQUIRE(net.pressure[p] == -1e4);
    }
    REQUIRE(torn > 10);
}
