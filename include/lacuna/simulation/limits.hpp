// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cmath>
#include <limits>
#include <vector>

#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/motion/stable_step.hpp>
#include <lacuna/simulation/force_terms.hpp>
#include <lacuna/simulation/simulation_state.hpp>

namespace lacuna {

/// The time step limits of a simulation in its present state, s.
struct time_step_limits {
    double wave_limit = 0; ///< the paper's eq. 9, distance over wave speed: least sqrt(m / k) of the counted pairs
    double mean_throat_limit = 0; ///< the paper's eq. 19, for the fluid; infinite if the flow has no such limit
    double flow = 0; ///< rigorous, for the fluid alone with its substeps and interval; infinite without flow
    double rigorous = 0;          ///< rigorous, for particles with rotation, damping and the stiffness of the fluid
    /// Stable limit of the whole model, s: a time step must not exceed it.
    double critical() const noexcept { return rigorous < flow ? rigorous : flow; }
};

/// Stable limit of the fluid, s; see time_step_limits::flow.
template <class Flow>
double flow_limit(Flow const& flow) {
    return double(flow.critical_time_step()) / flow.settings().interval;
}

/// Working memory of find_limits(). Reuse it: then further calls allocate nothing.
template <int Dim>
struct limit_scratch {
    frequency_bound<Dim> stiff, viscous;
    std::vector<pair_tangent<Dim>> with_moments;
};

namespace detail {
/// Adds bonds and contacts to the bounds: first all forces, then all moments.
/// \return the paper's eq. 9 without its factor: the least sqrt(m / k), m the smaller mass of a pair, s
template <class State, class Scratch>
double add_pairs(State const& s, contact_assumption const& assumed, Scratch& scratch) {
    using damping = typename State::damping_type;
    double wave = std::numeric_limits<double>::infinity();
    scratch.with_moments.clear();
    s.pairs.for_each_pair_tangent(s.store, assumed, [&](auto const& t) {
        scratch.stiff.add_pair(t.i, t.j, t.normal, t.normal_stiffness, t.shear_stiffness, t.prestress, t.lever_i,
                               t.lever_j);
        double const mass_i = double(s.store.mass(t.i)), mass_j = double(s.store.mass(t.j));
        if constexpr (damping::acts_on_pairs)
            scratch.viscous.add_pair(t.i, t.j, t.normal,
                                     damping::pair_force(s.settings.damping, t.normal_stiffness, mass_i, mass_j, 1.0),
                                     0, 0, t.lever_i, t.lever_j);
        wave = std::min(wave, std::sqrt(std::min(mass_i, mass_j) / t.normal_stiffness));
        if (t.moments.bending > 0 || t.moments.twisting > 0) scratch.with_moments.push_back(t);
    });
    for (auto const& t : scratch.with_moments)
        scratch.stiff.add_rotational(t.i, t.j, t.normal, t.moments.bending, t.moments.twisting);
    return wave;
}
} // namespace detail

/// Limits of the time step in the present state. They count bonds, contacts of particles and walls that touch or may
/// touch under the assumption, their dashpots, other damping, the fluid, and the model's own forces.
/// \param time time of the positions, s
template <class Model>
time_step_limits find_limits(simulation_state<Model> const& s, contact_assumption const& assumed, double time,
                             limit_scratch<Model::dim>& scratch) {
    using damping = typename Model::damping;
    bool const viscous = damping::acts_on_pairs || s.own_forces.active();
    scratch.stiff.reset(s.store.size());
    scratch.viscous.reset(viscous ? s.store.size() : 0);
    for (std::size_t k = 0; k < s.store.size(); ++k)
        for (int axis = 0; axis < frequency_bound<Model::dim>::freedoms; ++axis) {
            scratch.stiff.set_mobility(k, axis, double(s.store.mobility(k, axis)));
            if (viscous) scratch.viscous.set_mobility(k, axis, double(s.store.mobility(k, axis)));
        }
    time_step_limits result;
    result.wave_limit = detail::add_pairs(s, assumed, scratch);
    force_terms::add_stiffness(s, assumed, time, scratch.stiff, scratch.viscous);
    result.mean_throat_limit = result.flow = std::numeric_limits<double>::infinity();
    if constexpr (has_fluid<Model>)
        if (auto const* flow = s.fluid.get()) {
            if constexpr (requires { flow->mean_throat_limit(); })
                result.mean_throat_limit = double(flow->mean_throat_limit());
            result.flow = flow_limit(*flow);
        }
    double const against_motion = 1 + std::fabs(damping::particle_force(s.settings.damping, 1.0, -1.0));
    double drag_rate = 0;
    if constexpr (requires { damping::drag_rate(s.settings.damping); })
        drag_rate = damping::drag_rate(s.settings.damping);
    result.rigorous = scratch.stiff.time_step(scratch.viscous, against_motion, drag_rate);
    return result;
}

} // namespace lacuna
