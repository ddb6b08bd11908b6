// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace lacuna_run {

/// What a text would overflow the stack of a reader that calls itself with: lists and tables within each other, and keys
/// of many parts. A scenario has at most five levels.
/// \param name of the file
/// \throws refusal for more than 64 levels or parts, and for a NUL byte, with line and rule
void require_shallow(std::string_view text, std::string const& name);

} // namespace lacuna_run
