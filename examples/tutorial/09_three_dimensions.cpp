// SPDX-License-Identifier: BSD-3-Clause
//
// 9. Three dimensions: the same templates with another number.
//
// A sphere is thrown along a rough floor without spin. Friction slows it and spins it up until it rolls. Then it has
// 5/7 of its velocity (a disc would have 2/3), whatever the friction.

#include <cstdio>
#include <numbers>

#include <lacuna/simulation.hpp>

#include "check.hpp"

struct model : lacuna::default_model<3> {
    using damping = lacuna::viscous_damping; // along the normal, so that the sphere does not hop
};

int main() {
    double const radius = 0.01, gravity = 9.81, friction = 0.3, speed = 1; // m, m/s^2, 1, m/s
    double const mass = 2500 * 4 * std::numbers::pi * radius * radius * radius / 3, stiffness = 1e4;

    lacuna::packing<double, 3> spheres;
    spheres.add({0.0, 0.0, radius - mass * gravity / stiffness}, radius); // at the overlap that carries its weight

    lacuna::simulation_parameters<model> p;
    p.materials[0] = {.density = 2500, .contact = {stiffness, stiffness, friction}};
    p.walls.push_back({.point = {}, .normal = {0.0, 0.0, 1.0}, .material = p.materials[0].contact});
    p.gravity = {0.0, 0.0, -gravity};
    p.damping.ratio = 0.5;

    lacuna::simulation<model> sim(spheres, p);
    sim.set_velocity(0, {0.6 * speed, 0.8 * speed, 0.0});
    while (sim.time() < 0.2) sim.step(); // it rolls after 2 v / (7 mu g) = 0.097 s

    auto const v = sim.velocity(0), w = sim.spin(0);
    std::printf("velocity (%.4f, %.4f) m/s, spin (%.2f, %.2f) rad/s\n", v[0], v[1], w[0], w[1]);
    return tutorial::check("velocity left", norm(v) / speed, 5.0 / 7.0, 1e-3);
}
