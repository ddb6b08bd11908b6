// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/whole_file.hpp>
#include <lacuna/observe/frame_series.hpp>
#include <lacuna/observe/vtk_scenes.hpp>

namespace lacuna {

/// One frame in the text format of LAMMPS's command dump, as OVITO reads it: id counted from 1, type (material + 1),
/// position m, radius m, velocity m/s, spin rad/s, mass kg, and the orientation as a quaternion in OVITO's columns. The
/// box is the bounding box of the particles ("shrink-wrapped").
template <class Simulation>
std::string lammps_dump_text(Simulation const& sim) {
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (std::size_t k = 0; k < sim.size(); ++k)
        for (int axis = 0; axis < 3; ++axis) {
            double const x = axis < Simulation::dim ? sim.position(k)[axis] : 0.0, r = sim.radius(k);
            low[axis] = k == 0 || x - r < low[axis] ? x - r : low[axis];
            high[axis] = k == 0 || x + r > high[axis] ? x + r : high[axis];
        }
    std::string text = "ITEM: UNITS\nsi\nITEM: TIME\n" + to_text(sim.time()) + "\nITEM: TIMESTEP\n" +
                       std::to_string(sim.steps()) + "\nITEM: NUMBER OF ATOMS\n" + std::to_string(sim.size()) +
                       "\nITEM: BOX BOUNDS ss ss ss\n";
    for (int axis = 0; axis < 3; ++axis) text += to_text(low[axis]) + " " + to_text(high[axis]) + "\n";
    text += "ITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz mass quati quatj quatk quatw\n";
    for (std::size_t k = 0; k < sim.size(); ++k) {
        std::vector<double> row;
        detail::put_three(row, sim.position(k));
        row.push_back(sim.radius(k));
        detail::put_three(row, sim.velocity(k));
        detail::put_three(row, sim.spin(k));
        row.push_back(sim.mass(k));
        detail::put_quaternion(row, sim.orientation(k));
        text += std::to_string(k + 1) + " " + std::to_string(sim.material(k) + 1);
        for (double const x : row) text += " " + to_text(x);
        text += '\n';
    }
    return text;
}

/// Writes frames for OVITO, PREFIX-STEP.dump, each complete or not at all. OVITO reads `PREFIX-*.dump` as a series.
struct lammps_frames {
    template <class Simulation>
    void write(Simulation const& sim, std::string const& prefix, std::string const& number) const {
        whole_file file(prefix + "-" + number + ".dump");
        file.write(lammps_dump_text(sim));
        file.commit();
    }
};

/// Observer that writes LAMMPS dump files of a run.
using lammps_dump = frame_series<lammps_frames>;

} // namespace lacuna
