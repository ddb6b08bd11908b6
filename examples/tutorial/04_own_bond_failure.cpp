// SPDX-License-Identifier: BSD-3-Clause
//
// 4. Your own failure criterion in the library's bond.
//
// The criterion is an ellipse instead of the paper's box (Fig. 4). In tension a bond fails if
// (F_n / T)^2 + (F_s / S)^2 > 1; under compression it fails if the shear force exceeds S. Pulled with F_n = F_s, it
// breaks at T S / sqrt(T^2 + S^2).

#include <cmath>
#include <cstdio>

#include <lacuna/observe/crack_record.hpp>
#include <lacuna/simulation.hpp>

#include "check.hpp"

using lacuna::max; // works for numbers, packs of numbers and dual numbers

struct ellipse : lacuna::plain_envelope {
    template <class T>
    static failure<T> check_strength(parameters<T> const&, T normal, T shear, T tensile_limit, T shear_limit) {
        T across = max(normal, T(0)) / tensile_limit, along = shear / shear_limit;
        return {across * across + along * along > T(1), across >= along};
    }
};

struct model : lacuna::default_model<2> {
    using bond_law = lacuna::brittle_spring_bond_with<ellipse>;
};

int main() {
    lacuna::packing<double, 2> discs;
    discs.add({0.0, 0.0}, 0.5);
    discs.add({1.0, 0.0}, 0.5);
    discs.bonds.push_back({0, 1});

    double const tensile = 3e3, shear = 4e3; // Pa; the bond is 1 m x 1 m, so these are also forces in N
    lacuna::simulation_parameters<model> p;
    p.materials[0].bond = {.normal_stiffness = 1e8, .shear_stiffness = 1e8, .tensile_strength = tensile,
                           .shear_strength = shear};

    p.time_step = 1e-4; // s; must be given: with both particles fixed there is no stable limit

    // Both particles are fixed; one moves with equal velocities along and across the bond.
    lacuna::simulation<model> sim(discs, p);
    sim.fix(0);
    sim.fix(1);
    sim.set_velocity(1, {1e-4, 1e-4}); // m/s

    lacuna::crack_record<lacuna::break_event<2>> cracks;
    while (cracks.events().empty()) sim.run(1, cracks);
    auto const& crack = cracks.events().front();
    std::printf("broke after %.4g s, F_n = %.6g N, F_s = %.6g N\n", crack.time, crack.normal_force, crack.shear_force);
    return tutorial::check("normal force at failure, N", crack.normal_force,
                           tensile * shear / std::hypot(tensile, shear), 1e-3);
}
