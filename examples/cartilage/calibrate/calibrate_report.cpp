// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/calibrate/calibrate_report.hpp"

#include <cmath>

#include <lacuna/core/error.hpp>

#include "cartilage/common/choices_json.hpp"
#include "cartilage/common/json_writer.hpp"
#include "cartilage/common/write_whole.hpp"
#include "cartilage/report/html.hpp"
#include "cartilage/report/page.hpp"
#include "cartilage/report/study_figures.hpp"
#include "cartilage/study/cache.hpp"

namespace cartilage {

namespace {

constexpr double aim_MPa = 2;

std::string load_words(double load_MPa) {
    if (std::isinf(load_MPa)) return load_MPa > 0 ? "above" : "below";
    return number_text("%.3g", load_MPa);
}

std::string name_of(target_result const& t) {
    return std::string(lacuna::to_string(t.zone)) + ", " + name_of(t.what);
}

std::string off_words(target_result const& t) {
    if (t.packings == 0) return "undecided";
    if (std::isinf(t.median)) return t.median > 0 ? "above the range" : "below the range";
    return number_text("%+.1f MPa", t.median - t.paper) + number_text(" (%+.0f %%)", 100 * (t.median / t.paper - 1));
}

bool is_near(target_result const& t) { return t.packings > 0 && std::fabs(t.median - t.paper) <= aim_MPa; }

int near_count(calibrated_set const& set) {
    int n = 0;
    for (target_result const& t : set.targets) n += is_near(t);
    return n;
}

void add_set(json_writer& json, calibrated_set const& set) {
    json.value("misfit", set.misfit);
    if (!set.why.empty()) json.value("why", set.why);
    add_choices(json, set.choices);
    json.open('[', "targets");
    for (target_result const& t : set.targets) {
        json.open('{');
        json.value("zone", lacuna::to_string(t.zone));
        json.value("load", name_of(t.what));
        json.value("paper_MPa", t.paper);
        json.value("packings", t.packings);
        json.value("median_MPa", t.packings > 0 ? t.median : NAN);
        json.value("low_MPa", t.packings > 0 ? t.of_median.low : NAN);
        json.value("high_MPa", t.packings > 0 ? t.of_median.high : NAN);
        json.close('}');
    }
    json.close(']');
    json.open('[', "first_layer_first");
    for (first_layer_count const& c : set.first_layers) {
        json.open('{');
        json.value("zone", lacuna::to_string(c.zone));
        json.value("first", c.first);
        json.value("packings", c.packings);
        json.close('}');
    }
    json.close(']');
}

std::string calibration_json(calibrate_options const& o, std::vector<calibrated_set> const& sets, std::size_t best) {
    json_writer json;
    json.open('{');
    json.value("code", code_version());
    json.value("dry", o.study.model.dry);
    json.value("seeds", (unsigned long long)(o.study.seeds));
    json.value("lowest_MPa", o.study.loads.lowest_MPa);
    json.value("highest_MPa", o.study.loads.highest_MPa);
    json.value("resolution", o.study.loads.resolution);
    json.open('[', "free");
    for (choice_field const* f : o.free) json.value("", f->name);
    json.close(']');
    json.value("best", (unsigned long long)(best));
    json.open('[', "sets");
    for (calibrated_set const& set : sets) {
        json.open('{');
        add_set(json, set);
        json.close('}');
    }
    json.close(']');
    json.close('}');
    return json.text();
}

std::string page_of(calibrate_options const& o, std::vector<calibrated_set> const& sets, std::size_t best) {
    calibrated_set const& set = sets[best];
    std::string page = page_head("Cartilage under load: calibration") + "<h1>The best set of open choices</h1>\n";
    page += html_paragraph(
        "One set of the open choices, which the paper does not state, holds for all zones. The best of " +
        count_text(sets.size(), "set") + " is off by " + number_text("%.0f %%", 100 * std::expm1(set.misfit)) +
        " (root mean square of " +
        std::to_string(set.targets.size()) + " logarithms; a load out of range counts as a factor of 8); " +
        std::to_string(near_count(set)) + " of " + std::to_string(set.targets.size()) + " medians are within " +
        lacuna::to_text(aim_MPa) + " MPa of the paper's.");
    page += html_paragraph(
        std::to_string(o.study.seeds) + " packings of each zone, the same for every set; loads up to " +
        lacuna::to_text(o.study.loads.highest_MPa) + " MPa to " + number_text("%.3g", 100 * o.study.loads.resolution) +
        " %" + (o.study.model.dry ? ", without pore fluid." : ", with pore fluid."));
    std::vector<std::vector<std::string>> rows;
    for (target_result const& t : set.targets)
        rows.push_back({name_of(t), lacuna::to_text(t.paper), t.packings > 0 ? load_words(t.median) : "-",
                        t.packings > 0 ? load_words(t.of_median.low) + " to " + load_words(t.of_median.high) : "-",
                        off_words(t), is_near(t) ? "yes" : "no"});
    page += html_table("The paper's numbers beside the best set (MPa)",
                       {"load", "paper", "median", "95 % of the median", "off by",
                        "within " + lacuna::to_text(aim_MPa) + " MPa"},
                       rows);
    rows.clear();
    for (first_layer_count const& c : set.first_layers)
        rows.push_back(
            {std::string(lacuna::to_string(c.zone)), std::to_string(c.first) + " of " + std::to_string(c.packings)});
    page += html_table("Packings in which the first layer was the first to lose half of its bonds, in the run at the "
                       "capacity load",
                       {"zone", "packings"}, rows);
    page += html_paragraph("Choices of the best set that differ from the defaults:") + "<pre tabindex=\"0\">" +
            html_text(text_of(set.choices).empty() ? "none" : text_of(set.choices)) + "</pre>\n";
    rows.clear();
    std::vector<std::string> head{"set", "misfit"};
    for (choice_field const* f : o.free) head.emplace_back(f->name);
    for (target_result const& t : set.targets) head.push_back(name_of(t));
    for (std::size_t k = 0; k < sets.size(); ++k) {
        rows.push_back({std::to_string(k + 1), std::isnan(sets[k].misfit) ? "-" : number_text("%.3f", sets[k].misfit)});
        for (choice_field const* f : o.free) rows.back().push_back(f->text(sets[k].choices));
        for (target_result const& t : sets[k].targets)
            rows.back().push_back(t.packings > 0 ? load_words(t.median) : "-");
        rows.back().resize(head.size(), "-");
    }
    page += html_table("All sets in the order of their trial; medians in MPa", head, rows);
    return page + page_end();
}

} // namespace

std::string calibration_csv(calibrate_options const& o, std::vector<calibrated_set> const& sets) {
    std::string text = "set,misfit";
    for (choice_field const* f : o.free) text.append(",").append(f->name);
    std::vector<target_result> columns;
    for (calibrated_set const& set : sets)
        if (!set.targets.empty()) columns = set.targets;
    for (target_result const& t : columns) {
        std::string name = std::string(lacuna::to_string(t.zone)) + " " + name_of(t.what) + " MPa";
        for (char& c : name)
            if (c == ' ') c = '_';
        text += "," + name;
    }
    text += "\n";
    for (std::size_t k = 0; k < sets.size(); ++k) {
        text += std::to_string(k + 1) + "," + (std::isnan(sets[k].misfit) ? "" : lacuna::to_text(sets[k].misfit));
        for (choice_field const* f : o.free) text.append(",").append(f->text(sets[k].choices));
        for (std::size_t c = 0; c < columns.size(); ++c) {
            text += ",";
            if (c < sets[k].targets.size() && sets[k].targets[c].packings > 0)
                text += lacuna::to_text(sets[k].targets[c].median);
        }
        text += "\n";
    }
    return text;
}

void write_calibration(std::string const& directory, calibrate_options const& o,
                       std::vector<calibrated_set> const& sets, std::size_t best) {
    auto const write = [&](char const* name, std::string const& text) {
        write_whole(directory + "/" + name, text);
    };
    write("calibration.html", page_of(o, sets, best));
    write("calibration.csv", calibration_csv(o, sets));
    write("best.choices", "# misfit " + number_text("%.3f", sets[best].misfit) + "\n" + text_of(sets[best].choices));
    write("calibration.json", calibration_json(o, sets, best));
}

void print_set(std::FILE* out, std::size_t number, std::size_t of, calibrated_set const& set,
               std::vector<choice_field const*> const& free) {
    std::fprintf(out, "%zu/%zu misfit %.3f:", number, of, set.misfit);
    for (choice_field const* f : free)
        std::fprintf(out, " %s=%s", std::string(f->name).c_str(), f->text(set.choices).c_str());
    std::fprintf(out, " |");
    for (target_result const& t : set.targets)
        std::fprintf(out, " %s", t.packings > 0 ? load_words(t.median).c_str() : "-");
    std::fprintf(out, "%s%s\n", set.why.empty() ? "" : " ", set.why.c_str());
    std::fflush(out);
}

void print_best(std::FILE* out, calibrated_set const& set) {
    std::fprintf(out, "  %-22s %8s %8s  %s\n", "load (MPa)", "paper", "median", "off by");
    for (target_result const& t : set.targets)
        std::fprintf(out, "  %-22s %8.0f %8s  %s\n", name_of(t).c_str(), t.paper,
                     t.packings > 0 ? load_words(t.median).c_str() : "-", off_words(t).c_str());
    for (first_layer_count const& c : set.first_layers)
        std::fprintf(out, "  %s: the first layer failed first in %d of %d packings\n",
                     std::string(lacuna::to_string(c.zone)).c_str(), c.first, c.packings);
    std::fprintf(out, "  misfit %.3f; %d of %zu medians within %.0f MPa\n", set.misfit, near_count(set),
                 set.targets.size(), aim_MPa);
}

} // namespace cartilage
