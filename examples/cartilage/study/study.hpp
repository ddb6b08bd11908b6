// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cartilage/study/pool.hpp"
#include "cartilage/study/study_options.hpp"
#include "cartilage/study/study_result.hpp"

namespace cartilage {

/// Name of a study's file in its directory.
inline constexpr char const* study_file = "study.json";

/// The packings of a study, or of its shard, by zone, then seed.
std::vector<packing_request> requests_of(study_options const& o);

/// A study without packings and snapshots: only its settings.
study_result study_frame(study_options const& o);

/// Protects the results of another study. Those of the same study may be replaced, because they come out the same.
/// \throws usage_error if the directory holds another study
void refuse_other_study(std::string const& directory, study_result const& wanted);

/// The explicit study whose columns stand beside a study in equilibrium: that of the same choices in `o.beside`, or in
/// the usual directory; none: that one has none. \throws usage_error if `o.beside` has none
std::optional<study_result> study_beside(study_options const& o);

/// Runs a study or a shard of it. \param report receives the counts of runs and of results from the cache
/// \throws interruption if a signal asks to stop, std::invalid_argument if a model cannot be built
study_result run_study(study_options const& o, pool_report& report);

/// Joins the parts of a study in these directories. \throws usage_error if they are not parts of one study
study_result merge_studies(std::vector<std::string> const& directories);

} // namespace cartilage
