// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <optional>

#include <lacuna/observe/observer.hpp>
#include <lacuna/observe/progress.hpp>

/// \file
/// Progress of a run on a terminal.

namespace programs {

/// Shows percentage, rate and remaining time in one line on stderr if stderr is a terminal, otherwise nothing. It can
/// observe a simulation.
class terminal_progress {
public:
    static constexpr lacuna::stage stages = lacuna::stage::step;

    /// \param wanted false: shows nothing
    explicit terminal_progress(bool wanted = true) : sink_(wanted && lacuna::is_terminal(stderr) ? stderr : nullptr) {}

    /// Starts the display for a run.
    /// \param steps estimated number of steps
    /// \param particles number of particles, for the rate
    /// \param from number of steps done before
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
    /// Corrects the estimated number of steps.
    void expect(double steps) {
        if (sink_ != nullptr && reporter_) reporter_->expect(whole(steps));
    }
    /// Updates the display. \param step number of steps done, including those before the run
    void passed(long long step) {
        if (sink_ == nullptr || !reporter_) return;
        done_ = step;
        reporter_->update(done_ - from_);
    }
    template <class Simulation>
    void on_step(Simulation const& sim) {
        passed(sim.steps());
    }
    /// Ends the display; later output starts on a new line.
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
