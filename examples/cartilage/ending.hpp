// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>

#include "options.hpp"

namespace cartilage {

/// When a run is over (MODEL.md section 7): after the duration asked for; without one, once it is quiet, which is when
/// no bond has broken for a while and hardly any motion is left, or after its longest time.
class ending {
public:
    explicit ending(options const& o)
        : longest_(o.duration_ns ? *o.duration_ns * 1e-9 : 40e-9), may_be_quiet_(!o.duration_ns) {}

    /// The longest that the run may last, s.
    double longest() const { return longest_; }
    /// What it is called when the run lasts that long.
    char const* at_longest() const { return may_be_quiet_ ? "limit" : "duration"; }

    bool is_over(double time) const { return time >= longest_ * (1 - 1e-12); }
    /// To be asked after each step. \param kinetic energy, J \param last_break time of it, s; 0: none yet
    bool is_quiet(double kinetic, double time, double last_break) {
        highest_kinetic_ = std::max(highest_kinetic_, kinetic);
        return may_be_quiet_ && kinetic < quiet_fraction * highest_kinetic_ && time - last_break >= quiet_time;
    }

private:
    static constexpr double quiet_time = 20e-9;    // s without a break
    static constexpr double quiet_fraction = 1e-3; // of the largest kinetic energy

    double longest_;
    bool may_be_quiet_;
    double highest_kinetic_ = 0;
};

} // namespace cartilage
