// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <lacuna/core/state.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Velocity and spin of a particle before it was given another velocity or spin between two steps.
template <class Real, int Dim>
struct velocity_change {
    std::size_t particle; ///< internal index
    vec<Real, Dim> velocity;
    vec<Real, rotation_dim<Dim>> spin;
    bool of_spin; ///< whether the spin was given, not the velocity
};

/// The velocities that were given to particles since the last step.
///
/// The slip of a step comes from the motion before it, when the particles had their old velocities. So a step swaps the
/// old velocities in while it evaluates the forces.
template <class Real, int Dim>
class velocity_changes {
public:
    using change = velocity_change<Real, Dim>;

    bool empty() const noexcept { return changes_.empty(); }
    auto begin() const noexcept { return changes_.begin(); }
    auto end() const noexcept { return changes_.end(); }
    void clear() noexcept { changes_.clear(); }

    /// Records the velocity and spin of particle k, one of which is about to change.
    void add(particle_store<Real, Dim> const& store, std::size_t k, bool of_spin) {
        changes_.push_back({k, store.velocity(k), store.spin(k), of_spin});
    }

    /// Restores the velocities from before the changes, the last change first.
    void swap_in_old(particle_store<Real, Dim>& store) {
        std::for_each(changes_.rbegin(), changes_.rend(), [&](change& c) { swap_velocities(store, c); });
    }
    /// Restores the given velocities, the first change first.
    /// \param after called with each change once its new velocity is in place
    template <class After>
    void swap_in_new(particle_store<Real, Dim>& store, After const& after) {
        for (change& c : changes_) {
            swap_velocities(store, c);
            after(c);
        }
    }

    /// Internal index of the fastest particle that was given a velocity; -1: none.
    std::int32_t fastest(particle_store<Real, Dim> const& store) const noexcept {
        std::int32_t found = -1;
        Real speed = -1;
        for (change const& c : changes_)
            if (Real const own = squared_norm(store.velocity(c.particle)); !c.of_spin && own > speed)
                speed = own, found = std::int32_t(c.particle);
        return found;
    }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(changes_);
    }
    bool fit(std::size_t count) const noexcept {
        return std::all_of(begin(), end(), [&](change const& c) { return c.particle < count; });
    }

private:
    static void swap_velocities(particle_store<Real, Dim>& store, change& c) {
        change const now{c.particle, store.velocity(c.particle), store.spin(c.particle), c.of_spin};
        store.set_velocity(c.particle, c.velocity);
        store.set_spin(c.particle, c.spin);
        c = now;
    }

    std::vector<change> changes_;
};

} // namespace lacuna
