// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <lacuna/core/whole_file.hpp>

namespace lacuna {

/// The owner of a lock, as recorded in its file.
struct lock_owner {
    long process = 0;
    std::string started; ///< start time of the process as text from /proc; empty if the system has no /proc
    std::string host;

    std::string text() const {
        return std::to_string(process) + " " + (started.empty() ? "-" : started) + " " + host + "\n";
    }
    /// "process 1234 on HOST"
    std::string name() const {
        return process <= 0 ? "another process"
                            : "process " + std::to_string(process) + (host.empty() ? "" : " on " + host);
    }
    static lock_owner from(std::string_view text) {
        lock_owner o;
        char started[64] = "", host[256] = "";
        if (std::sscanf(std::string(text).c_str(), "%ld %63s %255s", &o.process, started, host) < 1) return {};
        o.started = std::string_view(started) == "-" ? "" : started;
        o.host = host;
        return o;
    }
    static lock_owner self() {
        lock_owner o;
#if __has_include(<unistd.h>)
        o.process = long(getpid());
        o.started = start_of(o.process);
        char host[256] = "";
        if (gethostname(host, sizeof host - 1) == 0) o.host = host;
#endif
        return o;
    }
    /// True if the owner may still be running. False if no process of this host has its number, or a later process has
    /// it. An owner on another host is assumed to be running.
    bool may_run() const {
#if __has_include(<unistd.h>)
        if (process <= 0) return false;
        lock_owner const here = self();
        if (host != here.host) return true;
        if (kill(pid_t(process), 0) != 0 && errno == ESRCH) return false;
        std::string const now = start_of(process);
        return started.empty() || now.empty() || now == started;
#else
        return false;
#endif
    }

private:
    /// Field 22 of /proc/PID/stat, clock ticks since the machine started.
    static std::string start_of(long process) {
        std::FILE* file = std::fopen(("/proc/" + std::to_string(process) + "/stat").c_str(), "rb");
        if (file == nullptr) return {};
        char buffer[2048];
        std::string const line(buffer, std::fread(buffer, 1, sizeof buffer, file));
        std::fclose(file);
        // Field 2 is the program's name in brackets, which may itself contain blanks and brackets.
        std::size_t at = line.rfind(')');
        for (int field = 2; field < 22 && at != std::string::npos; ++field) at = line.find(' ', at + 1);
        if (at == std::string::npos) return {};
        return line.substr(at + 1, line.find(' ', at + 1) - at - 1);
    }
};

/// Lock of one process on a directory, or on a part of its content: a file that exists while the lock is held and
/// records its owner. The lock itself is the system's (flock), so that it ends with its process, killed or not. On a
/// file system without locks, the file alone is the lock. Then an owner that no longer runs has lost it, and two
/// processes that come at the same instant may both get it. Network file systems lock across hosts if their servers do.
class directory_lock {
public:
    enum class outcome { taken, held_by_another, failed };

    explicit directory_lock(std::string path) : path_(std::move(path)) {}
    directory_lock(directory_lock const&) = delete;
    directory_lock& operator=(directory_lock const&) = delete;
    ~directory_lock() { release(); }

    /// True if another process holds the lock. Changes nothing.
    bool is_taken() {
#if __has_include(<unistd.h>)
        int const opened = ::open(path_.c_str(), O_RDWR | O_CLOEXEC);
        if (opened < 0) return false;
        bool const taken = !lock(opened);
        if (taken) owner_ = read(opened);
        close(opened);
        return taken;
#else
        return false;
#endif
    }
    /// Tries to take the lock.
    /// \return outcome::failed with the reason in errno
    outcome take() {
#if __has_include(<unistd.h>)
        for (;;) {
            int const opened = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
            if (opened < 0) return outcome::failed;
            if (!lock(opened)) {
                owner_ = read(opened);
                close(opened);
                return outcome::held_by_another;
            }
            // The previous owner may have removed the file since it was opened here.
            if (!detail::is_at(opened, path_)) {
                close(opened);
                continue;
            }
            std::string const text = lock_owner::self().text();
            // The lock holds even if there is no disk space for the owner's name.
            if (ftruncate(opened, 0) != 0 || pwrite(opened, text.data(), text.size(), 0) < 0) owner_ = {};
            file_ = opened;
            return outcome::taken;
        }
#else
        return outcome::taken;
#endif
    }
    void release() noexcept {
#if __has_include(<unistd.h>)
        if (file_ < 0) return;
        unlink(path_.c_str());
        close(std::exchange(file_, -1));
#endif
    }
    /// The owner, for a message.
    std::string owner() const { return owner_.name(); }

private:
#if __has_include(<unistd.h>)
    static bool lock(int opened) {
        if (flock(opened, LOCK_EX | LOCK_NB) == 0) return true;
        return errno != EWOULDBLOCK && !read(opened).may_run();
    }
    static lock_owner read(int opened) {
        char buffer[512];
        auto const got = pread(opened, buffer, sizeof buffer, 0);
        return lock_owner::from(std::string_view(buffer, got > 0 ? std::size_t(got) : 0));
    }
#endif

    std::string path_;
    lock_owner owner_;
    int file_ = -1;
};

/// Removes temporary files (see whole_file) whose writer has ended.
/// \param is_ours callable: final name of the file -> true if the file may be removed
template <class Rule>
void remove_unfinished_files(std::filesystem::path const& directory, Rule const& is_ours) {
    namespace fs = std::filesystem;
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator at(directory, error), end; !error && at != end; at.increment(error)) {
        std::string name = at->path().filename().string();
        if (name.size() <= 5 || name.substr(name.size() - 5) != ".part") continue;
        name.resize(name.size() - 5);
        std::string shorter = name;
        while (!shorter.empty() && (std::isdigit((unsigned char)(shorter.back())) || shorter.back() == '-'))
            shorter.pop_back();
        if (shorter.size() < name.size() && !shorter.empty() && shorter.back() == '.') shorter.pop_back();
        if (is_ours(name) || is_ours(shorter)) found.push_back(at->path());
    }
    for (fs::path const& path : found) {
#if __has_include(<unistd.h>)
        int const opened = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (opened < 0) continue;
        if (flock(opened, LOCK_EX | LOCK_NB) == 0) unlink(path.c_str());
        close(opened);
#else
        fs::remove(path, error);
#endif
    }
}

} // namespace lacuna
