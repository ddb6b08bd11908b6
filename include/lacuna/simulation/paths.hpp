// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include <lacuna/motion/symplectic_euler.hpp>

namespace lacuna {

/// Adds the largest displacement of each chunk in a step to the paths of the lists of pairs and of wall contacts.
/// \param reports reports of the step, one per chunk
/// \param time_step s
template <int Dim, class Real, class Interactions, class Walls>
void count_paths(std::span<motion_report<Real> const> reports, Real time_step, Interactions& interactions, Walls& walls) {
    static_assert(Interactions::chunk_particles == Walls::block_particles);
    for (std::size_t c = 0; c < reports.size(); ++c) {
        Real squared = 0;
        for (int axis = 0; axis < Dim; ++axis) squared += reports[c].fastest[axis] * reports[c].fastest[axis];
        Real const path = std::sqrt(squared) * time_step;
        interactions.add_path(int(c), path);
        walls.add_path(c, path);
    }
}

} // namespace lacuna
