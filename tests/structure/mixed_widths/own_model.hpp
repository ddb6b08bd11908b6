// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/simulation/forward.hpp>

struct own_model;

std::size_t count(lacuna::simulation<own_model> const& run);
