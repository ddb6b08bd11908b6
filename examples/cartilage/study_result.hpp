// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lacuna/draw/picture_scene.hpp>
#include "specimen/specimen_types.hpp"

/// \file
/// What a study found, as plain data: between the runs and the report. Loads in MPa, all else in SI units.

namespace cartilage {

/// One break, as a study keeps it.
struct study_crack {
    double time = 0; ///< s
    double x = 0;    ///< m, from the left side
    double y = 0;    ///< m, from the bottom
    bool shear = false; ///< else tension
    int fibre = -1;
};

/// Damage of one layer at the end of a probe.
struct study_layer {
    std::string zone;
    int layer = 0;
    int bonds = 0;
    int broken = 0;
    std::optional<double> half_broken_time; ///< s, when half of its bonds had broken
};

/// A run of one packing at one load.
struct probe {
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
    std::vector<study_crack> cracks;         ///< in order of time
    std::vector<study_layer> layers;

    /// Whether it ran until its time was over, so that its damage is the damage of that load.
    bool whole() const { return ended == "duration" || ended == "quiet" || ended == "limit"; }
};

/// The three loads of one packing; none: not within the range of loads.
struct thresholds {
    std::optional<double> first_crack_MPa; ///< lowest load with a broken bond
    std::optional<double> capacity_MPa;    ///< lowest load at which the first layer has half of its bonds broken
    std::optional<double> complete_MPa;    ///< lowest load at which 90 % of the fibres are cut
    /// Why a load is missing, by question; empty where there is one.
    std::string no_first_crack, no_capacity, no_complete;
};

/// All that is known of one packing.
struct packing_result {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    std::uint64_t seed = 1;
    thresholds found;
    std::vector<probe> probes; ///< by load; at one load a run that counts before a longer one that does not
};

/// What moves down through the specimen after the load has come, at one time: means over layers of equal thickness.
struct front_profile {
    double time = 0;                   ///< s
    std::size_t broken = 0;            ///< bonds broken so far
    std::vector<double> depth;         ///< m below the top: the middles of the layers
    std::vector<double> stress;        ///< Pa, vertical, of bonds and contacts, positive in tension
    std::vector<double> pore_pressure; ///< Pa, mean over the pores' volume; empty in a dry run
};

/// A run followed to its end at a load of which the paper shows a picture.
struct snapshot {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    std::uint64_t seed = 1;
    std::string figure; ///< of the paper, "10"
    probe run;
    lacuna::scene damage;               ///< at the end
    std::vector<front_profile> fronts;  ///< in order of time
};

struct study_result {
    double lowest_MPa = 5, highest_MPa = 1000, resolution = 0.02;
    std::string choices; ///< the open choices that were used, as text "name = value", one a line
    std::string code;    ///< version of the code that ran
    double step_share = 0.4; ///< time step over its rigorous bound
    bool dry = false;       ///< without pore fluid
    double length_um = 120; ///< of the specimens, horizontal
    double height_um = 300;
    std::vector<packing_result> packings; ///< by zone, then seed
    std::vector<snapshot> snapshots;      ///< by figure
};

} // namespace cartilage
