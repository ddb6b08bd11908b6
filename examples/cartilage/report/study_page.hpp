// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cartilage/report/study_figures.hpp"

namespace cartilage {

/// A section of the page with related figures.
struct figure_section {
    std::string title;
    std::string explanation; ///< text above the figures
    std::vector<figure> figures;
};

/// The complete page of a study. Pictures are read from `directory` and embedded.
/// \throws std::runtime_error if a picture cannot be read
std::string study_page(std::string const& directory, study_result const& study, std::vector<table3_cell> const& cells,
                       std::vector<figure_section> const& sections);

} // namespace cartilage
