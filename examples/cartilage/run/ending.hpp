// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <lacuna/core/error.hpp>

#include "cartilage/common/options.hpp"

namespace cartilage {

/// Decides when a run is over. A run with a duration ends after it. Other runs end when they are quiet, or after their
/// longest time. Quiet means that no bond broke for quiet_time and the kinetic energy is below quiet_fraction of its
/// largest value.
class ending {
public:
    explicit ending(options const& o)
        : longest_(o.duration_ns.value_or(o.choices.longest) * 1e-9), quiet_time_(o.choices.quiet_time * 1e-9),
          quiet_fraction_(o.choices.quiet_fraction), may_be_quiet_(!o.duration_ns) {}

    /// The longest duration of the run, s.
    double longest() const { return longest_; }
    /// The reason of the end, if the run lasts that long: "limit" or "duration".
    char const* at_longest() const { return may_be_quiet_ ? "limit" : "duration"; }

    /// Number of steps of this length (s) in the longest duration, at least 1. \throws usage_error for 1e15 and more
    long long steps(double time_step) const {
        double const steps = std::ceil(longest_ / time_step * (1 - 1e-12));
        if (!(steps < 1e15)) throw usage_error("--duration " + lacuna::to_text(longest_ * 1e9) + ": too many steps");
        return std::max(1LL, static_cast<long long>(steps));
    }

    bool is_over(double time) const { return time >= longest_ * (1 - 1e-12); }
    /// Call it in the order of time, as it remembers the largest kinetic energy.
    /// \param kinetic energy, J \param time s \param last_break time of the last break, s; 0: no break yet
    bool is_quiet(double kinetic, double time, double last_break) {
        highest_kinetic_ = std::max(highest_kinetic_, kinetic);
        return may_be_quiet_ && kinetic < quiet_fraction_ * highest_kinetic_ && time - last_break >= quiet_time_;
    }

private:
    double longest_;
    double quiet_time_;     // s
    double quiet_fraction_; // of the largest kinetic energy
    bool may_be_quiet_;
    double highest_kinetic_ = 0;
};

} // namespace cartilage
