// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cartilage/common/option_parsing.hpp"
#include "cartilage/run/equilibrium_run.hpp"
#include "cartilage/study/search.hpp"

namespace cartilage {

/// The request to `cartilage study` or `cartilage study merge`.
struct study_options {
    options model;                              ///< its zone, seed and load are ignored
    std::vector<lacuna::cartilage_zone> zones;
    std::uint64_t seeds = 20;                   ///< packings 1 to seeds of each zone
    load_range loads;
    int jobs = 0;                               ///< 0: all processors
    int shard = 1, shards = 1;                  ///< part `shard` of `shards`
    std::string out, cache;
    bool force = false, quiet = false, pictures = true;
    bool equilibrium = false;                   ///< load programs in equilibrium in place of runs
    equilibrium_request in_equilibrium;         ///< highest load, steps and pores of these programs
    std::string beside;                         ///< directory of an explicit study to show beside it; empty: the usual
    std::vector<std::string> merge;             ///< directories of parts to join; empty: run a study
};

/// Options that `study`, `sensitivity` and `calibrate` share, as text from the command line.
struct pool_arguments {
    std::string zones = "surface,middle,deep,whole", seeds, jobs, cache;
    bool quick = false;
};
/// Adds these options.
void add_pool_options(CLI::App& app, pool_arguments& args);
/// Adds --out, --force and --quiet. \param o its `out` is the default \param replaced by --force
void add_output_options(CLI::App& app, study_options& o, std::string const& replaced = "the results");
/// Sets model, zones, seeds, loads, time step, jobs and cache. \param seeds without --seeds and --quick
/// \throws usage_error, std::invalid_argument
void read_arguments(model_arguments const& model, pool_arguments const& args, study_options& o,
                    std::uint64_t seeds = 20);
/// \throws std::invalid_argument for a zone in which no specimen can be built
void validate_specimens(study_options const& o);

/// Reads the command line after the word `study`. \copydetails parse_command_line
std::optional<study_options> parse_study_command_line(int argc, char const* const* argv);

} // namespace cartilage
