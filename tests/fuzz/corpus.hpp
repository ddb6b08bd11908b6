// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

/// \file
/// Shared by the fuzz targets: writing seeds into the corpus folder, and checks of promises.

namespace fuzz {

/// Writes a seed into the growing corpus, the first folder of the command line. libFuzzer only reads other folders.
inline void write_seed(int argc, char** argv, std::string const& name, std::string const& bytes) {
    for (int k = 1; k < argc; ++k) {
        if (argv[k][0] == '-') continue;
        std::ofstream(std::string(argv[k]) + "/" + name, std::ios::binary) << bytes;
        return;
    }
}

/// Stops the fuzzer if a promise is broken.
inline void expect(bool holds, char const* promise = "") {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    __builtin_trap();
}

} // namespace fuzz
