// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace apertures {

/// One state of the pair.
struct sample {
    double force, gap;            ///< N, positive in tension; m
    double aperture, conductance; ///< m; m^3/(Pa s)
};

struct curve {
    std::string law;
    std::vector<sample> samples;
};

/// Draws apertures and conductances over the force, beside each other.
/// \throws std::runtime_error when the file cannot be written
void save_picture(std::string const& path, std::vector<curve> const& curves);

} // namespace apertures
