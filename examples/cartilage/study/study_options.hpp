// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cartilage/common/options.hpp"
#include "cartilage/study/search.hpp"

namespace CLI {
class App;
}

namespace cartilage {

/// What is asked of `cartilage study` and `cartilage study merge`.
struct study_options {
    options model;                              ///< zone, seed and load do not matter
    std::vector<lacuna::cartilage_zone> zones;
    std::uint64_t seeds = 20;                   ///< packings 1 to seeds of each zone
    load_range loads;
    int jobs = 0;                               ///< 0: all processors
    int shard = 1, shards = 1;                  ///< this part of so many
    std::string out, cache;
    bool force = false, quiet = false, pictures = true;
    std::vector<std::string> merge;             ///< directories to put together; empty: a study is to be run
};

/// Options of how packings are run that all studies have in common, as written.
struct pool_arguments {
    std::string zones = "surface,middle,deep,whole", seeds, jobs, cache;
    bool quick = false;
};
void add_pool_options(CLI::App& app, pool_arguments& args);
/// Zones, seeds, loads, jobs and cache. \throws usage_error
void understand_pool(pool_arguments const& args, study_options& o);

/// Reads the command line after the word `study`. \copydetails parse_command_line
std::optional<study_options> parse_study_command_line(int argc, char const* const* argv);

} // namespace cartilage
