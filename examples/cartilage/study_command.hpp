// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cartilage/study/study_options.hpp"

namespace cartilage {

/// `cartilage study`: runs a study, or the part of it that is asked for, or puts parts together; and reports.
/// \return the exit status \throws usage_error, std::invalid_argument, interruption
int study(study_options const& o);

} // namespace cartilage
