// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "cartilage/run/load_run.hpp"

namespace cartilage {

/// The damage until which a run at one load is followed.
enum class criterion : std::uint8_t {
    first_crack, ///< a bond breaks
    capacity,    ///< the first layer has half of its bonds broken
    complete,    ///< 90 % of the fibres are cut
    end          ///< none: the run goes on until its time is over
};

/// "first_crack", "capacity", "complete", "end".
char const* name_of(criterion c);

/// Whether the run came to that damage. A run that does not count meets nothing.
bool meets(load_run const& r, criterion c);

/// When the run came to it, s; none: not yet, or not at all.
std::optional<double> time_met(load_run const& r, criterion c);

/// How much of the criterion's damage the run has done, 1 or more where it is met. Of complete damage in the
/// logarithm of what is left, as if cuts fell on fibres by chance; of the first crack nothing is known: 0.
double share_of_damage(load_run const& r, criterion c);

} // namespace cartilage
