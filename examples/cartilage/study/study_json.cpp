// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/study_json.hpp"

namespace cartilage {

namespace {

template <class T>
json json_of_optional(std::optional<T> const& value) {
    return value ? json(*value) : json(nullptr);
}
/// Rows of numbers as one flat list.
template <class Rows, class Put>
json flat(Rows const& rows, Put const& put) {
    json list = json::array();
    for (auto const& row : rows) put(list, row);
    return list;
}
json json_of(load_run::crack const& c) { return json::array({c.time, c.x, c.y, c.shear, c.fibre}); }

json json_of(load_run::layer_damage const& l) {
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
json json_of(lacuna::scene const& s) {
    json j;
    j["frame"] = {s.left, s.bottom, s.right, s.top};
    j["title"] = s.title;
    j["subtitle"] = s.subtitle;
    j["load_label"] = s.load_label;
    j["captions"] = s.captions;
    j["particles"] = flat(s.particles, [](json& list, auto const& p) {
        for (double const v : {p.position[0], p.position[1], p.radius}) list.push_back(v);
        list.push_back(p.kind);
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

json json_of(front_profile const& f) {
    return {{"time", f.time}, {"broken", f.broken}, {"depth", f.depth}, {"stress", f.stress},
            {"pore_pressure", f.pore_pressure}};
}

/// A JSON array with one element in each line.
template <class Part>
std::string lines_of(std::vector<Part> const& parts) {
    std::string text = "[";
    for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? ",\n" : "\n") + cartilage::json_of(parts[i]).dump();
    return text + "\n]";
}

} // namespace

json json_of(load_run const& p) {
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
    for (auto const& p : r.runs) j["probes"].push_back(json_of(p));
    return j;
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

std::string text_of(study_result const& study) {
    auto const line = [](char const* key, json const& value) {
        return json(key).dump() + ": " + value.dump() + ",\n";
    };
    return "{\n" + line("lowest_MPa", study.lowest_MPa) + line("highest_MPa", study.highest_MPa) +
           line("resolution", study.resolution) + line("choices", study.choices) + line("code", study.code) +
           line("step_share", study.step_share) + line("dry", study.dry) + line("length_um", study.length_um) +
           line("height_um", study.height_um) + "\"packings\": " + lines_of(study.packings) +
           ",\n\"snapshots\": " + lines_of(study.snapshots) + "\n}\n";
}

} // namespace cartilage
