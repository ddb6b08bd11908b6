// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <lacuna/draw/picture_scene.hpp>

namespace cartilage {

/// Indices of the kinds of particles in a scene: outside fibres, and in a fibre.
enum particle_kind { free_particle, fibre_particle };

/// Names and colours of the kinds, as in the paper's Figure 9.
inline std::vector<lacuna::scene::particle_kind> particle_kinds() {
    return {{"free particle"}, {"bonded fibre particle", {0.83, 0.16, 0.15}, {0.86, 0.86, 0.87}}};
}

} // namespace cartilage
