// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace lacuna_run {

/// Refuses text that could overflow the stack of the recursive TOML reader: deeply nested lists and tables, and keys of
/// many parts. A scenario needs at most five levels.
/// \param name of the file, for messages
/// \throws refusal with line and rule for more than 64 levels or parts, and for a NUL byte
void require_shallow(std::string_view text, std::string const& name);

} // namespace lacuna_run
