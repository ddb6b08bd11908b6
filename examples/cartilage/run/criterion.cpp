// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/criterion.hpp"

#include <algorithm>
#include <cmath>

namespace cartilage {

char const* name_of(criterion c) {
    switch (c) {
    case criterion::first_crack: return "first_crack";
    case criterion::capacity: return "capacity";
    case criterion::complete: return "complete";
    default: return "end";
    }
}

std::optional<double> time_met(load_run const& r, criterion c) {
    switch (c) {
    case criterion::first_crack: return r.first_crack_time;
    case criterion::capacity: return r.capacity_time;
    case criterion::complete: return r.complete_time;
    default: return r.ran_to_end() ? std::optional(r.end_time) : std::nullopt;
    }
}

double share_of_damage(load_run const& r, criterion c) {
    if (c == criterion::capacity) return r.first_layer_fraction / 0.5;
    if (c == criterion::complete) return std::log1p(-std::min(r.cut_fraction, 0.9)) / std::log1p(-0.9);
    return 0;
}

bool meets(load_run const& r, criterion c) { return !r.invalid && time_met(r, c); }

} // namespace cartilage
