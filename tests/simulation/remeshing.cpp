// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "simulation/setups.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

#include <lacuna/pores/explicit_flow.hpp>
#include <lacuna/pores/implicit_flow.hpp>
#include <lacuna/pores/triangulation.hpp>

using namespace lacuna;
using setups::springs;

namespace {

struct sheared : setups::plane_locally_damped {
    using flow = implicit_flow;
};
struct sheared_explicitly : setups::plane_locally_damped {
    using flow = explicit_flow;
};

constexpr int columns = 11, rows = 8;

/// Discs of radius 0.4 to 0.5 in rows, the lowest held, the highest moved to the right; sealed, filled with fluid.
template <class Model>
simulation<Model> make_shear(remesh_parameters const& remeshing, int threads = 1, bool reversed = false) {
    std::mt19937_64 engine(3);
    auto const uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
    struct disc {
        vec<double, 2> x;
        double r;
        int row;
    };
    std::vector<disc> discs;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j)
            discs.push_back({{0.92 * (j + 0.5 * (i % 2)) + 0.02 * uniform(), 0.78 * i}, 0.4 + 0.1 * uniform(), i});
    if (reversed) std::reverse(discs.begin(), discs.end());
    packing<double, 2> packed;
    for (auto const& d : discs) packed.add(d.x, d.r);
    auto p = springs<Model>(1e5, 5e4, 0.6, 1);
    p.damping.factor = 0.5;
    p.flow.bulk_modulus = 1e3;
    p.flow.conductivity = std::is_same_v<Model, sheared> ? 100 : 0.01;
    p.flow.initial_pressure = 100;
    p.flow.aperture = {0.05, 1e3, 1.0};
    p.remeshing = remeshing;
    p.time_step = 2e-4;
    p.threads = threads;
    simulation<Model> sim(packed, p);
    for (std::size_t k = 0; k < discs.size(); ++k)
        if (discs[k].row == 0 || discs[k].row == rows - 1) {
            sim.fix(k);
            if (discs[k].row > 0) sim.set_velocity(k, {2, 0});
        }
    sim.fill_pores([](auto points, double const* radii) {
        return make_pore_network(triangulate_body(points, radii), points, radii);
    });
    return sim;
}

template <class Model>
std::size_t turned_over(simulation<Model> const& sim) {
    auto const& net = sim.flow().network();
    auto const x = sim.particles().positions();
    std::size_t count = 0;
    for (std::size_t p = 0; p < net.pores(); ++p)
        count += triangle_area(x[std::size_t(net.corner[0][p])], x[std::size_t(net.corner[1][p])],
                               x[std::size_t(net.corner[2][p])]) <= 0;
    return count;
}

} // namespace

TEST_CASE("a body sheared by more than its height: the mesh stays valid, the fluid's mass is kept") {
    auto sim = make_shear<sheared>({remesh_rule::when_needed, 20});
    auto still = make_shear<sheared>({remesh_rule::never});
    double const modulus = 1e3, least = sim.settings().flow.minimum_volume_fraction;
    long long meshes = 0;
    // 16000 steps of 2e-4 s at 2 m/s: 6.4 m, and a height of 5.5 m.
    for (int n = 0; n < 16000; ++n) {
        bool const due = (n + 1) % 20 == 0;
        pore_network<double, 2> old;
        std::vector<vec<double, 2>> places;
        if (due) {
            old = sim.flow().network();
            auto const x = sim.particles().positions();
            for (std::size_t k = 0; k < x.size(); ++k) places.push_back(x[k]);
        }
        sim.step_with_energy();
        auto const& ledger = sim.flow().ledger();
        REQUIRE_THAT(ledger.mass_residual, WithinAbs(0, 1e-12 * (ledger.gross_volume + 1)));
        if (!due) continue;
        auto const& net = sim.flow().network();
        double most = 0, most_before = 0;
        for (double const p : net.pressure) {
            REQUIRE(std::isfinite(p));
            most = std::max(most, std::fabs(p));
        }
        if (ledger.remeshes == meshes) continue;
        meshes = ledger.remeshes;
        REQUIRE(turned_over(sim) == 0);
        REQUIRE_THAT(ledger.remesh_residual, WithinAbs(0, 1e-12 * ledger.remesh_content));
        // From scratch: what the pores of the old mesh held after the step, whose positions were those before it.
        double before = 0, after = 0, scale = 0;
        for (std::size_t p = 0; p < old.pores(); ++p) {
            std::array<std::size_t, 3> const c{std::size_t(old.corner[0][p]), std::size_t(old.corner[1][p]),
                                               std::size_t(old.corner[2][p])};
            auto const* r = sim.particles().radii().data();
            double const v = pore_volume(places[c[0]], places[c[1]], places[c[2]], r[c[0]], r[c[1]], r[c[2]], 1.0,
                                         least * old.size[p]);
            before += v * old.pressure[p] / modulus - (v - old.volume[p]);
            scale += v * std::fabs(old.pressure[p]) / modulus;
            most_before = std::max(most_before, std::fabs(old.pressure[p]));
        }
        for (std::size_t p = 0; p < net.pores(); ++p) after += net.volume[p] * net.pressure[p] / modulus;
        REQUIRE_THAT(after - before, WithinAbs(0, 1e-12 * scale));
        REQUIRE(most < 1.5 * most_before + 100);
    }
    REQUIRE(meshes > 20);
    // With the mesh of the start the run ends where a pore has turned over.
    REQUIRE_THROWS_WITH(still.run(16000), contains_text("is turned over"));
    REQUIRE(still.flow().ledger().remeshes == 0);
    REQUIRE(turned_over(still) > 0);
    // What the new meshes took out of the compressed fluid has its place in the ledger.
    REQUIRE(std::fabs(sim.energy().fluid_remesh) > 1e-4 * sim.energy().largest());
    REQUIRE(std::fabs(sim.energy().residual()) < 1e-4 * sim.energy().largest());
}

TEST_CASE("a mesh that fits is left alone, to the bit") {
    auto watched = make_shear<sheared>({remesh_rule::when_needed, 1});
    auto plain = make_shear<sheared>({remesh_rule::never});
    watched.run(10);
    plain.run(10);
    REQUIRE(watched.flow().ledger().remeshes == 0);
    REQUIRE(watched.flow().network().pressure == plain.flow().network().pressure);
    for (std::size_t k = 0; k < plain.size(); ++k) REQUIRE(watched.position(k) == plain.position(k));
}

TEST_CASE("new meshes depend on no number of threads and on no order of input") {
    auto one = make_shear<sheared>({remesh_rule::when_needed, 20});
    auto two = make_shear<sheared>({remesh_rule::when_needed, 20}, 2);
    auto other = make_shear<sheared>({remesh_rule::when_needed, 20}, 1, true);
    for (auto* sim : {&one, &two, &other}) sim->run(3000);
    REQUIRE(one.flow().ledger().remeshes == other.flow().ledger().remeshes);
    REQUIRE(one.flow().network().pores() > 50);
    REQUIRE(one.flow().network().pressure == two.flow().network().pressure);
    REQUIRE(one.flow().network().pressure == other.flow().network().pressure);
    bool changed = false;
    auto const start = make_shear<sheared>({});
    changed = one.flow().network().corner != start.flow().network().corner;
    REQUIRE(changed);
    for (std::size_t k = 0; k < one.size(); ++k) {
        REQUIRE(one.position(k) == two.position(k));
        REQUIRE(one.position(k) == other.position(one.size() - 1 - k));
    }
}

TEST_CASE("explicit flow is given a new mesh like implicit flow, bad intervals are refused") {
    auto sim = make_shear<sheared_explicitly>({remesh_rule::when_needed, 20});
    sim.run(4000);
    REQUIRE(sim.flow().ledger().remeshes > 0);
    REQUIRE(turned_over(sim) == 0);
    for (double const p : sim.flow().network().pressure) REQUIRE(std::isfinite(p));
    REQUIRE_THROWS_WITH(make_shear<sheared>({remesh_rule::when_needed, 0}), contains_text("remeshing.interval = 0"));
}
