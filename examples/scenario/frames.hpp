// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "results.hpp"
#include "scenario.hpp"

namespace lacuna_run {

/// The state of a run as pictures and VTK files show it. SI units.
struct frame_data {
    struct pore {
        std::array<std::int32_t, 3> corners;
        double pressure, volume;
    };
    long long step = 0;
    double time = 0;
    std::vector<point> position, velocity;
    std::vector<char> intact; ///< of each bond
    std::vector<pore> pores;
};

/// Writes particles-<step>.vtp, with bonds also bonds-<step>.vtp, with fluid also pores-<step>.vtp. Adds each file to
/// its series particles.pvd, bonds.pvd or pores.pvd.
/// \throws std::runtime_error for a file that cannot be written
void write_vtk(results& out, frame_data const& f, scenario const& s, journal const& j);

/// Writes picture-<step>.png and picture-<step>.svg.
/// \throws std::runtime_error for a file that cannot be written
/// \throws refusal in a program built without pictures
void write_picture(results const& out, frame_data const& f, scenario const& s, journal const& j);

} // namespace lacuna_run
