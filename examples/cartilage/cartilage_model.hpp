// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <lacuna/loads/surface_traction.hpp>
#include <lacuna/particles/cartilage_specimen_types.hpp>
#include <lacuna/pores/explicit_flow.hpp>
#include <lacuna/pores/triangulation.hpp>
#include <lacuna/simulation.hpp>

#include "choices.hpp"

/// \file
/// The model of the paper, put together from the library's parts, and its numbers (Tables 1 and 2).

namespace cartilage {

/// Bonded and frictional springs without damping; no fluid.
struct dry_model : lacuna::default_model<2> {};

/// The same with water in the pores.
struct wet_model : lacuna::default_model<2> {
    using flow = lacuna::explicit_flow;
};

template <class Parameters>
typename Parameters::material material(double density, double stiffness, double friction, double strength) {
    typename Parameters::material m;
    m.density = density;
    m.contact.normal_stiffness = m.contact.shear_stiffness = stiffness;
    m.contact.friction = friction;
    m.bond.normal_stiffness = m.bond.shear_stiffness = stiffness;
    m.bond.tensile_strength = m.bond.shear_strength = strength;
    return m;
}

/// Parameters of the model for a specimen: materials of Table 1 in the order of lacuna::cartilage_material, rigid
/// walls beside the specimen, a time step of 0.4 of the rigorous bound.
template <class Model>
lacuna::simulation_parameters<Model> model_parameters(lacuna::cartilage_specimen<double> const& s,
                                                      choices const& open) {
    using parameters = lacuna::simulation_parameters<Model>;
    parameters p;
    double const mu = open.friction;
    p.materials = {material<parameters>(1000, 2.0e8, mu, 2e8), material<parameters>(2000, 2.0e8, mu, 2e8),
                   material<parameters>(2500, 2.1e8, mu, 9e8), material<parameters>(3000, 2.2e8, mu, 1e9)};
    p.thickness = s.thickness;
    p.safety = 0.4;
    // The generator lets neighbours overlap by its tolerance, or leave gaps up to twice that: both are contacts.
    p.interactions.initial_contact_tolerance = 2 * open.contact_tolerance;
    auto const rigid = p.materials.front().contact;
    p.walls = {{{s.wall_left, 0}, {1, 0}, rigid}, {{s.wall_right, 0}, {-1, 0}, rigid}};
    return p;
}

/// Where the fluid can leave: at the free sides and under the loaded surface, not through the support.
struct free_sides_drained {
    lacuna::throat_boundary<double> operator()(lacuna::boundary_throat<double, 2> const& throat) const {
        bool const support = throat.side == lacuna::body_side::bottom;
        return {support ? lacuna::boundary_kind::sealed : lacuna::boundary_kind::drained, 0.0};
    }
};

/// Holds the bottom row, loads the top row at once, and fills the pores where the model has a fluid.
/// \param pressure of the load, Pa
template <class Model>
void set_up(lacuna::simulation<Model>& sim, lacuna::cartilage_specimen<double> const& s, double pressure,
            choices const& open) {
    for (auto id : s.fixed) sim.fix(std::size_t(id));
    for (auto id : s.loaded) {
        double const radius = s.discs.radius[std::size_t(id)];
        auto const area =
            open.load_area == area_rule::disc ? lacuna::traction_area::disc : lacuna::traction_area::strip;
        double const force = lacuna::traction_force(pressure, radius, s.thickness, area);
        sim.apply(std::size_t(id), {0, -force}, 0, open.ramp_time * 1e-9);
    }
    if constexpr (lacuna::has_fluid<Model>)
        sim.fill_pores([](lacuna::points_view<double, 2> points, double const* radii) {
            return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii,
                                             free_sides_drained{});
        });
}

} // namespace cartilage
