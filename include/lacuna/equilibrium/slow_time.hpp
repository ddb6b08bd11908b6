// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/state.hpp>
#include <lacuna/simulation/guards.hpp>

namespace lacuna {

/// Parameters of steps in slow time, see equilibrium::advance().
struct slow_time_parameters {
    /// Length of the first step after a sudden change, s; > 0. The layer of pores that drains first should not drain
    /// within it: a sixth of the square of its width over the coefficient of consolidation is short enough.
    double first_step = 1e-6;
    double largest_step = std::numeric_limits<double>::infinity(); ///< s; >= first_step
    double smallest_step = 1e-15; ///< the run ends where steps must be shorter, s; > 0, at most first_step
    double growth = 1.25;         ///< largest ratio of a step to the one before, 1; > 1
    /// Largest local error of a pressure in a step, as a share of the largest pressure so far, 1; > 0. The error is
    /// estimated from the change of the rates. A step with a larger error is repeated with a shorter one.
    double tolerance = 5e-4;
    long long steps = 1000000; ///< largest number of steps of one call; >= 1

    /// \throws std::invalid_argument naming field, value and rule
    void validate(std::string const& name) const {
        require_positive(name + ".first_step", first_step);
        if (!(largest_step >= first_step)) refuse(name + ".largest_step", largest_step, ">= first_step");
        if (!(smallest_step > 0 && smallest_step <= first_step))
            refuse(name + ".smallest_step", smallest_step, "> 0 and at most first_step");
        if (!(growth > 1 && std::isfinite(growth))) refuse(name + ".growth", growth, "> 1 and finite");
        require_positive(name + ".tolerance", tolerance);
        require_in(name + ".steps", double(steps), 1, 1e15);
    }
};

/// How a run in slow time ended.
enum class slow_outcome {
    finished,      ///< at the end of the given time
    stopped,       ///< the observer asked for it, or after the largest number of steps
    mechanism,     ///< the particles have no equilibrium under their loads
    not_converged  ///< no step was found that converges
};

/// What a run in slow time did so far.
struct slow_result {
    slow_outcome outcome = slow_outcome::stopped;
    long long steps = 0;    ///< accepted steps
    long long repeated = 0; ///< steps that were repeated with a shorter one
    int factorisations = 0;
    std::size_t broken = 0; ///< bonds that failed; see equilibrium::events()
    double time_step = 0;   ///< length of the last step, s
    double error = 0;       ///< estimated error of the pressures in the last step, as a share of the largest, 1
    double unbalanced = 0;  ///< largest unbalanced force at the end of the last step, by the exact laws, N
    double largest_force = 0; ///< N

    bool finished() const noexcept { return outcome == slow_outcome::finished; }
};

/// What the next step in slow time needs of those before, besides the state of the simulation. It can be saved with a
/// checkpoint, like an observer: the run goes on with the same bits then.
class slow_history {
public:
    /// Forgets all steps: the next one is a first step.
    void clear() { *this = {}; }
    /// Whether the last step ended at this moment.
    bool continues(moment const& now) const noexcept { return now.step == step_ && now.time == time_; }

    /// Length to try for the next step, s. \param left time to the end, s
    double propose(slow_time_parameters const& p, double left) const noexcept {
        double const next = std::clamp(next_ > 0 ? next_ : p.first_step, p.smallest_step, p.largest_step);
        // No tiny step remains at the end.
        return left <= next * (1 + 1e-9) ? left : left < 2 * next ? 0.5 * left : next;
    }
    /// Largest error of a step's pressures by the change of their rates, as a share of the largest pressure, 1. The
    /// error of backward Euler is h^2 / 2 times the change of the rate per time. Of a first step nothing is known: 0.
    double error(std::vector<double> const& start, std::vector<double> const& end, double dt) const noexcept {
        if (rates_.size() != start.size()) return 0;
        double most = 0, scale = pressure_;
        for (std::size_t p = 0; p < start.size(); ++p) {
            most = std::max(most, std::fabs(end[p] - start[p] - rates_[p] * dt));
            scale = std::max({scale, std::fabs(start[p]), std::fabs(end[p])});
        }
        return most > 0 ? most * dt / (dt + last_) / scale : 0.0;
    }
    /// Length after which an error is within the tolerance, from the length that gave it, s.
    static double fitting(slow_time_parameters const& p, double dt, double error) noexcept {
        return error > 0 ? dt * 0.9 * std::sqrt(p.tolerance / error) : std::numeric_limits<double>::infinity();
    }
    /// Takes an accepted step.
    /// \param longest length of the next step, s, unless its error asks for a shorter one
    void accept(slow_time_parameters const& p, std::vector<double> const& start, std::vector<double> const& end,
                double dt, double longest) {
        next_ = std::min(longest, std::max(fitting(p, dt, error(start, end, dt)), 0.5 * dt));
        rates_.resize(start.size());
        for (std::size_t k = 0; k < start.size(); ++k) {
            rates_[k] = (end[k] - start[k]) / dt;
            pressure_ = std::max({pressure_, std::fabs(start[k]), std::fabs(end[k])});
        }
        last_ = dt;
    }
    /// The state after all that happened at one moment.
    void close(moment const& now) noexcept {
        step_ = now.step;
        time_ = now.time;
    }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(step_, time_, next_, last_, pressure_, rates_);
        require_state(next_ >= 0 && last_ >= 0, "the steps in slow time");
    }

private:
    long long step_ = -1; // of the simulation, and its time, at the end of the last step
    double time_ = 0;
    double next_ = 0, last_ = 0; // lengths of steps, s
    double pressure_ = 0;        // largest so far, Pa
    std::vector<double> rates_;  // of the pressures in the last step, Pa/s
};

} // namespace lacuna
