// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "cartilage/study/study_result.hpp"
#include "cartilage/study/study_series.hpp"

/// \file
/// How the load's force and the pore pressure move down through a specimen, and what they are when bonds break.

namespace cartilage {

struct front_arrivals {
    static constexpr double share = 0.1; ///< a front is there once this share of the quantity's largest value is

    series stress, pressure; ///< time (ns) of the arrival, depth (µm) below the top, downwards
    /// m/s: depth over time by least squares; none where they do not go with each other (correlation below 0.9).
    std::optional<double> stress_speed, pressure_speed;
};
/// When stress and pressure come to each layer of a snapshot, by size and not by sign.
front_arrivals arrivals_of(snapshot const& s);

/// The state where and when the first bond broke.
struct first_break {
    double time = 0;     ///< s
    double depth = 0;    ///< m
    double pressure = 0; ///< Pa, size of the pore pressure in the layer of the break
    double stress = 0;   ///< Pa, size of the vertical stress there
    double strength = 0; ///< Pa, of the fibre: what its bond carried when it broke (Table 1)
};
/// Of the profile next to the first break; none where nothing broke or the run was dry.
std::optional<first_break> first_break_of(snapshot const& s, double height_um);

} // namespace cartilage
