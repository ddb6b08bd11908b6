// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

/// \file
/// What the fuzz targets share: a seed corpus that each target writes itself into the folder it is given, and numbers
/// from bytes.

namespace fuzz {

/// Writes a seed into the corpus that grows: the first folder of the command line. Others are read only.
inline void write_seed(int argc, char** argv, std::string const& name, std::string const& bytes) {
    for (int k = 1; k < argc; ++k) {
        if (argv[k][0] == '-') continue;
        std::ofstream(std::string(argv[k]) + "/" + name, std::ios::binary) << bytes;
        return;
    }
}

/// Stops the run of the fuzzer when a promise is broken.
inline void expect(bool holds, char const* promise = "") {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    __builtin_trap();
}

} // namespace fuzz
