// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenario.hpp"

namespace lacuna_run {

/// Reads particles from a CSV file in the format of lacuna/packings/particle_csv.hpp.
/// \param key path of the key that names the file, for messages
/// \param materials known names of materials
/// \throws refusal that names file, line, column, value and rule
void read_particle_file(std::string const& path, std::string const& key, int dimension,
                        std::vector<material> const& materials, particle_list& to);

} // namespace lacuna_run
