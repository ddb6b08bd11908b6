// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include <lacuna/loads/surface_traction.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

#include "cartilage/run/cartilage_model.hpp"
#include "cartilage/run/ending.hpp"
#include "cartilage/specimen/collagen_strength.hpp"

/// \file
/// The numbers of the model (Tables 1 and 2), and what its choices make of them.

namespace cartilage {

template <class Parameters>
typename Parameters::material material(double density, double stiffness, double strength, choices const& open) {
    typename Parameters::material m;
    m.density = density;
    m.contact.normal_stiffness = m.contact.shear_stiffness = stiffness;
    m.contact.friction = open.friction;
    m.bond.normal_stiffness = m.bond.shear_stiffness = stiffness;
    m.bond.tensile_strength = m.bond.shear_strength = strength;
    if constexpr (requires { m.bond.bending_ratio; }) m.bond.bending_ratio = open.bond_moment;
    return m;
}

inline lacuna::traction_area traction_area_of(area_rule rule) {
    return rule == area_rule::disc ? lacuna::traction_area::disc : lacuna::traction_area::strip;
}

/// What each bond has of its own: the forces at which it breaks, by the chosen area and, of a link, its share of the
/// strength: that of the weaker of two fibres, that of the fibre next to matrix. Empty where all is as the law has it.
inline std::vector<lacuna::bond_values> bond_strengths(lacuna::cartilage_specimen<double> const& s,
                                                       choices const& open) {
    std::vector<lacuna::bond_values> values;
    std::size_t const links = s.fibre_links + s.matrix_links, of_fibres = s.discs.bonds.size() - links;
    if (open.bond_area == area_rule::strip && links == 0) return values;
    for (std::size_t b = 0; b < s.discs.bonds.size(); ++b) {
        auto const [i, j] = s.discs.bonds[b];
        double const one = collagen_strength[s.discs.material[std::size_t(i)]];
        double const other = collagen_strength[s.discs.material[std::size_t(j)]];
        double const share = b < of_fibres                   ? 1
                             : b < of_fibres + s.fibre_links ? open.fibre_links
                                                             : open.matrix_links;
        double const strength = share * (one > 0 && other > 0 ? std::min(one, other) : std::max(one, other));
        double const radius = std::min(s.discs.radius[std::size_t(i)], s.discs.radius[std::size_t(j)]);
        double const force = lacuna::traction_force(strength, radius, s.thickness, traction_area_of(open.bond_area));
        values.push_back({.tensile_force = force, .shear_force = force});
    }
    return values;
}

/// Parameters of the model for a specimen: materials of Table 1 in the order of lacuna::cartilage_material, rigid
/// walls beside the specimen, a time step of 0.4 of the rigorous bound, and the choices.
template <class Model>
lacuna::simulation_parameters<Model> model_parameters(lacuna::cartilage_specimen<double> const& s,
                                                      choices const& open) {
    using parameters = lacuna::simulation_parameters<Model>;
    parameters p;
    // Where matrix is bonded at all its bonds have strengths of their own.
    p.materials = {material<parameters>(1000, 2.0e8, collagen_strength[1], open),
                   material<parameters>(2000, 2.0e8, collagen_strength[1], open),
                   material<parameters>(2500, 2.1e8, collagen_strength[2], open),
                   material<parameters>(3000, 2.2e8, collagen_strength[3], open)};
    p.thickness = s.thickness;
    p.mass = open.mass == mass_rule::disc ? lacuna::mass_model::disc : lacuna::mass_model::sphere;
    p.bonds = bond_strengths(s, open);
    p.damping.factor = open.local_damping;
    p.safety = 0.4;
    p.follow_critical_step = false; // one step for a run, so that runs can be compared
    // The generator lets neighbours overlap by its tolerance, or leave gaps up to twice that: both are contacts.
    p.interactions.initial_contact_tolerance = 2 * open.contact_tolerance;
    auto const rigid = p.materials.front().contact;
    p.walls = {{{s.wall_left, 0}, {1, 0}, rigid}, {{s.wall_right, 0}, {-1, 0}, rigid}};
    if constexpr (lacuna::has_fluid<Model>) {
        p.flow.conductivity = open.conductivity;
        p.flow.aperture.residual_aperture = open.aperture * 1e-9;
        p.flow.aperture.half_force = open.half_force;
        p.flow.aperture.gap_factor = open.gap_factor;
        p.flow.merge_conductance = open.merge_conductance;
        p.flow.minimum_pressure = open.minimum_pressure;
    }
    return p;
}

/// Where the fluid can leave: never through the support.
struct drained_sides {
    drainage_rule rule;
    lacuna::throat_boundary<double> operator()(lacuna::boundary_throat<double, 2> const& throat) const {
        using lacuna::body_side;
        bool const top = throat.side == body_side::top, beside = !top && throat.side != body_side::bottom;
        bool const drained = (top && rule != drainage_rule::sealed) || (beside && rule == drainage_rule::top_and_sides);
        return {drained ? lacuna::boundary_kind::drained : lacuna::boundary_kind::sealed, 0.0};
    }
};

/// Holds the bottom row, loads the top row, and fills the pores where the model has a fluid.
/// \param pressure of the load, Pa
template <class Model>
void set_up(lacuna::simulation<Model>& sim, lacuna::cartilage_specimen<double> const& s, double pressure,
            choices const& open) {
    for (auto id : s.fixed) sim.fix(std::size_t(id));
    for (auto id : s.loaded) {
        double const radius = s.discs.radius[std::size_t(id)];
        double const force =
            lacuna::traction_force(pressure, radius, s.thickness, traction_area_of(open.load_area));
        sim.apply(std::size_t(id), {0, -force}, 0, open.ramp_time * 1e-9);
    }
    if (open.load == load_rule::platen) {
        std::vector<std::size_t> const under_it(s.loaded.begin(), s.loaded.end());
        sim.attach_to_rigid_plate(under_it, 1);
    }
    if constexpr (lacuna::has_fluid<Model>)
        sim.fill_pores([rule = open.drainage](lacuna::points_view<double, 2> points, double const* radii) {
            return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii,
                                             drained_sides{rule});
        });
}

template <class Model>
std::unique_ptr<lacuna::simulation<Model>> load_specimen(specimen const& s, options const& o) {
    auto parameters = model_parameters<Model>(s, o.open);
    parameters.threads = o.threads;
    parameters.safety = o.step_share;
    parameters.keep_pair_forces = o.pair_forces;
    if (o.time_step_ps) parameters.time_step = *o.time_step_ps * 1e-12;
    if constexpr (lacuna::has_fluid<Model>) parameters.flow.duration = ending(o).longest();
    parameters.allow_unstable_step = o.allow_unstable_step;
    auto sim = std::make_unique<lacuna::simulation<Model>>(s.discs, parameters);
    set_up(*sim, s, o.load_MPa * 1e6, o.open);
    try {
        if (o.time_step_ps) sim->resolve_time_step();
    } catch (std::invalid_argument const& bad) {
        throw std::invalid_argument("--time-step: " + std::string(bad.what()) + ": --allow-unstable-step");
    }
    return sim;
}

} // namespace cartilage
