// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenario.hpp"
#include "toml_table.hpp"

namespace lacuna_run {

/// All pairs whose gap is at most `gap`, m, but for rounding (lacuna::touches()), overlapping ones included, sorted.
/// A gap beyond ten radii, and one with a hundred times as many pairs as particles, is refused.
std::vector<pair> touching_pairs(particles const& p, int dimension, value const& gap);

/// The row of particles on one side of the body: those whose centre is seen from there, no other disc in front of it;
/// without those nearer to one of the row's ends than `margin`, m. In the plane.
std::vector<std::int32_t> row_on_side(particles const& p, side where, double margin);

} // namespace lacuna_run
