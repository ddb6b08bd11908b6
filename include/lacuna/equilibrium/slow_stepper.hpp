// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include <lacuna/equilibrium/interior_point.hpp>
#include <lacuna/equilibrium/parameters.hpp>
#include <lacuna/equilibrium/slow_time.hpp>
#include <lacuna/equilibrium/stepper.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// Steps in slow time: increments in which time passes and fluid flows. See equilibrium::advance().
template <class Model>
class slow_stepper : public equilibrium_stepper<Model> {
    using base = equilibrium_stepper<Model>;
    using base::account_, base::clock_, base::increment_, base::last_, base::parameters_, base::s_, base::system_,
        base::velocity_, base::wall_velocity_, base::spin_, base::flow_time_, base::part_;

public:
    using typename base::point;
    static constexpr int dim = Model::dim;
    using base::base;

    slow_history& history() noexcept { return base::rests_; }
    slow_history const& history() const noexcept { return base::rests_; }

    /// Brings the model to rest before the first step, if something has changed at once.
    /// \return whether it is in equilibrium
    bool settle_changes(slow_result& result) {
        slow_mode const mode(*this);
        bool const continues = history().continues(clock_.now());
        std::size_t const events = base::events().size();
        base::begin();
        equilibrium_result now;
        last_ = {true, 0};
        bool const settled =
            !base::given_remains() && base::events().size() == events && nearly_balanced(now);
        if (!settled || !continues) history().clear();
        bool const rests = settled || settle_at_once(result);
        base::end();
        return rests;
    }

    /// Makes one step.
    /// \param end_time time beyond which it must not go, s
    /// \return whether the model is in equilibrium after it
    bool make_slow_step(slow_time_parameters const& p, double end_time, slow_result& result) {
        slow_mode const mode(*this);
        base::begin(true);
        double const proposed = history().propose(p, std::numeric_limits<double>::infinity());
        double dt = history().propose(p, end_time - clock_.time());
        bool cut = false; // whether its error, or the solver, made the step shorter
        int located = 0;  // times that it was made shorter to end where a bond fails
        for (;; ++result.repeated) {
            auto const trial = try_step(dt, located, p);
            if (trial.taken) break;
            dt = trial.shorter;
            (trial.bond_fails ? ++located : cut = true);
            if (dt >= p.smallest_step) continue;
            result.outcome = slow_outcome::not_converged;
            base::end();
            return false;
        }
        auto const& flow = system_.flow();
        result.error = history().error(flow.start(), flow.end(), dt);
        history().accept(p, flow.start(), flow.end(), dt, cut ? dt : std::max(proposed, p.growth * dt));
        result.time_step = dt;
        ++result.steps;
        equilibrium_result now;
        bool const balanced = nearly_balanced(now) && last_.failures == 0;
        result.unbalanced = now.unbalanced;
        result.largest_force = now.largest_force;
        bool const rests = balanced || settle_at_once(result);
        base::end();
        return rests;
    }

private:
    /// What became of a step of a certain length.
    struct attempt {
        bool taken;
        double shorter = 0;      ///< length that may succeed, s
        bool bond_fails = false; ///< whether it is shorter so that it ends where a bond fails
    };
    /// Meanwhile pores are closed at constant time, whatever the parameters say of solve().
    struct slow_mode {
        slow_stepper& of;
        bool drained;
        explicit slow_mode(slow_stepper& s) : of(s), drained(s.drained_) {
            of.drained_ = false;
            of.slow_ = true;
        }
        ~slow_mode() {
            of.drained_ = drained;
            of.slow_ = false;
            of.flow_time_ = 0;
        }
    };

    /// A step may leave a little more than a solve: the next one takes it.
    bool nearly_balanced(equilibrium_result& now) {
        return base::check_balance(now) || now.unbalanced < 10 * parameters_.tolerance * now.largest_force;
    }
    /// Increments at constant time, without flow.
    bool settle_at_once(slow_result& result) {
        equilibrium_result found;
        base::settle(found, false);
        result.unbalanced = found.unbalanced;
        result.largest_force = found.largest_force;
        if (!found.reached())
            result.outcome = found.outcome == equilibrium_outcome::mechanism ? slow_outcome::mechanism
                                                                             : slow_outcome::not_converged;
        return found.reached();
    }

    attempt try_step(double dt, int located, slow_time_parameters const& p) {
        auto const loads = s_.loads;
        auto const motions = s_.motions;
        auto const wall_motions = s_.wall_motions;
        flow_time_ = dt;
        base::list();
        give_velocities(dt);
        double const share = base::begin_increment();
        attempt const found = share < 1 ? attempt{false, 0.99 * share * dt} : solve(dt, located, p);
        base::drop_given();
        if (found.taken) return found;
        system_.restore();
        s_.loads = loads;
        s_.loads.advance(s_.store, clock_.time());
        s_.motions = motions;
        s_.wall_motions = wall_motions;
        flow_time_ = 0;
        return found;
    }
    attempt solve(double dt, int located, slow_time_parameters const& p) {
        double const longest = 0.25 * median_radius(s_.store.radii());
        bool solved = false;
        for (double r = 1; r < 1e5 && !solved; r *= 100) {
            auto const scales = base::find_scales(longest, r * parameters_.regularisation);
            system_.scale_pressures(scales.stiffness);
            solved = interior_point(system_, scales, parameters_).solve(increment_);
        }
        if (!solved) return {false, dt / 4};
        double const reach = base::longest_motion();
        system_.hold_loose(increment_, parameters_.tolerance * system_.largest_force(), 0.5 * reach);
        if (double const moved = system_.largest_motion(increment_); moved > reach)
            return {false, 0.9 * dt * reach / moved};
        double const error = history().error(system_.flow().start(), system_.flow().end(), dt);
        if (error > p.tolerance && dt > p.smallest_step)
            return {false, std::max(std::clamp(history().fitting(p, dt, error), 0.1 * dt, 0.8 * dt), p.smallest_step)};
        bool const groups = parameters_.failures == failure_choice::worst_of_groups;
        base::failing_ = system_.failures(increment_, 1.0, !groups);
        if (!base::failing_.empty() && located < 8) {
            double const at = base::failing_.front().share;
            if (at < 0.98 && at * dt >= p.smallest_step) return {false, at * dt, true};
        }
        part_ = 1;
        last_ = {true, base::commit()};
        return {true};
    }
    /// Gives the displacements that prescribed velocities make in a step, and the loads at its end.
    void give_velocities(double dt) {
        double const now = clock_.time();
        s_.loads.advance(s_.store, now + dt);
        s_.motions.advance(now, dt, [&](std::size_t k, point const& v) { velocity_[k] = v; });
        for (std::size_t w = 0; w < s_.walls.size(); ++w) s_.walls.set_velocity(w, wall_velocity_[w]);
        s_.wall_motions.advance(s_.walls, now, dt);
        for (std::size_t w = 0; w < s_.walls.size(); ++w) {
            if (s_.wall_motions.has_servo(w)) continue;
            wall_velocity_[w] = s_.walls.next_velocity(w);
            if (norm(wall_velocity_[w]) > 0) base::give_wall(w, wall_velocity_[w] * dt);
        }
        for (std::size_t k = 0; k < s_.store.size(); ++k) {
            for (int axis = 0; axis < dim; ++axis)
                if (s_.store.held(k, axis) && velocity_[k][axis] != 0) base::give(k, axis, velocity_[k][axis] * dt);
            for (int r = 0; s_.store.mobility(k, dim) == 0 && r < rotation_dim<dim>; ++r)
                if (spin_[k][r] != 0) base::give(k, dim + r, spin_[k][r] * dt * s_.store.radius(k));
        }
    }
};
LACUNA_END_PACKS

} // namespace lacuna
