// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "outcome.hpp"

namespace poroelasticity {

/// \name Runs of the cases. \param quick a coarse body and a short run: the same code in a second
/// \{
outcome run_terzaghi(bool quick);
outcome run_mandel(bool quick);
outcome run_cryer(bool quick);
outcome run_darcy(bool quick);
/// \}

} // namespace poroelasticity
