// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cartilage/report/study_figures.hpp"

namespace cartilage {

/// Figures that belong together on the page.
struct figure_section {
    std::string title;
    std::string explanation; ///< what is drawn, for all of them
    std::vector<figure> figures;
};

/// The page of a study, complete: its pictures are those that stand in `directory`, and become part of it.
/// \throws std::runtime_error when a picture cannot be read
std::string study_page(std::string const& directory, study_result const& study, std::vector<table3_cell> const& cells,
                       std::vector<figure_section> const& sections);

} // namespace cartilage
