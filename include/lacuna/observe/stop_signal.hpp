// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <csignal>
#include <ctime>
#include <string>

#include <lacuna/observe/observer.hpp>

/// \file
/// Signals that ask a program to stop, as a wish that a run looks at after each step: so that it ends with whole files.

namespace lacuna {

namespace detail {
inline std::atomic<int> stop_signal_caught{0};
inline std::atomic<long long> stop_signal_time{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<long long>::is_always_lock_free);

/// ms
inline long long signal_clock() noexcept {
#if defined(CLOCK_MONOTONIC)
    std::timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long long)(now.tv_sec) * 1000 + now.tv_nsec / 1000000;
#else
    return (long long)(std::clock()) * 1000 / CLOCKS_PER_SEC;
#endif
}
} // namespace detail

/// The signal that asked to stop since watch_stop_signals() or request_stop(), 0 if none did.
inline int stop_signal() noexcept { return detail::stop_signal_caught.load(std::memory_order_relaxed); }

/// Asks as the signal would; safe in a signal handler. 0 takes the wish back.
inline void request_stop(int number) noexcept {
    detail::stop_signal_time = detail::signal_clock();
    detail::stop_signal_caught = number;
}

} // namespace lacuna

/// The first signal is a wish; a second, more than a second later, ends the program at once. Those in between belong to the
/// first: `timeout` and batch systems send a signal to the program and to its group.
extern "C" inline void lacuna_on_stop_signal(int number) {
    if (lacuna::stop_signal() == 0)
        lacuna::request_stop(number);
    else if (lacuna::detail::signal_clock() - lacuna::detail::stop_signal_time > 1000) {
        std::signal(number, SIG_DFL);
        std::raise(number);
    }
}

namespace lacuna {

/// From here on SIGINT, SIGTERM and SIGHUP (unless that is ignored, as under nohup) make stop_signal() say so, and SIGPIPE is
/// ignored: a run goes on when its output is no longer read. Programs call this; the library does not.
inline void watch_stop_signals() noexcept {
    std::signal(SIGINT, lacuna_on_stop_signal);
    std::signal(SIGTERM, lacuna_on_stop_signal);
#if defined(SIGHUP)
    if (std::signal(SIGHUP, lacuna_on_stop_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
#endif
#if defined(SIGPIPE)
    std::signal(SIGPIPE, SIG_IGN);
#endif
}

/// "SIGTERM" and so on.
inline std::string signal_name(int number) {
    switch (number) {
    case SIGINT: return "SIGINT";
    case SIGTERM: return "SIGTERM";
#if defined(SIGHUP)
    case SIGHUP: return "SIGHUP";
#endif
    default: return "signal " + std::to_string(number);
    }
}

/// Observer that ends a run after the step in which a signal came.
struct stop_on_signal {
    static constexpr stage stages = stage::step;
    template <class Simulation>
    run_control on_step(Simulation const&) const noexcept {
        return stop_signal() != 0 ? run_control::stop : run_control::go_on;
    }
};

} // namespace lacuna
