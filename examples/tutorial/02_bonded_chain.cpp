// SPDX-License-Identifier: BSD-3-Clause
//
// 2. A bonded chain. Bonds, supports, loads, damping.
//
// Eleven discs, glued one to the next, hang from the first. Pulled by F at the last the ten springs lengthen by
// 10 F / k. Local damping brings the chain to rest there.

#include <cstdio>

#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/simulation.hpp>

#include "check.hpp"

struct model : lacuna::default_model<2> {
    using damping = lacuna::local_damping; // a part overridden by its name
};

int main() {
    double const pull = 2, stiffness = 1e4; // N, N/m

    auto const discs = lacuna::chain<double, 2>(11, 0.05); // touching, each bonded to the next

    lacuna::simulation_parameters<model> p;
    p.materials[0].bond.normal_stiffness = p.materials[0].bond.shear_stiffness = stiffness;
    p.damping.factor = 0.3;

    lacuna::simulation<model> sim(discs, p);
    sim.fix(0);               // keeps the velocity it has: none
    sim.apply(10, {pull, 0}); // at once; a fourth argument would be the time within which it rises

    long long const steps = sim.run(20000);
    double const longer = sim.position(10)[0] - discs.position[10][0];
    std::printf("%lld steps, kinetic energy left %.1e J\n", steps, sim.kinetic_energy());
    return tutorial::check("elongation, m", longer, 10 * pull / stiffness, 1e-6);
}
