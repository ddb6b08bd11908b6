// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/state.hpp>
#include <lacuna/simulation/guards.hpp>
#include <lacuna/simulation/limits.hpp>
#include <lacuna/simulation/simulation_state.hpp>
#include <lacuna/simulation/step_control.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// Counts the steps of a run, and sets their length.
///
/// Without a given step the clock chooses a share of the critical step and follows it. A given step stays; the run ends
/// once it is unsafe, unless allow_unstable_step is set.
template <class Model>
class step_clock {
public:
    using real = typename Model::real;
    static constexpr int dim = Model::dim;
    using state_type = simulation_state<Model>;

    explicit step_clock(double start_time) : epoch_{start_time, 0} {}

    long long step() const noexcept { return step_; }
    bool is_resolved() const noexcept { return time_step_.has_value(); }
    /// Length of the next step, s; NaN until resolve().
    double time_step() const noexcept { return time_step_.value_or(std::numeric_limits<double>::quiet_NaN()); }
    /// Length of the last step, s. Before the first step: the length of the first.
    double previous_step() const noexcept { return step_ > 0 ? previous_ : time_step(); }
    /// Time of the positions, s.
    double time() const noexcept {
        return step_ == epoch_.step ? epoch_.time : epoch_.time + double(step_ - epoch_.step) * time_step();
    }
    moment now() const noexcept { return {step_, time()}; }
    step_control<Model> const& control() const noexcept { return control_; }

    /// Lets time pass in which no steps were made. \param duration s
    void pass(double duration) noexcept { epoch_ = {time() + duration, step_}; }
    /// Discards the length of the first step, because its reasons have changed; the next resolve() determines it again.
    void reset() noexcept { time_step_.reset(); }
    /// Call it when particles were fixed or released.
    void supports_changed() noexcept { control_.forget_forecast(); }
    /// Call it when the state has changed by other means than steps.
    void state_changed() noexcept { control_.update_next(); }

    /// Determines the length of the first step: the given step if it is stable; a share of the critical step if none is
    /// given. Does nothing if the length is known.
    /// \throws std::invalid_argument for a given step above the stable limit; and if none is given and nothing has a
    ///         stiffness
    /// \throws std::logic_error if the pores of a model with fluid are not filled
    void resolve(state_type& s);

    /// Call it before the forces of a step. Computes the critical step again if that is due, and follows it.
    /// \return the length of the step, s
    /// \throws unstable_run for a given step that is no longer safe
    double begin_step(state_type& s) {
        if (control_.needs_update()) update_critical_step(s);
        return previous_ = *time_step_;
    }
    /// Call it after a step.
    /// \param max_displacement upper bound of the path of every particle in the step, m
    /// \param remeshed whether the pores have a new mesh
    /// \throws unstable_run for a given step above the limit of the flow
    void end_step(state_type& s, real max_displacement, bool remeshed) {
        max_displacement_ = max_displacement;
        if (is_watched(s)) {
            double const path = std::max(double(max_displacement_), s.walls.fastest() * double(real(*time_step_)));
            double const deepest = std::max(s.pairs.take_deepest(), s.walls.take_deepest());
            control_.moved(path, deepest, !s.events.empty() || s.own_forces.active());
        }
        ++step_;
        if (remeshed || step_ % 64 == 0) enforce_flow_limit(s);
    }

    time_step_limits limits(state_type const& s) const;
    contact_assumption assumed_contacts(state_type const& s) const {
        return time_step_ ? control_.assumed() : next_assumption(s);
    }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(time_step_, control_, max_displacement_, step_, epoch_.time, epoch_.step, previous_);
        require_state(!time_step_ || (*time_step_ > 0 && std::isfinite(*time_step_)), "its time step");
        require_state(step_ >= 0 && step_ < (1LL << 62), "its number of steps");
    }

private:
    static bool is_given(state_type const& s) noexcept { return s.settings.time_step > 0; }
    /// Whether the bound is computed during the run.
    static bool is_watched(state_type const& s) noexcept { return !is_given(s) || !s.settings.allow_unstable_step; }
    /// Whether a step is positive and its inverse finite.
    static bool is_step(double step) noexcept { return real(step) > real(0) && std::isfinite(1 / real(step)); }

    time_step_limits find(state_type const& s, contact_assumption const& assumed) {
        return find_limits<Model>(s, assumed, time(), scratch_);
    }
    contact_assumption next_assumption(state_type const& s, bool wide = false, double reach = 0) const {
        return control_.next_assumption(s.store, s.pairs, s.walls, !is_given(s), wide, reach,
                                        double(s.guards.smallest_radius()), s.filled());
    }
    /// Updates the forecast of contacts in control_.
    void update_forecast(state_type const& s, double speed, double overlap) {
        control_.update_forecast(s.store, s.pairs, s.walls, s.settings.damping, speed, overlap, !is_given(s));
    }
    void record_update(state_type& s, contact_assumption const& assumed, double rigorous) {
        double const accurate = is_given(s) ? std::numeric_limits<double>::infinity()
                                            : 1.3 * s.settings.safety * control_.forecast().first_contact();
        control_.record_update(assumed, *time_step_, rigorous, accurate, !is_given(s), s.filled());
        s.pairs.watch_overlaps(control_.assumed().overlap);
    }

    /// Step to choose for a critical step, s. If nothing that is counted has a stiffness, a contact that may form
    /// determines it. At the present speeds nothing moves further than half of the default limit of checked_motion().
    double chosen_step(state_type const& s, double critical) const {
        double step = s.settings.safety * (std::isfinite(critical) ? critical : control_.forecast().first_contact());
        if (!std::isfinite(step)) return step;
        for (std::size_t k = 0; k < s.store.size(); ++k) {
            double const path = double(norm(s.store.velocity(k))) * step, most = 0.05 * double(s.store.radius(k));
            if (path > most) step *= most / path;
        }
        return std::min(step, 0.05 * double(s.guards.smallest_radius()) / s.walls.fastest_next());
    }
    double first_step(state_type const& s, time_step_limits const& found) const {
        double const critical = found.critical();
        if (is_given(s) && !s.settings.allow_unstable_step && !(s.settings.time_step <= critical))
            refuse("time_step", s.settings.time_step,
                   "at most the stable limit " + to_text(critical) + " s (of " +
                       (found.rigorous <= found.flow ? "the particles, with rotation and fluid stiffness"
                                                     : "the flow between pores") +
                       "; eq. 9 gives " + to_text(found.wave_limit) + " s), or allow_unstable_step");
        // If all particles are fixed, no step is too long, and eq. 9 gives a useful one.
        bool const free = std::isfinite(critical) || std::isfinite(control_.forecast().first_contact());
        double const step = is_given(s) ? s.settings.time_step : chosen_step(s, free ? critical : found.wave_limit);
        if (std::isinf(step))
            refuse("time_step", 0.0, "given: without any stiffness there is no critical time step");
        if (!is_step(step))
            refuse("time_step", step,
                   "longer, to be a step at all: a stiffness, a mass, a damping or a speed leaves the range of " +
                       precision_text<real>());
        return step;
    }
    void change_step(state_type const& s, double step) {
        if (!is_step(step))
            throw_unstable(s.store, now(), -1, "no time step is stable any more",
                           "a stiffness, a mass, a damping or a speed has left the range of " + precision_text<real>());
        epoch_ = {time(), step_};
        time_step_ = step;
    }

    /// Computes the bound again, because contacts have formed or got deeper.
    void update_critical_step(state_type& s) {
        double const speed = std::max(double(max_displacement_) / previous_, s.walls.fastest());
        if (is_given(s))
            check_given_step(s, speed);
        else
            follow_critical_step(s, speed);
    }
    void check_given_step(state_type& s, double speed) {
        auto assumed = next_assumption(s, control_.cannot_wait());
        auto found = find(s, assumed);
        if (control_.cannot_wait() && !(*time_step_ <= found.rigorous)) {
            // Near particles may pass each other: only contacts that are about to form may end the run.
            assumed = next_assumption(s);
            found = find(s, assumed);
        }
        update_forecast(s, speed, assumed.overlap);
        if (!(*time_step_ <= found.rigorous) && !s.settings.allow_unstable_step)
            throw_unstable(
                s.store, now(), -1,
                "the time step of " + to_text(*time_step_) + " s is above the stable limit, which is " +
                    to_text(found.rigorous) + " s by now",
                "contacts have formed or become stiffer, bonds have failed, or supports were released; without a "
                "given time_step the step follows the limit; allow_unstable_step ignores the limit");
        record_update(s, assumed, found.rigorous);
    }
    void follow_critical_step(state_type& s, double speed) {
        auto assumed = next_assumption(s, control_.cannot_wait(), 2 * speed * *time_step_);
        auto found = find(s, assumed);
        update_forecast(s, speed, assumed.overlap);
        if (double const longer = chosen_step(s, found.rigorous);
            longer > 1.05 * *time_step_ && 2 * speed * longer > assumed.gap) {
            // In a longer step particles can meet from further away.
            assumed = next_assumption(s, true, 2 * speed * longer);
            found = find(s, assumed);
        }
        double const critical = found.rigorous; // enforce_flow_limit() applies the limit of the fluid
        double const now = *time_step_, most = s.settings.safety * found.flow;
        double const wanted = speed > 0 ? std::min(chosen_step(s, critical), std::max(now, assumed.gap / (2 * speed)))
                                        : chosen_step(s, critical);
        // A slightly longer step is not worth a change.
        bool const follows = s.settings.follow_critical_step;
        bool const shrinks = follows ? wanted < 0.99 * now || now > critical : now > critical;
        bool const grows = follows && std::min(wanted, most) > 1.05 * now;
        if ((shrinks || grows) && std::isfinite(wanted)) change_step(s, std::min(wanted, most));
        record_update(s, assumed, found.rigorous);
    }

    /// Checks the limit of an explicit flow, which may have fallen below the step because throats have opened or the
    /// mesh is new. A chosen step is then chosen again; a given step ends the run.
    void enforce_flow_limit(state_type const& s) {
        if constexpr (has_fluid<Model>) {
            double const limit = flow_limit(*s.fluid.get());
            if (*time_step_ <= limit || s.settings.allow_unstable_step) return;
            if (is_given(s))
                throw_unstable(s.store, now(), -1,
                               "the flow between pores allows a time step of at most " + to_text(limit) +
                                   " s by now, less than " + to_text(*time_step_) + " s",
                               "throats have opened or pores have become small; flow.substeps = 0 makes as many flow "
                               "steps as are safe, implicit flow has no limit");
            change_step(s, s.settings.safety * limits(s).critical());
        }
    }

    /// When the present length began to apply.
    struct epoch {
        double time; ///< s
        long long step;
    };
    epoch epoch_;
    std::optional<double> time_step_;
    step_control<Model> control_;
    limit_scratch<dim> scratch_;
    double previous_ = 0;       // length of the last step, s
    real max_displacement_ = 0; // upper bound for every particle in the last step, m
    long long step_ = 0;
};
// Outside the class, for `extern template`: see explicit_stepper.
template <class Model>
void step_clock<Model>::resolve(state_type& s) {
    if (time_step_) return;
    if constexpr (has_fluid<Model>)
        if (!s.filled()) throw std::logic_error("simulation: the model has a fluid but fill_pores() was not called");
    control_.reset(s.filled());
    auto assumed = next_assumption(s);
    time_step_limits found = find(s, assumed);
    double speed = s.walls.fastest_next();
    for (std::size_t k = 0; k < s.store.size(); ++k) speed = std::max(speed, double(norm(s.store.velocity(k))));
    update_forecast(s, speed, assumed.overlap);
    if (double const reach = is_given(s) ? 0 : 2 * speed * chosen_step(s, found.critical());
        reach > assumed.gap && std::isfinite(reach)) {
        assumed = next_assumption(s, false, reach); // counts contacts that may form within the first step
        found = find(s, assumed);
    }
    time_step_ = first_step(s, found);
    record_update(s, assumed, found.rigorous);
}

template <class Model>
time_step_limits step_clock<Model>::limits(state_type const& s) const {
    limit_scratch<dim> scratch;
    return find_limits<Model>(s, assumed_contacts(s), time(), scratch);
}
LACUNA_END_PACKS

} // namespace lacuna
