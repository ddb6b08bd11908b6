// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/standard.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#if __has_include(<unistd.h>)
#include <fcntl.h>
#include <unistd.h>
#endif

namespace lacuna {

/// A file that appears whole or not at all: it is written under a temporary name in the same directory and gets
/// its own name in `commit()`. Without commit, destruction removes it and leaves an earlier file untouched.
class whole_file {
public:
    /// Opens the temporary file. \throws std::runtime_error naming the path and the system's reason
    explicit whole_file(std::string path) : path_(std::move(path)), temporary_(path_ + ".part") {
        file_ = std::fopen(temporary_.c_str(), "wb");
        if (file_ == nullptr) fail("cannot write");
    }
    whole_file(whole_file const&) = delete;
    whole_file& operator=(whole_file const&) = delete;
    ~whole_file() {
        if (file_ != nullptr) std::fclose(file_);
        if (!committed_) std::remove(temporary_.c_str());
    }

    std::FILE* handle() const noexcept { return file_; }
    /// \throws std::runtime_error when the bytes cannot be written
    void write(std::string_view bytes) {
        if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot write");
    }
    /// Closes the file and gives it its name. \throws std::runtime_error when something was not written
    void commit() {
        bool const sound = std::ferror(file_) == 0;
        bool const closed = std::fclose(std::exchange(file_, nullptr)) == 0;
        if (!sound || !closed) fail("cannot write");
        if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot rename to");
        committed_ = true;
    }
    /// As commit(), and the bytes and the name are on the disk when it returns: not lost when the power fails.
    void commit_to_disk() {
#if __has_include(<unistd.h>)
        if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) fail("cannot write");
        commit();
        auto const slash = path_.find_last_of('/');
        std::string const folder = slash == std::string::npos ? "." : path_.substr(0, slash + 1);
        // Best effort: not every file system lets its folders be opened and synchronised.
        if (int const opened = open(folder.c_str(), O_RDONLY); opened >= 0) {
            (void)fsync(opened);
            close(opened);
        }
#else
        commit();
#endif
    }

private:
    [[noreturn]] void fail(char const* what) const {
        throw std::runtime_error(std::string(what) + " " + path_ + ": " + std::strerror(errno));
    }

    std::string path_;
    std::string temporary_;
    std::FILE* file_ = nullptr;
    bool committed_ = false;
};

} // namespace lacuna
