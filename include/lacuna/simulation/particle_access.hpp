// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// The particles of a simulation, read by the number they have in the packing: their stable id.
template <class Real, int Dim>
class particle_access {
public:
    using point = vec<double, Dim>;

    std::size_t size() const noexcept { return store_.size(); }
    point position(std::size_t id) const { return convert<double>(store_.position(internal(id))); }
    point velocity(std::size_t id) const { return convert<double>(store_.velocity(internal(id))); }
    vec<double, rotation_dim<Dim>> spin(std::size_t id) const { return convert<double>(store_.spin(internal(id))); }
    double radius(std::size_t id) const { return double(store_.radius(internal(id))); }
    double mass(std::size_t id) const { return double(store_.mass(internal(id))); }
    double moment_of_inertia(std::size_t id) const { return double(store_.moment_of_inertia(internal(id))); }
    int material(std::size_t id) const { return store_.material(internal(id)); }
    /// Eq. 8's unit vector in 2D, a unit quaternion {w, x, y, z} in 3D.
    auto orientation(std::size_t id) const { return convert<double>(store_.orientation(internal(id))); }

    /// Kinetic energy of all particles with their present velocities, J.
    double kinetic_energy() const {
        double total = 0;
        for (std::size_t k = 0; k < store_.size(); ++k)
            total += 0.5 * double(store_.mass(k)) * double(squared_norm(store_.velocity(k))) +
                     0.5 * double(store_.moment_of_inertia(k)) * double(squared_norm(store_.spin(k)));
        return total;
    }

    /// The particles as the step sees them, in the library's own order.
    particle_store<Real, Dim> const& particles() const noexcept { return store_; }

protected:
    std::size_t internal(std::size_t id) const {
        if (id >= store_.size()) refuse("particle", double(id), "below the number of particles, " + std::to_string(store_.size()));
        return std::size_t(store_.internal(id));
    }

    particle_store<Real, Dim> store_;
};

} // namespace lacuna
