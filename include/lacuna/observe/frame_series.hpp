// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <utility>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/observer.hpp>

namespace lacuna {

/// Observer that writes a frame at the start of a run, after every n-th step, and at the end.
/// \tparam Writer has write(simulation const&, prefix, number): number is the step, in twelve digits
template <class Writer>
class frame_series {
public:
    static constexpr stage stages = stage::start | stage::step | stage::end;

    /// \param prefix what the files' names start with, directories included; these must be there
    /// \param every steps between frames
    /// \throws std::invalid_argument for less than one step
    frame_series(std::string prefix, long long every, Writer writer = {})
        : prefix_(std::move(prefix)), every_(every), writer_(std::move(writer)) {
        if (every < 1) refuse("frame_series.every", double(every), "at least 1");
    }
    /// \throws std::runtime_error when a file cannot be written
    template <class Simulation>
    void on_start(Simulation const& sim) {
        write(sim);
    }
    template <class Simulation>
    void on_step(Simulation const& sim) {
        if (sim.steps() % every_ == 0) write(sim);
    }
    template <class Simulation>
    void on_end(Simulation const& sim) {
        write(sim);
    }

private:
    template <class Simulation>
    void write(Simulation const& sim) {
        if (sim.steps() == last_) return;
        last_ = sim.steps();
        char number[24];
        std::snprintf(number, sizeof number, "%012lld", last_);
        writer_.write(sim, prefix_, number);
    }

    std::string prefix_;
    long long every_, last_ = -1;
    Writer writer_;
};

} // namespace lacuna
