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

/// What a run means to do with results of an earlier one.
enum class earlier_results {
    refuse,  ///< there must be none
    replace, ///< they are removed when the run begins to write
    keep     ///< the run goes on with them
};

/// The directory that a run's results go to. One owner at a time: the lock is the system's (directory_lock), so that it ends
/// with its process, however that ends. Opening makes the directory where needed and proves that it can be written; until
/// keep(), leaving takes back every directory that was made. A refused run writes nothing.
class run_directory {
public:
    /// \param field for messages: "output.directory", "--out"
    /// \param results names of the files that such a run leaves, `#` for a number; all others are never touched
    /// \param lock name of the lock's file: runs whose results have other names may share a directory by locks of their own
    /// \throws std::invalid_argument when another run owns it, when it holds results and these are not to be replaced or kept, or
    ///         when it cannot be written
    run_directory(std::string const& path, std::string const& field, std::vector<std::string> results, earlier_results earlier,
                  std::string const& lock = "lacuna.lock")
        : path_(path.empty() ? "." : path), field_(field), results_(std::move(results)), earlier_(earlier), lock_(file(lock)) {
        try {
            open();
        } catch (...) {
            lock_.release();
            take_back();
            throw;
        }
    }
    run_directory(run_directory const&) = delete;
    run_directory& operator=(run_directory const&) = delete;
    ~run_directory() {
        lock_.release();
        if (!kept_) take_back();
    }

    /// From here on the directory stays. Results that are to be replaced are removed, all before this returns.
    void keep() {
        stay();
        if (!std::exchange(begun_, true) && earlier_ == earlier_results::replace) remove_results();
    }
    /// From here on the directory stays, and so do results, until keep().
    void stay() noexcept { kept_ = true; }
    /// Removes all results: of a run that is refused after all. Directories that were made for it go with it.
    void discard() {
        remove_results();
        kept_ = false;
    }
    /// Path of a file in it.
    std::string file(std::string_view name) const { return (path_ / name).string(); }
    /// Removes a file, if it is there. \throws std::runtime_error when it cannot be removed
    void remove(std::string_view name) const {
        std::error_code error;
        std::filesystem::remove(path_ / name, error);
        if (error) throw std::runtime_error("cannot remove " + file(name) + ": " + error.message());
    }
    /// Whether a file of this name is one that such a run leaves.
    bool is_result(std::string_view name) const {
        for (auto const& pattern : results_)
            if (fits(name, pattern)) return true;
        return false;
    }
    /// Names of the results that are there, in order.
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
        auto const place = pattern.find('#');
        if (place == std::string_view::npos) return name == pattern;
        auto const ending = pattern.substr(place + 1);
        if (name.size() <= place + ending.size() || name.substr(0, place) != pattern.substr(0, place)) return false;
        auto const number = name.substr(place, name.size() - place - ending.size());
        return name.substr(place + number.size()) == ending && number.find_first_not_of("0123456789") == number.npos;
    }
    void refuse_owned() const { refuse_it("a directory of its own: it is in use by " + lock_.owner()); }
    void refuse_results() const {
        if (earlier_ != earlier_results::refuse) return;
        auto const names = results();
        if (!names.empty())
            refuse_it("a directory without results of an earlier run (it holds " + names.front() + "); --force replaces them");
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
            // Another run may have made it just now; whose directory it is the lock decides.
            if (fs::create_directory(*p, error)) made_.push_back(*p);
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
    /// What a killed run has left under temporary names.
    void remove_unfinished() const {
        remove_unfinished_files(path_, [this](std::string_view whole) { return is_result(whole); });
    }
    void remove_results() const {
        for (auto const& name : results()) remove(name);
    }
    void take_back() {
        for (auto p = made_.rbegin(); p != made_.rend(); ++p) {
            std::error_code ignored;
            std::filesystem::remove(*p, ignored);
        }
        made_.clear();
    }

    std::filesystem::path path_;
    std::string field_;
    std::vector<std::string> results_;
    earlier_results earlier_;
    directory_lock lock_;
    std::vector<std::filesystem::path> made_;
    bool kept_ = false, begun_ = false;
};

} // namespace lacuna
