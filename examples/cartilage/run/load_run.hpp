// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

/// \file
/// What a run of one packing at one load found, as plain data. Loads in MPa, all else in SI units.

namespace cartilage {

/// A run of one packing at one load.
struct load_run {
    /// One break.
    struct crack {
        double time = 0; ///< s
        double x = 0;    ///< m, from the left side
        double y = 0;    ///< m, from the bottom
        bool shear = false; ///< else tension
        int fibre = -1;
    };
    /// Damage of one layer at the end of the run.
    struct layer_damage {
        std::string zone;
        int layer = 0;
        int bonds = 0;
        int broken = 0;
        std::optional<double> half_broken_time; ///< s, when half of its bonds had broken
    };

    double load_MPa = 0;
    double end_time = 0;                     ///< s
    std::string ended;                       ///< "duration", "quiet", "limit", "first_crack", "capacity" or "complete"
    std::optional<double> first_crack_time;  ///< s, of the first broken bond
    std::optional<double> capacity_time;     ///< s, when the first layer had half of its bonds broken
    std::optional<double> complete_time;     ///< s, when 90 % of the fibres were cut
    double broken_fraction = 0;              ///< broken bonds over bonds, at the end
    double first_layer_fraction = 0;         ///< the same of the first layer (top fibre, top fifth, centre fibre)
    double cut_fraction = 0;                 ///< fibres with a broken bond over fibres
    double peak_pore_pressure = 0;           ///< Pa
    double energy_residual_fraction = 0;     ///< of the ledger, over its largest term
    std::optional<std::string> invalid;      ///< why the run does not count; none: it does
    std::vector<crack> cracks;               ///< in order of time
    std::vector<layer_damage> layers;

    /// Whether it ran until its time was over, so that its damage is the damage of that load.
    bool whole() const { return ended == "duration" || ended == "quiet" || ended == "limit"; }
};

} // namespace cartilage
