// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cartilage/run/equilibrium_options.hpp"

namespace cartilage {

/// The command `cartilage equilibrium`. \return whether no signal stopped it
/// \throws usage_error, std::invalid_argument, no_convergence
bool equilibrium(equilibrium_options const& o);

} // namespace cartilage
