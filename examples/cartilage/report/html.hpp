// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Pieces of an HTML page that needs no other file.

namespace cartilage {

/// Text as it stands between tags and in attributes.
std::string html_text(std::string_view plain);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// The whole of a file. \throws std::runtime_error naming the path
std::string file_bytes(std::string const& path);

/// An <img> that holds the picture. \param type "image/png" or "image/svg+xml" \throws as file_bytes
std::string html_picture(std::string const& path, std::string_view type, std::string_view alt);

/// Whether the words of a table's cells may be broken into lines.
enum class table_cells { one_line, wrapped };

/// A table in a scroller of its own, so that a narrow page stays narrow. The first cell of each row is its header.
std::string html_table(std::string_view caption, std::vector<std::string> const& head,
                       std::vector<std::vector<std::string>> const& rows, table_cells cells = table_cells::one_line);

} // namespace cartilage
