// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenario.hpp"

namespace lacuna_run {

/// Reads particles from a CSV file. Its first line names the columns: position.x, position.y (position.z), radius,
/// material, and if wanted velocity.x, velocity.y (velocity.z), spin (in space spin.x, spin.y, spin.z), in any order.
/// \param key path of the key that names the file, for messages
/// \throws refusal naming file, line, column, value and rule
void read_particle_file(std::string const& path, std::string const& key, int dimension,
                        std::vector<material> const& materials, particles& to);

} // namespace lacuna_run
