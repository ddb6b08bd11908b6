// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <lacuna/draw/plot.hpp>

#include "cartilage/study/study_result.hpp"
#include "cartilage/study/study_series.hpp"
#include "cartilage/study/study_table.hpp"

/// \file
/// The figures of a study. Each is drawn to stem.png and stem.svg in a directory and has a caption with its numbers.

namespace cartilage {

/// A drawn figure.
struct figure {
    std::string stem; ///< name of its files without ending
    std::string title;
    std::string caption;
    bool as_png = false; ///< the page shows the PNG, because the SVG has thousands of particles
};

/// \name Figures drawn to `directory`. \throws std::runtime_error if a file cannot be written
/// \{
/// The loads of all packings and their medians beside the paper's, one figure per load.
std::vector<figure> draw_threshold_figures(std::string const& directory, study_result const& study,
                                           std::vector<table3_cell> const& cells);
/// Damage against load, one figure per zone.
std::vector<figure> draw_damage_figures(std::string const& directory, study_result const& study);
/// Time t of the first crack, and t sqrt(P), against load P, one figure per zone.
std::vector<figure> draw_first_crack_figures(std::string const& directory, study_result const& study);
/// Positions and modes of the breaks, one figure per zone.
std::vector<figure> draw_crack_figures(std::string const& directory, study_result const& study);
/// Times at which half of each layer's bonds were broken, one figure per zone.
std::vector<figure> draw_layer_figures(std::string const& directory, study_result const& study);
/// The moments of one zone's layers. \param moment label of the axis \param event "lose half of its bonds"
figure draw_layer_order(std::string const& directory, lacuna::cartilage_zone zone, layer_order const& order,
                        std::string const& moment, std::string const& event);
/// Damage at the loads of the paper's Figures 10 to 12.
std::vector<figure> draw_snapshot_figures(std::string const& directory, study_result const& study);
/// Fronts of stress and pore pressure, one figure per snapshot with profiles.
std::vector<figure> draw_front_figures(std::string const& directory, study_result const& study);
/// \}

/// \name Sizes, colours and words that the figures share.
/// \{
inline constexpr lacuna::plot_style figure_style{17};
inline constexpr double figure_width = 560; ///< px
/// Frames of two plots one above the other, and the height of their page, px.
inline constexpr lacuna::rectangle upper_plot{76, 64, 540, 330}, lower_plot{76, 424, 540, 668};
inline constexpr double two_plots_height = 728;
inline constexpr lacuna::color tension_ink{0.80, 0.15, 0.12};
inline constexpr lacuna::color shear_ink{0.50, 0.20, 0.65};
inline constexpr lacuna::color paper_ink{0.85, 0.45, 0.05};
inline constexpr lacuna::color faint_ink{0.45, 0.55, 0.70, 0.45};

/// "Surface zone" or "Whole specimen".
std::string zone_title(lacuna::cartilage_zone zone);
/// One number in a format of printf; see lacuna::formatted().
std::string number_text(char const* format, double value);
/// A logarithmic axis of loads that extends 7 % beyond the two values, MPa.
lacuna::plot_axis load_axis(double lowest, double highest);
/// "1 packing", "2 packings".
std::string count_text(std::size_t count, char const* noun);
/// The legend in the top row of a page, from x = `left` on.
void draw_legend(lacuna::canvas& page, double left, std::vector<lacuna::legend_entry> const& entries);
/// \}

/// A figure of one zone: files KIND-ZONE.png and KIND-ZONE.svg. \param height of the page, px
/// \param draw callable (canvas&) \throws std::runtime_error if a file cannot be written
template <class Draw>
figure draw_zone_figure(std::string const& directory, std::string const& kind, lacuna::cartilage_zone zone,
                        std::string caption, double height, Draw const& draw) {
    figure f{kind + "-" + std::string(lacuna::to_string(zone)), zone_title(zone), std::move(caption)};
    lacuna::save_canvas_png_svg(directory + "/" + f.stem, figure_width, height, draw);
    return f;
}

/// An HTML element with the embedded picture and the caption. \param alt text in place of the picture
/// \throws std::runtime_error if the picture cannot be read
std::string html_figure(std::string const& directory, figure const& f, std::string const& alt);

} // namespace cartilage
