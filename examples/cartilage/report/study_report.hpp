// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cartilage/study/study_result.hpp"

namespace cartilage {

/// Writes the report of a study to an existing directory: `table3.csv`, plots and snapshots as PNG and SVG, and at last
/// `report.html`, which embeds all of them. An earlier report is removed first. Equal results give equal bytes.
/// \throws std::invalid_argument for a result without packings or with numbers out of range
/// \throws std::runtime_error if a file cannot be written
void write_report(std::string const& directory, study_result const& study);

/// Names of all files that a report may have.
std::vector<std::string> report_files();

} // namespace cartilage
