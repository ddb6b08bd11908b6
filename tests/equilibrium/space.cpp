// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "simulation/setups.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/equilibrium.hpp>
#include <lacuna/laws/beam_bond.hpp>
#include <lacuna/laws/hertz_mindlin.hpp>
#include <lacuna/laws/no_contact.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>

using namespace setups;
using lacuna::equilibrium;
using lacuna::simulation;
using lacuna::simulation_parameters;
using point = lacuna::vec<double, 3>;

namespace {

struct damped : space {
    using damping = lacuna::local_damping;
};
struct hertzian : damped {
    using contact_law = lacuna::hertz_mindlin;
};
struct beams : damped {
    using contact_law = lacuna::no_contact;
    using bond_law = lacuna::beam_bond;
};
struct porous : damped {
    using contact_law = lacuna::no_contact;
    using flow = lacuna::explicit_flow_with<lacuna::constant_aperture>;
};

using rotation = std::array<point, 3>; // its columns
rotation const as_is{point{1, 0, 0}, point{0, 1, 0}, point{0, 0, 1}};
/// Columns of an orthogonal matrix along no axis.
rotation const turned{point{0.36, 0.48, -0.8}, point{-0.8, 0.6, 0}, point{0.48, 0.64, 0.6}};

point rotate(rotation const& q, point const& x) { return q[0] * x[0] + q[1] * x[1] + q[2] * x[2]; }

/// Touching spheres of radius 0.5 along the first axis of q.
lacuna::packing<double, 3> row(int count, rotation const& q, bool bonded) {
    auto p = chain<3>(count, bonded);
    for (auto& x : p.position) x = rotate(q, x);
    return p;
}

double distance(auto const& sim, std::size_t i, std::size_t j) { return norm(sim.position(j) - sim.position(i)); }

template <class Model>
void add_wall(simulation_parameters<Model>& p, point const& at, point const& normal) {
    p.walls.push_back({at, normal, p.materials[0].contact});
}

/// Whether the engine's own steps, damped, leave an equilibrium as it is.
template <class Model>
void require_rest(simulation<Model>& sim, double radius = 0.5) {
    std::vector<point> before;
    for (std::size_t k = 0; k < sim.size(); ++k) before.push_back(sim.position(k));
    sim.run(200);
    double const speed = radius / (sim.limits().critical() * 200);
    for (std::size_t k = 0; k < sim.size(); ++k) {
        REQUIRE(norm(sim.position(k) - before[k]) < 1e-8 * radius);
        REQUIRE(norm(sim.velocity(k)) < 1e-6 * speed);
        REQUIRE(norm(sim.spin(k)) * radius < 1e-6 * speed);
    }
}

} // namespace

TEST_CASE("equilibrium in space: a chain of spheres under a load, in any direction", "[equilibrium][3d]") {
    // Each contact carries F: it closes by F / k.
    double const kn = 2e5, force = 30;
    std::vector<double> seen;
    for (auto const& q : {as_is, turned}) {
        simulation<damped> sim(row(3, q, false), springs<damped>(kn, 1e5, 0.3));
        sim.fix(0);
        sim.apply(2, rotate(q, {-force, 0, 0}));
        equilibrium<damped> eq(sim, {.tolerance = 1e-9});
        auto const r = eq.solve();
        REQUIRE(r.reached());
        REQUIRE(r.unbalanced <= 1e-9 * force);
        for (std::size_t k = 0; k < 2; ++k) {
            REQUIRE_THAT(1 - distance(sim, k, k + 1), WithinRel(force / kn, 2e-9));
            seen.push_back(1 - distance(sim, k, k + 1));
        }
        REQUIRE(norm(sim.position(2) - rotate(q, {2 - 2 * force / kn, 0, 0})) < 1e-5 * force / kn);
        require_rest(sim);
    }
    for (std::size_t k = 0; k < 2; ++k) REQUIRE_THAT(seen[k], WithinRel(seen[k + 2], 1e-9));
}

TEST_CASE("equilibrium in space: Hertzian spheres, loaded from zero and further", "[equilibrium][3d][hertz]") {
    // F = 4/3 E* sqrt(R*) overlap^1.5, E* = E / (2 (1 - nu^2)), R* = R / 2.
    double const young = 1e8, poisson = 0.2;
    double const hertz = 4.0 / 3 * young / (2 * (1 - poisson * poisson)) * std::sqrt(0.25);
    simulation_parameters<hertzian> p;
    p.materials[0].contact = {young, poisson, 0.4};
    for (int count : {2, 5}) {
        simulation<hertzian> sim(row(count, turned, false), p);
        // Without rotation the spheres do not roll off each other.
        for (std::size_t k = 0; k < sim.size(); ++k)
            sim.fix(k, {.x = k == 0, .y = k == 0, .z = k == 0, .rotation = true});
        auto const last = std::size_t(count) - 1;
        equilibrium<hertzian> eq(sim);
        for (double const force : {10.0, 3e4, 1e5, 2e3}) {
            sim.apply(last, rotate(turned, {-force, 0, 0}));
            auto const r = eq.solve();
            INFO("force " << force << ", " << r.factorisations << " factorisations");
            REQUIRE(r.reached());
            double const overlap = std::pow(force / hertz, 2.0 / 3);
            for (std::size_t k = 0; k < last; ++k)
                REQUIRE_THAT(1 - distance(sim, k, k + 1), WithinRel(overlap, 2e-6));
        }
        require_rest(sim);
    }
}

TEST_CASE("equilibrium in space: a cantilever of beams bends and twists", "[equilibrium][3d][beam]") {
    // F L^3 / (3 E I) + F L / (kappa G A), and T L / (G J).
    double const young = 1e9, poisson = 0.25, kappa = 0.9, length = 9, r = 0.5;
    double const g = young / (2 * (1 + poisson)), area = pi * r * r, inertia = pi * r * r * r * r / 4;
    simulation_parameters<beams> p;
    p.materials[0].bond = {young, poisson, never, never, 1, kappa};
    struct load {
        point along; // of the force
        double force, torque;
    };
    for (auto const& q : {as_is, turned})
        for (auto const& l : {load{{0, 1, 0}, 100, 0}, load{{0, -0.6, 0.8}, 100, 0}, load{{0, 1, 0}, 0, 500}}) {
            simulation<beams> sim(row(10, q, true), p);
            sim.fix(0);
            sim.apply(9, rotate(q, l.along * l.force), rotate(q, {l.torque, 0, 0}));
            equilibrium<beams> eq(sim, {.tolerance = 1e-8});
            auto const found = eq.solve();
            INFO(found.factorisations << " factorisations, unbalanced " << found.unbalanced);
            REQUIRE(found.reached());
            double const deflection =
                l.force * (length * length * length / (3 * young * inertia) + length / (kappa * g * area));
            double const slope = l.force * length * length / (2 * young * inertia);
            double const twist = l.torque * length / (g * 2 * inertia);
            auto const tip = sim.position(9) - rotate(q, {length, 0, 0});
            REQUIRE(norm(tip - rotate(q, l.along * deflection)) < 1e-4 * deflection + 1e-12);
            // The vector part of the quaternion is half the angle, for a small one: e_x x along by the slope.
            auto const o = sim.orientation(9);
            point const angle = point{o[1], o[2], o[3]} * 2.0;
            auto const bent = cross(q[0], rotate(q, l.along)) * slope;
            REQUIRE(norm(angle - bent - q[0] * twist) < 1e-5 * (slope + twist));
            require_rest(sim);
        }
}

namespace {

/// A sphere on a wall that dips along a direction that is no axis, its rotation fixed.
/// \param steepness tangent of the dip
simulation<damped> slope(double steepness, rotation const& q) {
    auto p = springs<damped>(1e5, 4e4, 0.5, unit_density(3));
    p.gravity = rotate(q, point{0.6 * steepness, 0.8 * steepness, -1} * 9.81);
    add_wall(p, {0, 0, 0}, rotate(q, {0, 0, 1}));
    lacuna::packing<double, 3> one;
    one.add(rotate(q, {0, 0, 0.5}), 0.5);
    simulation<damped> sim(one, p);
    sim.fix(0, {.x = false, .y = false, .z = false, .rotation = true});
    return sim;
}

} // namespace

TEST_CASE("equilibrium in space: a sphere on a slope holds below the angle of friction",
          "[equilibrium][3d][friction]") {
    std::vector<double> overlaps;
    for (auto const& q : {as_is, turned}) {
        double const steep = 0.95 * 0.5;
        auto holds = slope(steep, q);
        equilibrium<damped> eq(holds);
        auto const r = eq.solve();
        INFO(r.factorisations << " factorisations, unbalanced " << r.unbalanced);
        REQUIRE(r.reached());
        auto const x = holds.position(0);
        REQUIRE_THAT(0.5 - dot(x, q[2]), WithinRel(9.81 / 1e5, 2e-6));
        REQUIRE_THAT(dot(x, q[0]), WithinRel(0.6 * steep * 9.81 / 4e4, 1e-5));
        REQUIRE_THAT(dot(x, q[1]), WithinRel(0.8 * steep * 9.81 / 4e4, 1e-5));
        overlaps.push_back(0.5 - dot(x, q[2]));
        require_rest(holds);

        auto slides = slope(1.05 * 0.5, q);
        equilibrium<damped> none(slides);
        auto const m = none.solve();
        REQUIRE(m.outcome == lacuna::equilibrium_outcome::mechanism);
    }
    REQUIRE_THAT(overlaps[0], WithinRel(overlaps[1], 1e-9));
}

namespace {

/// Spheres in a slightly disturbed cubic lattice, bonded if they nearly touch, with pores.
simulation<porous> wet_cube(int n, double pressure) {
    lacuna::packing<double, 3> spheres;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
                auto const id = spheres.size();
                spheres.add({i + 0.03 * noise(id, 1), j + 0.03 * noise(id, 2), k + 0.03 * noise(id, 3)},
                            0.49 + 0.009 * noise(id, 4));
            }
    bond_touching(spheres, 0.05);
    simulation_parameters<porous> p;
    p.materials[0].density = unit_density(3);
    p.materials[0].bond = {1e4, 5e3};
    p.flow.bulk_modulus = 1e4;
    p.flow.initial_pressure = pressure;
    p.flow.aperture.aperture = 0.1;
    p.flow.conductivity = 0;
    p.time_step = 1e-3;
    simulation<porous> sim(spheres, p);
    sim.fill_pores([](auto points, double const* radii) {
        return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii, {});
    });
    for (std::size_t k = 0; k < sim.size(); ++k) {
        if (spheres.position[k][2] < 0.5) sim.fix(k);
        if (spheres.position[k][2] > n - 1.5) sim.apply(k, {0.5, 0.2, -1.5});
    }
    return sim;
}

std::vector<double> void_volumes(simulation<porous> const& sim) {
    auto const& net = sim.flow().network();
    std::vector<point> x;
    std::vector<double> radii;
    for (std::size_t k = 0; k < sim.size(); ++k) {
        x.push_back(sim.particles().position(k));
        radii.push_back(sim.particles().radius(k));
    }
    std::vector<double> volume;
    for (std::size_t p = 0; p < net.pores(); ++p) {
        lacuna::pore_mesh<3>::simplex s{};
        for (std::size_t c = 0; c < 4; ++c) s[c] = net.corner[c][p];
        volume.push_back(lacuna::simplex_void(s, lacuna::view_points(x), radii.data()));
    }
    return volume;
}

} // namespace

TEST_CASE("equilibrium in space: sealed pores follow their volumes, drained ones keep their pressure",
          "[equilibrium][3d][pores]") {
    for (auto const pores : {lacuna::pore_condition::sealed, lacuna::pore_condition::drained}) {
        bool const sealed = pores == lacuna::pore_condition::sealed;
        auto sim = wet_cube(4, 7);
        auto const before = void_volumes(sim);
        equilibrium<porous> eq(sim, {.pores = pores});
        auto const r = eq.solve();
        INFO(r.factorisations << " factorisations");
        REQUIRE(r.reached());
        REQUIRE(r.unbalanced <= 1e-6 * r.largest_force);
        auto const after = void_volumes(sim);
        auto const& pressure = sim.flow().network().pressure;
        REQUIRE(before.size() > 100);
        double most = 0;
        for (std::size_t p = 0; p < before.size(); ++p) {
            double const change = sealed ? 1e4 * std::log(before[p] / after[p]) : 0.0;
            REQUIRE_THAT(pressure[p], WithinAbs(7 + change, 1e-8));
            most = std::max(most, std::fabs(before[p] / after[p] - 1));
        }
        REQUIRE(most > 1e-4);
        if (sealed) require_rest(sim);
    }
}

namespace {

/// 216 spheres of different sizes, near the places of a close packing, in a box of six walls; its top is wall 5.
simulation<damped> block(double friction) {
    int const n = 6;
    auto p = springs<damped>(1e5, 8e4, friction, unit_density(3));
    lacuna::packing<double, 3> spheres;
    double const row = std::sqrt(0.75), layer = std::sqrt(2.0 / 3);
    for (int c = 0; c < n; ++c)
        for (int b = 0; b < n; ++b)
            for (int a = 0; a < n; ++a) {
                auto const id = spheres.size();
                spheres.add({a + 0.5 * ((b + c) % 2), (b + (c % 2) / 3.0) * row, c * layer},
                            0.4999 + 0.0001 * noise(id, 1));
            }
    point const low{-0.5, -0.5, -0.5}, high{n - 0.5 + 0.5, (n - 1 + 1 / 3.0) * row + 0.5, (n - 1) * layer + 0.5};
    for (int axis = 0; axis < 3; ++axis) {
        point normal{};
        normal[axis] = 1;
        add_wall(p, low, normal);
        add_wall(p, high, normal * -1.0);
    }
    simulation<damped> sim(spheres, p);
    return sim;
}

} // namespace

TEST_CASE("equilibrium in space: a block of rough spheres that a wall presses", "[equilibrium][3d][friction]") {
    auto sim = block(0.5);
    equilibrium<damped> eq(sim);
    eq.move_wall(5, {0, 0, -0.01});
    auto const r = eq.solve();
    INFO(r.factorisations << " factorisations, " << r.solves
                     << " solves, unbalanced " << r.unbalanced << " of " << r.largest_force);
    CHECK(r.reached());
    CHECK(r.unbalanced <= 1e-6 * r.largest_force);
    point sum{};
    double pressed = 0;
    for (std::size_t w = 0; w < 6; ++w) {
        sum += sim.walls().force(w);
        pressed += norm(sim.walls().force(w));
    }
    CHECK(norm(sum) < 1e-6 * pressed);
    CHECK(norm(sim.walls().force(5)) > 0.1 * pressed);
    require_rest(sim);
}
