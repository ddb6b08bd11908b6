// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../terminal_progress.hpp"
#include "outcome.hpp"

namespace poroelasticity {

/// \name Runs of the cases
/// \param quick a coarse model and a short run: the same code in a second
/// \param progress display of the progress
/// \{
outcome run_terzaghi(bool quick, programs::terminal_progress& progress);
outcome run_mandel(bool quick, programs::terminal_progress& progress);
outcome run_cryer(bool quick, programs::terminal_progress& progress);
outcome run_darcy(bool quick, programs::terminal_progress& progress);
outcome run_creep(bool quick, programs::terminal_progress& progress);
outcome run_relaxation(bool quick, programs::terminal_progress& progress);
/// The first three in slow time, from early to late times.
outcome run_slow_terzaghi(bool quick, programs::terminal_progress& progress);
outcome run_slow_mandel(bool quick, programs::terminal_progress& progress);
outcome run_slow_cryer(bool quick, programs::terminal_progress& progress);
/// \}

} // namespace poroelasticity
