// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "cartilage/run/equilibrium_run.hpp"

namespace cartilage {

/// The request to `cartilage equilibrium`.
struct equilibrium_options : equilibrium_request {
    bool json = false; ///< one JSON object on stdout in place of the table
};

/// Reads the command line after the word `equilibrium`. \copydetails parse_command_line
std::optional<equilibrium_options> parse_equilibrium_command_line(int argc, char const* const* argv);

} // namespace cartilage
