// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <lacuna/equilibrium/load_program.hpp>
#include <lacuna/equilibrium/parameters.hpp>
#include <lacuna/equilibrium/slow_stepper.hpp>
#include <lacuna/equilibrium/slow_time.hpp>
#include <lacuna/equilibrium/unknowns.hpp>
#include <lacuna/simulation.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// Static equilibrium of a simulation: the state in which loads, pairs, walls and pressures balance, whatever the time
/// that it takes. It works on the particles, bonds, contacts, pores and loads of the simulation: one may go from steps
/// to an equilibrium and back at any time, and a checkpoint of the simulation holds both.
///
/// Loads and pressures are those that act at the time of the simulation, which does not advance, except in slow time:
/// advance() lets fluid flow while the particles are at rest. Velocities are set to zero. A bond that is too strongly
/// loaded in the equilibrium fails.
template <class Model>
class equilibrium {
public:
    static_assert(std::is_same_v<typename Model::real, double>, "equilibrium: the model's real must be double");
    static constexpr int dim = Model::dim;
    using simulation_type = simulation<Model>;
    using point = vec<double, dim>;
    using event_type = equilibrium_event<dim>;

    /// \param sim must outlive this object
    /// \throws std::invalid_argument for a parameter out of range
    explicit equilibrium(simulation_type& sim, equilibrium_parameters const& p = {})
        : sim_(sim), s_(sim.state_), stepper_(sim.state_, sim.clock_, p) {
        p.validate("equilibrium");
    }

    equilibrium_parameters const& settings() const noexcept { return stepper_.settings(); }

    /// Displaces a particle in the next solve(), along axes along which it is fixed. A particle of a rigid plate takes
    /// the plate with it.
    /// \param displacement m
    /// \throws std::invalid_argument for a displacement along an axis that is free
    void move(std::size_t id, point const& displacement) {
        auto const k = sim_.internal(id);
        unknowns<dim> const numbers(s_.store, s_.plates);
        for (int axis = 0; axis < dim; ++axis) {
            require_finite("displacement of particle " + std::to_string(id), displacement[axis]);
            if (displacement[axis] == 0) continue;
            if (numbers.of(k, axis) >= 0)
                refuse("displacement of particle " + std::to_string(id), displacement[axis],
                       "0 along an axis along which it is not fixed");
            stepper_.give(k, axis, displacement[axis]);
        }
    }
    /// Turns a particle whose rotation is fixed in the next solve().
    /// \param angle rotation vector, in the plane an angle, rad
    /// \throws std::invalid_argument for a particle whose rotation is free
    void turn(std::size_t id, vec<double, rotation_dim<dim>> const& angle) {
        auto const k = sim_.internal(id);
        for (int r = 0; r < rotation_dim<dim>; ++r) {
            require_finite("rotation of particle " + std::to_string(id), angle[r]);
            if (angle[r] != 0 && s_.store.mobility(k, dim) > 0)
                refuse("rotation of particle " + std::to_string(id), angle[r], "0 where rotation is not fixed");
            stepper_.give(k, dim + r, angle[r] * s_.store.radius(k));
        }
    }
    /// Displaces a wall in the next solve(). A wall that a servo moves goes where the stress on it is the servo's.
    /// \param displacement m
    /// \throws std::invalid_argument for a wall that does not exist, and for one that a servo moves
    void move_wall(std::size_t w, point const& displacement) {
        if (w >= s_.walls.size())
            refuse("wall", double(w), "below the number of walls, " + std::to_string(s_.walls.size()));
        for (int axis = 0; axis < dim; ++axis)
            require_finite("displacement of wall " + std::to_string(w), displacement[axis]);
        if (s_.wall_motions.has_servo(w))
            refuse("wall " + std::to_string(w), "moved by a servo", "free of it to be moved");
        stepper_.give_wall(w, displacement);
    }
    /// Puts bonds into groups, for failure_choice::worst_of_groups: of each group one bond fails at once.
    /// \param group_of number of the group of each bond, in the order of the input; negative: of its own
    /// \throws std::invalid_argument unless there is one number per bond
    void group_bonds(std::vector<int> group_of) {
        std::size_t const bonds = s_.pairs.bond_records().size();
        if (group_of.size() != bonds)
            refuse("groups of bonds", double(group_of.size()), "as many as bonds, " + std::to_string(bonds));
        stepper_.group_bonds(std::move(group_of));
    }

    /// Searches for the equilibrium under the present loads, from the present state, and moves the simulation there.
    ///
    /// Bonds fail on the way, one after the other: each increment ends where the first bond fails, and the next one
    /// begins from there at the same loads. See events().
    /// \throws std::logic_error for a model with fluid whose pores are not filled
    /// \throws std::invalid_argument for a contact law whose force does not grow with the overlap, and for parts of a
    ///         simulation that no equilibrium knows: merged pores
    equilibrium_result solve() {
        equilibrium_result result;
        stepper_.clear_events();
        stepper_.set_event_load({});
        stepper_.begin();
        stepper_.settle(result, false);
        stepper_.end();
        return result;
    }

    /// Follows a stage of a load program from equilibrium to equilibrium. Bonds fail at the value at which they reach
    /// their strength, whatever the steps: the load stops there, further bonds fail at constant load until there is
    /// equilibrium again, and then it goes on. It ends early where there is no equilibrium. See events().
    /// \param set sets the loads: callable set(value), or set(from, to) to displace something from one value to another
    ///        by move(), turn() or move_wall(). It is called often, with values of the stage in any order; from == to
    ///        asks for the loads at that value.
    /// \param watch called after each equilibrium with a load_point. If it returns bool, false ends the stage there.
    /// \throws as solve(), and std::invalid_argument for a stage out of range
    template <class Set, class Watch = ignore_point>
    load_path follow(load_stage const& stage, Set&& set, Watch&& watch = {}) {
        stage.validate("load_stage");
        stepper_.clear_events();
        load_path path;
        int const factorised = stepper_.factorisations();
        double at = stage.from;
        for (int step = 0; step <= stage.steps; ++step) {
            stepper_.begin();
            try {
                reach(at, stage.at(step), set, path);
            } catch (...) {
                stepper_.end();
                throw;
            }
            stepper_.end();
            path.value = at;
            path.broken = events().size();
            path.factorisations = stepper_.factorisations() - factorised;
            if (!path.reached()) break;
            path.points.push_back({at, path.broken, path.last.unbalanced, path.last.largest_force,
                                   path.factorisations, path.energy});
            if (!goes_on(watch, path.points.back())) break;
        }
        return path;
    }

    /// \name Slow time
    /// \{
    /// Advances the simulation in time, always in equilibrium: fluid flows while the particles rest. Each step solves
    /// for displacements and pressures together by backward Euler, with loads and sources at its end, and is as long as
    /// its error allows. Velocities that are prescribed to particles and walls move them. What has changed at once
    /// before the call (loads, move()) acts first, without flow. A step ends where a bond fails; what follows from the
    /// failure happens at that moment, without flow. See events().
    /// \param duration s
    /// \param observer callable (double time, slow_result const& so_far), called after each step with the simulation at
    ///        that time; if it returns false, the run stops
    /// \throws std::invalid_argument for a duration that is not positive, for a parameter out of range, and as solve()
    template <class Observer>
    slow_result advance(double duration, slow_time_parameters const& p, Observer&& observer) {
        require_positive("duration", duration);
        return advance_to(sim_.time() + duration, p, observer);
    }
    slow_result advance(double duration, slow_time_parameters const& p = {}) {
        return advance(duration, p, [](double, slow_result const&) {});
    }
    /// The same up to a time, s. A run that is resumed from a checkpoint of the simulation and history() has the same
    /// bits as one that was not interrupted.
    template <class Observer>
    slow_result advance_to(double end_time, slow_time_parameters const& p, Observer&& observer) {
        p.validate("slow_time");
        if (!(end_time > sim_.time() && std::isfinite(end_time)))
            refuse("end_time", end_time, "finite and after the present, " + to_text(sim_.time()) + " s");
        slow_result result;
        stepper_.clear_events();
        int const factorised = stepper_.factorisations();
        bool go_on = stepper_.settle_changes(result);
        while (go_on && sim_.time() < end_time && result.steps < p.steps) {
            go_on = stepper_.make_slow_step(p, end_time, result);
            result.factorisations = stepper_.factorisations() - factorised;
            result.broken = events().size();
            if (go_on && sim_.time() >= end_time) result.outcome = slow_outcome::finished;
            if constexpr (std::is_same_v<decltype(observer(0.0, std::as_const(result))), bool>)
                go_on = observer(sim_.time(), std::as_const(result)) && go_on;
            else
                observer(sim_.time(), std::as_const(result));
        }
        return result;
    }
    slow_result advance_to(double end_time, slow_time_parameters const& p = {}) {
        return advance_to(end_time, p, [](double, slow_result const&) {});
    }
    /// What the next step in slow time needs of those before; to be saved with a checkpoint.
    slow_history& history() noexcept { return stepper_.history(); }
    slow_history const& history() const noexcept { return stepper_.history(); }
    /// \}

    /// Bonds that failed in the last solve(), follow() or advance(), in order.
    std::span<event_type const> events() const noexcept { return stepper_.events(); }

private:
    template <class Watch>
    static bool goes_on(Watch& watch, load_point const& point) {
        if constexpr (std::is_convertible_v<std::invoke_result_t<Watch&, load_point const&>, bool>) {
            return watch(point);
        } else {
            watch(point);
            return true;
        }
    }
    template <class Set>
    void set_loads(Set& set, double from, double to) {
        stepper_.drop_given();
        if constexpr (std::is_invocable_v<Set&, double, double>)
            set(from, to);
        else
            set(to);
    }
    /// Goes from one value of a program to another, with all failures on the way.
    template <class Set>
    void reach(double& at, double target, Set& set, load_path& path) {
        double const step = target - at;
        do {
            bool const arrived = at == target || approach(at, target, step, set, path);
            if (!settle(at, arrived, set, path)) return;
        } while (at != target);
    }
    /// Makes one increment towards a value. It ends where the first bond fails. A solve that does not converge, or that
    /// is not in balance at the failure, is made again with less.
    /// \param step of the program, from which less is measured
    /// \return false: the value and its loads are those of an eighth of the step further on, but nothing has moved yet
    template <class Set>
    bool approach(double& at, double target, double step, Set& set, load_path& path) {
        double to = target;
        for (;;) {
            set_loads(set, at, to);
            if (double const share = stepper_.given_share(); share < 1) {
                to = at + share * (to - at);
                continue;
            }
            ++path.solves;
            bool const tiny = std::fabs(to - at) <= std::fabs(step) / 64;
            if (!stepper_.find_increment(stepper_.settings().regularisation)) {
                if (tiny) break;
                to = at + 0.5 * (to - at);
                continue;
            }
            double const part = stepper_.part();
            if (part < 1) to = at + part * (to - at);
            set_loads(set, to, to);
            if (part < 1 && !tiny && stepper_.unbalance_at_part() > straight) continue;
            stepper_.set_event_load(to);
            equilibrium_result taken;
            stepper_.take_increment(stepper_.settings().regularisation, taken);
            path.energy += stepper_.take_energy();
            at = to;
            return true;
        }
        // The interior point fails from here even for a small step. Regularised solves may do it.
        to = std::fabs(target - at) <= std::fabs(step) / 8 ? target : at + step / 8;
        set_loads(set, at, to);
        at = to;
        return false;
    }
    /// \param arrived false: what is displaced has still to be moved
    /// \return whether there is an equilibrium at constant load
    template <class Set>
    bool settle(double at, bool arrived, Set& set, load_path& path) {
        if (arrived) set_loads(set, at, at);
        stepper_.set_event_load(at);
        equilibrium_result result;
        stepper_.settle(result, true);
        path.outcome = result.outcome;
        path.solves += result.solves;
        path.energy += result.energy;
        path.last = std::move(result);
        return path.reached();
    }

    /// Largest unbalanced force, over the largest force, at which the share of an increment counts as the state at that
    /// share of the load, 1.
    static constexpr double straight = 0.02;

    simulation_type& sim_;
    simulation_state<Model>& s_;
    slow_stepper<Model> stepper_;
};
LACUNA_END_PACKS

} // namespace lacuna
