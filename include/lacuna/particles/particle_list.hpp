// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/particles/packing.hpp>

namespace lacuna {

/// A packing and how its particles move, as files of particles hold them. SI units.
template <int Dim>
struct particle_list {
    lacuna::packing<double, Dim> packing;
    std::vector<vec<double, Dim>> velocity;            ///< of each particle, m/s
    std::vector<vec<double, rotation_dim<Dim>>> spin;  ///< of each particle, rad/s
    std::vector<double> density;                       ///< of each particle where the file has it, else none, kg/m^3

    std::size_t size() const noexcept { return packing.size(); }
    /// Appends a particle that rests.
    void add(vec<double, Dim> const& x, double radius, int material = 0) {
        packing.add(x, radius, material);
        velocity.push_back({});
        spin.push_back({});
    }
};

/// Gives the particles of a simulation the velocities and spins of the list that it was made of.
template <class Simulation, int Dim>
void set_motion(Simulation& sim, particle_list<Dim> const& list) {
    for (std::size_t k = 0; k < list.size(); ++k) {
        if (squared_norm(list.velocity[k]) > 0) sim.set_velocity(k, list.velocity[k]);
        if (squared_norm(list.spin[k]) > 0) sim.set_spin(k, list.spin[k]);
    }
}

} // namespace lacuna
