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

/// Compresses the arrays of VTK files in blocks, in the format of VTK's vtkZLibDataCompressor.
struct vtk_zlib {
    static constexpr char const* attribute = " compressor=\"vtkZLibDataCompressor\"";
    static constexpr std::size_t block = 1 << 18; ///< bytes in a block

    /// Appends a header and the compressed array. The header has the number of blocks, their length, the length of a
    /// shorter last block (or 0), and the compressed length of each block.
    /// \throws std::runtime_error if zlib fails
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
