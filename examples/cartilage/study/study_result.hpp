// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <lacuna/draw/picture_scene.hpp>

#include "cartilage/common/zone.hpp"
#include "cartilage/run/load_run.hpp"

/// \file
/// Results of a study as plain data, from the runs to the report. Loads in MPa, all else in SI units.

namespace cartilage {

enum class threshold { first_crack, capacity, complete };
inline constexpr std::array<threshold, 3> all_thresholds{threshold::first_crack, threshold::capacity,
                                                         threshold::complete};

/// The three loads of one packing; none: not found within the range of loads.
struct thresholds {
    std::optional<double> first_crack_MPa; ///< lowest load with a broken bond
    std::optional<double> capacity_MPa;    ///< lowest load at which the first layer has half of its bonds broken
    std::optional<double> complete_MPa;    ///< lowest load at which 90 % of the fibres are cut
    /// Why a load is missing, for each criterion; empty if there is a load.
    std::string no_first_crack, no_capacity, no_complete;

    std::optional<double> const& load(threshold what) const {
        return what == threshold::first_crack ? first_crack_MPa
               : what == threshold::capacity  ? capacity_MPa
                                              : complete_MPa;
    }
    std::string const& why_none(threshold what) const {
        return what == threshold::first_crack ? no_first_crack
               : what == threshold::capacity  ? no_capacity
                                              : no_complete;
    }
};

/// Loads and runs of one packing.
struct packing_result {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    std::uint64_t seed = 1;
    thresholds found;
    std::vector<load_run> runs; ///< by load; at one load a valid run comes before a longer invalid one
};

/// A load of one packing, MPa. Infinity: above the range; minus infinity: below it; none: no valid run decides.
inline std::optional<double> load_of(packing_result const& r, threshold what) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (auto const& load = r.found.load(what)) return load;
    std::string const& why = r.found.why_none(what);
    if (why.rfind("above", 0) == 0) return infinity;
    if (why.rfind("below", 0) == 0) return -infinity;
    return std::nullopt;
}

/// Profiles of stress and pore pressure over the depth at one time: means over layers of equal thickness.
struct front_profile {
    double time = 0;                   ///< s
    std::size_t broken = 0;            ///< bonds broken so far
    std::vector<double> depth;         ///< m below the top, of the middle of each layer
    std::vector<double> stress;        ///< Pa, vertical, of bonds and contacts, positive in tension
    std::vector<double> pore_pressure; ///< Pa, mean weighted by pore volume; empty in a dry run
};

/// A run to its end at the zone and load of a figure of the paper.
struct snapshot {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    std::uint64_t seed = 1;
    std::string figure; ///< number of the paper's figure, "10"
    load_run run;
    lacuna::scene damage;               ///< at the end
    std::vector<front_profile> fronts;  ///< in order of time
};

/// Settings and results of a study.
struct study_result {
    double lowest_MPa = 5, highest_MPa = 1000, resolution = 0.02;
    std::string choices; ///< all open choices, one "name = value" a line
    std::string code;    ///< version of the program, see code_version()
    double step_share = 0.4; ///< time step over its rigorous bound
    bool dry = false;       ///< without pore fluid
    double length_um = 120; ///< of the specimens, horizontal
    double height_um = 300;
    std::vector<packing_result> packings; ///< by zone, then seed
    std::vector<snapshot> snapshots;      ///< by figure
};

} // namespace cartilage
