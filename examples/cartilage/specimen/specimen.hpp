// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/draw/picture_scene.hpp>

#include "cartilage/common/options.hpp"
#include "cartilage/specimen/specimen_types.hpp"

namespace cartilage {

using specimen = lacuna::cartilage_specimen<double>;

/// The specimen that the command line asks for, in SI units.
lacuna::cartilage_specimen_parameters specimen_parameters(options const& o);
/// \throws usage_error when the specimen cannot be built, naming the option that is to blame
void validate_specimen(options const& o);
/// Builds the specimen that the command line asks for. \throws std::invalid_argument
specimen build_specimen(options const& o);

/// A specimen at a glance.
struct specimen_report {
    std::size_t particles = 0;
    std::size_t bonded_particles = 0;
    std::size_t fibres = 0;
    std::size_t bonds = 0;
    std::size_t fixed = 0;
    std::size_t loaded = 0;
    double area_fraction = 0;
    double mean_radius = 0; ///< m
    double max_overlap = 0; ///< over the smaller radius
    double mean_coordination = 0;
    std::size_t loose = 0; ///< particles with fewer than two neighbours
};

specimen_report report_of(specimen const& s);

/// The specimen as a picture's scene: particles, bonds, loads, support, walls and zones, with title and figures.
lacuna::scene scene_of(specimen const& s, options const& o);

} // namespace cartilage
