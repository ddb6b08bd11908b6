// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/core/whole_file.hpp>

namespace cartilage {

/// Writes a file that appears complete or not at all. \throws std::runtime_error if it cannot be written
inline void write_whole(std::string const& path, std::string const& text) {
    lacuna::whole_file file(path);
    file.write(text);
    file.commit();
}

} // namespace cartilage
