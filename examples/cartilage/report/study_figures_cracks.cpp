// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "cartilage/report/study_figures.hpp"
#include "cartilage/study/study_series.hpp"
#include "cartilage/study/study_statistics.hpp"

namespace cartilage {

namespace {

using lacuna::axis_scale;
using lacuna::canvas;
using lacuna::legend_mark;
using lacuna::plot;
using lacuna::plot_mark;
using lacuna::rectangle;

constexpr std::size_t slices = 10;

/// The cracks of a zone, the first crack of each packing, and the counts of each mode in each tenth of the height.
struct crack_map {
    series tension, shear, first; ///< µm
    std::array<double, slices> tension_in{}, shear_in{};
    std::vector<double> heights;          ///< µm
    std::map<std::string, int> broken_in; ///< broken bonds by the zone of their fibre
    std::size_t packings = 0, at_capacity = 0;

    std::size_t count() const { return heights.size(); }
};

crack_map crack_map_of(std::vector<packing_result const*> const& packings, double height_um) {
    crack_map map;
    for (packing_result const* packing : packings) {
        load_run const* run = representative_run(*packing);
        if (run == nullptr) continue;
        ++map.packings;
        map.at_capacity += packing->found.capacity_MPa.has_value();
        map.first.push_back({1e6 * run->cracks.front().x, 1e6 * run->cracks.front().y});
        for (load_run::layer_damage const& layer : run->layers) map.broken_in[layer.zone] += layer.broken;
        for (load_run::crack const& c : run->cracks) {
            double const share = 1e6 * c.y / height_um;
            auto const slice = std::size_t(std::clamp(share, 0.0, 0.999) * double(slices));
            (c.shear ? map.shear : map.tension).push_back({1e6 * c.x, 1e6 * c.y});
            (c.shear ? map.shear_in : map.tension_in)[slice] += 1;
            map.heights.push_back(1e6 * c.y);
        }
    }
    return map;
}

/// The shares of the breaks in each zone, for a specimen of several zones.
std::string zone_words(crack_map const& map) {
    if (map.broken_in.size() < 2) return "";
    int all = 0;
    for (auto const& [zone, broken] : map.broken_in) all += broken;
    if (all == 0) return "";
    std::string words;
    for (auto const zone : all_zones) {
        auto const found = map.broken_in.find(std::string(lacuna::to_string(zone)));
        if (found == map.broken_in.end()) continue;
        words += (words.empty() ? " By zone: " : ", ") + found->first + " " +
                 number_text("%.0f", 100.0 * found->second / all) + " %";
    }
    return words + ".";
}

std::string sentence_of(crack_map const& map, double height_um) {
    double const top = map.tension_in.back() + map.shear_in.back();
    double const tension = 100 * double(map.tension.size()) / double(map.count());
    std::vector<double> first;
    for (auto const& p : map.first) first.push_back(height_um - p[1]);
    return count_text(map.count(), "broken bond") + " in the representative runs of " +
           count_text(map.packings, "packing") + " (" + std::to_string(map.at_capacity) + " at capacity): " +
           number_text("%.0f", tension) +
           " % in tension, the others in shear; " + number_text("%.0f", 100 * top / double(map.count())) +
           " % lie in the top tenth of the height. The first crack lies " + number_text("%.0f", median(first)) +
           " µm below the top (median; quartiles " + number_text("%.0f", quantile(first, 0.25)) + " to " +
           number_text("%.0f", quantile(first, 0.75)) + ")." + zone_words(map);
}

void draw_map(canvas& page, crack_map const& map, double length_um, double height_um, double scale) {
    page.clear({1, 1, 1});
    rectangle const map_frame{76, 64, 76 + scale * length_um, 64 + scale * height_um};
    plot positions(page, map_frame, {0, length_um, "width (µm)", axis_scale::linear, length_um * scale < 250 ? 4 : 7},
               {0, height_um, "height (µm), load on top", axis_scale::linear, height_um * scale < 250 ? 4 : 7},
               figure_style);
    positions.draw_axes();
    double const size = map.count() > 2000 ? 1.3 : 2;
    positions.markers(map.shear, plot_mark::disc, shear_ink, size);
    positions.markers(map.tension, plot_mark::disc, tension_ink, size);
    positions.markers(map.first, plot_mark::ring, figure_style.ink, 4.5);

    double most = 0;
    for (std::size_t k = 0; k < slices; ++k) most = std::max(most, map.tension_in[k] + map.shear_in[k]);
    rectangle const counts_frame{map_frame.right + 40, map_frame.low,
                                 std::max(map_frame.right + 120, figure_width - 20), map_frame.high};
    plot counts(page, counts_frame,
                {0, 1.05 * most, "broken bonds", axis_scale::linear, counts_frame.width() < 200 ? 3 : 5},
                {0, height_um, "", axis_scale::linear, 6, {{0, ""}}}, figure_style);
    counts.draw_axes();
    for (std::size_t k = 0; k < slices; ++k) {
        double const low = height_um * (double(k) + 0.12) / slices, high = height_um * (double(k) + 0.88) / slices;
        counts.box(0, map.tension_in[k], low, high, tension_ink);
        counts.box(map.tension_in[k], map.tension_in[k] + map.shear_in[k], low, high, shear_ink);
    }
    draw_legend(page, map_frame.left,
                {{legend_mark::disc, tension_ink, "tension"},
                 {legend_mark::disc, shear_ink, "shear"},
                 {legend_mark::ring, figure_style.ink, "first of a packing"}});
}

std::string sentence_of(layer_order const& order, std::string const& event) {
    auto const often = std::max_element(order.layers.begin(), order.layers.end(),
                                        [](auto const& a, auto const& b) { return a.first < b.first; });
    auto const& top = order.layers.front();
    std::string words = "In " + std::to_string(top.first) + " of " +
                        count_text(std::size_t(order.packings), "packing") + " layer " + top.name +
                        " is the first to " + event;
    if (often->name == top.name) return words + "; no other layer is first more often.";
    return words + "; most often it is layer " + often->name + " (" + std::to_string(often->first) + ").";
}

void draw_layers(canvas& page, layer_order const& order, rectangle const& frame, std::string const& moment) {
    double earliest = 1e300, latest = 0;
    std::vector<lacuna::plot_tick> names;
    for (std::size_t k = 0; k < order.layers.size(); ++k) {
        names.push_back({-double(k), order.layers[k].name});
        for (double const t : order.layers[k].times) {
            earliest = std::min(earliest, t);
            latest = std::max(latest, t);
        }
    }
    page.clear({1, 1, 1});
    plot plane(page, frame, {0, 1.06 * latest, moment, axis_scale::linear, 7},
               {-double(order.layers.size()) + 0.4, 0.6, "layer", axis_scale::linear, 6, names}, figure_style);
    plane.draw_axes();
    for (std::size_t k = 0; k < order.layers.size(); ++k) {
        auto const& layer = order.layers[k];
        plot::points dots;
        for (double const t : layer.times) dots.push_back({t, -double(k)});
        plane.markers(dots, plot_mark::disc, faint_ink, 4);
        if (!layer.times.empty()) {
            double const middle = median(layer.times);
            plane.line({{middle, -double(k) - 0.35}, {middle, -double(k) + 0.35}}, lacuna::plot_ink(0), 3.5);
        }
        auto const y = plane.at(0, -double(k))[1];
        page.text({frame.right + 10, y}, std::to_string(layer.times.size()), 0.9 * figure_style.text_size,
                  figure_style.ink);
        page.text({frame.right + 50, y}, std::to_string(layer.first), 0.9 * figure_style.text_size, figure_style.ink);
    }
    for (auto const& [x, word] : {std::pair{10.0, "all"}, std::pair{50.0, "first"}})
        page.text({frame.right + x, frame.low - 16}, word, 0.9 * figure_style.text_size, figure_style.ink);
    draw_legend(page, frame.left,
                {{legend_mark::disc, faint_ink, "one packing"}, {legend_mark::line, lacuna::plot_ink(0), "median"}});
}

} // namespace

std::vector<figure> draw_crack_figures(std::string const& directory, study_result const& study) {
    std::vector<figure> figures;
    double const scale = std::min(340 / study.length_um, 460 / study.height_um);
    for (auto const zone : all_zones) {
        auto const map = crack_map_of(packings_of(study, zone), study.height_um);
        if (map.count() == 0) continue;
        figures.push_back(draw_zone_figure(
            directory, "cracks", zone, sentence_of(map, study.height_um), std::ceil(64 + scale * study.height_um + 60),
            [&](canvas& page) { draw_map(page, map, study.length_um, study.height_um, scale); }));
    }
    return figures;
}

figure draw_layer_order(std::string const& directory, lacuna::cartilage_zone zone, layer_order const& order,
                        std::string const& moment, std::string const& event) {
    rectangle const frame{118, 64, 462, 64 + std::max(120.0, 22.0 * double(order.layers.size()))};
    return draw_zone_figure(directory, "layers", zone, sentence_of(order, event), frame.high + 60,
                            [&](canvas& page) { draw_layers(page, order, frame, moment); });
}

std::vector<figure> draw_layer_figures(std::string const& directory, study_result const& study) {
    std::vector<figure> figures;
    for (auto const zone : all_zones) {
        auto const order = layer_order_of(packings_of(study, zone));
        if (order.packings > 0)
            figures.push_back(draw_layer_order(directory, zone, order, "time when half of its bonds were broken (ns)",
                                               "lose half of its bonds"));
    }
    return figures;
}

} // namespace cartilage
