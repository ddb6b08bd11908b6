// SPDX-License-Identifier: BSD-3-Clause
#include "study_json.hpp"

#include <stdexcept>
#include <utility>

namespace cartilage {

namespace {

template <class T>
json json_of_optional(std::optional<T> const& value) {
    return value ? json(*value) : json(nullptr);
}
template <class T>
void read_optional(json const& j, char const* key, std::optional<T>& value) {
    json const& found = j.at(key);
    value = found.is_null() ? std::nullopt : std::optional<T>(found.get<T>());
}

/// Points and the like: rows of numbers in one flat list.
template <class Rows, class Put>
json flat(Rows const& rows, Put const& put) {
    json list = json::array();
    for (auto const& row : rows) put(list, row);
    return list;
}
template <class Take>
void each_row(json const& list, std::size_t width, Take const& take) {
    if (!list.is_array() || list.size() % width != 0) throw std::invalid_argument("a list is not in rows");
    for (std::size_t at = 0; at < list.size(); at += width)
        take([&](std::size_t k) { return list[at + k].get<double>(); });
}

json json_of(study_crack const& c) { return json::array({c.time, c.x, c.y, c.shear, c.fibre}); }

json json_of(study_layer const& l) {
    return {{"zone", l.zone},
            {"layer", l.layer},
            {"bonds", l.bonds},
            {"broken", l.broken},
            {"half_broken_time", json_of_optional(l.half_broken_time)}};
}

json segments(std::vector<lacuna::scene::wall> const& walls) {
    return flat(walls, [](json& list, auto const& w) {
        for (double const v : {w.from[0], w.from[1], w.to[0], w.to[1]}) list.push_back(v);
    });
}
std::vector<lacuna::scene::wall> segments_from(json const& j) {
    std::vector<lacuna::scene::wall> walls;
    each_row(j, 4, [&](auto const& v) { walls.push_back({{v(0), v(1)}, {v(2), v(3)}}); });
    return walls;
}

json json_of(lacuna::scene const& s) {
    json j;
    j["frame"] = {s.left, s.bottom, s.right, s.top};
    j["title"] = s.title;
    j["subtitle"] = s.subtitle;
    j["load_label"] = s.load_label;
    j["captions"] = s.captions;
    j["particles"] = flat(s.particles, [](json& list, auto const& p) {
        for (double const v : {p.position[0], p.position[1], p.radius}) list.push_back(v);
        list.push_back(int(p.kind));
    });
    j["bonds"] = flat(s.bonds, [](json& list, auto const& b) {
        for (double const v : {b.from[0], b.from[1], b.to[0], b.to[1]}) list.push_back(v);
    });
    j["cracks"] = flat(s.cracks, [](json& list, auto const& c) {
        for (double const v : {c.position[0], c.position[1], c.direction[0], c.direction[1]}) list.push_back(v);
        list.push_back(int(c.mode));
    });
    j["pores"] = flat(s.pores, [](json& list, auto const& p) {
        for (double const v : {p.position[0], p.position[1], p.pressure}) list.push_back(v);
    });
    j["loads"] = flat(s.loads, [](json& list, auto const& l) {
        for (double const v : {l.at[0], l.at[1], l.direction[0], l.direction[1]}) list.push_back(v);
    });
    j["supports"] = segments(s.supports);
    j["walls"] = segments(s.walls);
    j["zones"] = json::array();
    for (auto const& z : s.zones) j["zones"].push_back({{"low", z.low}, {"high", z.high}, {"name", z.name}});
    return j;
}

lacuna::scene scene_from(json const& j) {
    using lacuna::scene;
    scene s;
    each_row(j.at("frame"), 4, [&](auto const& v) { s.left = v(0), s.bottom = v(1), s.right = v(2), s.top = v(3); });
    j.at("title").get_to(s.title);
    j.at("subtitle").get_to(s.subtitle);
    j.at("load_label").get_to(s.load_label);
    j.at("captions").get_to(s.captions);
    each_row(j.at("particles"), 4, [&](auto const& v) {
        s.particles.push_back({{v(0), v(1)}, v(2), scene::particle_kind(int(v(3)))});
    });
    each_row(j.at("bonds"), 4, [&](auto const& v) { s.bonds.push_back({{v(0), v(1)}, {v(2), v(3)}}); });
    each_row(j.at("cracks"), 5, [&](auto const& v) {
        s.cracks.push_back({{v(0), v(1)}, {v(2), v(3)}, scene::break_mode(int(v(4)))});
    });
    each_row(j.at("pores"), 3, [&](auto const& v) { s.pores.push_back({{v(0), v(1)}, v(2)}); });
    each_row(j.at("loads"), 4, [&](auto const& v) { s.loads.push_back({{v(0), v(1)}, {v(2), v(3)}}); });
    s.supports = segments_from(j.at("supports"));
    s.walls = segments_from(j.at("walls"));
    for (json const& z : j.at("zones"))
        s.zones.push_back({z.at("low").get<double>(), z.at("high").get<double>(), z.at("name").get<std::string>()});
    return s;
}

json json_of(front_profile const& f) {
    return {{"time", f.time}, {"broken", f.broken}, {"depth", f.depth}, {"stress", f.stress},
            {"pore_pressure", f.pore_pressure}};
}

/// The lines of an array, one element each.
template <class Part>
std::string lines_of(std::vector<Part> const& parts) {
    std::string text = "[";
    for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? ",\n" : "\n") + cartilage::json_of(parts[i]).dump();
    return text + "\n]";
}

} // namespace

json json_of(probe const& p) {
    json j;
    j["load_MPa"] = p.load_MPa;
    j["end_time"] = p.end_time;
    j["ended"] = p.ended;
    j["first_crack_time"] = json_of_optional(p.first_crack_time);
    j["capacity_time"] = json_of_optional(p.capacity_time);
    j["complete_time"] = json_of_optional(p.complete_time);
    j["broken_fraction"] = p.broken_fraction;
    j["first_layer_fraction"] = p.first_layer_fraction;
    j["cut_fraction"] = p.cut_fraction;
    j["peak_pore_pressure"] = p.peak_pore_pressure;
    j["energy_residual_fraction"] = p.energy_residual_fraction;
    j["invalid"] = json_of_optional(p.invalid);
    j["cracks"] = json::array();
    for (auto const& c : p.cracks) j["cracks"].push_back(json_of(c));
    j["layers"] = json::array();
    for (auto const& l : p.layers) j["layers"].push_back(json_of(l));
    return j;
}

probe probe_from(json const& j) {
    probe p;
    j.at("load_MPa").get_to(p.load_MPa);
    j.at("end_time").get_to(p.end_time);
    j.at("ended").get_to(p.ended);
    read_optional(j, "first_crack_time", p.first_crack_time);
    read_optional(j, "capacity_time", p.capacity_time);
    read_optional(j, "complete_time", p.complete_time);
    j.at("broken_fraction").get_to(p.broken_fraction);
    j.at("first_layer_fraction").get_to(p.first_layer_fraction);
    j.at("cut_fraction").get_to(p.cut_fraction);
    j.at("peak_pore_pressure").get_to(p.peak_pore_pressure);
    j.at("energy_residual_fraction").get_to(p.energy_residual_fraction);
    read_optional(j, "invalid", p.invalid);
    for (json const& c : j.at("cracks"))
        p.cracks.push_back({c.at(0).get<double>(), c.at(1).get<double>(), c.at(2).get<double>(), c.at(3).get<bool>(),
                            c.at(4).get<int>()});
    for (json const& l : j.at("layers")) {
        study_layer layer;
        l.at("zone").get_to(layer.zone);
        l.at("layer").get_to(layer.layer);
        l.at("bonds").get_to(layer.bonds);
        l.at("broken").get_to(layer.broken);
        read_optional(l, "half_broken_time", layer.half_broken_time);
        p.layers.push_back(std::move(layer));
    }
    return p;
}

json json_of(packing_result const& r) {
    json j;
    j["zone"] = lacuna::to_string(r.zone);
    j["seed"] = r.seed;
    j["first_crack_MPa"] = json_of_optional(r.found.first_crack_MPa);
    j["capacity_MPa"] = json_of_optional(r.found.capacity_MPa);
    j["complete_MPa"] = json_of_optional(r.found.complete_MPa);
    j["no_first_crack"] = r.found.no_first_crack;
    j["no_capacity"] = r.found.no_capacity;
    j["no_complete"] = r.found.no_complete;
    j["probes"] = json::array();
    for (auto const& p : r.probes) j["probes"].push_back(json_of(p));
    return j;
}

packing_result packing_from(json const& j) {
    packing_result r;
    r.zone = lacuna::parse_cartilage_zone(j.at("zone").get<std::string>());
    j.at("seed").get_to(r.seed);
    read_optional(j, "first_crack_MPa", r.found.first_crack_MPa);
    read_optional(j, "capacity_MPa", r.found.capacity_MPa);
    read_optional(j, "complete_MPa", r.found.complete_MPa);
    j.at("no_first_crack").get_to(r.found.no_first_crack);
    j.at("no_capacity").get_to(r.found.no_capacity);
    j.at("no_complete").get_to(r.found.no_complete);
    for (json const& p : j.at("probes")) r.probes.push_back(probe_from(p));
    return r;
}

json json_of(snapshot const& s) {
    json j;
    j["zone"] = lacuna::to_string(s.zone);
    j["seed"] = s.seed;
    j["figure"] = s.figure;
    j["run"] = json_of(s.run);
    j["fronts"] = json::array();
    for (auto const& f : s.fronts) j["fronts"].push_back(json_of(f));
    j["damage"] = json_of(s.damage);
    return j;
}

snapshot snapshot_from(json const& j) {
    snapshot s;
    s.zone = lacuna::parse_cartilage_zone(j.at("zone").get<std::string>());
    j.at("seed").get_to(s.seed);
    j.at("figure").get_to(s.figure);
    s.run = probe_from(j.at("run"));
    for (json const& f : j.at("fronts")) {
        front_profile front;
        f.at("time").get_to(front.time);
        f.at("broken").get_to(front.broken);
        f.at("depth").get_to(front.depth);
        f.at("stress").get_to(front.stress);
        f.at("pore_pressure").get_to(front.pore_pressure);
        s.fronts.push_back(std::move(front));
    }
    s.damage = scene_from(j.at("damage"));
    return s;
}

std::string text_of(study_result const& study) {
    auto const line = [](char const* key, json const& value) {
        return json(key).dump() + ": " + value.dump() + ",\n";
    };
    return "{\n" + line("lowest_MPa", study.lowest_MPa) + line("highest_MPa", study.highest_MPa) +
           line("resolution", study.resolution) + line("choices", study.choices) + line("code", study.code) +
           line("step_share", study.step_share) + line("dry", study.dry) + line("length_um", study.length_um) + line("height_um", study.height_um) +
           "\"packings\": " + lines_of(study.packings) + ",\n\"snapshots\": " + lines_of(study.snapshots) + "\n}\n";
}

study_result study_from(std::string const& text) {
    try {
        json const j = json::parse(text);
        study_result study;
        j.at("lowest_MPa").get_to(study.lowest_MPa);
        j.at("highest_MPa").get_to(study.highest_MPa);
        j.at("resolution").get_to(study.resolution);
        j.at("choices").get_to(study.choices);
        j.at("code").get_to(study.code);
        j.at("step_share").get_to(study.step_share);
        j.at("dry").get_to(study.dry);
        j.at("length_um").get_to(study.length_um);
        j.at("height_um").get_to(study.height_um);
        for (json const& p : j.at("packings")) study.packings.push_back(packing_from(p));
        for (json const& s : j.at("snapshots")) study.snapshots.push_back(snapshot_from(s));
        return study;
    } catch (json::exception const& bad) {
        throw std::runtime_error(bad.what());
    } catch (std::invalid_argument const& bad) {
        throw std::runtime_error(bad.what());
    }
}

} // namespace cartilage
