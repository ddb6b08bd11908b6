// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "cartilage/common/options.hpp"
#include "cartilage/run/results.hpp"

namespace cartilage {

/// Names of the files that `run` and `pack` write, for lacuna::run_directory; `#` stands for a number.
std::vector<std::string> run_results();

/// \name Writers. Each file appears complete or not at all. \throws std::runtime_error if it cannot be written
/// \{
void write_summary(std::string const& path, options const& o, run_result const& r);
void write_statistics(std::string const& path, options const& o, specimen_report const& s);
/// \}

/// \name Lines of cracks.csv, which grows during a run
/// \{
std::string crack_heading();
std::string crack_line(crack_record const& c);
/// \}

/// \name Short tables for the terminal
/// \{
void print_result(std::FILE* out, options const& o, run_result const& r);
void print_statistics(std::FILE* out, options const& o, specimen_report const& s);
/// \}

} // namespace cartilage
