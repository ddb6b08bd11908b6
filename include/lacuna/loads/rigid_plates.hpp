// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/core/state.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Rigid, smooth, massless plates: groups of particles that move as one along an axis and freely across it. A plate
/// distributes the sum F of the forces on its particles, of total mass M, so that all have the same acceleration:
///
///   f_k <- m_k F / M
///
/// The forces that a plate adds sum to zero and act at one common velocity: they conserve momentum and do no work.
template <class Real, int Dim>
class rigid_plates {
public:
    bool empty() const noexcept { return axis_.empty(); }
    std::size_t size() const noexcept { return axis_.size(); }
    int axis(std::size_t plate) const noexcept { return axis_[plate]; } ///< along which its particles move as one
    /// Internal indices of a plate's particles, sorted.
    std::span<std::uint32_t const> members(std::size_t plate) const noexcept {
        std::size_t const first = plate == 0 ? 0 : end_[plate - 1];
        return std::span(particles_).subspan(first, end_[plate] - first);
    }

    /// Adds a plate.
    /// \param particles internal indices
    /// \param axis axis along which they move as one
    /// \throws std::invalid_argument naming a particle that is given twice, is in another plate of this axis, or has
    ///         another velocity than the first; also for a plate without particles
    void add(particle_store<Real, Dim> const& store, std::vector<std::size_t> particles, int axis) {
        require_in("axis of a rigid plate", axis, 0, Dim - 1);
        if (particles.empty()) refuse("particles of a rigid plate", "none", "at least one");
        std::sort(particles.begin(), particles.end());
        std::vector<std::uint32_t> taken;
        for (std::size_t g = 0; g < axis_.size(); ++g)
            if (axis_[g] == axis) taken.insert(taken.end(), members(g).begin(), members(g).end());
        std::sort(taken.begin(), taken.end());
        for (std::size_t n = 0; n < particles.size(); ++n) {
            std::size_t const k = particles[n];
            bool const twice = (n > 0 && particles[n - 1] == k) ||
                               std::binary_search(taken.begin(), taken.end(), std::uint32_t(k));
            std::string const name = "particle " + std::to_string(store.id(k)) + " of a rigid plate";
            if (twice) refuse(name, "given twice", "in one plate along an axis, once");
            double const v = double(store.velocity(k)[axis]), first = double(store.velocity(particles[0])[axis]);
            if (v != first) refuse(name + ": velocity", v, "that of the plate, " + to_text(first));
        }
        axis_.push_back(axis);
        particles_.insert(particles_.end(), particles.begin(), particles.end());
        end_.push_back(std::uint32_t(particles_.size()));
    }

    /// Distributes the forces. A plate with a particle that is fixed along the axis does not accelerate.
    /// \param force callable: k -> sum of all forces on particle k, N
    /// \param extra receives the forces that the plates add, N; layout as in symplectic_euler::advance()
    template <class Force>
    void share(particle_store<Real, Dim> const& store, Force const& force, record_column<Real>& extra) const {
        for (std::size_t g = 0; g < axis_.size(); ++g) {
            int const axis = axis_[g];
            Real sum(0), mass(0);
            bool held = false;
            for (auto const k : members(g)) {
                sum += force(k)[axis];
                mass += store.mass(k);
                held = held || store.mobility(k, axis) == Real(0);
            }
            Real const acceleration = held ? Real(0) : sum / mass;
            for (auto const k : members(g))
                extra.at(Dim == 2 ? k : 2 * k, axis) += store.mass(k) * acceleration - force(k)[axis];
        }
    }

    /// Sum over all plates of of_plate(axis, sum of of_particle(k) over its particles). It does not depend on the order
    /// of plates and particles.
    template <class OfParticle, class OfPlate>
    std::uint64_t sum_of_plates(OfParticle const& of_particle, OfPlate const& of_plate) const {
        std::uint64_t sum = 0;
        for (std::size_t g = 0; g < axis_.size(); ++g) {
            std::uint64_t particles = 0;
            for (auto const k : members(g)) particles += of_particle(k);
            sum += of_plate(axis_[g], particles);
        }
        return sum;
    }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(axis_, end_, particles_);
        require_state(end_.size() == axis_.size() && (end_.empty() ? 0 : end_.back()) == particles_.size() &&
                          std::is_sorted(end_.begin(), end_.end()),
                      "a rigid plate");
        for (int const axis : axis_) require_state(axis >= 0 && axis < Dim, "a rigid plate's axis");
    }
    /// True if all plates consist of particles with an index below `count`.
    bool fit(std::size_t count) const noexcept {
        return std::all_of(particles_.begin(), particles_.end(), [&](std::uint32_t k) { return k < count; });
    }

private:
    std::vector<int> axis_;            // of each plate
    std::vector<std::uint32_t> end_;   // end of each plate's particles in particles_
    std::vector<std::uint32_t> particles_;
};

} // namespace lacuna
