// SPDX-License-Identifier: BSD-3-Clause
//
// 8. The stable time step, and what happens beyond it.
//
// The paper's eq. 9 gives sqrt(m / k) for a chain. But bonded discs also rotate. With k_s = k_n the fastest mode of a
// long chain is the one in which all discs rotate alike. Its frequency is sqrt(8 k / m), and the longest stable step is
// 2 over that frequency: 0.71 of eq. 9. The library's bound is rigorous: it is never above the true limit.

#include <cmath>
#include <cstdio>

#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/simulation.hpp>

#include "check.hpp"

struct model : lacuna::default_model<2> {};

lacuna::simulation<model> chain(double time_step) {
    lacuna::simulation_parameters<model> p;
    p.materials[0].bond = {.normal_stiffness = 1e6, .shear_stiffness = 1e6};
    p.time_step = time_step;      // 0: `safety` times the bound
    p.allow_unstable_step = true; // else a step above the bound is refused
    lacuna::simulation<model> sim(lacuna::chain<double, 2>(50, 0.5), p);
    for (std::size_t k = 0; k < sim.size(); ++k) sim.set_spin(k, {1e-6}); // rad/s
    return sim;
}

/// Whether a guard stops a run of 5,000 steps.
bool runs_away(double time_step) {
    auto sim = chain(time_step);
    try {
        sim.run(5000);
    } catch (lacuna::unstable_run const&) { // its message names step, time, particle and likely cause
        return true;
    }
    return false;
}

int main() {
    auto const limits = chain(0).limits();
    double stable = limits.rigorous, unstable = 1.1 * limits.wave_limit;
    if (runs_away(stable) || !runs_away(unstable)) return 1;
    while (unstable - stable > 1e-3 * stable) {
        double const middle = (stable + unstable) / 2;
        (runs_away(middle) ? unstable : stable) = middle;
    }
    std::printf("eq. 9: %.4g s; the library's bound: %.4g s; found by trial: stable at %.4g s, unstable at %.4g s\n",
                limits.wave_limit, limits.rigorous, stable, unstable);
    return tutorial::check("longest stable step over eq. 9", stable / limits.wave_limit, 1 / std::sqrt(2.0), 1e-2);
}
