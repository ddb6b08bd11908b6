// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/pack.hpp>

/// \file
/// Declares lacuna::simulation and lacuna::equilibrium, for headers that only name them. Do not declare them by hand:
/// LACUNA_BEGIN_PACKS opens an inner namespace, so that a declaration without it names a different class.

namespace lacuna {

LACUNA_BEGIN_PACKS
template <class Model>
class simulation;
template <class Model>
class equilibrium;
LACUNA_END_PACKS

} // namespace lacuna
