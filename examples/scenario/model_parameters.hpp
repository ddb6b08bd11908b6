// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <lacuna/laws/hertz_mindlin.hpp>
#include <lacuna/laws/parallel_bond.hpp>
#include <lacuna/simulation.hpp>

#include "chosen_flow.hpp"
#include "scenario.hpp"

/// \file
/// Converts a scenario to the parameters of the library.

namespace lacuna_run {

template <int Dim>
lacuna::vec<double, Dim> to_vec(point const& p) {
    lacuna::vec<double, Dim> v{};
    for (int axis = 0; axis < Dim; ++axis) v[axis] = p[std::size_t(axis)];
    return v;
}

inline double mean_radius(particle_list const& p) {
    double sum = 0;
    for (double const r : p.radius) sum += r;
    return sum / double(p.radius.size());
}

/// Fills the parameters of frictional springs from a material or a wall.
template <class Solid>
void fill_contact(lacuna::frictional_spring::material& to, Solid const& from, double /*mean_radius*/) {
    to = {from.normal_stiffness, from.shear_stiffness, from.friction};
}
/// Fills the parameters of Hertzian contacts from a material or a wall. Without Young's modulus they give two particles
/// of the mean radius the stated stiffnesses at an overlap of 1 % of that radius.
template <class Solid>
void fill_contact(lacuna::hertz_mindlin::material& to, Solid const& from, double mean_radius) {
    if (from.young_modulus) {
        to = {*from.young_modulus, from.poisson_ratio, from.friction, 1};
        return;
    }
    // k_n = 2 E* a with a = sqrt(r/2 * r/100), and E = 2 E* where nu = 0; then Mindlin's k_s is k_n.
    double const contact_radius = mean_radius * std::sqrt(0.005);
    to = {from.normal_stiffness / contact_radius, 0, from.friction, from.shear_stiffness / from.normal_stiffness};
}

template <class Bond>
void fill_bond(Bond& to, material const& from) {
    to.normal_stiffness = from.normal_stiffness;
    to.shear_stiffness = from.shear_stiffness;
    if (from.tensile_strength) to.tensile_strength = *from.tensile_strength;
    if (from.shear_strength) to.shear_strength = *from.shear_strength;
}

template <class Flow>
void fill_merging(Flow& to, fluid_settings const& from) {
    if (!from.merge_conductance) return;
    if constexpr (requires { to.merge_conductance; })
        to.merge_conductance = *from.merge_conductance;
    else if (*from.merge_conductance < 1e300)
        refuse("fluid.merge_conductance", lacuna::to_text(*from.merge_conductance),
               "left out: this kind of flow does not merge pores");
}

inline chosen_flow::parameters flow_of(fluid_settings const& from) {
    chosen_flow::parameters to;
    to.kind = from.implicit ? flow_kind::implicit_steps : flow_kind::explicit_steps;
    to.bulk_modulus = from.bulk_modulus;
    to.conductivity = from.conductivity;
    to.initial_pressure = from.initial_pressure;
    to.aperture.is_constant = from.constant_aperture;
    if (from.constant_aperture)
        to.aperture.constant.aperture = from.aperture;
    else
        to.aperture.contact_force = {from.aperture, from.half_force, from.gap_factor};
    // 0: as many flow steps per particle step as stability needs.
    to.substeps = from.implicit ? 1 : 0;
    if (from.minimum_pressure) to.minimum_pressure = *from.minimum_pressure;
    fill_merging(to, from);
    return to;
}

/// Time within which the flow of a throat must be noticeable, s: fluid.duration or the length of the run. Infinite if
/// that length is not known yet.
inline double duration_of(scenario const& s) {
    settings const& set = s.simulation;
    if (s.fluid->duration) return *s.fluid->duration;
    if (set.end_time) return *set.end_time;
    double const steps = std::max(1.0, double(*set.steps));
    return set.time_step > 0 ? steps * set.time_step : std::numeric_limits<double>::infinity();
}

template <class Model>
lacuna::simulation_parameters<Model> model_parameters(scenario const& s) {
    constexpr int dim = Model::dim;
    lacuna::simulation_parameters<Model> p;
    settings const& set = s.simulation;
    double const radius = mean_radius(s.particles);
    p.materials.clear();
    for (material const& m : s.materials) {
        typename lacuna::simulation_parameters<Model>::material one;
        one.density = m.density;
        fill_contact(one.contact, m, radius);
        fill_bond(one.bond, m);
        p.materials.push_back(one);
    }
    for (wall const& w : s.walls) {
        lacuna::wall<typename Model::contact_law, dim> one;
        one.point = to_vec<dim>(w.position);
        one.normal = to_vec<dim>(w.normal);
        fill_contact(one.material, w, radius);
        p.walls.push_back(one);
    }
    p.bonds = s.bonds.values;
    p.thickness = set.thickness;
    p.mass = set.spheres ? lacuna::mass_model::sphere : lacuna::mass_model::disc;
    p.gravity = to_vec<dim>(set.gravity);
    p.fluid_density = set.fluid_density;
    p.interactions.contacts = set.contact != contact_law::none;
    p.damping = {set.local_damping, set.mass_damping, set.viscous_damping};
    p.time_step = set.time_step;
    p.safety = set.safety;
    p.velocities_on_time = set.velocity_verlet;
    p.allow_unstable_step = set.allow_unstable_step;
    p.guards = set.guards;
    p.threads = set.threads;
    if constexpr (lacuna::has_fluid<Model>)
        if (s.fluid) {
            p.flow = flow_of(*s.fluid);
            p.flow.duration = duration_of(s);
            if (s.fluid->remeshing) p.remeshing.rule = lacuna::remesh_rule::when_needed;
            p.remeshing.interval = s.fluid->remeshing_interval;
            p.remeshing.on_broken_bond = s.fluid->remeshing_on_broken_bond;
        }
    return p;
}

} // namespace lacuna_run
