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

/// Reads the command line of `run` and `pack`. Returns nothing when only help or the version was asked for, which is then
/// on stdout. \param others commands that the help lists beside these
/// \throws usage_error for everything that is not understood or out of range
std::optional<options> parse_command_line(int argc, char const* const* argv, std::span<command_name const> others);

} // namespace cartilage
