// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <lacuna/core/text.hpp>
#include <lacuna/draw/picture_scene.hpp>
#include <lacuna/pores/network/pore_network.hpp>

#include "cartilage/run/results.hpp"

namespace cartilage {

/// The present pores of a run with their pressures, Pa; empty in a dry run.
template <class Simulation>
std::vector<lacuna::scene::pore> pores_of([[maybe_unused]] Simulation const& sim) {
    std::vector<lacuna::scene::pore> pores;
    if constexpr (requires { sim.flow().network(); }) {
        auto const& network = sim.flow().network();
        for (std::size_t p = 0; p < network.pores(); ++p)
            pores.push_back({lacuna::pore_middle(network, p, sim.particles().positions()), network.pressure[p]});
    }
    return pores;
}

/// The scene of the present damage, without the moment at which it is.
template <class Simulation>
lacuna::scene present_damage(Simulation const& sim, specimen const& s, options const& o,
                             std::span<crack_record const> cracks) {
    std::vector<lacuna::vec<double, 2>> position(sim.size());
    for (std::size_t id = 0; id < sim.size(); ++id) position[id] = sim.position(id);
    return damage_scene(s, o, position, cracks, pores_of(sim));
}

/// The scene of a run's present damage.
template <class Simulation>
lacuna::scene picture_of(Simulation const& sim, specimen const& s, options const& o,
                         std::span<crack_record const> cracks) {
    lacuna::scene picture = present_damage(sim, s, o, cracks);
    picture.subtitle += lacuna::formatted(", t = %.2f ns", 1e9 * sim.time());
    if (!cracks.empty()) picture.captions.push_back(lacuna::formatted("first at %.2f ns", 1e9 * cracks.front().time));
    return picture;
}

} // namespace cartilage
