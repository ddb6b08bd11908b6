// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <lacuna/draw/plot.hpp>

#include "cartilage/study/study_result.hpp"
#include "cartilage/study/study_table.hpp"

/// \file
/// The figures of a study: each drawn into stem.png and stem.svg of a directory, with a sentence made from its numbers.

namespace cartilage {

struct figure {
    std::string stem; ///< name of its files
    std::string title;
    std::string sentence; ///< what it shows
    bool photo = false;   ///< thousands of particles: better shown as PNG
};

/// \name Drawn into `directory`. \throws std::runtime_error when a file cannot be written
/// \{
/// The loads of all packings and their medians beside the paper's, one figure per load.
std::vector<figure> draw_threshold_figures(std::string const& directory, study_result const& study,
                                           std::vector<table3_cell> const& cells);
/// Damage against load, one figure per zone.
std::vector<figure> draw_damage_figures(std::string const& directory, study_result const& study);
/// Time of the first crack, and that times sqrt(P), against load P: one figure per zone.
std::vector<figure> draw_first_crack_figures(std::string const& directory, study_result const& study);
/// Where bonds broke and how, one figure per zone.
std::vector<figure> draw_crack_figures(std::string const& directory, study_result const& study);
/// When the layers had half of their bonds broken, one figure per zone.
std::vector<figure> draw_layer_figures(std::string const& directory, study_result const& study);
/// Damage at the loads of the paper's Figures 10 to 12.
std::vector<figure> draw_snapshot_figures(std::string const& directory, study_result const& study);
/// How stress and pore pressure move down, one figure per snapshot that has profiles.
std::vector<figure> draw_front_figures(std::string const& directory, study_result const& study);
/// \}

/// \name Sizes, colours and words that the figures share.
/// \{
inline constexpr lacuna::plot_style figure_style{17};
inline constexpr lacuna::color tension_ink{0.80, 0.15, 0.12};
inline constexpr lacuna::color shear_ink{0.50, 0.20, 0.65};
inline constexpr lacuna::color paper_ink{0.85, 0.45, 0.05};
inline constexpr lacuna::color faint_ink{0.45, 0.55, 0.70, 0.45};

/// "Surface zone" or "Whole specimen".
std::string zone_title(lacuna::cartilage_zone zone);
/// printf of one number; see lacuna::formatted().
std::string number_text(char const* format, double value);
/// A logarithmic axis of loads over the values, widened to round numbers.
lacuna::plot_axis load_axis(double lowest, double highest);
/// "1 packing", "2 packings".
std::string count_text(std::size_t count, char const* noun);
/// \}

} // namespace cartilage
