// SPDX-License-Identifier: BSD-3-Clause
#include "question.hpp"

#include <algorithm>
#include <cmath>

namespace cartilage {

char const* name_of(question q) {
    switch (q) {
    case question::first_crack: return "first_crack";
    case question::capacity: return "capacity";
    case question::complete: return "complete";
    default: return "end";
    }
}

std::optional<double> answer_time(probe const& p, question q) {
    switch (q) {
    case question::first_crack: return p.first_crack_time;
    case question::capacity: return p.capacity_time;
    case question::complete: return p.complete_time;
    default: return p.whole() ? std::optional(p.end_time) : std::nullopt;
    }
}

double share_of_damage(probe const& p, question q) {
    if (q == question::capacity) return p.first_layer_fraction / 0.5;
    if (q == question::complete) return std::log1p(-std::min(p.cut_fraction, 0.9)) / std::log1p(-0.9);
    return 0;
}

bool answers(probe const& p, question q) { return !p.invalid && answer_time(p, q); }

} // namespace cartilage
