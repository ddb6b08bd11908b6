// SPDX-License-Identifier: BSD-3-Clause
#include "journal.hpp"

#include <filesystem>
#include <system_error>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/canvas_file.hpp>

namespace lacuna_run {

output_directory::output_directory(std::string const& path) : path_(path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (!std::filesystem::is_directory(path, error)) refuse("output.directory", "\"" + path + "\"", "a directory that can be made");
    try {
        // Permissions do not tell everything (read-only file systems, quotas): only writing does.
        lacuna::whole_file probe(file(".lacuna-run-probe"));
    } catch (std::runtime_error const&) {
        refuse("output.directory", "\"" + path + "\"", "a directory that can be written");
    }
}

void output_directory::write(std::string const& name, std::string const& text) const {
    lacuna::whole_file whole(file(name));
    whole.write(text);
    whole.commit();
}

std::string heading_of(scenario const& s) {
    std::string text = "step,time";
    for (probe const& p : s.probes) text += "," + p.column;
    return text + "\n";
}

std::string probes_text(journal const& j) {
    std::string text = j.heading;
    for (std::string const& row : j.rows) text += row;
    return text;
}

std::string events_text(scenario const& s, journal const& j) {
    bool const space = s.simulation.dimension == 3;
    std::string text = "step,time,bond,first,second,mode,position.x,position.y";
    text += space ? ",position.z,normal_force,shear_force,energy\n" : ",normal_force,shear_force,energy\n";
    for (break_line const& b : j.breaks) {
        text += std::to_string(b.step) + "," + lacuna::to_text(b.time) + "," + std::to_string(b.bond) + "," +
                std::to_string(b.particles[0]) + "," + std::to_string(b.particles[1]);
        text += b.shear ? ",shear" : ",tension";
        for (std::size_t axis = 0; axis < (space ? 3 : 2); ++axis) text += "," + lacuna::to_text(b.position[axis]);
        for (double const x : {b.normal_force, b.shear_force, b.energy}) text += "," + lacuna::to_text(x);
        text += "\n";
    }
    return text;
}

} // namespace lacuna_run
