// SPDX-License-Identifier: BSD-3-Clause
//
// 11. Equilibrium: the state at rest under a load, without the many damped steps that lead there.
//
// Four discs hang below one that is held, each bonded to the next. The pull on the lowest rises in steps. The top bond
// carries the pull and the weight of four discs: it fails at a pull of T - 4 m g. Then there is no equilibrium. Steps
// in time go on from there, and the rope falls with the acceleration g + F / 4 m.

#include <cstdio>

#include <lacuna/equilibrium.hpp>
#include <lacuna/packings/hexagonal.hpp>

#include "check.hpp"

struct model : lacuna::default_model<2> {};

int main() {
    double const radius = 0.05, strength = 1e4, gravity = 9.81; // m, Pa, m/s^2
    auto const discs = lacuna::chain<double, 2>(5, radius, true);

    lacuna::simulation_parameters<model> p;
    p.materials[0].bond.tensile_strength = strength;
    p.gravity = {gravity, 0}; // down is x, along the rope

    lacuna::simulation<model> sim(discs, p);
    sim.fix(0);

    lacuna::equilibrium<model> rest(sim);
    double const step = 70; // N
    double pull = 0;
    auto found = rest.solve(); // under the weight alone
    while (found.reached() && found.broken == 0) {
        sim.apply(4, {pull += step, 0});
        found = rest.solve();
        std::printf("pull %g N: lowest disc at %.5f m, %d factorisations, bonds that failed: %zu\n", pull,
                    sim.position(4)[0], found.factorisations, found.broken);
    }
    // The share of the step at which the bond failed gives the load of the failure.
    double const failure = pull - step * (1 - found.first_failure);
    double const expected = strength * 2 * radius - 4 * sim.mass(4) * gravity; // N, for a thickness of 1 m
    int const wrong = tutorial::check("pull at failure, N", failure, expected, 1e-6);

    bool const none = found.outcome == lacuna::equilibrium_outcome::mechanism;
    std::printf("the rope %s\n", none ? "has no equilibrium any more" : "still holds");
    sim.run(1000);
    double const speed = (gravity + pull / (4 * sim.mass(4))) * sim.time();
    return wrong + !none + tutorial::check("speed of the fall, m/s", sim.velocity(4)[0], speed, 1e-3);
}
