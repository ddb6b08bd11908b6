// SPDX-License-Identifier: BSD-3-Clause
//
// 1. Two particles. A model, a packing, parameters, a run.
//
// A disc flies at another one that rests. While they touch they are two masses on a spring: the overlap reaches
// v sqrt(m_eff / k) with m_eff = m / 2. When they part, the first rests and the second has its velocity.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <lacuna/simulation.hpp>

#include "check.hpp"

// The parts of the simulator. These are the defaults: springs with friction between particles that touch, no fluid.
struct model : lacuna::default_model<2> {};

int main() {
    double const radius = 0.5, speed = 0.01, stiffness = 1000; // m, m/s, N/m

    lacuna::packing<double, 2> discs;
    discs.add({0.0, 0.0}, radius);
    discs.add({1.001, 0.0}, radius); // a gap of 1 mm

    lacuna::simulation_parameters<model> p;
    p.materials[0].density = 4 / std::numbers::pi; // 1 kg per disc: density pi r^2 times a thickness of 1 m
    p.materials[0].contact = {.normal_stiffness = stiffness, .shear_stiffness = stiffness, .friction = 0};
    p.safety = 0.05; // the step is a twentieth of the longest stable one: 150 steps in this collision

    lacuna::simulation<model> sim(discs, p); // refuses bad packings and parameters
    sim.set_velocity(0, {speed, 0.0});

    double deepest = 0;
    while (sim.time() < 0.3) {
        sim.step();
        deepest = std::max(deepest, 2 * radius - norm(sim.position(1) - sim.position(0)));
    }
    std::printf("after %lld steps of %.3g s: velocities %.6f and %.6f m/s\n", sim.steps(), sim.time_step(),
                sim.velocity(0)[0], sim.velocity(1)[0]);
    return tutorial::check("largest overlap, m", deepest, speed * std::sqrt(0.5 / stiffness), 1e-3);
}
