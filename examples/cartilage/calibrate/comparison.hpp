// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cartilage/common/choices.hpp"
#include "cartilage/common/options.hpp"
#include "cartilage/study/study_result.hpp"
#include "cartilage/study/study_statistics.hpp"
#include "cartilage/study/study_table.hpp"

/// \file
/// Compares sets of choices with each other and with the paper, on the same packings.

namespace cartilage {

/// The same request with another set of choices. Duration and, unless a size was requested, the domain follow from it.
options with_choices(options const& o, choices const& wanted);

/// Effect of one choice on a load, from packings of the same seeds: median and 95 % interval of the change.
struct change_of_load {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    threshold what = threshold::first_crack;
    int pairs = 0;               ///< packings whose load is known before and after the change
    double before = 0, after = 0; ///< medians over these, MPa
    double change = 0;           ///< of the load, %; infinite if the load leaves the range upwards
    interval of_change;          ///< of the median change, %
};

/// The changes by zone, then load. Zones and loads without a pair are left out. A pair whose load is outside the range
/// both times does not count, because its change is unknown.
std::vector<change_of_load> compare(std::vector<packing_result> const& before,
                                    std::vector<packing_result> const& after);

/// One of the paper's eleven loads beside that of an ensemble.
struct target_result {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    threshold what = threshold::first_crack;
    double paper = 0;    ///< MPa
    int packings = 0;    ///< packings that decide the load
    double median = 0;   ///< MPa; infinite: above the range
    interval of_median;  ///< 95 %
    double first_quartile = 0, third_quartile = 0;

    /// ln(median / paper), limited to -ln(8) and ln(8). Loads outside the range have the limit of their side; undecided
    /// loads have ln(8).
    double misfit() const;
};

/// The paper's loads, from Table 3 and for the whole specimen, of the zones in `packings`.
std::vector<target_result> targets_of(std::vector<packing_result> const& packings);

/// Root mean square of the misfits; 0.1 is an error of about 10 %. \param targets at least one
double misfit_of(std::vector<target_result> const& targets);

/// Number of a zone's packings in which the first layer was the first to lose half of its bonds, in the run at the
/// capacity load.
struct first_layer_count {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    int first = 0;    ///< packings in which no other layer was earlier
    int packings = 0; ///< packings with such a run
};
/// The counts of all zones with at least one such run.
std::vector<first_layer_count> first_layers_of(std::vector<packing_result> const& packings);

} // namespace cartilage
