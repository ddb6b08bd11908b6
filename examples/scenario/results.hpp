// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <lacuna/observe/run_directory.hpp>

#include "../terminal_progress.hpp"
#include "journal.hpp"

namespace lacuna_run {

/// Where a resumed run begins.
struct resumption {
    std::string checkpoint; ///< path; empty: the run begins at step 0
    long long step = 0;
    journal log{}; ///< at that step
    std::string directory{}; ///< with the files of the earlier part
};

/// Finds the files of the run that made a checkpoint: first in the output directory, then beside the checkpoint.
/// \throws refusal if files are missing or belong to another run
resumption find_earlier_part(scenario const& s, std::string const& checkpoint, journal const& log, long long step);

/// The files of a run in its output directory. CSV files and series of frames grow during the run. Every other file is
/// complete as soon as it appears.
class results {
public:
    /// Locks the directory.
    /// \param force replaces results of an earlier run
    /// \param quiet shows no progress
    /// \throws std::invalid_argument as lacuna::run_directory; nothing is written then
    results(scenario const& s, bool force, bool quiet, resumption const& start);

    /// Starts the CSV files, or restores all files to their content at the checkpoint.
    /// \throws std::runtime_error for a file that cannot be written, like all functions below
    void begin();
    std::string file(std::string_view name) const { return directory_.file(name); }
    void add_row(std::string const& line) { probes_.add(line); }
    void add_break(break_line const& b) { events_.add(event_text(scenario_, b)); }
    /// \param name of the series: "particles", "bonds" or "pores"
    void add_frame(std::string const& name, double time, std::string const& frame);
    /// Flushes the growing files to the disk and stores their lengths in the journal.
    void mark(journal& log);
    /// Call before a stop writes its own checkpoint: saves the last checkpoint of output.checkpoint_every under another
    /// name.
    void set_regular_checkpoint_aside();
    /// Call after a checkpoint of output.checkpoint_every was written.
    void regular_checkpoint_written();
    /// Writes summary.json. It comes last: if it exists, all files are complete.
    /// \param ended whether the run has ended and will not be resumed
    void finish(std::string const& summary, bool ended);
    /// The progress line on a terminal.
    programs::terminal_progress& progress() noexcept { return progress_; }
    /// Removes all files written, for a run that is refused after begin().
    void discard() { directory_.discard(); }

private:
    lacuna::growing_file& series(std::string const& name);
    void copy_earlier_files() const;
    void remove_later_frames() const;

    scenario const& scenario_;
    resumption start_;
    lacuna::run_directory directory_;
    lacuna::growing_file probes_, events_, particles_, bonds_, pores_;
    programs::terminal_progress progress_;
    bool checkpoint_is_of_stop_ = false; // checkpoint.bin was written by a stop, not by output.checkpoint_every
};

} // namespace lacuna_run
