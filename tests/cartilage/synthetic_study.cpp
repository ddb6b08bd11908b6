// SPDX-License-Identifier: BSD-3-Clause
#include "synthetic_study.hpp"

#include "cartilage/specimen/particle_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace cartilage;

double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1p-53; }

load_run make_load_run(std::mt19937_64& random, lacuna::cartilage_zone zone, double load, thresholds const& found,
                 char const* ended) {
    load_run p;
    p.load_MPa = load;
    p.ended = ended;
    p.end_time = 12e-9;
    p.peak_pore_pressure = 2e4 * load;
    p.energy_residual_fraction = 1e-5;
    double const first = found.first_crack_MPa.value_or(1e4), complete = found.complete_MPa.value_or(1e4);
    if (load < first) return p;
    p.first_crack_time = load > 6 * first ? 1.2e-9 : 11e-9 * std::sqrt(first / load);
    if (found.capacity_MPa && load >= *found.capacity_MPa) p.capacity_time = *p.first_crack_time + 1e-10;
    if (load >= complete) p.complete_time = *p.first_crack_time + 2e-10;
    p.broken_fraction = std::min(0.5, 0.01 + 0.3 * std::log(load / first));
    p.cut_fraction = std::min(1.0, 0.05 + 0.9 * std::log(load / first) / std::log(complete / first));
    p.first_layer_fraction = std::min(1.0, 0.1 + 0.4 * std::log(load / first));
    int const count = int(300 * p.broken_fraction);
    for (int k = 0; k < count; ++k) {
        load_run::crack c;
        c.time = *p.first_crack_time + (p.end_time - *p.first_crack_time) * k / count;
        c.x = 120e-6 * (0.2 + 0.6 * uniform(random));
        c.y = 300e-6 * (1 - 0.6 * uniform(random) * uniform(random));
        c.shear = uniform(random) < 0.3;
        c.fibre = int(20 * uniform(random));
        p.cracks.push_back(c);
    }
    auto const add_layers = [&](char const* name, int layers, double from) {
        for (int k = 0; k < layers; ++k) {
            load_run::layer_damage layer{name, k, 60, 0, {}};
            double const wait = 1e-9 * (from + 1.1 * k + 2 * uniform(random));
            if (*p.first_crack_time + wait < p.end_time) {
                layer.half_broken_time = *p.first_crack_time + wait;
                layer.broken = 40;
            }
            p.layers.push_back(layer);
        }
    };
    using lacuna::cartilage_zone;
    if (zone != cartilage_zone::whole) {
        add_layers(std::string(lacuna::to_string(zone)).c_str(), 8, 0.3);
    } else {
        add_layers("surface", 7, 0.3);
        add_layers("middle", 5, 5);
        add_layers("deep", 5, 8);
    }
    return p;
}

snapshot make_snapshot(std::mt19937_64& random, lacuna::cartilage_zone zone, char const* figure, double load) {
    snapshot s;
    s.zone = zone;
    s.figure = figure;
    s.run = make_load_run(random, zone, load, {0.8 * load, load, 2 * load, "", "", ""}, "duration");
    s.damage.right = 120e-6;
    s.damage.top = 300e-6;
    s.damage.title = "Synthetic";
    s.damage.subtitle = "not from a run";
    s.damage.load_label = "load";
    s.damage.kinds = cartilage::particle_kinds();
    for (int i = 0; i < 30; ++i)
        for (int j = 0; j < 75; ++j) {
            lacuna::vec<double, 2> const at{(4 * i + 2) * 1e-6, (4 * j + 2) * 1e-6};
            s.damage.particles.push_back(
                {at, 1.9e-6, j % 4 == 0 ? cartilage::fibre_particle : cartilage::free_particle});
            s.damage.pores.push_back({at + lacuna::vec<double, 2>{2e-6, 2e-6}, 1e6 * uniform(random)});
        }
    for (load_run::crack const& c : s.run.cracks) s.damage.cracks.push_back({{c.x, c.y}, {1, 0}, {}});
    // A front at 120 µm/ns, and a pressure of a hundredth of the stress behind it at half that speed.
    for (int step = 1; step <= 60; ++step) {
        front_profile f;
        f.time = 0.2e-9 * step;
        for (int layer = 0; layer < 15; ++layer) {
            double const depth = 20e-6 * (layer + 0.5);
            f.depth.push_back(depth);
            f.stress.push_back(depth <= 120e3 * f.time ? -1e6 * load : 0.0);
            f.pore_pressure.push_back(depth <= 60e3 * f.time ? 1e4 * load : 0.0);
        }
        s.fronts.push_back(f);
    }
    return s;
}

} // namespace

cartilage::study_result synthetic_study(int seeds) {
    using lacuna::cartilage_zone;
    std::mt19937_64 random(5);
    study_result study;
    study.code = "synthetic";
    study.choices = "bond = brittle spring\nload area = disc\nduration_ns = 12";
    double const middle[] = {45, 70, 90, 44};
    for (auto const zone :
         {cartilage_zone::surface, cartilage_zone::middle, cartilage_zone::deep, cartilage_zone::whole})
        for (int seed = 1; seed <= seeds; ++seed) {
            packing_result packing;
            packing.zone = zone;
            packing.seed = std::uint64_t(seed);
            double const first = middle[int(zone)] * std::exp(0.5 * (uniform(random) + uniform(random) - 1));
            packing.found.first_crack_MPa = first;
            packing.found.capacity_MPa = 1.8 * first;
            bool const holds = zone == cartilage_zone::deep && seed % 3 == 0;
            if (!holds) packing.found.complete_MPa = 5 * first;
            for (double const factor : {0.7, 0.95, 1.0, 1.3, 1.8, 3.0, 5.0, 9.0}) {
                char const* ended = factor == 1.0 ? "first_crack" : factor == 1.8 ? "capacity" : "duration";
                packing.runs.push_back(make_load_run(random, zone, factor * first, packing.found, ended));
            }
            packing.runs.push_back(make_load_run(random, zone, study.highest_MPa, packing.found, "duration"));
            if (seed == 2) packing.runs[5].invalid = "the energy ledger is open by 1.3 % <synthetic>";
            study.packings.push_back(packing);
        }
    study.snapshots = {make_snapshot(random, cartilage_zone::surface, "10", 50),
                       make_snapshot(random, cartilage_zone::deep, "11", 58),
                       make_snapshot(random, cartilage_zone::whole, "12", 49)};
    return study;
}
