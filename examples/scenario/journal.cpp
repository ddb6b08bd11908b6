// SPDX-License-Identifier: BSD-3-Clause
#include "journal.hpp"

#include <lacuna/core/error.hpp>

namespace lacuna_run {

std::string heading_of(scenario const& s) {
    std::string text = "step,time";
    for (probe const& p : s.probes) text += "," + p.column;
    return text + "\n";
}

std::string event_heading(scenario const& s) {
    std::string const text = "step,time,bond,first,second,mode,position.x,position.y";
    return text + (s.simulation.dimension == 3 ? ",position.z" : "") + ",normal_force,shear_force,energy\n";
}

std::string event_text(scenario const& s, break_line const& b) {
    std::string text = std::to_string(b.step) + "," + lacuna::to_text(b.time) + "," + std::to_string(b.bond) + "," +
                       std::to_string(b.particles[0]) + "," + std::to_string(b.particles[1]);
    text += b.shear ? ",shear" : ",tension";
    for (int axis = 0; axis < s.simulation.dimension; ++axis)
        text += "," + lacuna::to_text(b.position[std::size_t(axis)]);
    for (double const x : {b.normal_force, b.shear_force, b.energy}) text += "," + lacuna::to_text(x);
    return text + "\n";
}

} // namespace lacuna_run
