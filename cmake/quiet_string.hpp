// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Read by g++ 12 before each source of the programs built here. It takes inserts into std::string for copies onto
// themselves (GCC bug 105651): silent in the library's own lines, where they arise.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wrestrict"
#include <string>
#pragma GCC diagnostic pop
