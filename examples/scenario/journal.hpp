// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

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

/// What a run has told so far, and how it ended: all that its files say.
struct journal {
    std::vector<std::string> rows; ///< of probes.csv
    std::vector<break_line> breaks;
    struct frame {
        double time;
        std::string ending; ///< of the files' names
    };
    std::vector<frame> frames; ///< of the VTK series
    std::string heading;       ///< of probes.csv
    std::size_t broken(bool shear) const noexcept {
        std::size_t count = 0;
        for (break_line const& b : breaks) count += b.shear == shear;
        return count;
    }
};

/// The output directory: made, and proved to be writable, when it is opened; each file appears whole or not at all.
class output_directory {
public:
    /// \throws refusal when it cannot be written
    explicit output_directory(std::string const& path);
    std::string file(std::string const& name) const { return path_ + "/" + name; }
    void write(std::string const& name, std::string const& text) const;

private:
    std::string path_;
};

/// First line of probes.csv.
std::string heading_of(scenario const& s);
std::string probes_text(journal const& j);
std::string events_text(scenario const& s, journal const& j);

} // namespace lacuna_run
