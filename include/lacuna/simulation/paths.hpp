// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>

#include <lacuna/simulation/simulation_state.hpp>

namespace lacuna {

/// Adds the largest displacement of each chunk in a step to the paths of the lists of pairs and of wall contacts. Reads
/// the step's reports.
/// \param time_step s
template <class Model>
void count_paths(simulation_state<Model>& s, typename Model::real time_step) {
    using state = simulation_state<Model>;
    using real = typename Model::real;
    static_assert(state::interactions_type::chunk_particles == state::walls_type::block_particles);
    for (std::size_t c = 0; c < s.reports.size(); ++c) {
        real squared = 0;
        for (int axis = 0; axis < Model::dim; ++axis)
            squared += s.reports[c].fastest[axis] * s.reports[c].fastest[axis];
        real const path = std::sqrt(squared) * time_step;
        s.pairs.add_path(int(c), path);
        s.walls.add_path(c, path);
    }
}

} // namespace lacuna
