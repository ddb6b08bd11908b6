// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>

namespace lacuna {

/// Prescribed velocities of particles: each changes linearly from the current velocity to the target and then stays
/// there. A particle that has reached its target costs nothing.
template <int Dim>
class prescribed_motion {
public:
    using point = vec<double, Dim>;

    /// Replaces the prescribed velocity of a particle.
    /// \param k internal index
    /// \param from current velocity, m/s
    /// \param to target velocity, m/s
    /// \param ramp_time duration of the change, which begins at `now`, s; > 0
    /// \param now current time, s
    void add(std::size_t k, point const& from, point const& to, double ramp_time, double now) {
        forget(k);
        rising_.push_back({k, from, to, now, ramp_time});
    }
    /// Removes the prescribed velocity of a particle, if there is one.
    void forget(std::size_t k) {
        std::erase_if(rising_, [&](one const& r) { return r.particle == k; });
    }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(rising_);
    }

    /// Sum over all motions of hash(particle, from, to, ramp time). It does not depend on their order.
    template <class Hash>
    std::uint64_t sum_of_motions(Hash const& hash) const {
        std::uint64_t sum = 0;
        for (one const& r : rising_) sum += hash(r.particle, r.from, r.to, r.ramp_time);
        return sum;
    }

    /// True if all motions belong to particles with an index below `count`.
    bool fits(std::size_t count) const noexcept {
        for (one const& r : rising_)
            if (r.particle >= count) return false;
        return true;
    }

    /// Calls set(k, velocity) for each particle whose velocity still changes, with its mean velocity over the step from
    /// `time` to `time + time_step`, s.
    template <class Set>
    void advance(double time, double time_step, Set const& set) {
        if (rising_.empty()) return;
        auto const risen = [](one const& r, double t) { // integral of the share of the change over time, s
            double const u = t - r.start;
            return u <= 0 ? 0.0 : u < r.ramp_time ? 0.5 * u * u / r.ramp_time : u - 0.5 * r.ramp_time;
        };
        for (one const& r : rising_) {
            double const share = (risen(r, time + time_step) - risen(r, time)) / time_step;
            set(r.particle, r.from + (r.to - r.from) * share);
        }
        forget_finished(time);
    }

private:
    void forget_finished(double time) {
        std::erase_if(rising_, [&](one const& r) { return time >= r.start + r.ramp_time; });
    }

    struct one {
        std::size_t particle;
        point from, to;
        double start, ramp_time;
    };
    std::vector<one> rising_;
};

} // namespace lacuna
