// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <csignal>
#include <ctime>
#include <string>

#include <lacuna/observe/observer.hpp>

/// \file
/// Signals that ask a program to stop. A run checks for them after each step, so that it ends with complete files.

namespace lacuna {

namespace detail {
inline std::atomic<int> stop_signal_caught{0};
inline std::atomic<long long> stop_signal_time{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<long long>::is_always_lock_free);

/// Time for differences, ms.
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

/// The first signal that asked to stop, 0 if there was none. See watch_stop_signals() and request_stop().
inline int stop_signal() noexcept { return detail::stop_signal_caught.load(std::memory_order_relaxed); }

/// Acts like the arrival of a signal; safe in a signal handler. 0 withdraws the request.
inline void request_stop(int number) noexcept {
    detail::stop_signal_time = detail::signal_clock();
    detail::stop_signal_caught = number;
}

} // namespace lacuna

/// The first signal is a request; another one more than a second later ends the program at once. Signals in between
/// count as the first: `timeout` and batch systems send a signal to the program and to its group.
extern "C" inline void lacuna_on_stop_signal(int number) {
    if (lacuna::stop_signal() == 0)
        lacuna::request_stop(number);
    else if (lacuna::detail::signal_clock() - lacuna::detail::stop_signal_time > 1000) {
        std::signal(number, SIG_DFL);
        std::raise(number);
    }
}

namespace lacuna {

/// Installs handlers: from here on stop_signal() returns the number of a SIGINT, SIGTERM or SIGHUP. SIGHUP stays
/// ignored if it is, as under nohup. SIGPIPE is ignored, so that a run continues when its output is no longer read.
/// Programs call this function; the library does not.
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

/// The name of a signal, such as "SIGTERM".
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

/// Observer that ends a run after the step in which a signal has arrived.
struct stop_on_signal {
    static constexpr stage stages = stage::step;
    template <class Simulation>
    run_control on_step(Simulation const&) const noexcept {
        return stop_signal() != 0 ? run_control::stop : run_control::go_on;
    }
};

} // namespace lacuna
