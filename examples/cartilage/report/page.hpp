// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// \file
/// The common frame of all pages: one style sheet, no external resources.

namespace cartilage {

/// The beginning of a page, up to and with the tag <body>. \param title of the window, plain text
std::string page_head(std::string const& title);
/// The end of a page, from the tag </body> on.
std::string page_end();

/// \name Elements from plain text \param kind CSS class of the paragraph, empty or "lead"
/// \{
std::string html_paragraph(std::string const& plain, char const* kind = "");
std::string html_heading(std::string const& plain);
/// \}

} // namespace cartilage
