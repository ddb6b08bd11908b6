// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/particles/packing.hpp>

namespace lacuna {

/// Content of a file of particles: a packing, and the velocities of its particles. SI units.
template <int Dim>
struct particle_list {
    lacuna::packing<double, Dim> packing;
    std::vector<vec<double, Dim>> velocity;           ///< of each particle, m/s
    std::vector<vec<double, rotation_dim<Dim>>> spin; ///< of each particle, rad/s
    /// Density of each particle as read, kg/m^3; empty if the file has none. Simulations use packing.density.
    std::vector<double> density;

    std::size_t size() const noexcept { return packing.size(); }
    /// Appends a particle at rest.
    void add(vec<double, Dim> const& x, double radius, int material = 0) {
        packing.add(x, radius, material);
        velocity.push_back({});
        spin.push_back({});
    }
};

/// Sets the velocities and spins of a simulation's particles to those of the list from which it was made.
template <class Simulation, int Dim>
void set_motion(Simulation& sim, particle_list<Dim> const& list) {
    for (std::size_t k = 0; k < list.size(); ++k) {
        if (squared_norm(list.velocity[k]) > 0) sim.set_velocity(k, list.velocity[k]);
        if (squared_norm(list.spin[k]) > 0) sim.set_spin(k, list.spin[k]);
    }
}

namespace detail {

/// Refuses two particles in the same position, since the file probably repeats a particle.
/// \param line line number of each particle in its file
/// \throws std::invalid_argument naming the first line that repeats a position
template <int Dim>
void refuse_particles_given_twice(particle_list<Dim> const& list, std::vector<std::size_t> const& line,
                                  std::string const& name) {
    auto const& x = list.packing.position;
    std::vector<std::size_t> order(list.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    auto const less = [&](std::size_t a, std::size_t b) {
        for (int axis = 0; axis < Dim; ++axis)
            if (x[a][axis] != x[b][axis]) return x[a][axis] < x[b][axis];
        return line[a] < line[b];
    };
    std::sort(order.begin(), order.end(), less);
    std::size_t first = 0, second = 0; // `second` is the lowest line that repeats a position, that of line `first`
    for (std::size_t k = 1; k < order.size(); ++k) {
        bool same = true;
        for (int axis = 0; axis < Dim; ++axis) same = same && x[order[k - 1]][axis] == x[order[k]][axis];
        if (!same || (second > 0 && line[order[k]] > second)) continue;
        first = line[order[k - 1]];
        second = line[order[k]];
    }
    if (second > 0)
        refuse(name + ":" + std::to_string(second) + ": position", "that of line " + std::to_string(first),
               "another: two particles cannot have the same position");
}

} // namespace detail

} // namespace lacuna
