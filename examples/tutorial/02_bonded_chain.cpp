// SPDX-License-Identifier: BSD-3-Clause
//
// 2. A bonded chain. Bonds, supports, loads, damping.
//
// Eleven discs in a row are bonded, each to the next. The first is held, a force F pulls the last: the ten springs get
// longer by 10 F / k together. Local damping brings the chain to rest.

#include <cstdio>

#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/simulation.hpp>

#include "check.hpp"

struct model : lacuna::default_model<2> {
    using damping = lacuna::local_damping; // replaces one part of the default model
};

int main() {
    double const pull = 2, stiffness = 1e4; // N, N/m

    auto const discs = lacuna::chain<double, 2>(11, 0.05); // touching, each bonded to the next

    lacuna::simulation_parameters<model> p;
    p.materials[0].bond.normal_stiffness = p.materials[0].bond.shear_stiffness = stiffness;
    p.damping.factor = 0.3;

    lacuna::simulation<model> sim(discs, p);
    sim.fix(0);               // keeps its velocity, which is zero
    sim.apply(10, {pull, 0}); // at once; apply(10, force, torque, ramp_time) rises within ramp_time

    long long const steps = sim.run(20000);
    double const longer = sim.position(10)[0] - discs.position[10][0];
    std::printf("%lld steps, kinetic energy left %.1e J\n", steps, sim.kinetic_energy());
    return tutorial::check("elongation, m", longer, 10 * pull / stiffness, 1e-6);
}
