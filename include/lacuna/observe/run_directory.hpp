// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/whole_file.hpp>
#include <lacuna/observe/directory_lock.hpp>

namespace lacuna {

/// The treatment of results of an earlier run.
enum class earlier_results {
    refuse,  ///< there must be none
    replace, ///< they are removed when the run begins to write
    keep     ///< the run continues them
};

/// The directory for the results of a run. It has one owner at a time: the lock is the system's (directory_lock), so
/// that it ends with its process, however that ends. The constructor creates the directory if necessary and checks that
/// it is writable. Unless keep() or stay() was called, the destructor removes the directories that were created. A
/// refused run writes nothing.
class run_directory {
public:
    /// \param field for messages: "output.directory", "--out"
    /// \param results names of the files that such a run writes, with `#` for a number; no other file is ever touched
    /// \param lock name of the lock file; runs whose results have different names can share a directory with different
    ///         locks
    /// \throws std::invalid_argument if another run owns the directory, if it has results that must not be replaced or
    ///         kept, or if it cannot be written
    run_directory(std::string const& path, std::string const& field, std::vector<std::string> results,
                  earlier_results earlier, std::string const& lock = "lacuna.lock")
        : path_(path.empty() ? "." : path), field_(field), results_(std::move(results)), earlier_(earlier),
          lock_(file(lock)) {
        try {
            open();
        } catch (...) {
            lock_.release();
            remove_created();
            throw;
        }
    }
    run_directory(run_directory const&) = delete;
    run_directory& operator=(run_directory const&) = delete;
    ~run_directory() {
        lock_.release();
        if (!stays_) remove_created();
    }

    /// Makes the directory permanent. The first call removes all results of an earlier run that are to be replaced.
    void keep() {
        stay();
        if (!std::exchange(begun_, true) && earlier_ == earlier_results::replace) remove_results();
    }
    /// Makes the directory permanent, and leaves earlier results until keep() is called.
    void stay() noexcept { stays_ = true; }
    /// Removes all results, for a run that is refused after keep(). The destructor removes the created directories.
    void discard() {
        remove_results();
        stays_ = false;
    }
    /// Path of a file in the directory.
    std::string file(std::string_view name) const { return (path_ / name).string(); }
    /// Removes a file if it exists. \throws std::runtime_error if it cannot be removed
    void remove(std::string_view name) const {
        std::error_code error;
        std::filesystem::remove(path_ / name, error);
        if (error) throw std::runtime_error("cannot remove " + file(name) + ": " + error.message());
    }
    /// True if a file of this name is a result of such a run.
    bool is_result(std::string_view name) const {
        for (auto const& pattern : results_)
            if (fits(name, pattern)) return true;
        return false;
    }
    /// Names of the results in the directory, sorted.
    std::vector<std::string> results() const {
        std::vector<std::string> names;
        std::error_code error;
        for (std::filesystem::directory_iterator at(path_, error), end; !error && at != end; at.increment(error)) {
            std::string const name = at->path().filename().string();
            if (is_result(name) && !at->is_directory()) names.push_back(name);
        }
        std::sort(names.begin(), names.end());
        return names;
    }

private:
    [[noreturn]] void refuse_it(std::string const& rule) const { refuse(field_, "\"" + path_.string() + "\"", rule); }
    static bool fits(std::string_view name, std::string_view pattern) {
        auto const mark = pattern.find('#');
        if (mark == std::string_view::npos) return name == pattern;
        auto const ending = pattern.substr(mark + 1);
        if (name.size() <= mark + ending.size() || name.substr(0, mark) != pattern.substr(0, mark)) return false;
        auto const number = name.substr(mark, name.size() - mark - ending.size());
        return name.substr(mark + number.size()) == ending && number.find_first_not_of("0123456789") == number.npos;
    }
    void refuse_owned() const { refuse_it("a directory that no other run uses; it is in use by " + lock_.owner()); }
    void refuse_results() const {
        if (earlier_ != earlier_results::refuse) return;
        auto const names = results();
        if (!names.empty())
            refuse_it("a directory without results of an earlier run (it holds " + names.front() +
                      "); --force replaces them");
    }
    void open() {
        namespace fs = std::filesystem;
        if (lock_.is_taken()) refuse_owned();
        refuse_results();
        std::error_code error;
        std::vector<fs::path> missing;
        for (fs::path p = path_; !p.empty() && !fs::exists(p, error); p = p.parent_path()) {
            if (error) refuse_it("a directory that can be made: " + error.message());
            if (p.has_filename()) missing.push_back(p);
            if (p == p.parent_path()) break;
        }
        for (auto p = missing.rbegin(); p != missing.rend(); ++p) {
            // Another run may have created it just now; the lock decides who owns it.
            if (fs::create_directory(*p, error)) created_.push_back(*p);
            if (error) refuse_it("a directory that can be made: " + error.message());
        }
        if (!fs::is_directory(path_, error)) refuse_it("a directory, or one that can be made");
        auto const outcome = lock_.take();
        if (outcome == directory_lock::outcome::failed)
            refuse_it(std::string("a directory that can be written: ") + std::strerror(errno));
        if (outcome == directory_lock::outcome::held_by_another) refuse_owned();
        refuse_results();
        remove_unfinished();
    }
    /// Removes files that a killed run has left under temporary names.
    void remove_unfinished() const {
        remove_unfinished_files(path_, [this](std::string_view whole) { return is_result(whole); });
    }
    void remove_results() const {
        for (auto const& name : results()) remove(name);
    }
    void remove_created() {
        for (auto p = created_.rbegin(); p != created_.rend(); ++p) {
            std::error_code ignored;
            std::filesystem::remove(*p, ignored);
        }
        created_.clear();
    }

    std::filesystem::path path_;
    std::string field_;
    std::vector<std::string> results_;
    earlier_results earlier_;
    directory_lock lock_;
    std::vector<std::filesystem::path> created_;
    bool stays_ = false, begun_ = false;
};

} // namespace lacuna
