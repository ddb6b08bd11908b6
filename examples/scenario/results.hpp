// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <lacuna/observe/run_directory.hpp>

#include "../terminal_progress.hpp"
#include "journal.hpp"

namespace lacuna_run {

/// Where a run that is resumed begins.
struct resumption {
    std::string checkpoint; ///< path; empty: the run begins at its beginning
    long long step = 0;
    journal told{}; ///< until there
    std::string from{}; ///< directory with the files that it goes on from
};

/// Finds the files of the run that made a checkpoint: in the output directory, else beside the checkpoint.
/// \throws refusal when they are not there, or are not those of that run
resumption find_earlier_part(scenario const& s, std::string const& checkpoint, journal const& told, long long step);

/// The files of a run in its output directory. Logs and series of frames grow while it goes on; all others appear whole or not
/// at all.
class results {
public:
    /// Takes the directory. \param quiet shows no progress
    /// \throws std::invalid_argument as lacuna::run_directory: nothing is written then
    results(scenario const& s, bool force, bool quiet, resumption const& start);

    /// Begins the logs, or brings all files to what they were at the checkpoint. \throws std::runtime_error, as all below
    void begin();
    std::string file(std::string_view name) const { return directory_.file(name); }
    void add_row(std::string const& line) { probes_.add(line); }
    void add_break(break_line const& b) { events_.add(event_text(scenario_, b)); }
    /// \param name of the series: "particles", "bonds" or "pores"
    void add_frame(std::string const& name, double time, std::string const& frame);
    /// All that was told so far is on the disk, and the journal says how far the files go.
    void mark(journal& told);
    /// Before a checkpoint between those of output.checkpoint_every is written: keeps the last of these until the next.
    void make_room_for_stop();
    /// After one of output.checkpoint_every was written.
    void checkpoint_is_regular();
    /// Writes summary.json, last: its presence says that all is there.
    /// \param ended whether the run is at its end, and not to be resumed
    void finish(std::string const& summary, bool ended);
    /// How far the run is, for a person.
    programs::terminal_progress& progress() noexcept { return progress_; }
    /// Removes what was written, of a run that is refused after all.
    void discard() { directory_.discard(); }

private:
    lacuna::growing_file& series(std::string const& name);
    void bring_over() const;
    void drop_later_frames() const;

    scenario const& scenario_;
    resumption start_;
    lacuna::run_directory directory_;
    lacuna::growing_file probes_, events_, particles_, bonds_, pores_;
    programs::terminal_progress progress_;
    bool stopped_between_ = false; // checkpoint.bin is of a stop, not of output.checkpoint_every
};

} // namespace lacuna_run
