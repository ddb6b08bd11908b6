// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "cartilage/common/choices.hpp"

/// \file
/// Sets of choices that have a name.

namespace cartilage {

/// The presets: `literal` (the paper by its words), `lattice` (equal radii on lattices, without chance), `calibrated` (the
/// set that came nearest to the paper's eleven numbers, in dry runs).
std::vector<std::string_view> preset_names();
/// \throws std::invalid_argument when there is none of that name
choices preset_choices(std::string_view name);

} // namespace cartilage
