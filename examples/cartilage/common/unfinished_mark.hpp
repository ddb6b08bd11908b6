// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/observe/run_directory.hpp>

#include "cartilage/common/interruption.hpp"

namespace cartilage {

/// Marks a study, sensitivity or calibration without results: a file unfinished-COMMAND.json in its directory. The file
/// exists from before the first run until the results are written. Finished runs are in the cache.
class unfinished_mark {
public:
    /// Writes the mark, unless the directory has complete results. \throws std::runtime_error if it cannot be written
    unfinished_mark(lacuna::run_directory& out, std::string const& command);
    /// What to do with earlier results. Results beside a mark are incomplete, so that the same command replaces them.
    static lacuna::earlier_results earlier(std::string const& directory, std::string const& command, bool force);
    /// Call before the results are written. Removes those of an earlier run.
    void begin_results() const;
    /// Call after the results are written. Removes the mark.
    void end() const { out_.remove(name_of(command_)); }
    /// Result of work(). If a signal ends it, the mark records the signal, and the exception is passed on.
    /// \throws interruption; std::runtime_error if the file cannot be written
    template <class Work>
    auto stoppable(Work const& work) const {
        try {
            return work();
        } catch (interruption const&) {
            record_signal();
            throw;
        }
    }

private:
    static std::string name_of(std::string const& command) { return "unfinished-" + command + ".json"; }
    bool exists() const;
    void record_signal() const;
    void write(std::string const& ended) const;
    lacuna::run_directory& out_;
    std::string command_;
};

} // namespace cartilage
