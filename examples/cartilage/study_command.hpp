// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cartilage/study/study_options.hpp"

namespace cartilage {

/// The command `cartilage study`: runs a study or a shard, or joins shards; then writes the results.
/// \return the exit status \throws usage_error, std::invalid_argument, interruption
int study(study_options const& o);

} // namespace cartilage
