// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/calibrate/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartilage {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest_ratio = 8; // of a load and the paper's load, either way

} // namespace

options with_choices(options const& o, choices const& wanted) {
    options changed = o;
    auto const extent = [](choices const& c) { return c.domain == domain_rule::tall ? 120.0 : 300.0; };
    if (o.length_um == extent(o.choices) && o.height_um == 420 - extent(o.choices)) {
        changed.length_um = extent(wanted);
        changed.height_um = 420 - extent(wanted);
    }
    changed.choices = wanted;
    changed.duration_ns.reset();
    if (wanted.duration > 0) changed.duration_ns = wanted.duration;
    return changed;
}

std::vector<change_of_load> compare(std::vector<packing_result> const& before,
                                    std::vector<packing_result> const& after) {
    std::vector<change_of_load> changes;
    for (auto const zone : all_zones)
        for (threshold const what : all_thresholds) {
            std::vector<double> logs, old, now;
            for (packing_result const& b : before) {
                if (b.zone != zone) continue;
                auto const same = std::find_if(after.begin(), after.end(), [&](packing_result const& a) {
                    return a.zone == zone && a.seed == b.seed;
                });
                if (same == after.end()) continue;
                auto const x = load_of(b, what), y = load_of(*same, what);
                if (!x || !y || (!std::isfinite(*x) && *x == *y)) continue;
                old.push_back(*x);
                now.push_back(*y);
                bool const up = *y == infinity || *x == -infinity, down = *y == -infinity || *x == infinity;
                logs.push_back(up ? infinity : down ? -infinity : std::log(*y / *x));
            }
            if (logs.empty()) continue;
            auto const percent = [](double log_ratio) { return 100 * std::expm1(log_ratio); };
            change_of_load c{zone, what, int(logs.size()), median(old), median(now), percent(median(logs)), {}};
            auto const i = median_interval(logs);
            c.of_change = {percent(i.low), percent(i.high)};
            changes.push_back(c);
        }
    return changes;
}

double target_result::misfit() const {
    double const most = std::log(largest_ratio);
    if (packings == 0 || median == infinity) return most;
    if (!(median > 0)) return -most;
    return std::clamp(std::log(median / paper), -most, most);
}

std::vector<target_result> targets_of(std::vector<packing_result> const& packings) {
    std::vector<target_result> targets;
    for (auto const zone : all_zones) {
        bool const there = std::any_of(packings.begin(), packings.end(), [&](auto const& p) { return p.zone == zone; });
        for (threshold const what : all_thresholds) {
            auto const paper = paper_load(zone, what);
            if (!paper || !there) continue;
            std::vector<double> loads;
            for (packing_result const& p : packings)
                if (auto const load = p.zone == zone ? load_of(p, what) : std::nullopt) loads.push_back(*load);
            target_result t;
            t.zone = zone;
            t.what = what;
            t.paper = *paper;
            t.packings = int(loads.size());
            if (!loads.empty()) {
                t.median = median(loads);
                t.of_median = median_interval(loads);
                t.first_quartile = quantile(loads, 0.25);
                t.third_quartile = quantile(loads, 0.75);
            }
            targets.push_back(t);
        }
    }
    return targets;
}

double misfit_of(std::vector<target_result> const& targets) {
    double sum = 0;
    for (target_result const& t : targets) sum += t.misfit() * t.misfit();
    return std::sqrt(sum / double(targets.size()));
}

std::vector<first_layer_count> first_layers_of(std::vector<packing_result> const& packings) {
    std::vector<first_layer_count> counts;
    for (auto const zone : all_zones) {
        first_layer_count count{zone, 0, 0};
        for (packing_result const& p : packings) {
            if (p.zone != zone || !p.found.capacity_MPa) continue;
            auto const run = std::find_if(p.runs.begin(), p.runs.end(), [&](load_run const& one) {
                return !one.invalid && one.load_MPa == *p.found.capacity_MPa && one.capacity_time;
            });
            if (run == p.runs.end() || run->layers.empty()) continue;
            ++count.packings;
            count.first +=
                std::none_of(run->layers.begin() + 1, run->layers.end(), [&](load_run::layer_damage const& l) {
                    return l.half_broken_time && *l.half_broken_time < *run->capacity_time;
                });
        }
        if (count.packings > 0) counts.push_back(count);
    }
    return counts;
}

} // namespace cartilage
