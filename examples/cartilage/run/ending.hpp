// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <lacuna/core/error.hpp>

#include "cartilage/common/options.hpp"

namespace cartilage {

/// When a run is over: after the duration asked for; without one, once it is quiet, which is when
/// no bond has broken for a while and hardly any motion is left, or after its longest time.
class ending {
public:
    explicit ending(options const& o)
        : longest_(o.duration_ns.value_or(o.open.longest) * 1e-9), quiet_time_(o.open.quiet_time * 1e-9),
          quiet_fraction_(o.open.quiet_fraction), may_be_quiet_(!o.duration_ns) {}

    /// The longest that the run may last, s.
    double longest() const { return longest_; }
    /// What it is called when the run lasts that long.
    char const* at_longest() const { return may_be_quiet_ ? "limit" : "duration"; }

    /// Steps of this length until then, at least one. \throws usage_error for more than can be counted
    long long steps(double time_step) const {
        double const steps = std::ceil(longest_ / time_step * (1 - 1e-12));
        if (!(steps < 1e15)) throw usage_error("--duration " + lacuna::to_text(longest_ * 1e9) + ": too many steps");
        return std::max(1LL, static_cast<long long>(steps));
    }

    bool is_over(double time) const { return time >= longest_ * (1 - 1e-12); }
    /// To be asked after each step. \param kinetic energy, J \param last_break time of it, s; 0: none yet
    bool is_quiet(double kinetic, double time, double last_break) {
        highest_kinetic_ = std::max(highest_kinetic_, kinetic);
        return may_be_quiet_ && kinetic < quiet_fraction_ * highest_kinetic_ && time - last_break >= quiet_time_;
    }

private:
    double longest_;
    double quiet_time_;     // s without a break
    double quiet_fraction_; // of the largest kinetic energy
    bool may_be_quiet_;
    double highest_kinetic_ = 0;
};

} // namespace cartilage
