// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/model.hpp>
#include <lacuna/motion/stable_step.hpp>

namespace lacuna {

/// The time step limits of a simulation in its present state, s.
struct time_step_limits {
    double wave_limit = 0; ///< the paper's eq. 9: shortest distance over wave speed, from the stiffest light pair counted
    double mean_throat_limit = 0; ///< the paper's eq. 19, for the fluid; infinite where the flow has none
    double flow = 0;        ///< rigorous, for the fluid alone with its substeps and interval; infinite without flow
    double rigorous = 0;    ///< rigorous, for particles with rotation, damping and the stiffness of the fluid
    /// What a step has to stay below.
    double critical() const noexcept { return rigorous < flow ? rigorous : flow; }
};

namespace detail {

/// A pore resists a change of its volume: K_f / V_p times the square of it.
template <int Dim, class Store, class Flow>
void add_fluid_stiffness(frequency_bound<Dim>& bound, Store const& store, Flow const& flow) {
    auto const& net = flow.network();
    for (std::size_t p = 0; p < net.pores(); ++p) {
        auto const tractions = flow.pore_tractions(p, store.positions(), store.radii().data());
        std::array<std::size_t, std::size_t(Dim) + 1> who{};
        std::array<typename frequency_bound<Dim>::gradient, std::size_t(Dim) + 1> g{};
        for (std::size_t c = 0; c < who.size(); ++c) {
            who[c] = std::size_t(net.corner[c][p]);
            for (int axis = 0; axis < Dim; ++axis) g[c][std::size_t(axis)] = double(tractions[c][axis]);
        }
        bound.add(who, g, flow.settings().bulk_modulus / double(net.volume[p]));
    }
}

} // namespace detail

/// What a step has to stay below for the fluid, s; see time_step_limits::flow.
template <class Flow>
double flow_limit(Flow const& flow) {
    return double(flow.critical_time_step()) / flow.settings().interval;
}

/// Where find_limits() works: kept from one call to the next, a call allocates nothing.
template <int Dim>
struct limit_scratch {
    frequency_bound<Dim> stiff, viscous;
};

/// Limits of the time step of the given parts in their present state. Counted are bonds, contacts of
/// particles and walls that touch or may under an assumption, their dashpots, other damping, and the fluid.
/// \param flow nullptr without fluid
template <class Model, class Store, class Interactions, class Walls, class Flow>
time_step_limits find_limits(Store const& store, Interactions const& interactions, Walls const& walls, Flow const* flow,
                             typename Model::damping::parameters const& damping, contact_assumption const& assumed,
                             limit_scratch<Model::dim>& scratch) {
    using damping_type = typename Model::damping;
    using point = vec<double, Model::dim>;
    constexpr bool dashed = damping_type::acts_on_pairs;
    [[maybe_unused]] auto const dashpot = [&](double stiffness, double mass_i, double mass_j) {
        if constexpr (dashed) return damping_type::pair_force(damping, stiffness, mass_i, mass_j, 1.0);
        return 0.0;
    };
    auto &bound = scratch.stiff, &dashpots = scratch.viscous;
    bound.reset(store.size());
    dashpots.reset(dashed ? store.size() : 0);
    for (std::size_t k = 0; k < store.size(); ++k)
        for (int axis = 0; axis < frequency_bound<Model::dim>::freedoms; ++axis) {
            bound.set_mobility(k, axis, double(store.mobility(k, axis)));
            if constexpr (dashed) dashpots.set_mobility(k, axis, double(store.mobility(k, axis)));
        }
    double wave = std::numeric_limits<double>::infinity();
    interactions.for_each_stiffness(store, assumed, [&](std::size_t i, std::size_t j, point const& normal, double kn,
                                                        double ks, double prestress, double li, double lj) {
        bound.add_pair(i, j, normal, kn, ks, prestress, li, lj);
        double const mass_i = double(store.mass(i)), mass_j = double(store.mass(j));
        if constexpr (dashed) dashpots.add_pair(i, j, normal, dashpot(kn, mass_i, mass_j), 0, 0, li, lj);
        wave = std::min(wave, std::sqrt(std::min(mass_i, mass_j) / kn));
    });
    interactions.for_each_moment_stiffness(
        store, assumed, [&](std::size_t i, std::size_t j, point const& normal, moment_stiffness<double> const& k) {
            bound.add_rotational(i, j, normal, k.bending, k.twisting);
        });
    walls.for_each_stiffness(store, assumed, [&](std::size_t k, point const& normal, double kn, double ks, double lever) {
        bound.add_support(k, normal, kn, ks, lever);
        double const twice = 2 * double(store.mass(k));
        if constexpr (dashed) dashpots.add_support(k, normal, dashpot(kn, twice, twice), 0, lever);
    });
    walls.for_each_moment_stiffness(
        store, assumed, [&](std::size_t k, point const& normal, moment_stiffness<double> const& stiffness) {
            bound.add_rotational(k, normal, stiffness.bending, stiffness.twisting);
        });
    time_step_limits result;
    result.wave_limit = wave;
    result.mean_throat_limit = result.flow = std::numeric_limits<double>::infinity();
    if constexpr (has_fluid<Model>)
        if (flow) {
            detail::add_fluid_stiffness(bound, store, *flow);
            if constexpr (requires { flow->mean_throat_limit(); }) result.mean_throat_limit = double(flow->mean_throat_limit());
            result.flow = flow_limit(*flow);
        }
    double const against_motion = 1 + std::fabs(damping_type::particle_force(damping, 1.0, -1.0));
    double drag_rate = 0;
    if constexpr (requires { damping_type::drag_rate(damping); }) drag_rate = damping_type::drag_rate(damping);
    result.rigorous = bound.time_step(dashpots, against_motion, drag_rate);
    return result;
}

} // namespace lacuna
