// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <lacuna/observe/growing_file.hpp>

#include "scenario.hpp"

namespace lacuna_run {

/// A broken bond, for events.csv and pictures.
struct break_line {
    long long step = 0;
    double time = 0;
    std::int32_t bond = 0;
    pair particles{};
    bool shear = false;
    point position{}, direction{};
    double normal_force = 0, shear_force = 0, energy = 0;
};

/// A broken bond in pictures and VTK files.
struct crack {
    std::int32_t bond = 0;
    bool shear = false;
    point position{}, direction{};
};

/// The cracks so far, and how many bytes of each growing file are written. Part of a run's state. Rows of probes.csv
/// and events.csv are stored in the files alone.
struct journal {
    std::string heading; ///< of probes.csv
    std::vector<crack> cracks;
    lacuna::file_mark probes, events, particles, bonds, pores; ///< of the CSV files and the series of frames
    std::size_t broken(bool shear) const noexcept {
        std::size_t count = 0;
        for (crack const& c : cracks) count += c.shear == shear;
        return count;
    }
};

/// First line of probes.csv.
std::string heading_of(scenario const& s);
/// First line of events.csv.
std::string event_heading(scenario const& s);
/// A line of events.csv.
std::string event_text(scenario const& s, break_line const& b);

} // namespace lacuna_run
