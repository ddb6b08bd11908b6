// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cartilage/common/options.hpp"
#include "cartilage/study/study_result.hpp"

namespace cartilage {

/// A picture of the paper: zone and load.
struct paper_picture {
    std::string figure;
    lacuna::cartilage_zone zone;
    double load_MPa;
};
/// Figures 10 to 12.
std::vector<paper_picture> const& paper_pictures();

/// Follows the packing `o` under the load of a picture to the end, and keeps what the fronts of force and pressure did.
/// \throws interruption, std::invalid_argument
snapshot take_snapshot(paper_picture const& picture, options o);

} // namespace cartilage
