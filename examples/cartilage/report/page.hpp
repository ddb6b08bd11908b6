// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// \file
/// The frame that all pages of the program have: one style, nothing from elsewhere.

namespace cartilage {

/// From the beginning to the open body. \param title of the window, plain text
std::string page_head(std::string const& title);
std::string page_end();

/// \name From plain text \param kind of the paragraph, empty or "lead"
/// \{
std::string html_paragraph(std::string const& plain, char const* kind = "");
std::string html_heading(std::string const& plain);
/// \}

} // namespace cartilage
