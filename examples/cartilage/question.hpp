// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "study_result.hpp"

namespace cartilage {

/// What is asked of a run at one load; each includes the ones before it.
enum class question : std::uint8_t {
    first_crack, ///< does a bond break?
    capacity,    ///< does the first layer have half of its bonds broken?
    complete,    ///< are 90 % of the fibres cut?
    end          ///< what is there at the end of the run?
};

/// "first_crack", "capacity", "complete", "end".
char const* name_of(question q);

/// The run's answer: whether it came to what was asked for. A run that does not count has none.
bool answers(probe const& p, question q);

} // namespace cartilage
