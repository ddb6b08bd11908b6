// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cartilage/report/study_figures.hpp"
#include "cartilage/study/equilibrium_study.hpp"

namespace cartilage {

/// Names of all files that the report of a study in equilibrium may have.
std::vector<std::string> equilibrium_report_files();

/// Draws the loads of all packings, the positions of their breaks, and the loads at which their layers are cut.
/// \throws std::runtime_error if a file cannot be written
std::vector<figure> draw_equilibrium_figures(std::string const& directory, study_result const& study,
                                             std::vector<table3_cell> const& cells,
                                             std::vector<equilibrium_packing> const& packings);

} // namespace cartilage
