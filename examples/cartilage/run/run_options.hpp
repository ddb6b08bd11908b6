// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "cartilage/common/options.hpp"

namespace cartilage {

/// A command of the program that reads its own options.
struct command_name {
    char const* name;
    char const* description;
};

/// Reads the command line of `run` and `pack`. \param others further commands that the help lists
/// \return none if only help or the version was requested, which is then on stdout
/// \throws usage_error for unknown options and values that are not allowed
std::optional<options> parse_command_line(int argc, char const* const* argv, std::span<command_name const> others);

} // namespace cartilage
