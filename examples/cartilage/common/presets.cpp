// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/common/presets.hpp"

#include <string>

#include <lacuna/core/error.hpp>

namespace cartilage {

std::vector<std::string_view> preset_names() { return {"literal", "lattice", "calibrated"}; }

choices preset_choices(std::string_view name) {
    choices c;
    if (name == "literal") return c;
    if (name == "lattice") {
        c.packing = packing_rule::lattice;
        return c;
    }
    if (name == "calibrated") {
        // The result of `cartilage calibrate --dry` in data/calibrated/calibration.html.
        c.thickness = 5;
        c.bond_moment = 2.95;
        c.matrix_links = 1;
        c.ramp_time = 10.4;
        c.duration = 14.8;
        return c;
    }
    std::string rule;
    for (auto known : preset_names()) rule += (rule.empty() ? "" : ", ") + std::string(known);
    lacuna::refuse("preset", name, "one of " + rule);
}

} // namespace cartilage
