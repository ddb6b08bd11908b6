// SPDX-License-Identifier: BSD-3-Clause
#include "question.hpp"

namespace cartilage {

char const* name_of(question q) {
    switch (q) {
    case question::first_crack: return "first_crack";
    case question::capacity: return "capacity";
    case question::complete: return "complete";
    default: return "end";
    }
}

bool answers(probe const& p, question q) {
    if (p.invalid) return false;
    switch (q) {
    case question::first_crack: return p.first_crack_time.has_value();
    case question::capacity: return p.capacity_time.has_value();
    case question::complete: return p.complete_time.has_value();
    default: return p.whole();
    }
}

} // namespace cartilage
