// SPDX-License-Identifier: BSD-3-Clause
//
// Reads stored studies. Every value is checked: the values by which the report divides, counts or indexes have the
// type, range and length that text_of() writes.
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <utility>

#include "cartilage/specimen/particle_kinds.hpp"
#include "cartilage/study/stored_value.hpp"

namespace cartilage {

namespace {

constexpr int many = std::numeric_limits<int>::max();

std::optional<double> read_time(stored_value const& v) {
    if (v.is_null()) return std::nullopt;
    return v.not_negative();
}

/// A number that may be NaN. JSON has no NaN, so it is written as null; the energy of an unstable run may be NaN.
double number_or_none(stored_value const& v) {
    return v.is_null() ? std::numeric_limits<double>::quiet_NaN() : v.number();
}

std::string read_word(stored_value const& v, std::initializer_list<char const*> words) {
    std::string const found = v.text();
    std::string rule;
    for (char const* word : words) {
        if (found == word) return found;
        rule += (rule.empty() ? "one of " : ", ") + std::string(word);
    }
    v.refuse(rule);
}

lacuna::cartilage_zone read_zone(stored_value const& v) {
    return lacuna::parse_cartilage_zone(read_word(v, {"surface", "middle", "deep", "whole"}));
}

load_run::crack read_crack(stored_value const& c) {
    load_run::crack crack;
    std::size_t index = 0;
    c.each([&](stored_value const& v) {
        switch (index++) {
        case 0: crack.time = v.not_negative(); break;
        case 1: crack.x = v.number(); break;
        case 2: crack.y = v.number(); break;
        case 3: crack.shear = v.flag(); break;
        case 4: crack.fibre = v.integer(-1, many); break;
        default: c.refuse("a list of time, x, y, shear, fibre");
        }
    });
    if (index != 5) c.refuse("a list of time, x, y, shear, fibre");
    return crack;
}

load_run::layer_damage read_layer(stored_value const& l) {
    load_run::layer_damage layer;
    layer.zone = read_word(l["zone"], {"surface", "middle", "deep"});
    layer.layer = l["layer"].integer(0, many);
    layer.bonds = l["bonds"].integer(0, many);
    layer.broken = l["broken"].integer(0, layer.bonds);
    layer.half_broken_time = read_time(l["half_broken_time"]);
    return layer;
}

std::vector<lacuna::scene::wall> read_segments(stored_value const& list) {
    std::vector<lacuna::scene::wall> walls;
    list.each_row(4, [&](auto const& v) {
        walls.push_back({{v(0).number(), v(1).number()}, {v(2).number(), v(3).number()}});
    });
    return walls;
}

lacuna::scene read_scene(stored_value const& j) {
    using lacuna::scene;
    scene s;
    s.kinds = particle_kinds();
    auto const frame = j["frame"].numbers(4, false);
    s.left = frame[0], s.bottom = frame[1], s.right = frame[2], s.top = frame[3];
    if (!(s.right > s.left && s.top > s.bottom))
        j["frame"].refuse("left, bottom, right, top of a frame with a width and a height");
    s.title = j["title"].text();
    s.subtitle = j["subtitle"].text();
    s.load_label = j["load_label"].text();
    j["captions"].each([&](stored_value const& c) { s.captions.push_back(c.text()); });
    auto const at = [](auto const& v, std::size_t k) { return scene::point{v(k).number(), v(k + 1).number()}; };
    j["particles"].each_row(4, [&](auto const& v) {
        s.particles.push_back({at(v, 0), v(2).positive(), v(3).integer(0, int(fibre_particle))});
    });
    j["bonds"].each_row(4, [&](auto const& v) { s.bonds.push_back({at(v, 0), at(v, 2)}); });
    j["cracks"].each_row(5, [&](auto const& v) {
        int const last = int(scene::break_mode::shear);
        s.cracks.push_back({at(v, 0), at(v, 2), scene::break_mode(v(4).integer(0, last))});
    });
    j["pores"].each_row(3, [&](auto const& v) { s.pores.push_back({at(v, 0), v(2).number()}); });
    j["loads"].each_row(4, [&](auto const& v) { s.loads.push_back({at(v, 0), at(v, 2)}); });
    s.supports = read_segments(j["supports"]);
    s.walls = read_segments(j["walls"]);
    j["zones"].each([&](stored_value const& z) {
        s.zones.push_back({z["low"].number(), z["high"].number(), z["name"].text()});
    });
    return s;
}

/// Reads the profiles of a run. All have the same layers; in a dry run they have no pressures.
std::vector<front_profile> read_fronts(stored_value const& list) {
    std::vector<front_profile> fronts;
    list.each([&](stored_value const& f) {
        front_profile front;
        front.time = f["time"].not_negative();
        if (!fronts.empty() && front.time < fronts.back().time)
            f["time"].refuse("not before that of the profile before it");
        front.broken = f["broken"].integer(std::size_t(0), std::size_t(many));
        front.depth = fronts.empty() ? f["depth"].numbers() : f["depth"].numbers(fronts.front().depth.size(), false);
        if (front.depth.empty()) f["depth"].refuse("the depth of at least one layer");
        front.stress = f["stress"].numbers(front.depth.size(), false);
        front.pore_pressure =
            f["pore_pressure"].numbers(front.depth.size(), fronts.empty() || fronts.front().pore_pressure.empty());
        if (!fronts.empty() && front.pore_pressure.size() != fronts.front().pore_pressure.size())
            f["pore_pressure"].refuse("empty, as in the first profile");
        fronts.push_back(std::move(front));
    });
    return fronts;
}

load_run read_load_run(stored_value const& j) {
    load_run p;
    p.load_MPa = j["load_MPa"].positive();
    p.end_time = j["end_time"].not_negative();
    p.ended = read_word(j["ended"], {"duration", "quiet", "limit", "first_crack", "capacity", "complete", "invalid"});
    p.first_crack_time = read_time(j["first_crack_time"]);
    p.capacity_time = read_time(j["capacity_time"]);
    p.complete_time = read_time(j["complete_time"]);
    p.broken_fraction = j["broken_fraction"].number(0, 1);
    p.first_layer_fraction = j["first_layer_fraction"].number(0, 1);
    p.cut_fraction = j["cut_fraction"].number(0, 1);
    p.peak_pore_pressure = number_or_none(j["peak_pore_pressure"]);
    p.energy_residual_fraction = number_or_none(j["energy_residual_fraction"]);
    if (!j["invalid"].is_null()) p.invalid = j["invalid"].text();
    j["cracks"].each([&](stored_value const& c) {
        p.cracks.push_back(read_crack(c));
        if (p.cracks.size() > 1 && p.cracks.back().time < p.cracks[p.cracks.size() - 2].time)
            c.refuse("not before the crack before it");
    });
    j["layers"].each([&](stored_value const& l) { p.layers.push_back(read_layer(l)); });
    return p;
}

/// A load that a search found. It has to lie within its range, except for rounding.
std::optional<double> read_load(stored_value const& v, double lowest, double highest) {
    if (v.is_null()) return std::nullopt;
    double const load = v.positive();
    if (!(load >= lowest * (1 - 1e-9) && load <= highest * (1 + 1e-9)))
        v.refuse("within the range of loads, " + lacuna::to_text(lowest) + " to " + lacuna::to_text(highest));
    return load;
}

packing_result read_packing(stored_value const& j, double lowest, double highest) {
    packing_result r;
    r.zone = read_zone(j["zone"]);
    r.seed = j["seed"].integer(std::uint64_t(0), std::numeric_limits<std::uint64_t>::max());
    r.found.first_crack_MPa = read_load(j["first_crack_MPa"], lowest, highest);
    r.found.capacity_MPa = read_load(j["capacity_MPa"], lowest, highest);
    r.found.complete_MPa = read_load(j["complete_MPa"], lowest, highest);
    r.found.no_first_crack = j["no_first_crack"].text();
    r.found.no_capacity = j["no_capacity"].text();
    r.found.no_complete = j["no_complete"].text();
    j["probes"].each([&](stored_value const& p) {
        r.runs.push_back(read_load_run(p));
        if (r.runs.size() > 1 && r.runs.back().load_MPa < r.runs[r.runs.size() - 2].load_MPa)
            p["load_MPa"].refuse("not below that of the run before it");
    });
    return r;
}

snapshot read_snapshot(stored_value const& j) {
    snapshot s;
    s.zone = read_zone(j["zone"]);
    s.seed = j["seed"].integer(std::uint64_t(0), std::numeric_limits<std::uint64_t>::max());
    s.figure = j["figure"].text();
    s.run = read_load_run(j["run"]);
    s.fronts = read_fronts(j["fronts"]);
    s.damage = read_scene(j["damage"]);
    return s;
}

study_result read_study(stored_value const& j) {
    study_result study;
    study.lowest_MPa = j["lowest_MPa"].positive();
    study.highest_MPa = j["highest_MPa"].number();
    if (!(study.highest_MPa > study.lowest_MPa)) j["highest_MPa"].refuse("above lowest_MPa");
    study.resolution = j["resolution"].positive();
    study.choices = j["choices"].text();
    study.code = j["code"].text();
    study.step_share = j["step_share"].positive();
    study.dry = j["dry"].flag();
    study.length_um = j["length_um"].positive();
    study.height_um = j["height_um"].positive();
    j["packings"].each(
        [&](stored_value const& p) { study.packings.push_back(read_packing(p, study.lowest_MPa, study.highest_MPa)); });
    j["snapshots"].each([&](stored_value const& s) { study.snapshots.push_back(read_snapshot(s)); });
    return study;
}

} // namespace

load_run load_run_from(json const& j) { return read_load_run(stored_value(j)); }
packing_result packing_from(json const& j) {
    return read_packing(stored_value(j), 0, std::numeric_limits<double>::max());
}
snapshot snapshot_from(json const& j) { return read_snapshot(stored_value(j)); }

study_result study_from(std::string const& text) {
    try {
        json const j = json::parse(text);
        return read_study(stored_value(j));
    } catch (json::exception const& bad) {
        throw std::runtime_error(bad.what());
    } catch (std::invalid_argument const& bad) {
        throw std::runtime_error(bad.what());
    }
}

} // namespace cartilage
