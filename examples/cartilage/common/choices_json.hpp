// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "cartilage/common/choices.hpp"
#include "cartilage/common/json_writer.hpp"

namespace cartilage {

/// Adds the object "choices": each choice by its name; words and numbers that are not finite as text.
inline void add_choices(json_writer& json, choices const& c) {
    json.open('{', "choices");
    for (choice_field const& f : choice_fields()) {
        double const value = f.get(c);
        if (f.type == choice_field::kind::word || !std::isfinite(value))
            json.value(f.name, f.text(c));
        else
            json.value(f.name, value);
    }
    json.close('}');
}

} // namespace cartilage
