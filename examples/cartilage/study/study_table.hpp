// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cartilage/study/study_result.hpp"
#include "cartilage/study/study_statistics.hpp"

/// \file
/// Table 3 of the paper beside that of a study. Loads in MPa; infinite: outside the study's range of loads.

namespace cartilage {

/// "first crack", "capacity" or "complete".
char const* name_of(threshold what);

/// The paper's load from its Table 3 or, for the whole specimen, from the text beside its Figure 12. None for complete
/// damage of the whole specimen.
std::optional<double> paper_load(lacuna::cartilage_zone zone, threshold what);

/// One load of one zone over all packings of a study.
struct table3_cell {
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    threshold what = threshold::first_crack;
    std::vector<double> loads; ///< of the packings that a valid run decides, sorted
    int invalid = 0;           ///< packings that no valid run decides
    int none = 0;              ///< packings in `loads` that hold at the highest load
    double first_quartile = 0, median = 0, third_quartile = 0;
    interval of_median;                     ///< 95 %
    std::optional<double> paper;            ///< the paper's load
    std::optional<double> paper_percentile; ///< share of the packings below the paper's load, %

    int count() const { return int(loads.size()); }
};

/// The cell of these loads of packings, MPa; infinite: above the highest load; none: undecided.
table3_cell cell_of(lacuna::cartilage_zone zone, threshold what, std::vector<std::optional<double>> const& loads,
                    double highest_MPa);

/// The cells of all zones of the study, zone by zone. A packing without a load holds if a valid run at the highest load
/// shows it, has failed if a valid run at the lowest load shows it, and is invalid otherwise.
std::vector<table3_cell> table3(study_result const& study);

/// A load in MPa to three significant digits, never with a power of ten.
std::string load_number(double load_MPa);

/// A load as text: its number, "> 1000" above the range, "< 5" below it.
std::string load_text(double load_MPa, study_result const& study);

/// The table as CSV, one row per cell. Missing numbers are empty.
std::string table3_csv(std::vector<table3_cell> const& cells, study_result const& study);

} // namespace cartilage
