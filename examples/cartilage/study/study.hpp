// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cartilage/study/pool.hpp"
#include "cartilage/study/study_options.hpp"
#include "cartilage/study/study_result.hpp"

namespace cartilage {

/// Name of a study's file in its directory.
inline constexpr char const* study_file = "study.json";

/// The packings of a study, by zone, then seed; of a shard only its own.
std::vector<packing_request> requests_of(study_options const& o);

/// A study with all but its packings and snapshots.
study_result study_frame(study_options const& o);

/// Results of another study are not replaced by accident; of the same one they come out the same anyway.
/// \throws usage_error where the directory holds another study
void refuse_other_study(std::string const& directory, study_result const& wanted);

/// Runs a study, or the part of it that is asked for. \param report what was run and what was kept from before
/// \throws interruption, std::invalid_argument
study_result run_study(study_options const& o, pool_report& report);

/// The study whose parts are in these directories. \throws usage_error where they are not parts of one
study_result merge_studies(std::vector<std::string> const& directories);

} // namespace cartilage
