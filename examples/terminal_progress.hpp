// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <optional>

#include <lacuna/observe/observer.hpp>
#include <lacuna/observe/progress.hpp>

/// \file
/// How far a run is, on a terminal.

namespace programs {

/// Shows percent, rate and time left in one line on stderr where that is a terminal; elsewhere nothing. An observer of
/// simulations, too.
class terminal_progress {
public:
    static constexpr lacuna::stage stages = lacuna::stage::step;

    /// \param wanted false: nothing is shown
    explicit terminal_progress(bool wanted = true) : sink_(wanted && lacuna::is_terminal(stderr) ? stderr : nullptr) {}

    /// A run begins. \param steps about so many \param from the number of steps done before it
    void begin(double steps, std::size_t particles, long long from = 0) {
        finish();
        lacuna::progress_options how;
        how.sink = sink_;
        how.steps = whole(steps);
        how.particles = std::max(1LL, static_cast<long long>(particles));
        how.terminal = true;
        from_ = done_ = from;
        reporter_.emplace(how);
    }
    /// The run turns out to be about so many steps long.
    void expect(double steps) {
        if (sink_ != nullptr && reporter_) reporter_->expect(whole(steps));
    }
    /// \param step the number of steps done, those before the run included
    void passed(long long step) {
        if (sink_ == nullptr || !reporter_) return;
        done_ = step;
        reporter_->update(done_ - from_);
    }
    template <class Simulation>
    void on_step(Simulation const& sim) {
        passed(sim.steps());
    }
    /// The run has ended: what is said next stands on a line of its own.
    void finish() {
        if (sink_ != nullptr && reporter_) reporter_->finish(done_ - from_);
        reporter_.reset();
    }

private:
    static long long whole(double steps) { return steps >= 1 ? static_cast<long long>(std::min(steps, 1e15)) : 1; }

    std::FILE* sink_;
    std::optional<lacuna::progress_reporter<>> reporter_;
    long long from_ = 0, done_ = 0;
};

} // namespace programs
