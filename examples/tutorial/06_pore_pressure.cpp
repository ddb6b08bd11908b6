// SPDX-License-Identifier: BSD-3-Clause
//
// 6. Pore pressure. Discs, the pores between them, and fluid that flows from pore to pore.
//
// Four discs that are held enclose two equal pores with one throat between them. One pore starts at 1000 Pa, the other
// at zero. Each pressure changes at the rate C K_f / V times the difference, which therefore decays as
// exp(-2 C K_f t / V).

#include <cmath>
#include <cstdio>
#include <numbers>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation.hpp>

#include "check.hpp"

struct model : lacuna::default_model<2> {
    using flow = lacuna::explicit_flow_with<lacuna::constant_aperture>; // eq. 14 to 19 with throats of one aperture
};

int main() {
    // A rhombus of touching discs: two triangles of side 1 m, back to back.
    double const radius = 0.5, half_height = std::sqrt(0.75);
    lacuna::packing<double, 2> discs;
    discs.add({0.0, 0.0}, radius);
    discs.add({1.0, 0.0}, radius);
    discs.add({0.5, half_height}, radius);
    discs.add({0.5, -half_height}, radius);

    lacuna::simulation_parameters<model> p;
    p.flow.bulk_modulus = 1e9;       // K_f, Pa
    p.flow.conductivity = 1e-3;      // k, m/(s Pa)
    p.flow.aperture.aperture = 1e-3; // a, m: C = k a^3 / l = 1e-12 m^3/(s Pa), as l = 2 r = 1 m
    p.time_step = 1e-2;

    lacuna::simulation<model> sim(discs, p);
    for (std::size_t k = 0; k < discs.size(); ++k) sim.fix(k);
    sim.fill_pores([](auto positions, double const* radii) {
        return lacuna::make_pore_network(lacuna::triangulate_body(positions, radii), positions, radii);
    });
    sim.flow().set_pressure(0, 1000); // Pa

    double const volume = half_height / 2 - std::numbers::pi * radius * radius / 2; // less three sectors of 60 degrees
    double const decay = 2 * 1e-12 * 1e9 / volume; // 1/s
    sim.run(std::llround(1 / decay / p.time_step));

    auto const& pores = sim.flow().network();
    double const left = (pores.pressure[0] - pores.pressure[1]) / 1000;
    std::printf("pressures %.3f and %.3f Pa after %.4g s\n", pores.pressure[0], pores.pressure[1], sim.time());
    return tutorial::check("difference left", left, std::exp(-decay * sim.time()), 1e-3);
}
