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
    auto const path = rest.follow({0, 1000, 5}, [&](double pull) { sim.apply(4, {pull, 0}); },
                                  [&](lacuna::load_point const& now) {
                                      std::printf("pull %g N: lowest disc at %.5f m, %d factorisations\n", now.value,
                                                  sim.position(4)[0], now.factorisations);
                                  });
    double const pull = rest.events().empty() ? 0 : rest.events()[0].load;
    double const expected = strength * 2 * radius - 4 * sim.mass(4) * gravity; // N, for a thickness of 1 m
    int const wrong = tutorial::check("pull at failure, N", pull, expected, 1e-6);

    bool const none = path.outcome == lacuna::equilibrium_outcome::mechanism;
    std::printf("the rope %s\n", none ? "has no equilibrium any more" : "still holds");
    sim.run(1000);
    double const speed = (gravity + pull / (4 * sim.mass(4))) * sim.time();
    return wrong + !none + tutorial::check("speed of the fall, m/s", sim.velocity(4)[0], speed, 1e-3);
}
