// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/observe/run_directory.hpp>

namespace cartilage {

/// The mark of a study, or the like, whose results are not there yet: a file unfinished-COMMAND.json, from before its first run
/// until its results are written. The kept runs are in the cache.
class unfinished_mark {
public:
    unfinished_mark(lacuna::run_directory& out, std::string const& command);
    /// What becomes of results that are there: with a mark beside them they are not whole, and the same command goes on.
    static lacuna::earlier_results earlier(std::string const& directory, std::string const& command, bool force);
    /// Before the results are written: those of an earlier run are removed first.
    void begin_results() const;
    /// After they are.
    void end() const { out_.remove(name_of(command_)); }
    /// A signal came. \throws std::runtime_error when the file cannot be written
    void stopped_by(int signal) const;

private:
    static std::string name_of(std::string const& command) { return "unfinished-" + command + ".json"; }
    bool is_there() const;
    void write(std::string const& ended) const;
    lacuna::run_directory& out_;
    std::string command_;
};

} // namespace cartilage
