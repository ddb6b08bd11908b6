// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace apertures {

/// One state of the pair of discs.
struct sample {
    double force, gap;            ///< N, positive in tension; m
    double aperture, conductance; ///< m; m^3/(Pa s)
};

/// The states of the pair with one aperture law.
struct curve {
    std::string law;
    std::vector<sample> samples;
};

/// Draws apertures and conductances as functions of the force, side by side.
/// \throws std::runtime_error if the file cannot be written
void save_picture(std::string const& path, std::vector<curve> const& curves);

} // namespace apertures
