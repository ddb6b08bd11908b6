// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cartilage/common/options.hpp"
#include "cartilage/study/study_result.hpp"

namespace cartilage {

/// Zone and load of a figure of the paper.
struct paper_picture {
    std::string figure;
    lacuna::cartilage_zone zone;
    double load_MPa;
};
/// The paper's Figures 10 to 12.
std::vector<paper_picture> const& paper_pictures();

/// Runs a packing of the model `o` to the end at the zone and load of a picture. Records profiles of stress and pore
/// pressure.
/// \throws interruption if a signal asks to stop, std::invalid_argument if the model cannot be built
snapshot take_snapshot(paper_picture const& picture, options o);

} // namespace cartilage
