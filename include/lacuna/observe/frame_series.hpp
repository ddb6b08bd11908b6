// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <utility>

#include <lacuna/core/error.hpp>
#include <lacuna/observe/observer.hpp>

namespace lacuna {

/// Observer that writes a frame at the start of a run, after every n-th step, and at the end. A resumed simulation
/// continues the existing series. You may pass the observer to save_checkpoint() and load_checkpoint(), but need not.
/// \tparam Writer has write(simulation const&, prefix, number), where number is the step in twelve digits. If it also
/// has files that span frames, it has resume(simulation const&, prefix), which resets those of an earlier part of the
/// simulation to the current time and returns a series_part.
template <class Writer>
class frame_series {
public:
    static constexpr stage stages = stage::start | stage::step | stage::end;

    /// \param prefix beginning of the file names, including directories, which must exist
    /// \param every number of steps between frames
    /// \throws std::invalid_argument for less than one step
    frame_series(std::string prefix, long long every, Writer writer = {})
        : prefix_(std::move(prefix)), every_(every), writer_(std::move(writer)) {
        if (every < 1) refuse("frame_series.every", double(every), "at least 1");
    }
    /// \throws std::runtime_error if a file cannot be written
    template <class Simulation>
    void on_start(Simulation const& sim) {
        bool const goes_back = sim.steps() < latest_;
        if (goes_back) last_ = -1;
        if constexpr (requires { writer_.resume(sim, prefix_); }) {
            if (sim.steps() > 0 && (latest_ < 0 || goes_back)) {
                auto const part = writer_.resume(sim, prefix_);
                latest_ = sim.steps();
                if (part.has_current) last_ = sim.steps();
                if (part.exists) return;
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
    long long last_ = -1;   // step of the last frame; part of the state
    long long latest_ = -1; // step of the last frame that this object wrote; not part of the state
    Writer writer_;
};

/// The remains of an earlier part of a series.
struct series_part {
    bool exists = false;      ///< it has frames up to the current time
    bool has_current = false; ///< it has the frame of the current time, too
};

} // namespace lacuna
