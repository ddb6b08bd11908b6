// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "cartilage/study/study_result.hpp"
#include "cartilage/study/study_series.hpp"

/// \file
/// How stress and pore pressure move down through a specimen, and their values at the first break.

namespace cartilage {

/// Arrival of the fronts of stress and pore pressure at each layer.
struct front_arrivals {
    static constexpr double share = 0.1; ///< a front has arrived at this share of the quantity's largest value

    series stress, pressure; ///< time of arrival (ns), depth below the top (µm); downwards
    /// Speed in m/s: slope of depth over time by least squares; none if their correlation is below 0.9.
    std::optional<double> stress_speed, pressure_speed;
};
/// The arrivals in a snapshot. Stress and pressure count by magnitude.
front_arrivals arrivals_of(snapshot const& s);

/// The state at the position and time of the first break.
struct first_break {
    double time = 0;     ///< s
    double depth = 0;    ///< m
    double pressure = 0; ///< Pa, magnitude of the pore pressure in the layer of the break
    double stress = 0;   ///< Pa, magnitude of the vertical stress in that layer
    double strength = 0; ///< Pa, strength of the fibres at that depth (Table 1)
};
/// The state in the profile nearest in time to the first break; none if nothing broke or the run was dry.
std::optional<first_break> first_break_of(snapshot const& s, double height_um);

} // namespace cartilage
