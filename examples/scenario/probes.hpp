// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenario.hpp"

namespace lacuna_run {

struct value;

/// One entry of [[probes]]; the rest of the scenario is read already. \throws refusal
probe read_probe(value const& from, scenario const& s);

} // namespace lacuna_run
