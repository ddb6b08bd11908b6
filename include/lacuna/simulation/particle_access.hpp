// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Read access to particles by id, their number in the packing. `Simulation` derives from this class and has
/// particles(), which returns a particle_store<Real, Dim>.
template <class Simulation, class Real, int Dim>
class particle_access {
public:
    using point = vec<double, Dim>;

    std::size_t size() const noexcept { return store().size(); }
    /// m.
    point position(std::size_t id) const { return convert<double>(store().position(internal(id))); }
    /// m/s.
    point velocity(std::size_t id) const { return convert<double>(store().velocity(internal(id))); }
    /// rad/s.
    vec<double, rotation_dim<Dim>> spin(std::size_t id) const { return convert<double>(store().spin(internal(id))); }
    double radius(std::size_t id) const { return double(store().radius(internal(id))); }
    double mass(std::size_t id) const { return double(store().mass(internal(id))); }
    double moment_of_inertia(std::size_t id) const { return double(store().moment_of_inertia(internal(id))); }
    int material(std::size_t id) const { return store().material(internal(id)); }
    /// Unit vector of the paper's eq. 8 in 2D, unit quaternion {w, x, y, z} in 3D.
    auto orientation(std::size_t id) const { return convert<double>(store().orientation(internal(id))); }

    /// Kinetic energy of all particles with their present velocities, J.
    double kinetic_energy() const {
        double total = 0;
        for (std::size_t k = 0; k < size(); ++k)
            total += 0.5 * double(store().mass(k)) * double(squared_norm(store().velocity(k))) +
                     0.5 * double(store().moment_of_inertia(k)) * double(squared_norm(store().spin(k)));
        return total;
    }

protected:
    /// \throws std::invalid_argument for an id that no particle has
    std::size_t internal(std::size_t id) const {
        if (id >= size()) refuse("particle", double(id), "below the number of particles, " + std::to_string(size()));
        return std::size_t(store().internal(id));
    }

private:
    particle_store<Real, Dim> const& store() const noexcept {
        return static_cast<Simulation const&>(*this).particles();
    }
};

} // namespace lacuna
