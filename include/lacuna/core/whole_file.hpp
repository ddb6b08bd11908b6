// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/standard.hpp>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#if __has_include(<unistd.h>)
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace lacuna {

namespace detail {
#if __has_include(<unistd.h>)
/// True if `path` still names this open file.
inline bool is_at(int file, std::string const& path) noexcept {
    struct stat opened {}, named {};
    return fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
           opened.st_dev == named.st_dev;
}
#endif
[[noreturn]] inline void fail_file(char const* what, std::string const& path) {
    throw std::runtime_error(std::string(what) + " " + path + ": " + std::strerror(errno));
}
} // namespace detail

/// A file that appears complete or not at all. It is written under a temporary name in the same directory (PATH.part,
/// or PATH.NUMBER-NUMBER.part while another writer is writing the same path); `commit()` renames it to PATH. Without
/// commit, destruction removes it and leaves an earlier file untouched. The next writer of the same path overwrites a
/// temporary file that a killed program has left.
class whole_file {
public:
    /// Opens the temporary file. \throws std::runtime_error naming the path and the system's reason
    explicit whole_file(std::string path) : path_(std::move(path)), temporary_(path_ + ".part") {
        open();
        if (file_ == nullptr) fail("cannot write");
    }
    whole_file(whole_file const&) = delete;
    whole_file& operator=(whole_file const&) = delete;
    ~whole_file() {
#if __has_include(<unistd.h>)
        // Remove it before it is closed: after that another writer may own the name.
        if (!committed_ && file_ != nullptr) std::remove(temporary_.c_str());
        if (file_ != nullptr) std::fclose(file_);
#else
        if (file_ != nullptr) std::fclose(file_);
        if (!committed_) std::remove(temporary_.c_str());
#endif
    }

    std::FILE* handle() const noexcept { return file_; }
    /// \throws std::runtime_error when the bytes cannot be written
    void write(std::string_view bytes) {
        if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot write");
    }
    /// Closes the file and renames it. \throws std::runtime_error if not all bytes could be written, or not renamed
    void commit() {
        if (std::ferror(file_) != 0 || std::fflush(file_) != 0) fail("cannot write");
#if __has_include(<unistd.h>)
        // Some file systems report a failed write only when the file is closed. Until it is renamed, a second handle
        // holds the lock and so the temporary name.
        int const held = dup(fileno(file_));
        bool const closed = std::fclose(std::exchange(file_, nullptr)) == 0;
        bool const renamed = closed && std::rename(temporary_.c_str(), path_.c_str()) == 0;
        int const reason = errno;
        if (!renamed) std::remove(temporary_.c_str());
        if (held >= 0) close(held);
        errno = reason;
        committed_ = true;
#else
        bool const closed = std::fclose(std::exchange(file_, nullptr)) == 0;
        bool const renamed = closed && std::rename(temporary_.c_str(), path_.c_str()) == 0;
        committed_ = renamed;
#endif
        if (!closed) fail("cannot write");
        if (!renamed) fail("cannot rename to");
    }
    /// Like commit(), but returns only when the bytes and the name are on the disk: a power failure cannot lose them.
    void commit_to_disk() {
#if __has_include(<unistd.h>)
        if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) fail("cannot write");
        commit();
        auto const slash = path_.find_last_of('/');
        std::string const folder = slash == std::string::npos ? "." : path_.substr(0, slash + 1);
        // Best effort: not every file system can open and synchronise a folder.
        if (int const opened = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC); opened >= 0) {
            (void)fsync(opened);
            close(opened);
        }
#else
        commit();
#endif
    }

private:
#if __has_include(<unistd.h>)
    /// The system's lock on the temporary file shows whether its writer is still at work or was killed.
    void open() {
        static std::atomic<unsigned> count{0};
        for (;;) {
            int const opened = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
            if (opened < 0) return;
            bool const free = flock(opened, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
            if (free && detail::is_at(opened, temporary_)) {
                if (ftruncate(opened, 0) == 0) file_ = fdopen(opened, "wb");
                if (file_ == nullptr) close(opened);
                return;
            }
            close(opened);
            if (!free) temporary_ = path_ + "." + std::to_string(getpid()) + "-" + std::to_string(++count) + ".part";
        }
    }
#else
    void open() { file_ = std::fopen(temporary_.c_str(), "wb"); }
#endif
    [[noreturn]] void fail(char const* what) const { detail::fail_file(what, path_); }

    std::string path_;
    std::string temporary_;
    std::FILE* file_ = nullptr;
    bool committed_ = false;
};

} // namespace lacuna
