// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "cartilage/common/choices.hpp"

/// \file
/// Named sets of choices.

namespace cartilage {

/// The presets: `literal` (the values that the paper states), `lattice` (equal radii on lattices, nothing random) and
/// `calibrated` (the set that came nearest to the paper's eleven loads, in dry runs).
std::vector<std::string_view> preset_names();
/// The choices of a preset. \throws std::invalid_argument if there is none of that name
choices preset_choices(std::string_view name);

} // namespace cartilage
