// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <lacuna/core/vec.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Detects motion that is lost to rounding. A particle far from the origin does not move at all, whatever its velocity,
/// if its path in a step is less than half of the spacing of numbers there.
///
/// The watch follows one particle at a time, while its velocity hardly changes. Once velocity times time reaches
/// sixteen spacings, the displacement has to agree with it within a half. A particle at rest is never followed that
/// far, because small forces keep changing its velocity. Only particles with a meaningful velocity are followed: one
/// that was just given a velocity, one with a prescribed motion and, without damping, the fastest.
template <class Real, int Dim>
class resolution_watch {
public:
    struct finding {
        std::int32_t particle = -1; ///< internal index; -1: none
        double expected = 0;        ///< path by velocity times time, m
        double actual = 0;          ///< path by its positions, m
        double spacing = 0;         ///< spacing of numbers at its position, m
    };

    bool follows() const noexcept { return particle_ >= 0; }
    /// Starts to follow particle k at its present position.
    /// \param change the watch ends once the relative change of the velocity exceeds this, 1
    void follow(particle_store<Real, Dim> const& store, std::int32_t k, Real change) noexcept {
        particle_ = k;
        change_ = change;
        begun_ = false;
        start_ = convert<double>(store.position(std::size_t(k)));
        path_ = {};
    }
    /// First particle with a prescribed motion of which rounding takes more than half in a step; -1: none.
    static std::int32_t find_held(particle_store<Real, Dim> const& store, Real time_step) noexcept {
        for (std::size_t k = 0; k < store.size(); ++k) {
            Real expected = 0, lost = 0;
            for (int axis = 0; axis < Dim; ++axis) {
                if (!store.held(k, axis)) continue;
                Real const path = store.velocity(k)[axis] * time_step, position = store.position(k)[axis];
                Real const actual = Real(position + path) - position;
                expected += path * path;
                lost += (actual - path) * (actual - path);
            }
            if (4 * lost > expected) return std::int32_t(k);
        }
        return -1;
    }
    /// Examines the state after a step.
    /// \return a particle whose motion is lost to rounding, or none
    finding look(particle_store<Real, Dim> const& store, double time_step) noexcept {
        if (!follows()) return {};
        auto const k = std::size_t(particle_);
        auto const velocity = store.velocity(k);
        if (!begun_) velocity_ = velocity;
        begun_ = true;
        if (!(norm(velocity - velocity_) <= change_ * norm(velocity_)) || !(squared_norm(velocity) > 0))
            return stop({});
        path_ += convert<double>(velocity) * time_step;
        Real far = 0;
        for (int axis = 0; axis < Dim; ++axis) far = std::max(far, std::abs(store.position(k)[axis]));
        double const spacing = double(std::nextafter(far, std::numeric_limits<Real>::infinity()) - far);
        double const expected = norm(path_);
        if (expected < 16 * spacing) return {};
        auto const actual = store.nearest(convert<double>(store.position(k)) - start_);
        if (norm(actual - path_) <= 0.5 * expected) return stop({});
        return stop({particle_, expected, norm(actual), spacing});
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(particle_, change_, begun_, velocity_, start_, path_);
    }
    bool fits(std::size_t count) const noexcept { return particle_ >= -1 && particle_ < std::int64_t(count); }

private:
    finding stop(finding const& f) noexcept {
        particle_ = -1;
        return f;
    }

    std::int32_t particle_ = -1;
    Real change_ = 0;
    bool begun_ = false;
    vec<Real, Dim> velocity_{};
    vec<double, Dim> start_{}, path_{};
};

} // namespace lacuna
