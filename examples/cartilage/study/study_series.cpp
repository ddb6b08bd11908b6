// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/study_series.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cartilage/study/study_statistics.hpp"

namespace cartilage {

namespace {

double read_at(series const& line, double x) {
    auto const after = std::lower_bound(line.begin(), line.end(), x, [](auto const& p, double v) { return p[0] < v; });
    if (after == line.begin()) return (*after)[1];
    auto const before = after - 1;
    double const share = std::log(x / (*before)[0]) / std::log((*after)[0] / (*before)[0]);
    return (*before)[1] + share * ((*after)[1] - (*before)[1]);
}

int half_broken_layers(load_run const& p) {
    return int(std::count_if(p.layers.begin(), p.layers.end(),
                             [](load_run::layer_damage const& layer) { return layer.half_broken_time.has_value(); }));
}

/// Common slope of y over x within groups; each group is taken relative to its own means.
class slope_within_groups {
public:
    void add(series const& group) {
        double x = 0, y = 0;
        for (auto const& p : group) {
            x += p[0] / double(group.size());
            y += p[1] / double(group.size());
        }
        for (auto const& p : group) {
            xx_ += (p[0] - x) * (p[0] - x);
            xy_ += (p[0] - x) * (p[1] - y);
        }
    }
    std::optional<double> value() const { return xx_ > 1e-6 ? std::optional<double>(xy_ / xx_) : std::nullopt; }

private:
    double xx_ = 0, xy_ = 0;
};

} // namespace

std::vector<packing_result const*> packings_of(study_result const& study, lacuna::cartilage_zone zone) {
    std::vector<packing_result const*> found;
    for (packing_result const& packing : study.packings)
        if (packing.zone == zone) found.push_back(&packing);
    return found;
}

std::vector<series> damage_series(std::vector<packing_result const*> const& packings) {
    std::vector<series> all;
    for (packing_result const* packing : packings) {
        series line;
        for (load_run const& p : packing->runs)
            if (p.ran_to_end() && !p.invalid) line.push_back({p.load_MPa, 100 * p.broken_fraction});
        std::sort(line.begin(), line.end(), [](auto const& a, auto const& b) { return a[0] < b[0]; });
        if (!line.empty()) all.push_back(std::move(line));
    }
    return all;
}

series median_series(std::vector<series> const& all) {
    std::vector<double> loads;
    for (series const& line : all)
        for (auto const& p : line) loads.push_back(p[0]);
    std::sort(loads.begin(), loads.end());
    loads.erase(std::unique(loads.begin(), loads.end()), loads.end());
    series middle;
    for (double const x : loads) {
        std::vector<double> values;
        for (series const& line : all)
            if (line.front()[0] <= x && x <= line.back()[0]) values.push_back(read_at(line, x));
        if (2 * values.size() >= all.size()) middle.push_back({x, median(values)});
    }
    return middle;
}

first_crack_times first_crack_times_of(std::vector<packing_result const*> const& packings) {
    first_crack_times found;
    slope_within_groups slope;
    std::vector<double> products;
    for (packing_result const* packing : packings) {
        series logs;
        for (load_run const& p : packing->runs) {
            if (p.invalid) continue;
            found.longest_run = std::max(found.longest_run, 1e9 * p.end_time);
            if (!p.first_crack_time) continue;
            double const t = 1e9 * *p.first_crack_time;
            bool const elastic = *p.first_crack_time <= first_crack_times::elastic_until;
            (elastic ? found.elastic : found.slow).push_back({p.load_MPa, t});
            if (elastic) continue;
            logs.push_back({std::log(p.load_MPa), std::log(t)});
            products.push_back(t * std::sqrt(p.load_MPa));
        }
        if (logs.size() > 1) slope.add(logs);
    }
    found.slope = slope.value();
    if (!products.empty()) {
        found.product_low = quantile(products, 0.25);
        found.product = median(products);
        found.product_high = quantile(products, 0.75);
    }
    return found;
}

load_run const* representative_run(packing_result const& packing) {
    load_run const* most = nullptr;
    for (load_run const& p : packing.runs) {
        if (p.invalid || p.cracks.empty()) continue;
        if (packing.found.capacity_MPa && std::fabs(p.load_MPa / *packing.found.capacity_MPa - 1) < 1e-9) return &p;
        if (most == nullptr || p.cracks.size() > most->cracks.size()) most = &p;
    }
    return most;
}

void layer_order::add(std::vector<std::pair<std::string, std::optional<double>>> const& moments) {
    double earliest = 1e300;
    for (auto const& [name, moment] : moments) earliest = std::min(earliest, moment.value_or(1e300));
    packings += earliest < 1e300;
    for (auto const& [name, moment] : moments) {
        auto const named = [&wanted = name](layer const& l) { return l.name == wanted; };
        auto known = std::find_if(layers.begin(), layers.end(), named);
        if (known == layers.end()) known = layers.insert(layers.end(), {name, {}, 0});
        if (!moment) continue;
        known->times.push_back(*moment);
        known->first += *moment == earliest;
    }
}

layer_order layer_order_of(std::vector<packing_result const*> const& packings) {
    layer_order order;
    for (packing_result const* packing : packings) {
        load_run const* run = nullptr;
        for (load_run const& p : packing->runs)
            if (!p.invalid && (run == nullptr || half_broken_layers(p) > half_broken_layers(*run))) run = &p;
        if (run == nullptr) continue;
        std::vector<std::pair<std::string, std::optional<double>>> moments;
        for (load_run::layer_damage const& layer : run->layers) {
            auto const& half = layer.half_broken_time;
            moments.emplace_back(layer.zone + " " + std::to_string(layer.layer),
                                 half ? std::optional(1e9 * *half) : std::nullopt);
        }
        order.add(moments);
    }
    return order;
}

} // namespace cartilage
