// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/pack.hpp>

/// \file
/// Declares lacuna::simulation, for headers that only name it. A declaration by hand would name another class: simulation is
/// in the namespace that LACUNA_BEGIN_PACKS opens.

namespace lacuna {

LACUNA_BEGIN_PACKS
template <class Model>
class simulation;
LACUNA_END_PACKS

} // namespace lacuna
