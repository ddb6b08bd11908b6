// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <lacuna/core/vec.hpp>
#include <lacuna/interactions/break_event.hpp>
#include <lacuna/draw/picture_scene.hpp>

#include "options.hpp"
#include "report.hpp"
#include "specimen.hpp"

/// \file
/// From what a run saw to what it reports: breaks sorted to fibres and layers, and the picture of the damage.

namespace cartilage {

/// The record of a break, with its fibre and the direction in which the bond was laid.
crack_record crack_of(specimen const& s, lacuna::break_event<2> const& event);

/// Sorts the cracks of `r` to layers (by zone, then number) and counts the fibres with at least one.
void sort_cracks(specimen const& s, run_result& r);

/// The damage at a time of the run. \param position of the particles by id, m \param pores as they stand
lacuna::scene damage_scene(specimen const& s, options const& o, std::span<lacuna::vec<double, 2> const> position,
                           std::span<crack_record const> cracks, std::vector<lacuna::scene::pore> pores, double time);

} // namespace cartilage
