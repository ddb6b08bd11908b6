// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <lacuna/observe/run_directory.hpp>

#include "options.hpp"
#include "report.hpp"

namespace cartilage {

/// \name Names of the files that a command leaves, for lacuna::run_directory; `#` is a number
/// \{
std::vector<std::string> run_results(); ///< of run and pack
std::vector<std::string> study_results();
std::vector<std::string> sensitivity_results();
std::vector<std::string> calibration_results();
/// \}

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

/// \name Writers; each file appears whole or not at all. \throws std::runtime_error
/// \{
void write_summary(std::string const& path, options const& o, run_result const& r);
void write_statistics(std::string const& path, options const& o, specimen_report const& s);
/// \}

/// \name cracks.csv, which grows while a run goes on
/// \{
std::string crack_heading();
std::string crack_line(crack_record const& c);
/// \}

/// \name The short tables for a person
/// \{
void print_result(std::FILE* out, options const& o, run_result const& r);
void print_statistics(std::FILE* out, options const& o, specimen_report const& s);
/// \}

} // namespace cartilage
