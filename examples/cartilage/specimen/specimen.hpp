// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/draw/picture_scene.hpp>

#include "cartilage/common/options.hpp"
#include "cartilage/specimen/specimen_types.hpp"

namespace cartilage {

using specimen = lacuna::cartilage_specimen<double>;

/// Parameters of the requested specimen, in SI units.
lacuna::cartilage_specimen_parameters specimen_parameters(options const& o);
/// Checks that the specimen can be built. \throws usage_error that names the bad option
void validate_specimen(options const& o);
/// Builds the requested specimen. \throws std::invalid_argument
specimen build_specimen(options const& o);

/// Counts and statistics of a specimen.
struct specimen_report {
    std::size_t particles = 0;
    std::size_t bonded_particles = 0;
    std::size_t fibres = 0;
    std::size_t bonds = 0;
    std::size_t fixed = 0;
    std::size_t loaded = 0;
    double area_fraction = 0;
    double mean_radius = 0; ///< m
    double max_overlap = 0; ///< relative to the smaller radius
    double mean_coordination = 0;
    std::size_t loose = 0; ///< particles with fewer than two neighbours
};

specimen_report report_of(specimen const& s);

/// The scene for a picture of the specimen: particles, bonds, loads, support, walls and zones, with title and counts.
lacuna::scene scene_of(specimen const& s, options const& o);

} // namespace cartilage
