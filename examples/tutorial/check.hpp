// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdio>

namespace tutorial {

/// Prints a value beside its expected value.
/// \param relative tolerance, as a share of the expected value; 0: both must be equal
/// \return exit status of the program: 0 if the value is right, else 1
inline int check(char const* what, double value, double expected, double relative) {
    bool const right = std::fabs(value - expected) <= relative * std::fabs(expected);
    std::printf("%s: %.9g, expected %.9g to %.1g: %s\n", what, value, expected, relative, right ? "right" : "WRONG");
    return right ? 0 : 1;
}

} // namespace tutorial
