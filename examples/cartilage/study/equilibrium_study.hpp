// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cartilage/run/equilibrium_run.hpp"
#include "cartilage/study/study_options.hpp"
#include "cartilage/study/study_result.hpp"
#include "cartilage/study/study_table.hpp"

/// \file
/// A study in equilibrium: the loads of many packings, one load program each. Loads in MPa, all else in SI units.

namespace cartilage {

/// Name of an equilibrium study's file in its directory.
inline constexpr char const* equilibrium_study_file = "equilibrium.json";

/// What a packing does under a load that grows.
struct equilibrium_packing {
    struct layer {
        std::string name; ///< "surface 0"
        std::optional<double> cut_MPa;
    };
    lacuna::cartilage_zone zone = lacuna::cartilage_zone::surface;
    std::uint64_t seed = 1;
    std::string result, ended; ///< as in equilibrium_run
    double load_MPa = 0;       ///< at the end
    double unbalanced = 0;     ///< at the end, over the largest force, 1
    std::optional<double> first_crack_MPa, capacity_MPa, capacity_half_MPa, complete_MPa;
    std::vector<layer> layers;
    std::vector<load_run::crack> cracks; ///< without times
    std::vector<double> crack_MPa;
    int factorisations = 0;

    /// A load of Table 3; infinity: not up to the highest load. None: equilibrium ends, or was not found, before.
    std::optional<double> load(threshold what) const;
};

/// All packings of a study or its shard, on several threads. Finished packings are stored in the cache.
/// \param from_cache receives the number of packings from the cache
/// \throws interruption if a signal asks to stop, std::invalid_argument if a model cannot be built
std::vector<equilibrium_packing> run_equilibrium_study(study_options const& o, std::size_t& from_cache);

/// The cells of Table 3. The capacity is the load at which a fibre of the first layer and another one are cut.
std::vector<table3_cell> table3(std::vector<equilibrium_packing> const& packings, double highest_MPa);

/// The same packings as a study, for its figures: one run for each packing.
study_result as_study(study_options const& o, std::vector<equilibrium_packing> const& packings);

/// Table 3 as CSV: each cell with the columns of an explicit study beside it. \param beside null: there is none
std::string equilibrium_csv(std::vector<table3_cell> const& cells, study_result const& study,
                            study_result const* beside);
/// The same as a short table for the terminal.
std::string equilibrium_table(std::vector<table3_cell> const& cells, study_result const& study,
                              study_result const* beside);

/// The text of equilibrium.json, with one line for each packing.
std::string text_of(study_result const& study, std::vector<equilibrium_packing> const& packings);

} // namespace cartilage
