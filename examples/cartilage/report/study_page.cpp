// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/report/study_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <lacuna/core/error.hpp>

#include "cartilage/report/html.hpp"
#include "cartilage/report/page.hpp"

namespace cartilage {

namespace {

std::string paragraph(std::string const& plain, char const* kind = "") { return html_paragraph(plain, kind); }

std::string heading(std::string const& plain) { return html_heading(plain); }

std::vector<lacuna::cartilage_zone> zones_of(study_result const& study) {
    std::vector<lacuna::cartilage_zone> found;
    for (auto const zone : all_zones)
        if (std::any_of(study.packings.begin(), study.packings.end(), [&](auto const& p) { return p.zone == zone; }))
            found.push_back(zone);
    return found;
}

/// "1 to 20", "1 to 3, 7".
std::string seeds_text(std::vector<std::uint64_t> seeds) {
    std::sort(seeds.begin(), seeds.end());
    std::string text;
    for (std::size_t k = 0; k < seeds.size();) {
        std::size_t last = k;
        while (last + 1 < seeds.size() && seeds[last + 1] == seeds[last] + 1) ++last;
        text += (text.empty() ? "" : ", ") + std::to_string(seeds[k]);
        if (last > k) text += (last > k + 1 ? " to " : ", ") + std::to_string(seeds[last]);
        k = last + 1;
    }
    return text;
}

/// A reason with "..." for its numbers, because these differ from run to run.
std::string kind_of(std::string const& reason) {
    std::string kind;
    for (std::size_t k = 0; k < reason.size();) {
        std::size_t const end = reason.find_first_not_of("0123456789.+-e", k);
        bool const number = reason[k] >= '0' && reason[k] <= '9';
        kind += number ? "..." : std::string(1, reason[k]);
        k = number ? std::min(end, reason.size()) : k + 1;
    }
    return kind;
}

std::string runs_section(study_result const& study) {
    std::vector<std::vector<std::string>> rows;
    std::map<std::string, std::size_t> reasons;
    std::size_t runs = 0, bad = 0;
    for (auto const zone : zones_of(study)) {
        std::vector<std::uint64_t> seeds;
        std::size_t zone_runs = 0, zone_whole = 0, zone_bad = 0;
        for (packing_result const& packing : study.packings) {
            if (packing.zone != zone) continue;
            seeds.push_back(packing.seed);
            for (load_run const& p : packing.runs) {
                ++zone_runs;
                zone_whole += p.ran_to_end();
                zone_bad += p.invalid.has_value();
                if (p.invalid) ++reasons[kind_of(*p.invalid)];
            }
        }
        rows.push_back({std::string(lacuna::to_string(zone)), std::to_string(seeds.size()), seeds_text(seeds),
                        std::to_string(zone_runs), std::to_string(zone_whole), std::to_string(zone_bad)});
        runs += zone_runs;
        bad += zone_bad;
    }
    std::string text = heading("Packings and runs");
    text +=
        paragraph("Specimens of " + lacuna::to_text(study.length_um) + " by " + lacuna::to_text(study.height_um) +
                  " µm" + (study.dry ? ", without pore fluid" : ", with pore fluid") + ". Each load was sought from " +
                  lacuna::to_text(study.lowest_MPa) + " to " + lacuna::to_text(study.highest_MPa) +
                  " MPa on a logarithmic scale, to " + number_text("%.3g", 100 * study.resolution) +
                  " %. A run stops once its criterion is met; the others ran to the end. The time step is " +
                  number_text("%.3g", study.step_share) + " of the rigorous bound.");
    text += html_table("Number of packings and runs",
                       {"zone", "packings", "seeds", "runs", "to the end", "invalid"}, rows);
    if (bad == 0) {
        text += paragraph("No run is invalid.");
    } else {
        text += paragraph(std::to_string(bad) + " of " + count_text(runs, "run") +
                          " do not count; no number on this page includes them:");
        rows.clear();
        for (auto const& [why, number] : reasons) rows.push_back({why, std::to_string(number)});
        text += html_table("Invalid runs", {"reason", "runs"}, rows, table_cells::wrapped);
    }
    text += paragraph("Code: " + (study.code.empty() ? "not recorded" : study.code) +
                      ". The open choices, which the paper does not state:");
    return text + "<pre tabindex=\"0\">" + html_text(study.choices.empty() ? "defaults" : study.choices) + "</pre>\n";
}

std::string interval_text(double low, double high, study_result const& study) {
    return load_text(low, study) + " to " + load_text(high, study);
}

std::string tables(study_result const& study, std::vector<table3_cell> const& cells) {
    std::vector<std::vector<std::string>> side_by_side, full;
    for (table3_cell const& cell : cells) {
        std::string const zone(lacuna::to_string(cell.zone));
        std::string const paper = cell.paper ? lacuna::to_text(*cell.paper) : "-";
        bool const known = !cell.loads.empty();
        if (cell.what == threshold::first_crack) side_by_side.push_back({zone});
        side_by_side.back().push_back((known ? load_text(cell.median, study) : "-") + " (paper " + paper + ")");
        full.push_back({zone + ", " + name_of(cell.what), std::to_string(cell.count()), std::to_string(cell.invalid),
                        std::to_string(cell.none), known ? load_text(cell.median, study) : "-",
                        known ? interval_text(cell.first_quartile, cell.third_quartile, study) : "-",
                        known ? interval_text(cell.of_median.low, cell.of_median.high, study) : "-", paper,
                        cell.paper_percentile ? number_text("%.0f %%", *cell.paper_percentile) : "-"});
    }
    std::string text = heading("Table 3");
    text += paragraph("First crack: the lowest load with a broken bond. Capacity: the lowest load at which the first "
                      "layer has half of its bonds broken. Complete: the lowest load at which 90 % of the fibres are "
                      "cut. All in MPa.");
    text += html_table("Medians of this study and the paper's loads (MPa)",
                       {"zone", "first crack", "capacity", "complete"}, side_by_side, table_cells::wrapped);
    text += html_table("Medians with their scatter (MPa)",
                       {"load", "packings", "invalid", "none", "median", "quartiles", "95 % of the median", "paper",
                        "paper's percentile"},
                       full);
    return text +
           paragraph("None: packings that hold at the highest load; their load counts as infinite. Invalid: "
                     "packings whose load no valid run decides; they do not count. The interval of the median is "
                     "a percentile bootstrap over packings. The percentile is the share of packings below the "
                     "paper's load.");
}

std::string limits(study_result const& study, std::vector<table3_cell> const& cells) {
    int fewest = 1 << 30, none = 0, invalid = 0;
    for (table3_cell const& cell : cells) {
        fewest = std::min(fewest, cell.count());
        none += cell.none;
        invalid += cell.invalid;
    }
    std::vector<std::string> lines;
    lines.push_back("Loads are known to " + number_text("%.3g", 100 * study.resolution) +
                    " % at best. If a higher load does not always break more, the load is one of several possible "
                    "ones.");
    lines.push_back("The smallest cell of Table 3 has " + count_text(std::size_t(fewest), "packing") + "; " +
                    count_text(std::size_t(none), "load") + " above " + lacuna::to_text(study.highest_MPa) +
                    " MPa and " + count_text(std::size_t(invalid), "undecided load") + " over all cells.");
    lines.push_back(
        "The median damage is drawn where at least half of the packings have runs to the end on both sides. It leaves "
        "out runs that stopped early, at high loads.");
    lines.push_back("Where t √P is constant, a load depends on the duration of the runs. First cracks within 2 ns "
                    "come from elastic waves.");
    lines.push_back("Snapshots and fronts are single runs of one packing each, not medians.");
    std::string text = heading("Limits") + "<ul>\n";
    for (std::string const& line : lines) text += "<li>" + html_text(line) + "</li>\n";
    return text + "</ul>\n";
}

std::string show(std::string const& directory, figure_section const& section) {
    std::string text = heading(section.title) + paragraph(section.explanation) + "<div class=\"figures\">\n";
    for (figure const& f : section.figures) text += html_figure(directory, f, section.title + ", " + f.title);
    return text + "</div>\n";
}

} // namespace

std::string study_page(std::string const& directory, study_result const& study, std::vector<table3_cell> const& cells,
                       std::vector<figure_section> const& sections) {
    std::size_t const zones = zones_of(study).size();
    std::string text = page_head("Cartilage under load: study") + "<h1>Cartilage under load</h1>\n";
    text +=
        paragraph("At which load each zone of articular cartilage cracks, beside Hong, Evans and Mente: " +
                      count_text(study.packings.size(), "random packing") + " of " + count_text(zones, "zone") + ".",
                  "lead");
    text += runs_section(study) + tables(study, cells);
    for (figure_section const& section : sections)
        if (!section.figures.empty()) text += show(directory, section);
    return text + limits(study, cells) + page_end();
}

} // namespace cartilage
