// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "simulation/setups.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation/checkpoint.hpp>

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

/// Discs of radius 0.4 to 0.5 in rows, sealed and filled with fluid. The lowest row is fixed, the highest moves to the
/// right.
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

/// State of a run after every given number of steps.
template <class Model>
void check_resumed(std::string const& name, long long steps, std::size_t least) {
    std::string const path = "remeshing_" + name + ".bin";
    remesh_parameters const often{remesh_rule::when_needed, 20};
    auto whole = make_shear<Model>(often);
    std::vector<std::uint64_t> states;
    std::vector<long long> new_meshes; // steps after which the mesh was another
    for (long long n = 0; n < steps; ++n) {
        auto const before = whole.flow().ledger().remeshes;
        whole.step_with_energy();
        states.push_back(state_hash(whole));
        if (whole.flow().ledger().remeshes > before) new_meshes.push_back(n + 1);
    }
    INFO(new_meshes.size() << " new meshes");
    REQUIRE(new_meshes.size() >= least);
    for (long long const at :
         {1LL, new_meshes[0] - 1, new_meshes[0], new_meshes[new_meshes.size() / 2] + 7, new_meshes.back()}) {
        auto first = make_shear<Model>(often, 2);
        for (long long n = 0; n < at; ++n) first.step_with_energy();
        save_checkpoint(path, first);
        auto second = make_shear<Model>(often);
        load_checkpoint(path, second);
        REQUIRE(state_hash(second) == states[std::size_t(at - 1)]);
        // To the end, also from a run that had another state before.
        for (auto* run : {&second, &first}) {
            if (run == &first) load_checkpoint(path, first);
            for (long long n = at; n < steps; ++n) {
                run->step_with_energy();
                REQUIRE(state_hash(*run) == states[std::size_t(n)]);
            }
        }
        REQUIRE(second.flow().network().pressure == whole.flow().network().pressure);
        REQUIRE(second.energy().residual() == whole.energy().residual());
    }
    // Other pores than those of the file, from the same particles.
    auto other = make_shear<Model>(often);
    other.fill_pores([](points_view<double, 2> points, double const* radii) {
        auto drained = [](auto const&) { return throat_boundary<double>{boundary_kind::drained, 0.0}; };
        return make_pore_network(triangulate_body(points, radii), points, radii, drained);
    });
    auto const before = state_hash(other);
    REQUIRE_THROWS_WITH(load_checkpoint(path, other), contains_text("it was made with other pores"));
    REQUIRE(state_hash(other) == before);
    // Without remeshing its settings differ.
    auto fixed = make_shear<Model>({remesh_rule::never});
    REQUIRE_THROWS_WITH(load_checkpoint(path, fixed), contains_text("other settings"));
    std::remove(path.c_str());
}

/// Four discs A, B below and C, D above, radius 0.3, that do not touch, all held; C and D move to the right. The two
/// pores are ABD and ADC first; once AD is longer than BC a triangulation has ABC and BDC. A and C are bonded.
/// \param speed of C and D, m/s
/// \param drains whether the sides of a new mesh are drained; those of the first are not
template <class Model>
simulation<Model> make_four(simulation_parameters<Model> p, double strength, double speed = 5, bool drains = false) {
    packing<double, 2> discs;
    for (vec<double, 2> const x : {vec<double, 2>{0, 0}, {1, 0}, {-0.02, 1}, {0.98, 1}}) discs.add(x, 0.3);
    discs.bonds.push_back({0, 2});
    p.materials = springs<Model>(1e3, 1e3, 0, 1, strength).materials;
    p.damping.factor = 0;
    p.flow.bulk_modulus = 1e3;
    p.flow.aperture = {0.05, 1.0, 1.0};
    simulation<Model> sim(discs, p);
    for (std::size_t k = 0; k < 4; ++k) sim.fix(k);
    for (std::size_t const k : {2u, 3u}) sim.set_velocity(k, {speed, 0});
    sim.fill_pores([drains, first = points_view<double, 2>(sim.particles().positions())[2][0]](
                       points_view<double, 2> points, double const* radii) {
        auto const sides = drains && points[2][0] != first ? boundary_kind::drained : boundary_kind::sealed;
        return make_pore_network(regular_triangulation(points, radii), points, radii,
                                 [&](auto const&) { return throat_boundary<double>{sides, 0.0}; });
    });
    return sim;
}

/// Explicit limit of the four discs, s: V / (K_f C) of either pore, whose throat is between the discs i and j.
double limit_of_four(double conductivity, vec<double, 2> const& across) {
    double const volume = 0.5 - setups::pi * 0.09 / 2, aperture = 0.05 + norm(across) - 0.6;
    return volume / (1e3 * conductivity * aperture * aperture * aperture / 0.6);
}

template <class Model>
std::size_t inverted_pores(simulation<Model> const& sim) {
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
        std::vector<vec<double, 2>> old_positions;
        if (due) {
            old = sim.flow().network();
            auto const x = sim.particles().positions();
            for (std::size_t k = 0; k < x.size(); ++k) old_positions.push_back(x[k]);
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
        REQUIRE(inverted_pores(sim) == 0);
        REQUIRE_THAT(ledger.remesh_residual, WithinAbs(0, 1e-12 * ledger.remesh_content));
        // Recomputed: the fluid in the pores of the old mesh after the step, with the positions before it.
        double before = 0, after = 0, scale = 0;
        for (std::size_t p = 0; p < old.pores(); ++p) {
            std::array<std::size_t, 3> const c{std::size_t(old.corner[0][p]), std::size_t(old.corner[1][p]),
                                               std::size_t(old.corner[2][p])};
            auto const* r = sim.particles().radii().data();
            double const v = pore_volume(old_positions[c[0]], old_positions[c[1]], old_positions[c[2]], r[c[0]],
                                         r[c[1]], r[c[2]], 1.0, least * old.size[p]);
            before += v * old.pressure[p] / modulus - (v - old.volume[p]);
            scale += v * std::fabs(old.pressure[p]) / modulus;
            most_before = std::max(most_before, std::fabs(old.pressure[p]));
        }
        for (std::size_t p = 0; p < net.pores(); ++p) after += net.volume[p] * net.pressure[p] / modulus;
        REQUIRE_THAT(after - before, WithinAbs(0, 1e-12 * scale));
        REQUIRE(most < 1.5 * most_before + 100);
    }
    REQUIRE(meshes > 20);
    // With the initial mesh the run ends once a pore is inverted.
    REQUIRE_THROWS_WITH(still.run(16000), contains_text("is inverted"));
    REQUIRE(still.flow().ledger().remeshes == 0);
    REQUIRE(inverted_pores(still) > 0);
    // The energy that the new meshes took out of the compressed fluid is in the ledger.
    REQUIRE(std::fabs(sim.energy().fluid_remesh) > 1e-4 * sim.energy().largest());
    REQUIRE(std::fabs(sim.energy().residual()) < 1e-4 * sim.energy().largest());
}

TEST_CASE("a mesh that fits is not replaced, and the bits stay the same") {
    auto watched = make_shear<sheared>({remesh_rule::when_needed, 1});
    auto plain = make_shear<sheared>({remesh_rule::never});
    watched.run(10);
    plain.run(10);
    REQUIRE(watched.flow().ledger().remeshes == 0);
    REQUIRE(watched.flow().network().pressure == plain.flow().network().pressure);
    for (std::size_t k = 0; k < plain.size(); ++k) REQUIRE(watched.position(k) == plain.position(k));
}

TEST_CASE("new meshes do not depend on the number of threads or the order of the input") {
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

TEST_CASE("explicit flow gets new meshes like implicit flow, and bad intervals are refused") {
    auto sim = make_shear<sheared_explicitly>({remesh_rule::when_needed, 20});
    sim.run(4000);
    REQUIRE(sim.flow().ledger().remeshes > 0);
    REQUIRE(inverted_pores(sim) == 0);
    for (double const p : sim.flow().network().pressure) REQUIRE(std::isfinite(p));
    REQUIRE_THROWS_WITH(make_shear<sheared>({remesh_rule::when_needed, 0}), contains_text("remeshing.interval = 0"));
}

TEST_CASE("a run with new meshes is resumed to the same bits, with implicit and with explicit flow", "[checkpoint]") {
    check_resumed<sheared>("implicit", 2500, 5);
    check_resumed<sheared_explicitly>("explicit", 2500, 1);
}

TEST_CASE("a broken bond causes a new mesh with on_broken_bond") {
    for (bool const asked : {false, true}) {
        simulation_parameters<sheared> p;
        p.time_step = 1e-3;
        p.remeshing = {remesh_rule::when_needed, 10, asked};
        // The bond fails at a stretch of 0.1 m, when C is 0.46 m to the right of A.
        auto sim = make_four<sheared>(p, 100 / 0.6);
        long long broke = -1;
        while (broke < 0 && sim.steps() < 200) {
            sim.step();
            REQUIRE(sim.flow().ledger().remeshes == 0);
            if (!sim.events().empty()) broke = sim.steps();
        }
        REQUIRE(broke == int(std::ceil((std::sqrt(1.1002 * 1.1002 - 1) + 0.02) / 5e-3)) + 1);
        while (sim.steps() % 10 != 9) sim.step();
        REQUIRE(sim.flow().ledger().remeshes == 0);
        sim.step();
        REQUIRE(sim.flow().ledger().remeshes == (asked ? 1 : 0));
        auto const& net = sim.flow().network();
        REQUIRE(net.interior_throats == 1);
        // The throat between the pores is then BC; without a new mesh it is AD.
        std::array<int, 2> ends{sim.particles().id(std::size_t(net.throat_particle[0][0])),
                                sim.particles().id(std::size_t(net.throat_particle[1][0]))};
        std::sort(ends.begin(), ends.end());
        REQUIRE(ends == (asked ? std::array<int, 2>{1, 2} : std::array<int, 2>{0, 3}));
        sim.run(50);
        REQUIRE(sim.flow().ledger().remeshes == (asked ? 1 : 0));
    }
}

TEST_CASE("the explicit flow's step is safe from the first step on, as throats open, and after a new mesh") {
    double const conductivity = 0.2;
    double const first = limit_of_four(conductivity, {0.98, 1});
    simulation_parameters<sheared_explicitly> p;
    p.flow.conductivity = conductivity;
    p.safety = 0.8;
    SECTION("before the first step the present gaps count") {
        auto sim = make_four(p, 1e9);
        REQUIRE_THAT(sim.limits().flow, WithinRel(first, 1e-12));
        REQUIRE_THAT(sim.resolve_time_step(), WithinRel(0.8 * first, 1e-12));
        p.time_step = 1.01 * first;
        auto hasty = make_four(p, 1e9);
        REQUIRE_THROWS_WITH(hasty.step(), contains_text("time_step = ") && contains_text("the flow between pores"));
    }
    SECTION("a chosen step is chosen again as throats open") {
        auto sim = make_four(p, 1e9, 0.5);
        sim.flow().set_pressure(0, 100);
        int changes = 0;
        sim.resolve_time_step();
        while (sim.time() < 3) {
            double const step = sim.time_step(), time = sim.time();
            sim.run(1);
            REQUIRE_THAT(sim.time(), WithinRel(time + step, 1e-12));
            // Apertures belong to the positions before the step; the next check is at most 64 steps away.
            double const limit = limit_of_four(conductivity, {0.98 + 0.5 * time, 1});
            REQUIRE_THAT(sim.limits().flow, WithinRel(limit, 1e-9));
            REQUIRE(step < 1.2 * limit);
            if (sim.time_step() != step) {
                ++changes;
                REQUIRE_THAT(sim.time_step(), WithinRel(0.8 * limit, 1e-9));
            }
        }
        REQUIRE(changes >= 3);
        // Equal volumes and equal pressures, in the end.
        for (double const pressure : sim.flow().network().pressure) REQUIRE_THAT(pressure, WithinRel(50.0, 1e-9));
    }
    SECTION("a given step ends the run, unless unstable steps are allowed or flow steps are divided") {
        p.time_step = 0.8 * first;
        auto const drive = [&] { return make_four(p, 1e9, 0.5); };
        long long expected = 63;
        while (limit_of_four(conductivity, {0.98 + 0.5 * p.time_step * double(expected), 1}) > p.time_step)
            expected += 64;
        auto sim = drive();
        REQUIRE_THROWS_WITH(sim.run(5000),
                            contains_text("the flow between pores allows") && contains_text("substeps = 0"));
        REQUIRE(sim.steps() == expected + 1);
        p.flow.substeps = 0;
        auto careful = drive();
        REQUIRE(careful.run(expected + 100) == expected + 100);
        p.flow.substeps = 1;
        p.allow_unstable_step = true;
        auto bold = drive();
        REQUIRE(bold.run(expected + 100) == expected + 100);
    }
    SECTION("the limit of a new mesh is checked at once") {
        p.remeshing = {remesh_rule::when_needed, 10, true};
        p.safety = 0.95;
        // The bond fails when C is 0.95 m to the right of A, before the first check at step 64. Both rows move, so that
        // the flow limits the step, not the path of a disc in a step.
        auto sim = make_four(p, (std::hypot(0.93, 1.0) - 1) * 1e3 / 0.6, 7.5, true);
        for (std::size_t const k : {0u, 1u}) sim.set_velocity(k, {-7.5, 0});
        double const chosen = sim.resolve_time_step();
        while (sim.flow().ledger().remeshes == 0 && sim.steps() < 5000) {
            REQUIRE(sim.time_step() == chosen);
            sim.run(1);
        }
        REQUIRE(sim.steps() < 64);
        REQUIRE(sim.time_step() < chosen);
        REQUIRE_THAT(sim.time_step(), WithinRel(0.95 * sim.limits().flow, 1e-12));
    }
}
