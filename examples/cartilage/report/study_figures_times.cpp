// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
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

constexpr lacuna::color elastic_ink{0.10, 0.35, 0.75}, slow_ink{0.80, 0.30, 0.10};
constexpr double elastic_ns = 1e9 * first_crack_times::elastic_until;

struct range {
    double low = 1e300, high = 0;
    void add(double v) {
        low = std::min(low, v);
        high = std::max(high, v);
    }
};

std::string sentence_of(first_crack_times const& t) {
    std::string words = std::to_string(t.elastic.size()) + " of " + count_text(t.count(), "first crack") +
                        " came within " + number_text("%.3g", elastic_ns) + " ns (elastic).";
    if (t.slow.empty()) return words;
    words += " For the later ones t √P is " + number_text("%.3g", t.product) + " ns √MPa (quartiles " +
             number_text("%.3g", t.product_low) + " to " + number_text("%.3g", t.product_high) + ")";
    bool const constant = t.slope && std::fabs(*t.slope + 0.5) <= 0.1;
    if (t.slope)
        words += ", and within a packing t goes as P to the power " + number_text("%.2f", *t.slope) +
                 (constant ? ": the product is constant, so that this \"strength\" only reflects the run's duration"
                           : "; -0.50 would make the product constant");
    words += ".";
    if (constant)
        words += " At that product a run of " + number_text("%.3g", t.longest_run) + " ns cracks from " +
                 load_number(std::pow(t.product / t.longest_run, 2)) + " MPa on.";
    return words;
}

void draw(canvas& page, first_crack_times const& t) {
    range load, time, product;
    for (series const* points : {&t.elastic, &t.slow})
        for (auto const& p : *points) {
            load.add(p[0]);
            time.add(p[1]);
            product.add(p[1] * std::sqrt(p[0]));
        }
    time.add(elastic_ns);
    auto const log_axis = [](range const& r, char const* label) {
        return lacuna::plot_axis{0.8 * r.low, 1.25 * r.high, label, axis_scale::logarithmic, 7};
    };
    auto const products = [](series const& points) {
        series out;
        for (auto const& p : points) out.push_back({p[0], p[1] * std::sqrt(p[0])});
        return out;
    };
    page.clear({1, 1, 1});
    auto loads = load_axis(load.low, load.high);
    plot times(page, upper_plot, loads, log_axis(time, "time of the first crack (ns)"), figure_style);
    times.box(loads.low, loads.high, times.y().low, elastic_ns, {0.10, 0.35, 0.75, 0.10});
    times.draw_axes();
    times.markers(t.elastic, plot_mark::disc, elastic_ink, 3.2);
    times.markers(t.slow, plot_mark::ring, slow_ink, 3.2);
    plot below(page, lower_plot, loads, log_axis(product, "time times √load (ns √MPa)"), figure_style);
    if (t.product > 0) below.box(loads.low, loads.high, t.product_low, t.product_high, {0.80, 0.30, 0.10, 0.12});
    below.draw_axes();
    below.markers(products(t.elastic), plot_mark::disc, elastic_ink, 3.2);
    below.markers(products(t.slow), plot_mark::ring, slow_ink, 3.2);
    if (t.product > 0) {
        below.rule_y(t.product, slow_ink, 1.6);
        series curve;
        for (int k = 0; k <= 40; ++k) {
            double const p = loads.low * std::pow(loads.high / loads.low, k / 40.0);
            curve.push_back({p, t.product / std::sqrt(p)});
        }
        times.dashed_line(curve, slow_ink, 1.6);
    }
    draw_legend(page, upper_plot.left,
                {{legend_mark::disc, elastic_ink, "elastic"},
                 {legend_mark::ring, slow_ink, "later"},
                 {legend_mark::dashes, slow_ink, "kinematic: t √P constant"}});
}

} // namespace

std::vector<figure> draw_first_crack_figures(std::string const& directory, study_result const& study) {
    std::vector<figure> figures;
    for (auto const zone : all_zones) {
        auto const times = first_crack_times_of(packings_of(study, zone));
        if (times.count() == 0) continue;
        figures.push_back(draw_zone_figure(directory, "first-crack", zone, sentence_of(times), two_plots_height,
                                           [&](canvas& page) { draw(page, times); }));
    }
    return figures;
}

} // namespace cartilage
