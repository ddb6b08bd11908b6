// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "options.hpp"
#include "report.hpp"

namespace cartilage {

/// The directory that results go to. Opening it creates it where needed and proves that it can be written;
/// until `keep()`, leaving takes back every directory that was created for it.
class output_directory {
public:
    /// \throws usage_error when it cannot be written, or holds results already and `force` is not set
    output_directory(std::string const& path, bool force);
    output_directory(output_directory const&) = delete;
    output_directory& operator=(output_directory const&) = delete;
    ~output_directory();

    /// From here on the directory stays; results of an earlier run that lie in it are removed.
    void keep();
    /// Path of a file in it.
    std::string file(std::string const& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
    std::vector<std::filesystem::path> created_;
    bool kept_ = false;
};

/// \name Writers; each file appears whole or not at all. \throws std::runtime_error
/// \{
void write_summary(std::string const& path, options const& o, run_result const& r);
void write_cracks(std::string const& path, run_result const& r);
void write_statistics(std::string const& path, options const& o, specimen_report const& s);
/// \}

/// \name The short tables for a person
/// \{
void print_result(std::FILE* out, options const& o, run_result const& r);
void print_statistics(std::FILE* out, options const& o, specimen_report const& s);
/// \}

} // namespace cartilage
