// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "cartilage/run/load_run.hpp"

namespace cartilage {

/// The damage at which a run at one load may stop.
enum class criterion : std::uint8_t {
    first_crack, ///< a bond breaks
    capacity,    ///< the first layer has half of its bonds broken
    complete,    ///< 90 % of the fibres are cut
    end          ///< none: the run continues until its time is over
};

/// "first_crack", "capacity", "complete", "end".
char const* name_of(criterion c);

/// Whether the run reached that damage. An invalid run meets no criterion.
bool meets(load_run const& r, criterion c);

/// The time at which the run reached that damage, s; none: it did not.
std::optional<double> time_met(load_run const& r, criterion c);

/// Share of the criterion's damage that the run has done; 1 or more if it is met. For complete damage it is measured in
/// the logarithm of the share of uncut fibres, as if cuts hit fibres at random. For the first crack it is always 0.
double share_of_damage(load_run const& r, criterion c);

} // namespace cartilage
