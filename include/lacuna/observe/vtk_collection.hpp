// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/growing_file.hpp>

/// \file
/// ParaView's collections (.pvd), which list the file of each time. They grow frame by frame and are complete at every
/// moment.

namespace lacuna {

namespace detail {
inline constexpr std::string_view collection_head =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
inline constexpr std::string_view collection_foot = "</Collection>\n</VTKFile>\n";
inline constexpr std::string_view collection_entry = "<DataSet timestep=\"";
} // namespace detail

/// A collection; call begin() or resume() before adding frames.
inline growing_file vtk_collection(std::string path) {
    return {std::move(path), std::string(detail::collection_head), std::string(detail::collection_foot)};
}

/// The line of one frame.
/// \param time s
/// \param file name relative to the collection
inline std::string vtk_collection_entry(double time, std::string const& file) {
    return std::string(detail::collection_entry) + to_text(time) + "\" file=\"" + file + "\"/>\n";
}

/// The part of a collection with times up to `time`, and the last of these times, s. The mark is empty if there is no
/// file, if Lacuna did not write it, or if it has later frames only.
/// \param time s
inline std::pair<file_mark, double> vtk_collection_until(std::string const& path, double time) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr) return {};
    std::string text;
    char buffer[16384];
    for (std::size_t got; (got = std::fread(buffer, 1, sizeof buffer, file)) > 0;) text.append(buffer, got);
    std::fclose(file);
    if (text.compare(0, detail::collection_head.size(), detail::collection_head) != 0) return {};
    std::size_t end = detail::collection_head.size();
    double last = 0;
    bool any = false;
    while (text.compare(end, detail::collection_entry.size(), detail::collection_entry) == 0) {
        double at = 0;
        char const* const number = text.data() + end + detail::collection_entry.size();
        auto const read = std::from_chars(number, text.data() + text.size(), at);
        auto const line = text.find('\n', end);
        if (read.ec != std::errc() || line == std::string::npos || !(at <= time)) break;
        last = at;
        any = true;
        end = line + 1;
    }
    if (!any) return {};
    checksum sum;
    sum.add(text.data(), end);
    return {file_mark{end, sum.value()}, last};
}

/// Writes a collection in one go, complete or not at all.
/// \param frames time in s, and name of a file relative to the collection
/// \throws std::runtime_error if it cannot be written
inline void save_vtk_series(std::string const& path, std::vector<std::pair<double, std::string>> const& frames) {
    std::string text(detail::collection_head);
    for (auto const& [time, name] : frames) text += vtk_collection_entry(time, name);
    whole_file file(path);
    file.write(text + std::string(detail::collection_foot));
    file.commit();
}

} // namespace lacuna
