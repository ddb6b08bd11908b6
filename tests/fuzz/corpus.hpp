// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

/// \file
/// What the fuzz targets share: a seed corpus that each target writes itself into the folder it is given, and numbers
/// from bytes.

namespace fuzz {

/// Writes a seed into the corpus: the last argument of the command line.
inline void write_seed(int argc, char** argv, std::string const& name, std::string const& bytes) {
    if (argc > 1 && argv[argc - 1][0] != '-') std::ofstream(std::string(argv[argc - 1]) + "/" + name, std::ios::binary) << bytes;
}

/// Stops the run of the fuzzer when a promise is broken.
inline void expect(bool holds) {
    if (!holds) __builtin_trap();
}

} // namespace fuzz
