// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include <lacuna/core/version.hpp>
#include <lacuna/core/whole_file.hpp>

/// \file
/// The file format of a checkpoint, in which the state is embedded. Numbers are lengths in bytes:
///
///   magic, 8 | byte order, 4 | format, 4 | library version, 3 x 4 | length of the model's name, 4 | the name |
///   length, 8, and bytes of each: input of the program | input of the simulation | state |
///   checksum of all bytes before, 8 | end mark, 8

namespace lacuna {

/// 64-bit FNV-1a hash. Each step is a bijection of the sum so far: one changed byte always changes the result.
class checksum {
public:
    checksum() = default;
    /// Continues from the sum of the bytes before.
    explicit checksum(std::uint64_t before) noexcept : sum_(before) {}
    void add(void const* data, std::size_t size) noexcept {
        auto const* byte = static_cast<unsigned char const*>(data);
        for (std::size_t k = 0; k < size; ++k) sum_ = (sum_ ^ byte[k]) * 0x100000001b3u;
    }
    std::uint64_t value() const noexcept { return sum_; }

private:
    std::uint64_t sum_ = 0xcbf29ce484222325u;
};
inline std::uint64_t checksum_of(std::string_view bytes) noexcept {
    checksum sum;
    sum.add(bytes.data(), bytes.size());
    return sum.value();
}

/// A checkpoint that cannot be used; the message names the file and the reason.
class checkpoint_error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The content of a checkpoint.
struct checkpoint_content {
    std::string model; ///< dimension, precision and the names of the parts
    std::string given; ///< bytes: constant input of the simulation, which a resumed simulation compares
    std::string state; ///< bytes
    std::string program_input{}; ///< bytes: input of the program, if it stores it; the program itself compares it
};

namespace detail {

inline constexpr char checkpoint_magic[9] = "LACUNACP", checkpoint_end[9] = "PCANUCAL";
inline constexpr std::uint32_t checkpoint_format = 7, checkpoint_byte_order = 0x01020304;
inline constexpr std::uint32_t checkpoint_version[3] = {LACUNA_VERSION_MAJOR, LACUNA_VERSION_MINOR,
                                                        LACUNA_VERSION_PATCH};

inline std::string version_text(std::uint32_t const (&v)[3]) {
    return std::to_string(v[0]) + "." + std::to_string(v[1]) + "." + std::to_string(v[2]);
}

template <class T>
void put(std::string& to, T const& value) {
    to.append(reinterpret_cast<char const*>(&value), sizeof value);
}
template <class T>
bool take(std::string_view& from, T& value) {
    if (from.size() < sizeof value) return false;
    std::memcpy(&value, from.data(), sizeof value);
    from.remove_prefix(sizeof value);
    return true;
}

} // namespace detail

/// Returns the bytes of the file.
inline std::string pack_checkpoint(checkpoint_content const& content) {
    std::string bytes(detail::checkpoint_magic, 8);
    detail::put(bytes, detail::checkpoint_byte_order);
    detail::put(bytes, detail::checkpoint_format);
    for (auto const number : detail::checkpoint_version) detail::put(bytes, number);
    detail::put(bytes, std::uint32_t(content.model.size()));
    bytes += content.model;
    for (std::string const* part : {&content.program_input, &content.given, &content.state}) {
        detail::put(bytes, std::uint64_t(part->size()));
        bytes += *part;
    }
    detail::put(bytes, checksum_of(bytes));
    bytes.append(detail::checkpoint_end, 8);
    return bytes;
}

/// Reads the bytes of a file.
/// \param name of the file, for the message
/// \throws checkpoint_error unless they are a complete and sound checkpoint of this or an earlier version
inline checkpoint_content unpack_checkpoint(std::string_view bytes, std::string const& name) {
    auto const refuse_file = [&](std::string const& why) { throw checkpoint_error("checkpoint " + name + ": " + why); };
    std::string_view rest = bytes;
    if (rest.substr(0, 8) != std::string_view(detail::checkpoint_magic, 8))
        refuse_file("it is not a checkpoint of Lacuna");
    rest.remove_prefix(8);
    std::uint32_t order = 0, format = 0, version[3] = {0, 0, 0}, name_length = 0;
    std::uint64_t length = 0, sum = 0;
    auto const need = [&](bool complete) {
        if (!complete) refuse_file("it is truncated");
    };
    need(detail::take(rest, order) && detail::take(rest, format) && detail::take(rest, version) &&
         detail::take(rest, name_length));
    if (order != detail::checkpoint_byte_order)
        refuse_file("it comes from a machine with another byte order, or is corrupted");
    auto const& ours = detail::checkpoint_version;
    bool newer = format > detail::checkpoint_format;
    for (int k = 0, equal = 1; k < 3 && equal; ++k) {
        newer = newer || version[k] > ours[k];
        equal = version[k] == ours[k];
    }
    if (newer)
        refuse_file("it was written by a newer version, " + detail::version_text(version) + " in format " +
                    std::to_string(format) + "; this is " + detail::version_text(ours) + " with format " +
                    std::to_string(detail::checkpoint_format));
    if (format != detail::checkpoint_format) refuse_file("format " + std::to_string(format) + " is unknown");
    checkpoint_content content;
    need(name_length <= rest.size());
    content.model = rest.substr(0, name_length);
    rest.remove_prefix(name_length);
    for (std::string* part : {&content.program_input, &content.given, &content.state}) {
        need(detail::take(rest, length) && length <= rest.size());
        *part = rest.substr(0, std::size_t(length));
        rest.remove_prefix(std::size_t(length));
    }
    need(detail::take(rest, sum) && rest.size() >= 8);
    if (rest != std::string_view(detail::checkpoint_end, 8))
        refuse_file("it does not end as it should: it is corrupted");
    if (sum != checksum_of(bytes.substr(0, bytes.size() - 16)))
        refuse_file("its checksum is wrong: it is corrupted");
    return content;
}

/// Writes a checkpoint under a temporary name, forces it to the disk, and renames it. A program that is killed at any
/// moment leaves the previous file or the new one.
/// \throws std::runtime_error naming the path and the system's reason
inline void write_checkpoint(std::string const& path, checkpoint_content const& content) {
    whole_file file(path);
    file.write(pack_checkpoint(content));
    file.commit_to_disk();
}

/// Reads a checkpoint. \throws checkpoint_error if the file cannot be read or unpack_checkpoint() refuses it
inline checkpoint_content read_checkpoint(std::string const& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr) throw checkpoint_error("checkpoint " + path + ": cannot read it: " + std::strerror(errno));
    std::string bytes;
    char buffer[65536];
    for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, file)) > 0;) bytes.append(buffer, count);
    bool const failed = std::ferror(file) != 0;
    std::fclose(file);
    if (failed) throw checkpoint_error("checkpoint " + path + ": cannot read it");
    return unpack_checkpoint(bytes, path);
}

} // namespace lacuna
