// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

/// \file
/// Result of a run of one packing at one load, as plain data. Loads in MPa, all else in SI units.

namespace cartilage {

/// Result of a run of one packing at one load.
struct load_run {
    /// A broken bond.
    struct crack {
        double time = 0; ///< s
        double x = 0;    ///< m, from the left side
        double y = 0;    ///< m, from the bottom
        bool shear = false; ///< broke in shear; else in tension
        int fibre = -1;     ///< index of its fibre; -1: a cross link
    };
    /// Damage of one layer at the end of the run.
    struct layer_damage {
        std::string zone;
        int layer = 0;
        int bonds = 0;
        int broken = 0;
        std::optional<double> half_broken_time; ///< s, time at which half of its bonds were broken
    };

    double load_MPa = 0;
    double end_time = 0;                     ///< s
    std::string ended;                       ///< "duration", "quiet", "limit", "first_crack", "capacity" or "complete"
    std::optional<double> first_crack_time;  ///< s, of the first broken bond
    std::optional<double> capacity_time;     ///< s, when half of the first layer's bonds were broken
    std::optional<double> complete_time;     ///< s, when 90 % of the fibres were cut
    double broken_fraction = 0;              ///< broken bonds of fibres over all of them, at the end
    double first_layer_fraction = 0;         ///< the same for the first layer (top fibre, top fifth, centre fibre)
    double cut_fraction = 0;                 ///< fibres with a broken bond over all fibres
    double peak_pore_pressure = 0;           ///< Pa
    double energy_residual_fraction = 0;     ///< residual of the ledger over its largest term
    std::optional<std::string> invalid;      ///< why the run does not count; none: it counts
    std::vector<crack> cracks;               ///< in order of time
    std::vector<layer_damage> layers;

    /// Whether the run did not stop at a criterion, so that its damage is the final damage at that load.
    bool ran_to_end() const { return ended == "duration" || ended == "quiet" || ended == "limit"; }
};

} // namespace cartilage
