// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <lacuna/core/whole_file.hpp>
#include <lacuna/observe/checkpoint_file.hpp>

namespace lacuna {

/// The beginning of a growing file that belongs to a state.
struct file_mark {
    std::uint64_t bytes = 0; ///< length of this beginning; 0: the file does not exist yet
    std::uint64_t sum = 0;   ///< checksum of these bytes
    bool operator==(file_mark const&) const = default;
};

/// A text file that grows by whole lines during a run, and is cut back to a mark when the run is resumed. At every
/// moment it consists of a head, whole lines and a foot. An exception is a program that is killed during a write: the
/// last line may then be incomplete, and resume() removes it.
///
/// Lines wait in memory until some thousand bytes have accumulated or a second has passed; flush() writes them at once.
/// The file is not held open, so that the object can be copied with an observer; only one of the copies may continue.
class growing_file {
public:
    growing_file() = default;
    /// Stores the arguments; does not touch the file.
    /// \param head lines at the beginning
    /// \param foot lines at the end, such as closing tags
    growing_file(std::string path, std::string head, std::string foot = {})
        : path_(std::move(path)), head_(std::move(head)), foot_(std::move(foot)) {}

    /// Creates the file, or replaces it. \throws std::runtime_error if it cannot be written
    void begin() {
        whole_file file(path_);
        file.write(head_ + foot_);
        file.commit();
        pending_.clear();
        mark_ = {};
        count(head_);
        on_disk_ = false;
    }
    /// Cuts the existing file back to a mark and continues it. An empty mark removes the file.
    /// \throws std::runtime_error if the file's beginning is not that of the mark, or if it cannot be written
    void resume(file_mark const& mark) {
        if (mark.bytes == 0) {
            std::remove(path_.c_str());
        } else {
            if (!begins_with(path_, mark))
                throw std::runtime_error("cannot continue " + path_ + ": it does not begin with the " +
                                         std::to_string(mark.bytes) + " bytes that belong to the state");
            if (foot_.empty())
                cut(mark.bytes);
            else
                copy_beginning(path_, mark, path_, foot_);
        }
        pending_.clear();
        mark_ = mark;
        on_disk_ = false;
    }
    /// Appends whole lines. \throws std::runtime_error if they cannot be written
    void add(std::string_view lines) {
        if (lines.empty()) return;
        if (pending_.empty()) since_ = std::chrono::steady_clock::now();
        pending_ += lines;
        if (pending_.size() >= most_waiting || std::chrono::steady_clock::now() - since_ > std::chrono::seconds(1))
            flush();
    }
    /// Writes the lines that wait. \throws std::runtime_error on failure; the file then still consists of whole lines
    void flush() { write(false); }
    /// Like flush(), but returns only when the bytes are on the disk.
    void sync() { write(true); }

    bool has_begun() const noexcept { return mark_.bytes > 0; }
    /// The mark of the written part; after flush() it includes all lines.
    file_mark const& mark() const noexcept { return mark_; }
    std::string const& path() const noexcept { return path_; }

    /// True if the beginning of a file is that of the mark. A missing file fits the empty mark only.
    static bool begins_with(std::string const& path, file_mark const& mark) {
        std::FILE* file = std::fopen(path.c_str(), "rb");
        if (file == nullptr) return mark.bytes == 0;
        checksum sum;
        std::uint64_t left = mark.bytes;
        char buffer[16384];
        while (left > 0) {
            std::size_t const got =
                std::fread(buffer, 1, std::size_t(std::min<std::uint64_t>(left, sizeof buffer)), file);
            if (got == 0) break;
            sum.add(buffer, got);
            left -= got;
        }
        std::fclose(file);
        return left == 0 && (mark.bytes == 0 || sum.value() == mark.sum);
    }
    /// Copies the beginning of a file, followed by a foot, to a path, complete or not at all. \throws
    /// std::runtime_error if a file cannot be read or written
    static void copy_beginning(std::string const& from, file_mark const& mark, std::string const& to,
                               std::string_view foot = {}) {
        std::FILE* file = std::fopen(from.c_str(), "rb");
        if (file == nullptr) detail::fail_file("cannot read", from);
        std::uint64_t left = mark.bytes;
        try {
            whole_file copy(to);
            char buffer[16384];
            while (left > 0) {
                std::size_t const got =
                    std::fread(buffer, 1, std::size_t(std::min<std::uint64_t>(left, sizeof buffer)), file);
                if (got == 0) throw std::runtime_error("cannot read " + from + ": it is too short");
                copy.write({buffer, got});
                left -= got;
            }
            copy.write(foot);
            copy.commit();
        } catch (...) {
            std::fclose(file);
            throw;
        }
        std::fclose(file);
    }

private:
    static constexpr std::size_t most_waiting = 8192;

    void count(std::string_view bytes) {
        checksum sum = mark_.bytes == 0 ? checksum{} : checksum{mark_.sum};
        sum.add(bytes.data(), bytes.size());
        mark_ = {mark_.bytes + bytes.size(), sum.value()};
    }
    void cut(std::uint64_t bytes) const {
        std::error_code error;
        std::filesystem::resize_file(path_, bytes, error);
        if (error) throw std::runtime_error("cannot write " + path_ + ": " + error.message());
    }
    /// Removes the part of a line that a full disk has taken.
    void remove_partial_line() const {
        std::error_code ignored;
        std::filesystem::resize_file(path_, mark_.bytes, ignored);
        if (foot_.empty()) return;
        if (std::FILE* file = std::fopen(path_.c_str(), "ab")) {
            std::fwrite(foot_.data(), 1, foot_.size(), file);
            std::fclose(file);
        }
    }
    void write(bool to_disk) {
        if (!has_begun() || (pending_.empty() && (!to_disk || on_disk_))) return;
        std::FILE* file = std::fopen(path_.c_str(), "r+b");
        if (file == nullptr) detail::fail_file("cannot write", path_);
        // One write that overwrites the old foot: a kill between two writes would leave a file without its foot.
        std::string const piece = pending_ + foot_;
        std::setvbuf(file, nullptr, _IONBF, 0);
        bool sound = std::fseek(file, long(mark_.bytes), SEEK_SET) == 0;
        if (!pending_.empty()) sound = sound && std::fwrite(piece.data(), 1, piece.size(), file) == piece.size();
#if __has_include(<unistd.h>)
        if (to_disk) sound = sound && fsync(fileno(file)) == 0;
#endif
        int reason = errno;
        if (std::fclose(file) != 0 && sound) sound = false, reason = errno;
        if (!sound) {
            remove_partial_line();
            errno = reason;
            detail::fail_file("cannot write", path_);
        }
        count(pending_);
        pending_.clear();
        on_disk_ = to_disk;
    }

    std::string path_, head_, foot_, pending_;
    file_mark mark_;
    bool on_disk_ = false; // all written bytes are on the disk
    std::chrono::steady_clock::time_point since_{};
};

} // namespace lacuna
