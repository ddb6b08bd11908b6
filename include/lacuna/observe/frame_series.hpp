// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <utility>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/observer.hpp>

namespace lacuna {

/// Observer that writes a frame at the start of a run, after every n-th step, and at the end. A run that is resumed, from a
/// checkpoint or in another process, goes on with the series that is there: it may, but need not be given to
/// save_checkpoint() and load_checkpoint().
/// \tparam Writer has write(simulation const&, prefix, number): number is the step, in twelve digits; and, if its files are
///         more than one for each frame, resume(simulation const&, prefix), which brings those of an earlier part of the run
///         to what they were at the present time, and says how: see series_part
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
        bool const goes_back = sim.steps() < latest_;
        if (goes_back) last_ = -1;
        if constexpr (requires { writer_.resume(sim, prefix_); }) {
            if (sim.steps() > 0 && (latest_ < 0 || goes_back)) {
                auto const part = writer_.resume(sim, prefix_);
                latest_ = sim.steps();
                if (part.has_present) last_ = sim.steps();
                if (part.is_there) return;
            }
        }
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
    template <class Archive>
    void serialize(Archive& ar) {
        ar(last_);
    }

private:
    template <class Simulation>
    void write(Simulation const& sim) {
        if (sim.steps() == last_) return;
        last_ = latest_ = sim.steps();
        char number[24];
        std::snprintf(number, sizeof number, "%012lld", last_);
        writer_.write(sim, prefix_, number);
    }

    std::string prefix_;
    long long every_;
    long long last_ = -1;   // frame of the present run
    long long latest_ = -1; // frame that this object wrote, not part of a state
    Writer writer_;
};

/// What is left of an earlier part of a series.
struct series_part {
    bool is_there = false;    ///< frames up to the present time
    bool has_present = false; ///< that of the present time, too
};

} // namespace lacuna
