// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pool.hpp"
#include "study_options.hpp"
#include "study_result.hpp"

namespace cartilage {

/// The packings of a study, by zone, then seed; of a shard only its own.
std::vector<packing_request> requests_of(study_options const& o);

/// Runs a study, or the part of it that is asked for, or puts parts together; and reports.
/// \return the exit status \throws usage_error, std::invalid_argument, interruption
int study(study_options const& o);

} // namespace cartilage
