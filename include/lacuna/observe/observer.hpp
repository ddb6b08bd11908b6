// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

#include <lacuna/core/error.hpp>
#include <lacuna/core/standard.hpp>

namespace lacuna {

/// Moments of a run at which an observer is called.
enum class stage : unsigned {
    start = 1,    ///< on_start(simulation const&), before the first step
    step = 2,     ///< on_step(simulation const&), after each step
    breakage = 4, ///< on_break(break_event const&, simulation const&), for each bond that fails, in order
    end = 8       ///< on_end(simulation const&), after the last step, also if the run was stopped
};
constexpr stage operator|(stage a, stage b) noexcept { return stage(unsigned(a) | unsigned(b)); }
constexpr bool has(stage set, stage one) noexcept { return (unsigned(set) & unsigned(one)) != 0; }

/// The result of on_step. An observer whose on_step returns void never stops a run.
enum class run_control { go_on, stop };

/// An observer is a class with one or more of the hooks that `stage` lists. A hook may be a template over the
/// simulation, or take one type of it; so a local class works too.
///
/// With `static constexpr stage stages` an observer declares its hooks. Each declared hook must be callable, and no
/// other may exist: a misspelt hook is a compile error. With `static constexpr bool needs_energy = true`, the energy
/// ledger is computed in all steps of its runs. With a member `bool needs_energy_in(long long step) const`, it is
/// computed in the steps for which this is true, counted from 0. After a step without it, a new ledger starts.
template <class O>
concept observer = std::is_class_v<std::remove_cvref_t<O>>;

/// Observer that calls `call(simulation const&)` after every step whose number is a multiple of the interval; see
/// every().
template <class Call>
class every_steps {
public:
    static constexpr stage stages = stage::step;

    /// \throws std::invalid_argument for an interval below 1
    every_steps(long long interval, Call call) : interval_(interval), call_(std::move(call)) {
        if (interval < 1) refuse("every.interval", double(interval), ">= 1");
    }
    template <class Simulation>
    auto on_step(Simulation const& sim) {
        using answer = decltype(call_(sim));
        if constexpr (std::is_same_v<answer, run_control>)
            return sim.steps() % interval_ == 0 ? call_(sim) : run_control::go_on;
        else if (sim.steps() % interval_ == 0)
            call_(sim);
    }

private:
    long long interval_;
    Call call_;
};
/// Observer that calls `call(simulation const&)` at the end of a run; see at_end().
template <class Call>
class at_end_of_run {
public:
    static constexpr stage stages = stage::end;
    explicit at_end_of_run(Call call) : call_(std::move(call)) {}
    template <class Simulation>
    void on_end(Simulation const& sim) {
        call_(sim);
    }

private:
    Call call_;
};

/// \code
/// sim.run(10000, lacuna::every(100, [&](auto const& s) { heights.push_back(s.position(0)[1]); }));
/// \endcode
/// \param interval steps from one call to the next, from step 0 of the simulation on
/// \param call callable(simulation const&); may return run_control::stop to end the run
/// \throws std::invalid_argument for an interval below 1
template <class Call>
auto every(long long interval, Call call) {
    return every_steps<Call>(interval, std::move(call));
}
/// \param call callable(simulation const&)
template <class Call>
auto at_end(Call call) {
    return at_end_of_run<Call>(std::move(call));
}

namespace detail {

template <class O>
inline constexpr bool needs_energy = requires { requires std::remove_cvref_t<O>::needs_energy; };

template <class O>
inline constexpr bool samples_energy = requires(std::remove_cvref_t<O> const& o, long long step) {
    { o.needs_energy_in(step) } -> std::convertible_to<bool>;
};
/// True if an observer needs the energy ledger in a step.
template <class O>
constexpr bool wants_energy([[maybe_unused]] O const& o, [[maybe_unused]] long long step) {
    if constexpr (samples_energy<O>)
        return o.needs_energy_in(step);
    else
        return needs_energy<O>;
}

template <class Answer>
inline constexpr bool is_answer_of_step = std::is_void_v<Answer> || std::is_same_v<Answer, run_control>;

/// Whether an observer lists its stages.
template <class O>
concept declares_stages = requires {
    { std::remove_cvref_t<O>::stages } -> std::convertible_to<stage>;
};
/// Whether a hook of that stage may be called: one that is declared, or any of an observer that declares none.
template <class O>
constexpr bool takes_part(stage one) {
    if constexpr (declares_stages<O>)
        return has(O::stages, one);
    else
        return true;
}

template <class Simulation, class Event, class O>
constexpr void check_observer() {
    using type = std::remove_cvref_t<O>;
    constexpr bool starts = requires(type& o, Simulation const& s) { o.on_start(s); };
    constexpr bool steps = requires(type& o, Simulation const& s) { o.on_step(s); };
    constexpr bool breaks = requires(type& o, Event const& e, Simulation const& s) { o.on_break(e, s); };
    constexpr bool ends = requires(type& o, Simulation const& s) { o.on_end(s); };
    if constexpr (steps)
        static_assert(is_answer_of_step<decltype(std::declval<type&>().on_step(std::declval<Simulation const&>()))>,
                      "on_step must return void or run_control");
    if constexpr (declares_stages<type>) {
        constexpr stage wanted = type::stages;
        static_assert(starts || !has(wanted, stage::start),
                      "observer declares stage::start but on_start(simulation const&) cannot be called");
        static_assert(steps || !has(wanted, stage::step),
                      "observer declares stage::step but on_step(simulation const&) cannot be called");
        static_assert(
            breaks || !has(wanted, stage::breakage),
            "observer declares stage::breakage but on_break(break_event const&, simulation const&) cannot be called");
        static_assert(ends || !has(wanted, stage::end),
                      "observer declares stage::end but on_end(simulation const&) cannot be called");
        // The opposite mistake: a hook without its declared stage would silently never be called.
        static_assert(!starts || has(wanted, stage::start), "on_start is not among the stages");
        static_assert(!steps || has(wanted, stage::step), "on_step is not among the stages");
        static_assert(!breaks || has(wanted, stage::breakage), "on_break is not among the stages");
        static_assert(!ends || has(wanted, stage::end), "on_end is not among the stages");
    } else {
        static_assert(starts || steps || breaks || ends,
                      "an observer needs one of on_start(simulation const&), on_step(simulation const&), "
                      "on_break(break_event const&, simulation const&), on_end(simulation const&)");
    }
}

// A hook that cannot be called has been refused by check_observer(); a call would only make the message longer.
template <class O, class Simulation>
void notify_start(O& o, Simulation const& s) {
    if constexpr (takes_part<O>(stage::start) && requires { o.on_start(s); }) o.on_start(s);
}
template <class O, class Event, class Simulation>
void notify_break(O& o, Event const& event, Simulation const& s) {
    if constexpr (takes_part<O>(stage::breakage) && requires { o.on_break(event, s); }) o.on_break(event, s);
}
/// \return whether the run may go on
template <class O, class Simulation>
bool notify_step(O& o, Simulation const& s) {
    if constexpr (takes_part<O>(stage::step) && requires { o.on_step(s); }) {
        if constexpr (!std::is_same_v<decltype(o.on_step(s)), run_control>)
            o.on_step(s);
        else
            return o.on_step(s) != run_control::stop;
    }
    return true;
}
template <class O, class Simulation>
void notify_end(O& o, Simulation const& s) {
    if constexpr (takes_part<O>(stage::end) && requires { o.on_end(s); }) o.on_end(s);
}

} // namespace detail
} // namespace lacuna
