// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <zlib.h>

#include <lacuna/observe/vtk.hpp>

namespace lacuna {

/// Stores the arrays of VTK files compressed, in blocks, as VTK's own vtkZLibDataCompressor does.
struct vtk_zlib {
    static constexpr char const* attribute = " compressor=\"vtkZLibDataCompressor\"";
    static constexpr std::size_t block = 1 << 18; ///< bytes that are compressed together

    /// Appends an array, after the number of its blocks, their length, that of a last block that is shorter (or 0), and
    /// the compressed length of each.
    /// \throws std::runtime_error when zlib cannot
    static void append(std::string& data, void const* array, std::size_t bytes) {
        std::vector<std::uint64_t> header{(bytes + block - 1) / block, block, bytes % block};
        auto const* from = static_cast<unsigned char const*>(array);
        std::string packed;
        for (std::size_t at = 0; at < bytes; at += block) {
            auto const length = uLong(std::min(block, bytes - at));
            auto room = compressBound(length);
            auto const begin = packed.size();
            packed.resize(begin + room);
            if (compress2(reinterpret_cast<Bytef*>(&packed[begin]), &room, from + at, length, Z_BEST_SPEED) != Z_OK)
                throw std::runtime_error("zlib cannot compress a block of a VTK file");
            packed.resize(begin + room);
            header.push_back(room);
        }
        data.append(reinterpret_cast<char const*>(header.data()), header.size() * sizeof header[0]);
        data += packed;
    }
};

} // namespace lacuna
