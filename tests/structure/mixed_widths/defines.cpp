// SPDX-License-Identifier: BSD-3-Clause
#include "own_model.hpp"

#include <lacuna/simulation.hpp>

struct own_model : lacuna::default_model<2> {};

std::size_t count(lacuna::simulation<own_model> const& run) { return run.size(); }
