// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenario.hpp"
#include "toml_table.hpp"

namespace lacuna_run {

/// All pairs whose gap is at most `gap`, m, within rounding (lacuna::touches()), sorted. Includes overlapping pairs.
/// \throws refusal for a gap above ten median radii, and for more than a hundred times as many pairs as particles
std::vector<pair> touching_pairs(particle_list const& p, int dimension, value const& gap);

/// The row of particles on one side of a packing in the plane: their centres are visible from that side, with no other
/// disc in front. Leaves out particles within `margin`, m, of the row's ends.
std::vector<std::int32_t> row_on_side(particle_list const& p, side where, double margin);

} // namespace lacuna_run
