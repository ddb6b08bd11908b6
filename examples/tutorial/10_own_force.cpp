// SPDX-License-Identifier: BSD-3-Clause
//
// 10. A body force: a function of position, velocity, mass and time, as a struct or a lambda.
//
// A planet moves around a sun with G M = 1 m^3/s^2. It starts at 1 m, perpendicular to the line to the sun, at 1.2
// times the speed of a circular orbit. Its orbit is an ellipse with the far end at r v^2 / (2 - r v^2) = 2.5714 m. The
// library adds the work of the force to the energy ledger, and its derivatives to the bound of the time step.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <lacuna/simulation.hpp>

#include "check.hpp"

struct central_field {
    double attraction = 1; // G M, m^3/s^2
    lacuna::vec<double, 2> operator()(lacuna::acted_particle<2> const& p) const {
        double const r = norm(p.position);
        return p.position * (-attraction * p.mass / (r * r * r));
    }
};

struct model : lacuna::default_model<2> {
    using forces = lacuna::body_force<central_field>;
};

int main() {
    lacuna::packing<double, 2> planet;
    planet.add({1.0, 0.0}, 0.1);
    lacuna::simulation_parameters<model> p;
    p.forces.force.attraction = 1;
    p.time_step = 1e-3; // s

    lacuna::simulation<model> sim(planet, p);
    sim.set_velocity(0, {0.0, 1.2}); // m/s
    double farthest = 0;
    sim.run(
        12000, lacuna::every(1, [&](auto const& s) { farthest = std::max(farthest, norm(s.position(0))); }),
        lacuna::at_end([](auto const& s) { std::printf("stable up to a step of %.3g s\n", s.limits().critical()); }));
    return tutorial::check("far end of the orbit, m", farthest, 1.44 / (2 - 1.44), 1e-3);
}
