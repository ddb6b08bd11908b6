// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cartilage/study/study_result.hpp"

namespace cartilage {

/// Writes what a study found into a directory that exists: `table3.csv`, the plots and snapshots as PNG and SVG, and
/// last `report.html`, which holds all of them; an earlier report in it is removed first. The same result gives the same
/// bytes.
/// \throws std::invalid_argument for a result without packings, or with numbers out of range
/// \throws std::runtime_error when a file cannot be written
void write_report(std::string const& directory, study_result const& study);

/// Names of all files that a report may have.
std::vector<std::string> report_files();

} // namespace cartilage
