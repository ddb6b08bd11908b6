// SPDX-License-Identifier: BSD-3-Clause
#include "presets.hpp"

#include <string>

#include <lacuna/core/error.hpp>

namespace cartilage {

std::vector<std::string_view> preset_names() { return {"literal", "lattice"}; }

choices preset_choices(std::string_view name) {
    choices c;
    if (name == "literal") return c;
    if (name == "lattice") {
        c.packing = packing_rule::lattice;
        return c;
    }
    std::string rule;
    for (auto known : preset_names()) rule += (rule.empty() ? "" : " or ") + std::string(known);
    lacuna::refuse("preset", name, rule);
}

} // namespace cartilage
