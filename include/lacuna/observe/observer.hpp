// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

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

/// An observer declares its stages as `static constexpr stage stages`. The hook of each declared stage must be
/// callable: a misspelt or ill-typed hook is a compile error. With `static constexpr bool needs_energy = true`, the
/// energy ledger is computed in all steps of its runs. With a member `bool needs_energy_in(long long step) const`, it
/// is computed in the steps for which this is true, counted from 0. After a step without it, a new ledger starts.
template <class O>
concept observer = requires {
    { std::remove_cvref_t<O>::stages } -> std::convertible_to<stage>;
};

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

template <class Simulation, class Event, class O>
constexpr void check_observer() {
    using type = std::remove_cvref_t<O>;
    constexpr stage wanted = type::stages;
    if constexpr (has(wanted, stage::start))
        static_assert(requires(type & o, Simulation const& s) { o.on_start(s); },
                      "observer declares stage::start but on_start(simulation const&) cannot be called");
    if constexpr (has(wanted, stage::step))
        static_assert(requires(type & o, Simulation const& s) { o.on_step(s); },
                      "observer declares stage::step but on_step(simulation const&) cannot be called");
    if constexpr (requires(type & o, Simulation const& s) { o.on_step(s); })
        static_assert(is_answer_of_step<decltype(std::declval<type&>().on_step(std::declval<Simulation const&>()))>,
                      "on_step must return void or run_control");
    if constexpr (has(wanted, stage::breakage))
        static_assert(requires(type & o, Event const& e, Simulation const& s) { o.on_break(e, s); },
                      "observer declares stage::breakage but on_break(break_event const&, simulation const&) "
                      "cannot be called");
    if constexpr (has(wanted, stage::end))
        static_assert(requires(type & o, Simulation const& s) { o.on_end(s); },
                      "observer declares stage::end but on_end(simulation const&) cannot be called");
    // The opposite mistake: a hook without its declared stage would silently never be called.
    if constexpr (!has(wanted, stage::start))
        static_assert(!requires(type & o, Simulation const& s) { o.on_start(s); }, "on_start is not among the stages");
    if constexpr (!has(wanted, stage::step))
        static_assert(!requires(type & o, Simulation const& s) { o.on_step(s); }, "on_step is not among the stages");
    if constexpr (!has(wanted, stage::breakage))
        static_assert(!requires(type & o, Event const& e, Simulation const& s) { o.on_break(e, s); },
                      "on_break is not among the stages");
    if constexpr (!has(wanted, stage::end))
        static_assert(!requires(type & o, Simulation const& s) { o.on_end(s); }, "on_end is not among the stages");
}

// check_observer() has refused hooks that cannot be called; calling them here would only lengthen the error message.
template <class O, class Simulation>
void notify_start(O& o, Simulation const& s) {
    if constexpr (has(O::stages, stage::start) && requires { o.on_start(s); }) o.on_start(s);
}
template <class O, class Event, class Simulation>
void notify_break(O& o, Event const& event, Simulation const& s) {
    if constexpr (has(O::stages, stage::breakage) && requires { o.on_break(event, s); }) o.on_break(event, s);
}
/// \return true if the run may continue
template <class O, class Simulation>
bool notify_step(O& o, Simulation const& s) {
    if constexpr (has(O::stages, stage::step) && requires { o.on_step(s); }) {
        if constexpr (!std::is_same_v<decltype(o.on_step(s)), run_control>)
            o.on_step(s);
        else
            return o.on_step(s) != run_control::stop;
    }
    return true;
}
template <class O, class Simulation>
void notify_end(O& o, Simulation const& s) {
    if constexpr (has(O::stages, stage::end) && requires { o.on_end(s); }) o.on_end(s);
}

} // namespace detail
} // namespace lacuna
