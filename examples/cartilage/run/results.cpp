// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/results.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <lacuna/core/text.hpp>

namespace cartilage {

crack_record crack_of(specimen const& s, lacuna::break_event<2> const& event) {
    crack_record c;
    c.step = event.step;
    c.time = event.time;
    c.bond = event.bond;
    c.first = event.particles[0];
    c.second = event.particles[1];
    c.shear = event.mode == lacuna::bond_state::broken_in_shear;
    auto const first = std::size_t(c.first), second = std::size_t(c.second);
    c.fibre = s.fibre[first] == s.fibre[second] ? s.fibre[first] : -1;
    auto const along = s.discs.position[second] - s.discs.position[first];
    c.position = {event.position[0], event.position[1]};
    c.direction = {along[0], along[1]};
    c.normal_force = event.normal_force;
    c.shear_force = event.shear_force;
    c.energy = event.energy;
    return c;
}

void sort_cracks(specimen const& s, run_result& r) {
    std::map<std::pair<int, int>, layer_result> layers;
    std::vector<layer_result*> layer_of(s.fibres.size());
    for (std::size_t f = 0; f < s.fibres.size(); ++f) {
        auto const& fibre = s.fibres[f];
        layer_result& layer = layers[{int(fibre.zone), fibre.layer}];
        layer.zone = lacuna::to_string(fibre.zone);
        layer.layer = fibre.layer;
        layer.bonds += fibre.bonds.size();
        ++layer.fibres;
        layer_of[f] = &layer;
    }
    std::vector<char> cut(s.fibres.size(), 0);
    for (crack_record const& c : r.cracks) {
        if (c.fibre < 0) continue;
        ++layer_of[std::size_t(c.fibre)]->broken;
        cut[std::size_t(c.fibre)] = 1;
    }
    r.layers.clear();
    for (auto& [key, layer] : layers) r.layers.push_back(layer);
    r.fibres_cut = 0;
    for (char c : cut) r.fibres_cut += std::size_t(c);
}

lacuna::scene damage_scene(specimen const& s, options const& o, std::span<lacuna::vec<double, 2> const> position,
                           std::span<crack_record const> cracks, std::vector<lacuna::scene::pore> pores) {
    using lacuna::scene;
    scene picture = scene_of(s, o);
    for (std::size_t i = 0; i < position.size(); ++i) picture.particles[i].position = position[i];
    std::vector<char> intact(s.discs.bonds.size(), 1);
    for (crack_record const& c : cracks) {
        intact[std::size_t(c.bond)] = 0;
        picture.cracks.push_back({{c.position[0], c.position[1]},
                                  {c.direction[0], c.direction[1]},
                                  c.shear ? scene::break_mode::shear : scene::break_mode::tension});
    }
    picture.bonds.clear();
    for (std::size_t b = 0; b < intact.size(); ++b)
        if (intact[b])
            picture.bonds.push_back(
                {position[std::size_t(s.discs.bonds[b][0])], position[std::size_t(s.discs.bonds[b][1])]});
    picture.loads.clear();
    for (auto i : s.loaded) picture.loads.push_back({position[std::size_t(i)], {0, -1}});
    picture.pores = std::move(pores);

    double const share = intact.empty() ? 0.0 : 100.0 * double(cracks.size()) / double(intact.size());
    picture.captions.push_back(std::to_string(cracks.size()) + lacuna::formatted(" bonds broken (%.1f %%)", share));
    return picture;
}

} // namespace cartilage
