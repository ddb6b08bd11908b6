// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <lacuna/interactions/law_stiffness.hpp>
#include <lacuna/laws/law_concepts.hpp>
#include <lacuna/motion/stable_step.hpp>
#include <lacuna/simulation/guards.hpp>
#include <lacuna/simulation/particle_forces.hpp>
#include <lacuna/simulation/simulation_state.hpp>

/// \file
/// Forces on particles other than pair forces and constant loads: one struct per term, and one list of all terms.
/// A term has
///   - `active(state)`: whether it acts at all. If no term is active, a step moves particles while their pair forces
///     are in the cache;
///   - `add_forces<WithEnergy>(state, step)`: adds its forces to state.other_forces;
///   - `add_stiffness(state, assumed, time, stiff, viscous)`: adds its stiffness and damping to the bounds of the time
///     step.

namespace lacuna {

namespace detail {

/// Adds the stiffness of the fluid: a change dV of a pore's volume takes the energy K_f dV^2 / (2 V_p).
template <int Dim, class Real, class Flow>
void add_fluid_stiffness(frequency_bound<Dim>& bound, particle_store<Real, Dim> const& store, Flow const& flow) {
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

/// Data of one step for the force terms.
template <class Real>
struct force_step {
    moment now;            ///< number of the step, and time of the positions
    Real previous;         ///< length of the step that led to the positions, s
    bool pairs_changed;    ///< whether the tables of pairs have changed since the last step
    bool remeshed = false; ///< output: whether the pores have a new mesh
};

/// Pressure of the fluid. First in the list: it overwrites state.other_forces.
struct fluid_term {
    template <class State>
    static bool active(State const& s) noexcept {
        return s.filled();
    }
    template <bool WithEnergy, class State, class Step>
    static void add_forces(State& s, Step& step) {
        if (step.pairs_changed) {
            s.fluid.map_throats(s.pairs);
            s.fluid.deactivate_slow_throats(s.store, s.pairs);
        }
        s.fluid.template step<WithEnergy>(s.store, s.pairs, step.previous, step.now.step, s.settings.threads,
                                          s.other_forces);
        step.remeshed = s.fluid.remesh(s.store, s.pairs, step.now.step);
    }
    template <class State, class Bound>
    static void add_stiffness(State const& s, contact_assumption const&, double, Bound& stiff, Bound&) {
        if constexpr (has_fluid<typename State::model_type>)
            detail::add_fluid_stiffness(stiff, s.store, *s.fluid.get());
    }
};

/// Moments of bonds and contacts that resist bending, twisting and rolling. Their stiffness counts with that of the
/// pairs.
struct pair_moment_term {
    template <class State>
    static constexpr bool active(State const&) noexcept {
        return carries_moment<typename State::bond_law_type> || carries_moment<typename State::contact_law_type>;
    }
    template <bool WithEnergy, class State, class Step>
    static void add_forces(State& s, Step&) {
        s.pairs.add_moments(s.store, s.other_forces);
    }
    template <class State, class Bound>
    static void add_stiffness(State const&, contact_assumption const&, double, Bound&, Bound&) {}
};

/// Contact with walls.
struct wall_term {
    template <class State>
    static bool active(State const& s) noexcept {
        return !s.walls.empty();
    }
    template <bool WithEnergy, class State, class Step>
    static void add_forces(State& s, Step& step) {
        auto const beyond = s.walls.evaluate(s.store, step.previous, s.settings.damping, s.other_forces, s.wall_energy);
        if (beyond >= 0 && s.settings.guards.walls)
            throw_unstable(s.store, step.now, beyond, "its centre is beyond a wall",
                           step.now.step == 0
                               ? "it is there from the start: a wall's point or normal, or the particle's position"
                               : "the load or speed is too high for the stiffness of the wall");
    }
    template <class State, class Bound>
    static void add_stiffness(State const& s, contact_assumption const& assumed, double, Bound& stiff, Bound& viscous) {
        using damping = typename State::damping_type;
        s.walls.for_each_stiffness(
            s.store, assumed, [&](std::size_t k, auto const& normal, double kn, double ks, double lever) {
                stiff.add_support(k, normal, kn, ks, lever);
                double const twice = 2 * double(s.store.mass(k));
                if constexpr (damping::acts_on_pairs)
                    viscous.add_support(k, normal, damping::pair_force(s.settings.damping, kn, twice, twice, 1.0), 0,
                                        lever);
            });
        s.walls.for_each_moment_stiffness(s.store, assumed,
                                          [&](std::size_t k, auto const& normal, auto const& stiffness) {
                                              stiff.add_rotational(k, normal, stiffness.bending, stiffness.twisting);
                                          });
    }
};

/// The model's own forces, its slot `forces`.
struct own_force_term {
    template <class State>
    static bool active(State const& s) noexcept {
        return s.own_forces.active();
    }
    template <bool WithEnergy, class State, class Step>
    static void add_forces(State& s, Step& step) {
        if constexpr (requires { s.own_forces.add_forces(s.store, 0.0, 1, s.other_forces); })
            s.own_forces.add_forces(s.store, step.now.time, s.settings.threads, s.other_forces);
    }
    template <class State, class Bound>
    static void add_stiffness(State const& s, contact_assumption const&, double time, Bound& stiff, Bound& viscous) {
        if constexpr (requires { s.own_forces.add_stiffness(s.store, time, stiff, viscous); })
            s.own_forces.add_stiffness(s.store, time, stiff, viscous);
    }
};

/// Rigid plates. Last in the list: they distribute the sum of all other forces among their particles.
struct rigid_plate_term {
    template <class State>
    static bool active(State const& s) noexcept {
        return !s.plates.empty();
    }
    template <bool WithEnergy, class State, class Step>
    static void add_forces(State& s, Step&) {
        s.plates.share(
            s.store, [&](std::size_t k) { return total_force(s.store, s.pairs, s.other_forces, k).force; },
            s.other_forces);
    }
    template <class State, class Bound>
    static void add_stiffness(State const&, contact_assumption const&, double, Bound&, Bound&) {}
};

/// Terms in the order in which they add their forces; stiffnesses are added in the opposite order.
template <class... Terms>
struct term_list {
    template <class State>
    static bool any_active(State const& s) noexcept {
        return (Terms::active(s) || ...);
    }
    template <bool WithEnergy, class State, class Step>
    static void add_forces(State& s, Step& step) {
        if (!fluid_term::active(s)) std::fill(s.other_forces.data(), s.other_forces.data() + 4 * s.other_forces.size(),
                      typename State::real(0));
        ((Terms::active(s) ? Terms::template add_forces<WithEnergy>(s, step) : void()), ...);
    }
    template <class State, class Bound>
    static void add_stiffness(State const& s, contact_assumption const& assumed, double time, Bound& stiff,
                              Bound& viscous) {
        // A fold over an assignment evaluates from right to left.
        int order = 0;
        ((Terms::active(s) ? Terms::add_stiffness(s, assumed, time, stiff, viscous) : void(), order) = ... = 0);
    }
};
using force_terms = term_list<fluid_term, pair_moment_term, wall_term, own_force_term, rigid_plate_term>;

} // namespace lacuna
