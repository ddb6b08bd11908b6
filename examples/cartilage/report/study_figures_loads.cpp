// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "cartilage/report/study_figures.hpp"
#include "cartilage/study/study_series.hpp"

namespace cartilage {

namespace {

using lacuna::axis_scale;
using lacuna::canvas;
using lacuna::legend_mark;
using lacuna::plot;
using lacuna::plot_mark;

constexpr lacuna::rectangle frame{76, 64, 540, 360};
constexpr double height = 420;
constexpr lacuna::color ours_ink{0.10, 0.35, 0.75};

std::string median_words(table3_cell const& cell, study_result const& study) {
    std::string const zone(lacuna::to_string(cell.zone));
    if (cell.loads.empty()) return zone + " undecided";
    return zone + " " + load_text(cell.median, study);
}

/// A sentence on whether the medians of the three zones rise with depth, as the paper's loads do.
std::string order_words(std::vector<table3_cell const*> const& zones) {
    std::vector<table3_cell const*> known;
    for (table3_cell const* cell : zones)
        if (cell->zone != lacuna::cartilage_zone::whole && !cell->loads.empty()) known.push_back(cell);
    if (known.size() < 2) return "";
    bool rises = true, apart = true;
    for (std::size_t k = 1; k < known.size(); ++k) {
        rises = rises && known[k]->median > known[k - 1]->median;
        apart = apart && known[k]->of_median.low > known[k - 1]->of_median.high;
    }
    if (!rises) return " The medians do not rise from zone to zone with depth, as the paper's loads do.";
    return apart ? " The medians rise with depth, and the intervals of neighbouring zones do not overlap."
                 : " The medians rise with depth, but intervals of neighbouring zones overlap.";
}

/// A sentence with the ratio of the quartiles of each zone.
std::string scatter_words(std::vector<table3_cell const*> const& zones) {
    std::string words;
    for (table3_cell const* cell : zones)
        if (cell->count() > 1 && std::isfinite(cell->first_quartile) && std::isfinite(cell->third_quartile))
            words += (words.empty() ? "" : ", ") + std::string(lacuna::to_string(cell->zone)) + " " +
                     number_text("%.2f", cell->third_quartile / cell->first_quartile);
    return words.empty() ? "" : " Third over first quartile: " + words + ".";
}

figure draw_threshold(std::string const& directory, study_result const& study,
                      std::vector<table3_cell const*> const& zones, threshold what) {
    std::string const name = name_of(what);
    figure f{what == threshold::first_crack ? "loads-first-crack" : "loads-" + name,
             "Load of " + (what == threshold::complete ? std::string("complete damage") : name), "", false};
    std::vector<lacuna::plot_tick> ticks;
    for (std::size_t k = 0; k < zones.size(); ++k)
        ticks.push_back({double(k), std::string(lacuna::to_string(zones[k]->zone))});
    double const beyond = 1.25 * study.highest_MPa;
    auto const draw = [&](canvas& page) {
        page.clear({1, 1, 1});
        plot plane(page, frame, {-0.5, double(zones.size()) - 0.5, "", axis_scale::linear, 6, ticks},
                   {0.8 * study.lowest_MPa, 1.5 * study.highest_MPa, "load (MPa)", axis_scale::logarithmic, 8},
                   figure_style);
        plane.draw_axes();
        draw_legend(page, frame.left,
                    {{legend_mark::disc, faint_ink, "one packing"},
                     {legend_mark::line, ours_ink, "median, 95 %"},
                     {legend_mark::diamond, paper_ink, "paper"}});
        plane.rule_y(study.highest_MPa, figure_style.ink, 1);
        for (std::size_t k = 0; k < zones.size(); ++k) {
            table3_cell const& cell = *zones[k];
            auto const on_page = [&](double load) { return std::clamp(load, 0.88 * study.lowest_MPa, beyond); };
            plot::points dots;
            for (std::size_t i = 0; i < cell.loads.size(); ++i) {
                // Spread sideways in the order of the load, so that equal loads stay visible.
                double const aside = cell.loads.size() < 2 ? 0 : 0.4 * double(i) / double(cell.loads.size() - 1) - 0.2;
                dots.push_back({double(k) + aside, on_page(cell.loads[i])});
            }
            plane.markers(dots, plot_mark::disc, faint_ink, 4);
            if (!cell.loads.empty()) {
                double const x = double(k), low = on_page(cell.of_median.low), high = on_page(cell.of_median.high);
                plane.line({{x, low}, {x, high}}, ours_ink, 2.2);
                for (double const end : {low, high}) plane.line({{x - 0.08, end}, {x + 0.08, end}}, ours_ink, 2.2);
                plane.line({{x - 0.25, on_page(cell.median)}, {x + 0.25, on_page(cell.median)}}, ours_ink, 3.5);
            }
            if (cell.paper) plane.markers({{double(k) + 0.32, *cell.paper}}, plot_mark::diamond, paper_ink, 7);
        }
        plane.word(double(zones.size()) - 0.53, beyond, "none", figure_style.ink, lacuna::text_align::right);
    };
    lacuna::save_canvas_png_svg(directory + "/" + f.stem, figure_width, height, draw);
    f.caption = "Medians in MPa: ";
    for (std::size_t k = 0; k < zones.size(); ++k) f.caption += (k ? ", " : "") + median_words(*zones[k], study);
    f.caption += "." + order_words(zones) + scatter_words(zones);
    int inside = 0, compared = 0;
    for (table3_cell const* cell : zones) {
        if (!cell->paper || cell->loads.empty()) continue;
        ++compared;
        inside += cell->of_median.low <= *cell->paper && *cell->paper <= cell->of_median.high;
    }
    f.caption += " The paper's load lies inside the median's 95 % interval in " + std::to_string(inside) + " of " +
                  std::to_string(compared) + ".";
    return f;
}

} // namespace

std::vector<figure> draw_threshold_figures(std::string const& directory, study_result const& study,
                                           std::vector<table3_cell> const& cells) {
    std::vector<figure> figures;
    for (threshold const what : all_thresholds) {
        std::vector<table3_cell const*> zones;
        for (table3_cell const& cell : cells)
            if (cell.what == what) zones.push_back(&cell);
        if (!zones.empty()) figures.push_back(draw_threshold(directory, study, zones, what));
    }
    return figures;
}

std::vector<figure> draw_damage_figures(std::string const& directory, study_result const& study) {
    std::vector<figure> figures;
    for (auto const zone : all_zones) {
        auto const all = damage_series(packings_of(study, zone));
        if (all.empty()) continue;
        series const middle = median_series(all);
        double lowest = 1e300, highest = 0, most = 0;
        for (series const& line : all)
            for (auto const& p : line) {
                lowest = std::min(lowest, p[0]);
                highest = std::max(highest, p[0]);
                most = std::max(most, p[1]);
            }
        auto const draw = [&](canvas& page) {
            page.clear({1, 1, 1});
            plot plane(page, frame, load_axis(lowest, highest), {0, std::max(1.06 * most, 1.0), "broken bonds (%)"},
                       figure_style);
            plane.draw_axes();
            for (series const& line : all) plane.line(line, faint_ink, 1.3);
            for (series const& line : all)
                if (line.size() == 1) plane.markers(line, plot_mark::disc, faint_ink, 2.5);
            plane.line(middle, ours_ink, 3.5);
            draw_legend(page, frame.left,
                        {{legend_mark::line, faint_ink, "one packing"}, {legend_mark::dash, ours_ink, "median"}});
        };
        std::string caption = count_text(all.size(), "packing") + " with runs to the end, up to " +
                              number_text("%.1f", most) + " % broken.";
        if (middle.size() > 1)
            caption += " The median goes from " + number_text("%.1f", middle.front()[1]) + " % at " +
                       load_number(middle.front()[0]) + " MPa to " + number_text("%.1f", middle.back()[1]) + " % at " +
                       load_number(middle.back()[0]) + " MPa.";
        figures.push_back(draw_zone_figure(directory, "damage", zone, std::move(caption), height, draw));
    }
    return figures;
}

} // namespace cartilage
