// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/equilibrium_study.hpp"

#include <atomic>
#include <cstdio>
#include <limits>
#include <mutex>
#include <utility>

#include <lacuna/core/text.hpp>
#include <lacuna/observe/progress.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "cartilage/common/interruption.hpp"
#include "cartilage/common/jobs.hpp"
#include "cartilage/study/cache.hpp"
#include "cartilage/study/study.hpp"
#include "cartilage/study/study_json.hpp"

namespace cartilage {

namespace {

template <class T>
json json_of_optional(std::optional<T> const& value) {
    return value ? json(*value) : json(nullptr);
}
std::optional<double> optional_of(json const& j) {
    return j.is_null() ? std::nullopt : std::optional(j.get<double>());
}

json json_of(equilibrium_packing const& p) {
    json j;
    j["zone"] = lacuna::to_string(p.zone);
    j["seed"] = p.seed;
    j["result"] = p.result;
    j["ended"] = p.ended;
    j["load_MPa"] = p.load_MPa;
    j["unbalanced"] = p.unbalanced;
    j["first_crack_MPa"] = json_of_optional(p.first_crack_MPa);
    j["capacity_MPa"] = json_of_optional(p.capacity_MPa);
    j["capacity_half_MPa"] = json_of_optional(p.capacity_half_MPa);
    j["complete_MPa"] = json_of_optional(p.complete_MPa);
    j["factorisations"] = p.factorisations;
    j["layers"] = json::array();
    for (auto const& l : p.layers) j["layers"].push_back({{"name", l.name}, {"cut_MPa", json_of_optional(l.cut_MPa)}});
    j["cracks"] = json::array();
    for (std::size_t k = 0; k < p.cracks.size(); ++k) {
        auto const& c = p.cracks[k];
        j["cracks"].push_back(json::array({p.crack_MPa[k], c.x, c.y, c.shear, c.fibre}));
    }
    return j;
}

equilibrium_packing packing_of(json const& j) {
    equilibrium_packing p;
    p.zone = lacuna::parse_cartilage_zone(j.at("zone").get<std::string>());
    p.seed = j.at("seed");
    p.result = j.at("result");
    p.ended = j.at("ended");
    p.load_MPa = j.at("load_MPa");
    p.unbalanced = j.at("unbalanced");
    p.first_crack_MPa = optional_of(j.at("first_crack_MPa"));
    p.capacity_MPa = optional_of(j.at("capacity_MPa"));
    p.capacity_half_MPa = optional_of(j.at("capacity_half_MPa"));
    p.complete_MPa = optional_of(j.at("complete_MPa"));
    p.factorisations = j.at("factorisations");
    for (auto const& l : j.at("layers")) p.layers.push_back({l.at("name"), optional_of(l.at("cut_MPa"))});
    for (auto const& c : j.at("cracks")) {
        p.crack_MPa.push_back(c.at(0));
        p.cracks.push_back({0, c.at(1), c.at(2), c.at(3), c.at(4)});
    }
    return p;
}

equilibrium_packing strength_of(equilibrium_request const& r) {
    specimen const s = build_specimen(r.model);
    equilibrium_run const found = find_strength(s, r, nullptr, nullptr, nullptr);
    if (found.ended == "interrupted") throw interruption();
    equilibrium_packing p;
    p.zone = r.model.zone;
    p.seed = r.model.seed;
    p.result = found.result();
    p.ended = found.ended;
    p.load_MPa = found.load_MPa;
    p.unbalanced = found.unbalanced;
    p.first_crack_MPa = found.first_crack_MPa;
    p.capacity_MPa = found.capacity_MPa;
    p.capacity_half_MPa = found.capacity_half_MPa;
    p.complete_MPa = found.complete_MPa;
    p.factorisations = found.factorisations;
    for (auto const& l : found.layers) p.layers.push_back({l.zone + " " + std::to_string(l.layer), l.cut_MPa});
    for (crack_record const& c : found.cracks)
        p.cracks.push_back({0, c.position[0] - s.left, c.position[1], c.shear, c.fibre});
    p.crack_MPa = found.crack_MPa;
    return p;
}

std::string key_of(equilibrium_request const& r) {
    return cartilage::key_of(r.model) + "equilibrium up to " + lacuna::to_text(r.model.load_MPa) + " MPa in " +
           std::to_string(r.steps) + (r.drained ? " drained" : " sealed") +
           (r.failures == lacuna::failure_choice::first ? " first" : " worst");
}

/// A packing from the cache; none: there is none, or its file is damaged.
std::optional<equilibrium_packing> stored(result_cache const& cache, std::string const& name, std::string const& key) {
    try {
        if (auto const found = cache.find(name, key)) return packing_of(*found);
    } catch (std::exception const&) {
        // A damaged entry counts as missing.
    }
    return std::nullopt;
}

std::string interval_text(table3_cell const& cell, study_result const& study) {
    if (cell.loads.empty()) return "-";
    return load_text(cell.median, study) + " (" + load_text(cell.of_median.low, study) + " to " +
           load_text(cell.of_median.high, study) + ")";
}

table3_cell const* same_cell(std::vector<table3_cell> const& cells, table3_cell const& cell) {
    for (table3_cell const& other : cells)
        if (other.zone == cell.zone && other.what == cell.what) return &other;
    return nullptr;
}

} // namespace

std::optional<double> equilibrium_packing::load(threshold what) const {
    auto const& found = what == threshold::first_crack ? first_crack_MPa
                        : what == threshold::capacity  ? capacity_MPa
                                                       : complete_MPa;
    if (found) return found;
    return ended == "limit" ? std::optional(std::numeric_limits<double>::infinity()) : std::nullopt;
}

std::vector<equilibrium_packing> run_equilibrium_study(study_options const& o, std::size_t& from_cache) {
    auto const requests = requests_of(o);
    result_cache const cache(o.cache);
    std::vector<equilibrium_packing> packings(requests.size());
    lacuna::progress_options settings;
    settings.sink = o.quiet ? nullptr : stderr;
    settings.steps = std::max<long long>(1, static_cast<long long>(requests.size()));
    settings.unit = nullptr;
    settings.terminal = lacuna::is_terminal(settings.sink);
    lacuna::progress_reporter<> progress(settings);
    std::mutex guard;
    long long done = 0;
    from_cache = 0;
    for_each_in_parallel(requests.size(), o.jobs, [&](std::size_t k) {
        equilibrium_request r = o.in_equilibrium;
        r.model = requests[k].model;
        r.model.load_MPa = o.in_equilibrium.model.load_MPa;
        std::string const name = std::string(lacuna::to_string(r.model.zone)) + "-" + std::to_string(r.model.seed);
        std::string const key = key_of(r);
        auto found = stored(cache, name, key);
        bool const known = found.has_value();
        if (!known) {
            if (lacuna::stop_signal() != 0) throw interruption();
            found = strength_of(r);
            cache.store(name, key, json_of(*found));
        }
        std::lock_guard const lock(guard);
        packings[k] = std::move(*found);
        from_cache += known;
        progress.update(++done, name);
    });
    progress.finish(done, "packings");
    return packings;
}

std::vector<table3_cell> table3(std::vector<equilibrium_packing> const& packings, double highest_MPa) {
    std::vector<table3_cell> cells;
    for (auto const zone : all_zones)
        for (threshold const what : all_thresholds) {
            std::vector<std::optional<double>> loads;
            for (auto const& p : packings)
                if (p.zone == zone) loads.push_back(p.load(what));
            if (!loads.empty()) cells.push_back(cell_of(zone, what, loads, highest_MPa));
        }
    return cells;
}

study_result as_study(study_options const& o, std::vector<equilibrium_packing> const& packings) {
    study_result study = study_frame(o);
    study.highest_MPa = o.in_equilibrium.model.load_MPa;
    study.lowest_MPa = study.highest_MPa;
    for (auto const& p : packings) {
        packing_result r;
        r.zone = p.zone;
        r.seed = p.seed;
        r.found.first_crack_MPa = p.first_crack_MPa;
        r.found.capacity_MPa = p.capacity_MPa;
        r.found.complete_MPa = p.complete_MPa;
        load_run run;
        run.load_MPa = p.load_MPa;
        run.ended = p.ended;
        run.cracks = p.cracks;
        r.runs = {run};
        study.packings.push_back(r);
        if (p.first_crack_MPa) study.lowest_MPa = std::min(study.lowest_MPa, *p.first_crack_MPa);
    }
  
    study.lowest_MPa = std::min(study.lowest_MPa, 0.05 * study.highest_MPa);
    return study;
}

std::string equilibrium_csv(std::vector<table3_cell> const& cells, study_result const& study,
                            study_result const* beside) {
    std::string text = "zone,load,packings,undecided,none,median_MPa,first_quartile_MPa,third_quartile_MPa,"
                       "median_low_MPa,median_high_MPa,explicit_packings,explicit_median_MPa,explicit_median_low_MPa,"
                       "explicit_median_high_MPa,paper_MPa\n";
    auto const others = beside ? table3(*beside) : std::vector<table3_cell>();
    for (table3_cell const& cell : cells) {
        text.append(lacuna::to_string(cell.zone)).append(",").append(name_of(cell.what));
        for (int const number : {cell.count(), cell.invalid, cell.none})
            text.append(",").append(std::to_string(number));
        for (double const load :
             {cell.median, cell.first_quartile, cell.third_quartile, cell.of_median.low, cell.of_median.high})
            text.append(",").append(cell.loads.empty() ? "" : load_text(load, study));
        table3_cell const* other = same_cell(others, cell);
        bool const known = other && !other->loads.empty();
        text.append(",").append(other ? std::to_string(other->count()) : "");
        text.append(",").append(known ? load_text(other->median, *beside) : "");
        text.append(",").append(known ? load_text(other->of_median.low, *beside) : "");
        text.append(",").append(known ? load_text(other->of_median.high, *beside) : "");
        text.append(",").append(cell.paper ? lacuna::to_text(*cell.paper) : "").append("\n");
    }
    return text;
}

std::string equilibrium_table(std::vector<table3_cell> const& cells, study_result const& study,
                              study_result const* beside) {
    auto const others = beside ? table3(*beside) : std::vector<table3_cell>();
    char line[200];
    std::snprintf(line, sizeof line, "  %-8s %-12s %4s %9s  %-24s %-24s %6s\n", "zone", "load", "n", "undecided",
                  "equilibrium", "explicit", "paper");
    std::string text = line;
    for (table3_cell const& cell : cells) {
        table3_cell const* other = same_cell(others, cell);
        std::snprintf(line, sizeof line, "  %-8s %-12s %4d %9d  %-24s %-24s %6s\n",
                      std::string(lacuna::to_string(cell.zone)).c_str(), name_of(cell.what), cell.count(), cell.invalid,
                      interval_text(cell, study).c_str(), other ? interval_text(*other, *beside).c_str() : "-",
                      cell.paper ? lacuna::to_text(*cell.paper).c_str() : "-");
        text += line;
    }
    return text + "  medians with their 95 % intervals, MPa; capacity in equilibrium: the first layer and another "
                  "fibre are cut,\n  explicit: half of the first layer's bonds; undecided: equilibrium ends or was not "
                  "found before\n";
}

std::string text_of(study_result const& study, std::vector<equilibrium_packing> const& packings) {
    auto const line = [](char const* key, json const& value) {
        return json(key).dump() + ": " + value.dump() + ",\n";
    };
    std::string text = "{\n" + line("highest_MPa", study.highest_MPa) + line("choices", study.choices) +
                       line("code", study.code) + line("dry", study.dry) + line("length_um", study.length_um) +
                       line("height_um", study.height_um) + "\"packings\": [";
    for (std::size_t k = 0; k < packings.size(); ++k) text += (k ? ",\n" : "\n") + json_of(packings[k]).dump();
    return text + "\n]\n}\n";
}

} // namespace cartilage
