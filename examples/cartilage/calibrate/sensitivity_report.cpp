// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/calibrate/sensitivity_report.hpp"

#include <algorithm>
#include <cmath>

#include <lacuna/core/error.hpp>

#include "cartilage/common/write_whole.hpp"
#include "cartilage/report/html.hpp"
#include "cartilage/report/page.hpp"
#include "cartilage/report/study_figures.hpp"
#include "cartilage/report/tornado.hpp"

namespace cartilage {

namespace {

constexpr double largest_change = 400; // %, limit of a plot's axis
constexpr double frame_left = 190, frame_right = 640;

std::string number_or_empty(double value) { return std::isfinite(value) ? lacuna::to_text(value) : ""; }

std::string percent_text(double percent) {
    if (std::isnan(percent)) return "-";
    if (std::isinf(percent)) return percent > 0 ? "above the range" : "below the range";
    return number_text("%+.0f %%", percent);
}

struct named_change {
    variation const* what;
    change_of_load const* change;
};

/// The changes of one load of one zone, the largest first.
std::vector<named_change> changes_of(std::vector<variation> const& variations, lacuna::cartilage_zone zone,
                                     threshold what) {
    std::vector<named_change> found;
    for (variation const& v : variations)
        for (change_of_load const& c : v.changes)
            if (c.zone == zone && c.what == what) found.push_back({&v, &c});
    // Half the load counts as much as twice the load. A load below the range has -100 %.
    auto const size = [](named_change const& n) {
        return std::fabs(std::log1p(std::max(n.change->change, -100.0) / 100));
    };
    std::stable_sort(found.begin(), found.end(),
                     [&](named_change const& a, named_change const& b) { return size(a) > size(b); });
    return found;
}

std::string label_of(variation const& v) { return std::string(v.field->name) + " = " + v.field->text(v.value); }

figure draw(std::string const& directory, std::vector<variation> const& variations, lacuna::cartilage_zone zone,
            threshold what) {
    figure f{tornado_stem(zone, what), zone_title(zone) + ", " + name_of(what), "", false};
    std::vector<lacuna::tornado_row> rows;
    double low = -20, high = 20;
    auto const cut = [](double percent) { return std::clamp(percent, -100.0, largest_change); };
    for (variation const& v : variations)
        for (change_of_load const& c : v.changes) {
            if (c.zone != zone || c.what != what) continue;
            if (rows.empty() || rows.back().name != v.field->name) rows.push_back({std::string(v.field->name), {}});
            rows.back().bars.push_back(
                {v.field->text(v.value), cut(c.change), cut(c.of_change.low), cut(c.of_change.high)});
            low = std::min({low, cut(c.of_change.low), cut(c.change)});
            high = std::max({high, cut(c.of_change.high), cut(c.change)});
        }
    double const top = 14, tall = lacuna::tornado_height(rows, figure_style);
    lacuna::rectangle const frame{frame_left, top, frame_right, top + tall};
    double const room = 0.2 * (high - low);
    auto const paint = [&](lacuna::canvas& page) {
        page.clear({1, 1, 1});
        lacuna::draw_tornado(page, frame, rows, {low - room, high + room, "change of the load (%)"}, figure_style);
    };
    lacuna::save_canvas_png_svg(directory + "/" + f.stem, frame_right + 20, top + tall + 52, paint);
    auto const sorted = changes_of(variations, zone, what);
    f.caption = "Largest: ";
    for (std::size_t k = 0; k < std::min<std::size_t>(3, sorted.size()); ++k)
        f.caption += (k > 0 ? ", " : "") + label_of(*sorted[k].what) + " " + percent_text(sorted[k].change->change);
    std::size_t clear = 0;
    for (named_change const& n : sorted) clear += n.change->of_change.low > 0 || n.change->of_change.high < 0;
    f.caption += ". " + std::to_string(clear) + " of " + std::to_string(sorted.size()) +
                  " changes have a 95 % interval without zero.";
    return f;
}

} // namespace

std::string tornado_stem(lacuna::cartilage_zone zone, threshold what) {
    std::string load = name_of(what);
    std::replace(load.begin(), load.end(), ' ', '-');
    return "sensitivity-" + std::string(lacuna::to_string(zone)) + "-" + load;
}

std::string sensitivity_csv(std::vector<variation> const& variations, choices const& base) {
    std::string text = "choice,unit,base,value,zone,load,pairs,base_median_MPa,median_MPa,change_percent,low_percent,"
                       "high_percent\n";
    for (variation const& v : variations)
        for (change_of_load const& c : v.changes) {
            text.append(v.field->name).append(",").append(v.field->unit).append(",").append(v.field->text(base));
            text.append(",").append(v.field->text(v.value)).append(",").append(lacuna::to_string(c.zone)).append(",");
            text.append(name_of(c.what)).append(",").append(std::to_string(c.pairs));
            for (double const value : {c.before, c.after, c.change, c.of_change.low, c.of_change.high})
                text.append(",").append(number_or_empty(value));
            text += "\n";
        }
    return text;
}

void write_sensitivity(std::string const& directory, study_options const& o, std::vector<packing_result> const& plain,
                       std::vector<variation> const& variations) {
    std::string page = page_head("Cartilage under load: sensitivity") + "<h1>Effect of the open choices</h1>\n";
    page += html_paragraph(
        "The effect of each open choice, which the paper does not state, on the loads of Table 3. "
        "One choice changes at a time; each packing is compared with the same packing of the base. Bars are "
        "medians of the changes, whiskers their 95 % intervals (bootstrap over packings).");
    page += html_paragraph(std::to_string(o.seeds) + " packings of each zone, loads from " +
                           lacuna::to_text(o.loads.lowest_MPa) + " to " + lacuna::to_text(o.loads.highest_MPa) +
                           " MPa to " + number_text("%.3g", 100 * o.loads.resolution) + " %" +
                           (o.model.dry ? ", without pore fluid." : ", with pore fluid.") +
                           " A bar that ends at -100 % or " + number_text("+%.0f", largest_change) +
                           " % may be a load outside the range.");
    std::string const base = text_of(o.model.choices);
    page += html_paragraph("The base:") + "<pre tabindex=\"0\">" +
            html_text(base.empty() ? "all choices at their defaults" : base) + "</pre>\n<div class=\"figures\">\n";
    for (auto const zone : all_zones)
        for (threshold const what : all_thresholds) {
            if (changes_of(variations, zone, what).empty()) continue;
            figure const f = draw(directory, variations, zone, what);
            page += html_figure(directory, f, f.title);
        }
    page += "</div>\n";
    std::vector<std::vector<std::string>> rows;
    for (choice_field const& f : choice_fields())
        rows.push_back({std::string(f.name), f.text(o.model.choices), std::string(f.unit), std::string(f.reason)});
    page += html_table("The choices and why they are open", {"choice", "base", "unit", "reason"}, rows);
    std::vector<std::vector<std::string>> medians;
    for (target_result const& t : targets_of(plain))
        medians.push_back({std::string(lacuna::to_string(t.zone)) + ", " + name_of(t.what), lacuna::to_text(t.paper),
                           t.packings > 0 ? number_text("%.3g", t.median) : "-"});
    page += html_table("Medians of the base and loads of the paper (MPa)", {"load", "paper", "base"}, medians);
    page += page_end();

    auto const write = [&](char const* name, std::string const& text) {
        write_whole(directory + "/" + name, text);
    };
    write("sensitivity.html", page);
    write("sensitivity.csv", sensitivity_csv(variations, o.model.choices));
}

void print_sensitivity(std::FILE* out, std::vector<variation> const& variations) {
    for (auto const zone : all_zones)
        for (threshold const what : all_thresholds) {
            auto const sorted = changes_of(variations, zone, what);
            if (sorted.empty()) continue;
            std::fprintf(out, "  %s, %s\n", std::string(lacuna::to_string(zone)).c_str(), name_of(what));
            for (std::size_t k = 0; k < std::min<std::size_t>(5, sorted.size()); ++k)
                std::fprintf(out, "    %-32s %-18s (%s to %s)\n", label_of(*sorted[k].what).c_str(),
                             percent_text(sorted[k].change->change).c_str(),
                             percent_text(sorted[k].change->of_change.low).c_str(),
                             percent_text(sorted[k].change->of_change.high).c_str());
        }
}

} // namespace cartilage
