// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "results.hpp"
#include "scenario.hpp"

namespace lacuna_run {

/// The state of a run that pictures and VTK files show.
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
    bool rigid = false; ///< of flow alone
};

/// Writes particles-<step>.vtp, bonds-<step>.vtp, pores-<step>.vtp where there are pores, and the series particles.pvd
/// and so on.
void write_vtk(results& out, frame_data const& f, scenario const& s, journal const& j);

/// Writes picture-<step>.png and .svg.
void write_picture(results const& out, frame_data const& f, scenario const& s, journal const& j);

} // namespace lacuna_run
