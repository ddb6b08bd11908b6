// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/study_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

namespace cartilage {

namespace {

bool reaches(load_run const& p, threshold what) {
    switch (what) {
    case threshold::first_crack: return p.first_crack_time.has_value();
    case threshold::capacity: return p.capacity_time.has_value();
    default: return p.complete_time.has_value();
    }
}

/// The load of a packing, MPa. Infinite: outside the range; none: no valid run decides it.
std::optional<double> known_load(packing_result const& packing, threshold what, study_result const& study) {
    constexpr double beyond = std::numeric_limits<double>::infinity();
    if (auto const& load = packing.found.load(what)) return load;
    for (load_run const& p : packing.runs) {
        if (p.invalid) continue;
        bool const yes = reaches(p, what);
        if (p.load_MPa >= study.highest_MPa * (1 - 1e-9) && p.ran_to_end() && !yes) return beyond;
        if (p.load_MPa <= study.lowest_MPa * (1 + 1e-9) && yes) return -beyond;
    }
    return std::nullopt;
}

std::string percent_text(double percent) { return lacuna::formatted("%.1f", percent); }

} // namespace

char const* name_of(threshold what) {
    switch (what) {
    case threshold::first_crack: return "first crack";
    case threshold::capacity: return "capacity";
    default: return "complete";
    }
}

std::optional<double> paper_load(lacuna::cartilage_zone zone, threshold what) {
    constexpr std::array<std::array<double, 3>, 4> loads{{{45, 48, 53}, {53, 56, 58}, {55, 57, 60}, {46, 49, 0}}};
    double const load = loads[std::size_t(zone)][std::size_t(what)];
    return load > 0 ? std::optional<double>(load) : std::nullopt;
}

table3_cell cell_of(lacuna::cartilage_zone zone, threshold what, std::vector<std::optional<double>> const& loads,
                    double highest_MPa) {
    table3_cell cell;
    cell.zone = zone;
    cell.what = what;
    for (auto const& load : loads) {
        if (!load) {
            ++cell.invalid;
            continue;
        }
        cell.loads.push_back(*load);
        cell.none += *load > highest_MPa * (1 + 1e-9);
    }
    std::sort(cell.loads.begin(), cell.loads.end());
    cell.paper = paper_load(zone, what);
    if (cell.loads.empty()) return cell;
    cell.first_quartile = quantile_of_sorted(cell.loads, 0.25);
    cell.median = quantile_of_sorted(cell.loads, 0.5);
    cell.third_quartile = quantile_of_sorted(cell.loads, 0.75);
    cell.of_median = median_interval(cell.loads);
    if (cell.paper) cell.paper_percentile = percentile_of(*cell.paper, cell.loads);
    return cell;
}

std::vector<table3_cell> table3(study_result const& study) {
    std::vector<table3_cell> cells;
    for (auto const zone : all_zones) {
        bool const studied = std::any_of(study.packings.begin(), study.packings.end(),
                                         [&](packing_result const& p) { return p.zone == zone; });
        if (!studied) continue;
        for (threshold const what : all_thresholds) {
            std::vector<std::optional<double>> loads;
            for (packing_result const& packing : study.packings)
                if (packing.zone == zone) loads.push_back(known_load(packing, what, study));
            table3_cell cell = cell_of(zone, what, loads, study.highest_MPa);
            for (double const load : cell.loads)
                if (std::isfinite(load))
                    lacuna::require_in("study.packings.found", load, study.lowest_MPa * (1 - 1e-9),
                                       study.highest_MPa * (1 + 1e-9));
            cells.push_back(std::move(cell));
        }
    }
    return cells;
}

std::string load_number(double load_MPa) {
    return lacuna::formatted(load_MPa < 9.995 ? "%.2f" : (load_MPa < 99.95 ? "%.1f" : "%.0f"), load_MPa);
}

std::string load_text(double load_MPa, study_result const& study) {
    if (std::isinf(load_MPa))
        return load_MPa > 0 ? "> " + lacuna::to_text(study.highest_MPa) : "< " + lacuna::to_text(study.lowest_MPa);
    return load_number(load_MPa);
}

std::string table3_csv(std::vector<table3_cell> const& cells, study_result const& study) {
    std::string text = "zone,load,packings,invalid,none,median_MPa,first_quartile_MPa,third_quartile_MPa,"
                       "median_low_MPa,median_high_MPa,paper_MPa,paper_percentile\n";
    for (table3_cell const& cell : cells) {
        text.append(lacuna::to_string(cell.zone)).append(",").append(name_of(cell.what));
        for (int const number : {cell.count(), cell.invalid, cell.none})
            text.append(",").append(std::to_string(number));
        for (double const load :
             {cell.median, cell.first_quartile, cell.third_quartile, cell.of_median.low, cell.of_median.high})
            text.append(",").append(cell.loads.empty() ? "" : load_text(load, study));
        text.append(",").append(cell.paper ? lacuna::to_text(*cell.paper) : "");
        text.append(",").append(cell.paper_percentile ? percent_text(*cell.paper_percentile) : "");
        text += "\n";
    }
    return text;
}

} // namespace cartilage
