// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <lacuna/draw/picture.hpp>

#include "cartilage/report/study_figures.hpp"
#include "cartilage/study/study_fronts.hpp"

namespace cartilage {

namespace {

using lacuna::axis_scale;
using lacuna::canvas;
using lacuna::legend_mark;
using lacuna::plot;
using lacuna::plot_mark;
using lacuna::rectangle;

constexpr lacuna::color stress_ink{0.13, 0.13, 0.15}, pressure_ink{0.10, 0.35, 0.75};

std::string title_of(snapshot const& s) {
    return zone_title(s.zone) + ", " + load_number(s.run.load_MPa) + " MPa (Figure " + s.figure + ")";
}

std::string damage_words(snapshot const& s) {
    std::size_t const shear = std::size_t(
        std::count_if(s.run.cracks.begin(), s.run.cracks.end(), [](load_run::crack const& c) { return c.shear; }));
    std::string words = "Seed " + std::to_string(s.seed) + ", after " + number_text("%.3g", 1e9 * s.run.end_time) +
                        " ns: " + number_text("%.1f", 100 * s.run.broken_fraction) + " % of the bonds broken (" +
                        std::to_string(s.run.cracks.size() - shear) + " in tension, " + std::to_string(shear) +
                        " in shear), " + number_text("%.0f", 100 * s.run.cut_fraction) + " % of the fibres cut, " +
                        number_text("%.0f", 100 * s.run.first_layer_fraction) + " % of the first layer's bonds broken.";
    if (s.run.invalid) words += " This run does not count: " + *s.run.invalid + ".";
    return words;
}

double largest(std::vector<double> const& values) {
    double most = 0;
    for (double const v : values) most = std::max(most, std::fabs(v));
    return most;
}

void draw_fronts(canvas& page, snapshot const& s, double height_um) {
    auto const fronts = arrivals_of(s);
    auto const broken = first_break_of(s, height_um);
    // The times from the first waves to the end of the run span three decades.
    double const last = 1e9 * s.fronts.back().time;
    double const first = std::max(1e9 * s.fronts.front().time, 1e-4 * last);
    lacuna::plot_axis const times{0.9 * first, 1.1 * last, "time (ns)", axis_scale::logarithmic, 8};
    auto const upward = [&](series const& front) {
        series out;
        for (auto const& p : front) out.push_back({p[0], height_um - p[1]});
        return out;
    };
    page.clear({1, 1, 1});
    plot positions(page, upper_plot, times, {0.0, height_um, "height (µm), load on top"}, figure_style);
    positions.draw_axes();
    series cracks;
    for (load_run::crack const& c : s.run.cracks) cracks.push_back({1e9 * c.time, 1e6 * c.y});
    positions.markers(cracks, plot_mark::cross, tension_ink, 3);
    positions.line(upward(fronts.stress), stress_ink, 2.4);
    positions.line(upward(fronts.pressure), pressure_ink, 2.4);

    series stress, pressure;
    double lowest = 1e300, highest = 0;
    auto const add = [&](series& line, double time, std::vector<double> const& values) {
        double const most = 1e-6 * largest(values);
        if (!(most > 0)) return;
        line.push_back({1e9 * time, most});
        highest = std::max(highest, most);
        lowest = std::min(lowest, most);
    };
    for (front_profile const& p : s.fronts) {
        add(stress, p.time, p.stress);
        add(pressure, p.time, p.pore_pressure);
    }
    if (highest > 0) {
        lowest = std::max(lowest, 1e-5 * highest);
        plot magnitudes(page, lower_plot, times,
                        {0.8 * lowest, 1.6 * highest, "largest mean of a layer (MPa)", axis_scale::logarithmic, 7},
                        figure_style);
        magnitudes.draw_axes();
        magnitudes.line(stress, stress_ink, 2.4);
        magnitudes.line(pressure, pressure_ink, 2.4);
        if (broken) magnitudes.rule_x(1e9 * broken->time, tension_ink, 1.6);
    }
    draw_legend(page, upper_plot.left,
                {{legend_mark::line, stress_ink, "stress"},
                 {legend_mark::line, pressure_ink, "pore pressure"},
                 {legend_mark::line, tension_ink, "bond breaks"}});
}

std::string arrival_words(char const* what, series const& front, std::optional<double> const& speed) {
    if (front.empty()) return "";
    if (speed) return std::string("The ") + what + " moves down at " + number_text("%.3g", 1e-3 * *speed) + " µm/ns. ";
    auto const ends =
        std::minmax_element(front.begin(), front.end(), [](auto const& a, auto const& b) { return a[0] < b[0]; });
    return std::string("The ") + what + " arrives between " + number_text("%.2g", (*ends.first)[0]) + " and " +
           number_text("%.2g", (*ends.second)[0]) + " ns, not in the order of depth. ";
}

std::string front_words(snapshot const& s, double height_um) {
    auto const fronts = arrivals_of(s);
    std::string words = arrival_words("stress", fronts.stress, fronts.stress_speed) +
                        arrival_words("pore pressure", fronts.pressure, fronts.pressure_speed);
    if (auto const b = first_break_of(s, height_um)) {
        words += "At the first break (" + number_text("%.2f", 1e9 * b->time) + " ns, " +
                 number_text("%.0f", 1e6 * b->depth) + " µm deep) the mean pore pressure around it is " +
                 number_text("%.2g", 1e-6 * b->pressure) +
                 " MPa: " + number_text("%.2g", 100 * b->pressure / b->strength) +
                 " % of the stress that broke the fibre (" + number_text("%.0f", 1e-6 * b->strength) + " MPa).";
    } else {
        words += s.run.cracks.empty() ? "No bond breaks." : "There is no pore pressure at the first break.";
    }
    if (s.run.peak_pore_pressure > 0)
        words += " The largest pressure of a pore in the whole run is " +
                 number_text("%.3g", 1e-6 * s.run.peak_pore_pressure) + " MPa.";
    return words;
}

} // namespace

std::vector<figure> draw_snapshot_figures(std::string const& directory, study_result const& study) {
    std::vector<figure> figures;
    for (snapshot const& s : study.snapshots) {
        if (s.damage.particles.empty()) continue;
        figure f{"figure-" + s.figure, title_of(s), damage_words(s), true};
        lacuna::save_damage(directory + "/" + f.stem, s.damage);
        figures.push_back(std::move(f));
    }
    return figures;
}

std::vector<figure> draw_front_figures(std::string const& directory, study_result const& study) {
    std::vector<figure> figures;
    for (snapshot const& s : study.snapshots) {
        if (s.fronts.size() < 2 || !(s.fronts.back().time > 0)) continue;
        figure f{"fronts-" + s.figure, title_of(s), front_words(s, study.height_um), false};
        lacuna::save_canvas_png_svg(directory + "/" + f.stem, figure_width, two_plots_height,
                                    [&](canvas& page) { draw_fronts(page, s, study.height_um); });
        figures.push_back(std::move(f));
    }
    return figures;
}

} // namespace cartilage
