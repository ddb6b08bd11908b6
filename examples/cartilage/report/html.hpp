// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Elements of an HTML page that needs no other file.

namespace cartilage {

/// Escapes text for use between tags and in attributes.
std::string html_text(std::string_view plain);

/// Base64 code of the bytes after RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// The content of a file. \throws std::runtime_error that names the path
std::string file_bytes(std::string const& path);

/// An <img> element with the embedded picture. \param type "image/png" or "image/svg+xml" \throws as file_bytes
std::string html_picture(std::string const& path, std::string_view type, std::string_view alt);

/// Whether cells of a table stay on one line or wrap.
enum class table_cells { one_line, wrapped };

/// A table in a scrollable region, so that it does not widen a narrow page. The first cell of each row is its header.
std::string html_table(std::string_view caption, std::vector<std::string> const& head,
                       std::vector<std::vector<std::string>> const& rows, table_cells cells = table_cells::one_line);

} // namespace cartilage
