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
/// Sets of choices compared with each other and with the paper, on the same packings.

namespace cartilage {

/// The same request with another set of choices: their domain and duration, too, unless the size was asked for.
options with_choices(options const& o, choices const& open);

/// What one choice does to a load, on packings of the same seeds: the change in percent, median and 95 % interval.
struct change_of_load {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    threshold what = threshold::first_crack;
    int pairs = 0;               ///< packings whose load is known with and without the change
    double before = 0, after = 0; ///< medians over these, MPa
    double change = 0;           ///< of the load, %; infinite where the load leaves the range
    interval of_change;          ///< of the median change, %
};

/// By zone, then load; zones and loads without a pair are left out. A load that is beyond the range both times has not
/// changed as far as one knows: such a pair does not count.
std::vector<change_of_load> compare(std::vector<packing_result> const& before,
                                    std::vector<packing_result> const& after);

/// One of the paper's eleven numbers beside an ensemble's.
struct target_result {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    threshold what = threshold::first_crack;
    double paper = 0;    ///< MPa
    int packings = 0;    ///< that decide it
    double median = 0;   ///< MPa; infinite: above the range
    interval of_median;  ///< 95 %
    double first_quartile = 0, third_quartile = 0;

    /// ln(median / paper), at most that of eight times the paper's load either way, which also stands for loads that
    /// are beyond the range or undecided.
    double misfit() const;
};

/// The numbers of Table 3 and of the whole specimen, of the zones that `packings` has.
std::vector<target_result> targets_of(std::vector<packing_result> const& packings);

/// Root mean square of the misfits: 0.1 stands for 10 % off. \param targets at least one
double misfit_of(std::vector<target_result> const& targets);

/// In how many of a zone's packings the first layer was the first to have half of its bonds broken, in the run at the
/// capacity load; of how many with such a run.
struct first_layer_count {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    int first = 0, packings = 0;
};
std::vector<first_layer_count> first_layers_of(std::vector<packing_result> const& packings);

} // namespace cartilage
