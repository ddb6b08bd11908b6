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
/// The parameters of the model: Tables 1 and 2 of the paper and the open choices.

namespace cartilage {

template <class Parameters>
typename Parameters::material material(double density, double stiffness, double strength, choices const& c) {
    typename Parameters::material m;
    m.density = density;
    m.contact.normal_stiffness = m.contact.shear_stiffness = stiffness;
    m.contact.friction = c.friction;
    m.bond.normal_stiffness = m.bond.shear_stiffness = stiffness;
    m.bond.tensile_strength = m.bond.shear_strength = strength;
    if constexpr (requires { m.bond.bending_ratio; }) m.bond.bending_ratio = c.bond_moment;
    return m;
}

inline lacuna::traction_area traction_area_of(area_rule rule) {
    return rule == area_rule::disc ? lacuna::traction_area::disc : lacuna::traction_area::strip;
}

/// The forces at which each bond breaks, from the chosen area. A cross link has its share of the strength: of the
/// weaker one of two fibres, or of the fibre that touches a free particle. Empty if the bond law's own strength holds
/// for all.
inline std::vector<lacuna::bond_values> bond_strengths(lacuna::cartilage_specimen<double> const& s,
                                                       choices const& c) {
    std::vector<lacuna::bond_values> values;
    std::size_t const links = s.fibre_links + s.matrix_links, of_fibres = s.discs.bonds.size() - links;
    if (c.bond_area == area_rule::strip && links == 0) return values;
    for (std::size_t b = 0; b < s.discs.bonds.size(); ++b) {
        auto const [i, j] = s.discs.bonds[b];
        double const one = collagen_strength[s.discs.material[std::size_t(i)]];
        double const other = collagen_strength[s.discs.material[std::size_t(j)]];
        double const share = b < of_fibres                   ? 1
                             : b < of_fibres + s.fibre_links ? c.fibre_links
                                                             : c.matrix_links;
        double const strength = share * (one > 0 && other > 0 ? std::min(one, other) : std::max(one, other));
        double const radius = std::min(s.discs.radius[std::size_t(i)], s.discs.radius[std::size_t(j)]);
        double const force = lacuna::traction_force(strength, radius, s.thickness, traction_area_of(c.bond_area));
        values.push_back({.tensile_force = force, .shear_force = force});
    }
    return values;
}

/// Parameters of the model for a specimen: materials of Table 1 in the order of lacuna::cartilage_material, rigid
/// walls beside the specimen, and the choices. The time step is 0.4 of the rigorous bound.
template <class Model>
lacuna::simulation_parameters<Model> model_parameters(lacuna::cartilage_specimen<double> const& s,
                                                      choices const& c) {
    using parameters = lacuna::simulation_parameters<Model>;
    parameters p;
    // Bonds of free particles get their strengths from bond_strengths().
    p.materials = {material<parameters>(1000, 2.0e8, collagen_strength[1], c),
                   material<parameters>(2000, 2.0e8, collagen_strength[1], c),
                   material<parameters>(2500, 2.1e8, collagen_strength[2], c),
                   material<parameters>(3000, 2.2e8, collagen_strength[3], c)};
    p.thickness = s.thickness;
    p.mass = c.mass == mass_rule::disc ? lacuna::mass_model::disc : lacuna::mass_model::sphere;
    p.bonds = bond_strengths(s, c);
    p.damping.factor = c.local_damping;
    p.safety = 0.4;
    p.follow_critical_step = false; // a constant step, so that runs can be compared
    // The generator leaves overlaps up to its tolerance and gaps up to twice that. Both are contacts.
    p.interactions.initial_contact_tolerance = 2 * c.contact_tolerance;
    auto const rigid = p.materials.front().contact;
    p.walls = {{{s.wall_left, 0}, {1, 0}, rigid}, {{s.wall_right, 0}, {-1, 0}, rigid}};
    if constexpr (lacuna::has_fluid<Model>) {
        p.flow.conductivity = c.conductivity;
        p.flow.aperture.residual_aperture = c.aperture * 1e-9;
        p.flow.aperture.half_force = c.half_force;
        p.flow.aperture.gap_factor = c.gap_factor;
        p.flow.merge_conductance = c.merge_conductance;
        p.flow.minimum_pressure = c.minimum_pressure;
    }
    return p;
}

/// The boundaries where the fluid can leave. The bottom is always sealed.
struct drained_sides {
    drainage_rule rule;
    lacuna::throat_boundary<double> operator()(lacuna::boundary_throat<double, 2> const& throat) const {
        using lacuna::body_side;
        bool const top = throat.side == body_side::top, beside = !top && throat.side != body_side::bottom;
        bool const drained = (top && rule != drainage_rule::sealed) || (beside && rule == drainage_rule::top_and_sides);
        return {drained ? lacuna::boundary_kind::drained : lacuna::boundary_kind::sealed, 0.0};
    }
};

/// Fixes the bottom row, loads the top row, and fills the pores if the model has a fluid.
/// \param pressure of the load, Pa
template <class Model>
void set_up(lacuna::simulation<Model>& sim, lacuna::cartilage_specimen<double> const& s, double pressure,
            choices const& c) {
    for (auto id : s.fixed) sim.fix(std::size_t(id));
    for (auto id : s.loaded) {
        double const radius = s.discs.radius[std::size_t(id)];
        double const force =
            lacuna::traction_force(pressure, radius, s.thickness, traction_area_of(c.load_area));
        sim.apply(std::size_t(id), {0, -force}, 0, c.ramp_time * 1e-9);
    }
    if (c.load == load_rule::platen) {
        std::vector<std::size_t> const loaded(s.loaded.begin(), s.loaded.end());
        sim.attach_to_rigid_plate(loaded, 1);
    }
    if constexpr (lacuna::has_fluid<Model>)
        sim.fill_pores([rule = c.drainage](lacuna::points_view<double, 2> points, double const* radii) {
            return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii,
                                             drained_sides{rule});
        });
}

template <class Model>
std::unique_ptr<lacuna::simulation<Model>> load_specimen(specimen const& s, options const& o) {
    auto parameters = model_parameters<Model>(s, o.choices);
    parameters.threads = o.threads;
    parameters.safety = o.step_share;
    parameters.keep_pair_forces = o.pair_forces;
    if (o.time_step_ps) parameters.time_step = *o.time_step_ps * 1e-12;
    if constexpr (lacuna::has_fluid<Model>) parameters.flow.duration = ending(o).longest();
    parameters.allow_unstable_step = o.allow_unstable_step;
    auto sim = std::make_unique<lacuna::simulation<Model>>(s.discs, parameters);
    set_up(*sim, s, o.load_MPa * 1e6, o.choices);
    try {
        if (o.time_step_ps) sim->resolve_time_step();
    } catch (std::invalid_argument const& bad) {
        throw std::invalid_argument("--time-step: " + std::string(bad.what()) + ": --allow-unstable-step");
    }
    return sim;
}

} // namespace cartilage
