// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/loads/rigid_plates.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Numbers of the unknowns of an equilibrium: the free displacements of the particles. A rotation counts as the
/// displacement of the particle's surface, angle times radius, so that all unknowns are lengths. The particles of a
/// rigid plate share one unknown along its axis. A wall that a servo moves has one unknown along its normal.
template <int Dim>
class unknowns {
public:
    static constexpr int rotations = rotation_dim<Dim>;
    static constexpr int per_particle = Dim + rotations; ///< freedoms of a particle: displacements, then rotations

    unknowns() = default;
    /// Fixed freedoms of the store get no unknown; neither do plates with a particle that is fixed along their axis.
    /// \param free_walls for each wall, whether it is free along its normal; may be empty
    template <class Real>
    unknowns(particle_store<Real, Dim> const& store, rigid_plates<Real, Dim> const& plates,
             std::vector<char> const& free_walls = {})
        : index_(store.size() * per_particle, 0) {
        constexpr int held = -1, in_plate = -2;
        for (std::size_t k = 0; k < store.size(); ++k)
            for (int f = 0; f < per_particle; ++f)
                if (store.mobility(k, f < Dim ? f : Dim) == Real(0)) index_[k * per_particle + std::size_t(f)] = held;
        for (std::size_t g = 0; g < plates.size(); ++g)
            for (auto const k : plates.members(g)) {
                auto& index = index_[k * per_particle + std::size_t(plates.axis(g))];
                if (index != held) index = in_plate;
            }
        for (auto& index : index_)
            if (index == 0) index = count_++;
        own_ = count_;
        for (std::size_t g = 0; g < plates.size(); ++g) {
            bool free = true;
            for (auto const k : plates.members(g)) free = free && of(k, plates.axis(g)) == in_plate;
            int const shared = free ? count_++ : held;
            for (auto const k : plates.members(g)) index_[k * per_particle + std::size_t(plates.axis(g))] = shared;
        }
        for (char const free : free_walls) wall_.push_back(free ? count_++ : held);
    }

    int count() const noexcept { return count_; }
    /// Whether an unknown is not that of one particle, but of a plate or a wall.
    bool shared(int unknown) const noexcept { return unknown >= own_; }
    /// Number of a freedom's unknown; -1: the freedom is held.
    int of(std::size_t particle, int freedom) const noexcept {
        return index_[particle * per_particle + std::size_t(freedom)];
    }
    /// Number of a wall's unknown; -1: the wall is held.
    int of_wall(std::size_t w) const noexcept { return wall_[w]; }
    /// The numbers of a particle's freedoms.
    std::span<int const> of(std::size_t particle) const noexcept {
        return std::span(index_).subspan(particle * per_particle, per_particle);
    }

private:
    std::vector<int> index_, wall_;
    int count_ = 0, own_ = 0;
};

} // namespace lacuna
