// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "outcome.hpp"

namespace poroelasticity {

/// Draws the pressure field over the packing, and beside it the curves: points of the run on lines of the closed form.
/// \throws std::runtime_error when the file cannot be written
void save_picture(std::string const& path, outcome const& o);

} // namespace poroelasticity
