// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdio>

namespace tutorial {

/// Prints a value beside the one it should have.
/// \param relative largest difference over the expected value that is still right; 0: equal
/// \return exit status of the program: 0 when the value is right
inline int check(char const* what, double value, double expected, double relative) {
    bool const right = std::fabs(value - expected) <= relative * std::fabs(expected);
    std::printf("%s: %.9g, expected %.9g to %.1g: %s\n", what, value, expected, relative, right ? "right" : "WRONG");
    return right ? 0 : 1;
}

} // namespace tutorial
