// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/draw/picture_scene.hpp>
#include "specimen/specimen_types.hpp"

#include "options.hpp"
#include "report.hpp"

namespace cartilage {

using specimen = lacuna::cartilage_specimen<double>;

/// Builds the specimen that the command line asks for. \throws std::invalid_argument
specimen build_specimen(options const& o);

specimen_report report_of(specimen const& s);

/// The specimen as a picture's scene: particles, bonds, loads, support, walls and zones, with title and figures.
lacuna::scene scene_of(specimen const& s, options const& o);

} // namespace cartilage
