// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/core/records.hpp>
#include <lacuna/interactions/pair_loop.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Force on one particle, N, and torque on it over its radius, N.
template <class Real, int Dim>
struct particle_force {
    vec<Real, Dim> force;
    vec<Real, rotation_dim<Dim>> turning;
};

/// Sum of all forces of the last evaluation on one particle. It excludes damping policies that act on particles.
/// \param extra forces of fluid, walls and moments, in the layout of the integrators
/// \param k internal index
template <class Real, int Dim, class Interactions>
particle_force<Real, Dim> total_force(particle_store<Real, Dim> const& store, Interactions const& interactions,
                                      record_column<Real> const& extra, std::size_t k) {
    constexpr auto chunk_particles = std::size_t(Interactions::chunk_particles);
    constexpr std::size_t records = pair_forces<Real, Dim>::records_per_pair;
    particle_force<Real, Dim> sum{};
    auto const add = [&](record<Real> const& force, record<Real> const& turning) {
        for (int axis = 0; axis < Dim; ++axis) sum.force[axis] += force[axis];
        for (int axis = 0; axis < rotation_dim<Dim>; ++axis) sum.turning[axis] += turning[Dim == 2 ? 2 : axis];
    };
    interactions.for_force_sums(int(k / chunk_particles), [&](auto const& pair_force) {
        auto const of_pairs = pair_force(int(k % chunk_particles));
        if constexpr (Dim == 2)
            add(of_pairs, of_pairs);
        else
            add(of_pairs[0], of_pairs[1]);
    });
    record<Real> const load = store.load(k), none(Real(0));
    add(load, Dim == 2 ? load : store.torques().size() > 0 ? store.torques()[k] : none);
    add(extra[records * k], extra[records * (k + 1) - 1]);
    return sum;
}

/// Shifts a particle's velocity from the time of its position back by half a step.
/// \param sum present forces on the particle
/// \param half_a_step s
template <class Real, int Dim>
void set_velocity_back(particle_store<Real, Dim>& store, particle_force<Real, Dim> const& sum, std::size_t k,
                       Real half_a_step) {
    auto velocity = store.velocity(k);
    for (int axis = 0; axis < Dim; ++axis) velocity[axis] -= sum.force[axis] * store.mobility(k, axis) * half_a_step;
    store.set_velocity(k, velocity);
}
/// Shifts a particle's spin, as set_velocity_back().
template <class Real, int Dim>
void set_spin_back(particle_store<Real, Dim>& store, particle_force<Real, Dim> const& sum, std::size_t k,
                   Real half_a_step) {
    auto spin = store.spin(k);
    for (int axis = 0; axis < rotation_dim<Dim>; ++axis)
        spin[axis] -= sum.turning[axis] * store.radius(k) * store.mobility(k, Dim) * half_a_step;
    store.set_spin(k, spin);
}

} // namespace lacuna
