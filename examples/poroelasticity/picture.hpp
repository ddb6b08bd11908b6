// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "outcome.hpp"

namespace poroelasticity {

/// Draws the pressure field with the packing and, beside it, the curves: circles for the run, lines for the closed
/// form.
/// \throws std::runtime_error if the file cannot be written
void save_picture(std::string const& path, outcome const& o);

} // namespace poroelasticity
