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
#include "cartilage/study/study_result.hpp"

/// \file
/// Many packings, each searched for its loads on its own: one run a thread, results kept from one study to the next.

namespace cartilage {

/// One packing and the model it is run with: zone, seed, choices, size and fluid of `model`; its load does not matter.
struct packing_request {
    options model;
    load_range loads;
};

/// What a pool did.
struct pool_report {
    std::size_t runs = 0;          ///< runs at a load that were begun
    std::size_t packings_kept = 0; ///< packings found among the results kept earlier
    std::size_t runs_kept = 0;   ///< the same of runs of packings that were left unfinished
};

struct pool_options {
    int jobs = 0;                 ///< runs at the same time; 0: as many as there are processors
    std::string cache;            ///< directory of kept results, created where needed; empty: nothing is kept
    std::FILE* progress = nullptr; ///< null: silent
    std::vector<std::function<void()>> further{}; ///< other work, for threads that no packing is left for
    pool_report* report = nullptr; ///< null: nobody wants to know
};

/// The loads of all packings, in the order of the requests; the same whatever the number of jobs and whatever was kept.
/// \throws interruption when a signal asks to stop, after what was finished has been kept
/// \throws std::invalid_argument when a specimen or model cannot be built
std::vector<packing_result> run_packings(std::vector<packing_request> const& requests, pool_options const& how);

/// Median of a zone's loads in MPa for a person's eyes: "-" above the range, "<" below it, "?" when no packing has one.
std::string median_text(std::vector<packing_result> const& packings, lacuna::cartilage_zone zone, threshold what);

} // namespace cartilage
