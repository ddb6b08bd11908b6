// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <lacuna/observe/run_directory.hpp>

namespace cartilage {

/// Prints the paths of files in a directory, one a line.
inline void print_paths(lacuna::run_directory const& out, std::vector<std::string> const& names) {
    for (std::string const& name : names) std::printf("%s\n", out.file(name).c_str());
}

} // namespace cartilage
