// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cartilage/common/options.hpp"
#include "cartilage/study/search.hpp"
#include "cartilage/study/study_options.hpp"
#include "cartilage/study/study_result.hpp"

/// \file
/// Searches for the loads of many packings on several threads, one run on each. Results are stored in a cache.

namespace cartilage {

/// One packing and its model: zone, seed, choices, size and fluid of `model`. The load of `model` is ignored.
struct packing_request {
    options model;
    load_range loads;
};

/// Counts of runs and packings.
struct pool_report {
    std::size_t runs = 0;          ///< runs that were started
    std::size_t packings_from_cache = 0; ///< packings found in the cache
    std::size_t runs_from_cache = 0;     ///< runs of unfinished packings found in the cache
};

struct pool_options {
    pool_options() = default;
    /// Jobs, cache and progress of a study.
    explicit pool_options(study_options const& o)
        : jobs(o.jobs), cache(o.cache), progress(o.quiet ? nullptr : stderr) {}

    int jobs = 0;                 ///< runs at the same time; 0: one for each processor
    std::string cache;            ///< directory of stored results, created if missing; empty: no cache
    std::FILE* progress = nullptr; ///< null: no progress
    std::vector<std::function<void()>> other_tasks{}; ///< run after the packings, on free threads
    pool_report* report = nullptr; ///< receives the counts; may be null
};

/// The loads of all packings, in the order of the requests. They depend neither on the number of jobs nor on the cache.
/// \throws interruption if a signal asks to stop; finished runs are in the cache then
/// \throws std::invalid_argument if a specimen or model cannot be built
std::vector<packing_result> run_packings(std::vector<packing_request> const& requests, pool_options const& how);

/// Median of a zone's loads in MPa as text: "-" above the range, "<" below it, "?" if no packing decides it.
std::string median_text(std::vector<packing_result> const& packings, lacuna::cartilage_zone zone, threshold what);

} // namespace cartilage
