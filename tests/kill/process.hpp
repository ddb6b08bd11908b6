// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

/// \file
/// Programs that run beside a test and receive signals from it, and the files that they leave.

namespace process {

namespace fs = std::filesystem;

/// A program that runs in a directory. Its output goes to the file DIRECTORY.said.
class running {
public:
    running(std::vector<std::string> const& words, fs::path const& directory) {
        fs::path const said = (directory.has_filename() ? directory : directory.parent_path()).string() + ".said";
        child_ = fork();
        if (child_ < 0) throw std::runtime_error("cannot fork");
        if (child_ == 0) {
            std::vector<char*> arguments;
            for (auto const& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
            arguments.push_back(nullptr);
            int const out = open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
            if (chdir(directory.c_str()) != 0 || dup2(out, 1) < 0 || dup2(out, 2) < 0) _exit(126);
            execv(arguments[0], arguments.data());
            _exit(127);
        }
    }
    running(running const&) = delete;
    running& operator=(running const&) = delete;
    ~running() {
        if (child_ <= 0) return;
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
    }
    pid_t id() const { return child_; }
    void send(int signal) const { kill(child_, signal); }
    /// Waits for its end. \return exit status, or minus the number of the signal that ended it
    int wait() {
        int status = 0;
        if (waitpid(child_, &status, 0) != child_) throw std::runtime_error("cannot wait");
        child_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

private:
    pid_t child_ = 0;
};

inline std::string read_all(fs::path const& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
/// The bytes of every file below a directory, by its path relative to the directory.
inline std::map<std::string, std::string> files_of(fs::path const& directory) {
    std::map<std::string, std::string> all;
    if (!fs::exists(directory)) return all;
    for (auto const& entry : fs::recursive_directory_iterator(directory))
        if (entry.is_regular_file()) all[fs::relative(entry.path(), directory).string()] = read_all(entry.path());
    return all;
}
/// Names of the files that differ, for a message.
inline std::string difference(std::map<std::string, std::string> const& a,
                              std::map<std::string, std::string> const& b) {
    std::string names;
    for (auto const& [name, bytes] : a)
        if (auto const other = b.find(name); other == b.end() || other->second != bytes) names += " " + name;
    for (auto const& [name, bytes] : b)
        if (a.find(name) == a.end()) names += " (and " + name + ")";
    return names;
}
inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace process
