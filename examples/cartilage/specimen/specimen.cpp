// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/specimen/specimen.hpp"

#include <stdexcept>
#include <string>

#include <lacuna/core/error.hpp>

#include "cartilage/specimen/cartilage_specimen.hpp"
#include "cartilage/specimen/particle_kinds.hpp"

namespace cartilage {

lacuna::cartilage_specimen_parameters specimen_parameters(options const& o) {
    lacuna::cartilage_specimen_parameters p;
    p.zone = o.zone;
    p.preset = o.choices.packing == packing_rule::lattice ? lacuna::specimen_preset::lattice
                                                     : lacuna::specimen_preset::literal;
    p.length = o.length_um / 1e6;
    p.height = o.height_um / 1e6;
    p.seed = o.seed;
    if (o.choices.radii == radius_rule::equal) p.r_min = p.r_max = p.diameter() / 2;
    p.fibre_spacing = o.choices.fibre_spacing;
    p.fibre_layers = o.choices.fibre_layers;
    p.link_fibres = o.choices.fibre_links > 0;
    p.link_matrix = o.choices.matrix_links > 0;
    p.middle_fibre_length = o.choices.middle_fibre_length * 1e-6;
    p.deep_fraction = o.choices.deep_fraction;
    p.surface_fraction = o.choices.surface_fraction;
    p.middle_fraction = 1 - o.choices.deep_fraction - o.choices.surface_fraction;
    p.fill = o.choices.fill;
    p.contact_tolerance = o.choices.contact_tolerance;
    p.thickness = o.choices.thickness / 1e6;
    p.wall_distance = o.choices.wall_distance;
    return p;
}

void validate_specimen(options const& o) {
    try {
        specimen_parameters(o).validate();
    } catch (std::invalid_argument const& bad) {
        std::string const message = std::string(bad.what()) + " m";
        if (message.rfind("specimen.height", 0) == 0)
            throw usage_error("--height " + lacuna::to_text(o.height_um) + ": " + message);
        if (message.rfind("specimen.length", 0) == 0)
            throw usage_error("--length " + lacuna::to_text(o.length_um) + ": " + message);
        throw usage_error(bad.what());
    }
}

specimen build_specimen(options const& o) { return lacuna::make_cartilage_specimen<double>(specimen_parameters(o)); }

specimen_report report_of(specimen const& s) {
    specimen_report r;
    r.particles = s.discs.size();
    r.bonded_particles = s.statistics.bonded;
    r.fibres = s.fibres.size();
    r.bonds = s.discs.bonds.size();
    r.fixed = s.fixed.size();
    r.loaded = s.loaded.size();
    r.area_fraction = s.statistics.area_fraction;
    r.mean_radius = s.statistics.mean_radius;
    r.max_overlap = s.statistics.max_overlap;
    r.mean_coordination = s.statistics.mean_coordination;
    r.loose = s.statistics.loose;
    return r;
}

lacuna::scene scene_of(specimen const& s, options const& o) {
    using lacuna::scene;
    scene picture;
    picture.left = s.left;
    picture.right = s.right;
    picture.bottom = 0;
    picture.top = s.height;
    picture.kinds = particle_kinds();
    picture.particles.resize(s.discs.size());
    for (std::size_t i = 0; i < s.discs.size(); ++i)
        picture.particles[i] = {s.discs.position[i], s.discs.radius[i],
                                s.fibre[i] >= 0 ? fibre_particle : free_particle};
    for (auto const& bond : s.discs.bonds)
        picture.bonds.push_back({s.discs.position[std::size_t(bond[0])], s.discs.position[std::size_t(bond[1])]});
    for (auto i : s.loaded) picture.loads.push_back({s.discs.position[std::size_t(i)], {0, -1}});
    picture.supports = {{{s.left, 0}, {s.right, 0}}};
    picture.walls = {{{s.wall_left, s.height}, {s.wall_left, 0}}, {{s.wall_right, 0}, {s.wall_right, s.height}}};
    if (o.zone == lacuna::cartilage_zone::whole)
        picture.zones = {{0, s.deep_top, "deep"},
                         {s.deep_top, s.middle_top, "middle"},
                         {s.middle_top, s.height, "surface"}};

    std::string name(lacuna::to_string(o.zone));
    name[0] = char(name[0] - 'a' + 'A');
    picture.title = (o.zone == lacuna::cartilage_zone::whole ? "Whole cartilage" : name + " zone");
    if (o.what == command::run) {
        picture.load_label = lacuna::to_text(o.load_MPa) + " MPa";
        picture.title += ", " + picture.load_label;
    }
    picture.subtitle = "seed " + std::to_string(o.seed) + (o.dry ? ", dry" : "");
    picture.captions = {std::to_string(s.discs.size()) + " particles", std::to_string(s.fibres.size()) + " fibres",
                        std::to_string(s.discs.bonds.size()) + " bonds"};
    return picture;
}

} // namespace cartilage
