// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <lacuna/observe/observer.hpp>

namespace lacuna {

/// Observer that records every bond failure of a run, in order.
/// \tparam Event the simulation's break_event
template <class Event>
class crack_record {
public:
    static constexpr stage stages = stage::breakage;

    template <class Simulation>
    void on_break(Event const& event, Simulation const&) {
        events_.push_back(event);
    }
    std::vector<Event> const& events() const noexcept { return events_; }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(events_);
    }

private:
    std::vector<Event> events_;
};

} // namespace lacuna
