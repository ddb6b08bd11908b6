// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "study_result.hpp"

namespace cartilage {

/// What is asked of a run at one load.
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

/// When the run came to it, s; none: not yet, or not at all.
std::optional<double> answer_time(probe const& p, question q);

/// How much of the damage that is asked for the run has done, 1 or more where the answer is yes. Of complete damage in
/// the logarithm of what is left, as if cuts fell on fibres by chance; of the first crack nothing is known: 0.
double share_of_damage(probe const& p, question q);

} // namespace cartilage
