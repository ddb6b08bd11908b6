// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// \file
/// Stops a compiler that is set to an older standard than C++20.

#if defined(_MSVC_LANG)
#define LACUNA_LANGUAGE _MSVC_LANG
#else
#define LACUNA_LANGUAGE __cplusplus
#endif
#if LACUNA_LANGUAGE < 202002L
#error Lacuna needs C++20 or later: compile with -std=c++20 (MSVC: /std:c++20)
// A missing file ends the compilation here, before errors that would only hide the message above.
#include <lacuna_stops_here>
#endif
#undef LACUNA_LANGUAGE
