// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <lacuna/core/vec.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Tells motion that is lost to rounding: a particle so far from the origin that the path of a step is less than half of the
/// spacing of numbers there stays where it is, whatever its velocity.
///
/// One particle is followed at a time, while its velocity stays what it is; once velocity times time has come to sixteen
/// spacings, its displacement has to be that within a half. A body at rest is never followed that far: its small forces
/// change what velocity rounding leaves to it. Those are followed whose velocity is known to mean something: that have just
/// been given one, that move as prescribed, and, where nothing damps, the fastest.
template <class Real, int Dim>
class resolution_watch {
public:
    struct finding {
        std::int32_t particle = -1; ///< internal index; -1: none
        double meant = 0;           ///< path by velocity times time, m
        double made = 0;            ///< path by its places, m
        double spacing = 0;         ///< of numbers at its place, m
    };

    bool follows() const noexcept { return particle_ >= 0; }
    /// From its present place on. \param change of the velocity, over the velocity, at which it is followed no longer
    void follow(particle_store<Real, Dim> const& store, std::int32_t k, Real change) noexcept {
        particle_ = k;
        change_ = change;
        begun_ = false;
        place_ = convert<double>(store.position(std::size_t(k)));
        path_ = {};
    }
    /// Of the particles that move as prescribed, the first whose step is lost by more than a half; -1: none.
    static std::int32_t find_held(particle_store<Real, Dim> const& store, Real time_step) noexcept {
        for (std::size_t k = 0; k < store.size(); ++k) {
            Real meant = 0, lost = 0;
            for (int axis = 0; axis < Dim; ++axis) {
                if (!store.held(k, axis)) continue;
                Real const way = store.velocity(k)[axis] * time_step, place = store.position(k)[axis];
                Real const made = Real(place + way) - place;
                meant += way * way;
                lost += (made - way) * (made - way);
            }
            if (4 * lost > meant) return std::int32_t(k);
        }
        return -1;
    }
    /// Looks at the state after a step.
    finding look(particle_store<Real, Dim> const& store, double time_step) noexcept {
        if (!follows()) return {};
        auto const k = std::size_t(particle_);
        auto const velocity = store.velocity(k);
        if (!begun_) velocity_ = velocity;
        begun_ = true;
        if (!(norm(velocity - velocity_) <= change_ * norm(velocity_)) || !(squared_norm(velocity) > 0)) return stop({});
        path_ += convert<double>(velocity) * time_step;
        Real far = 0;
        for (int axis = 0; axis < Dim; ++axis) far = std::max(far, std::abs(store.position(k)[axis]));
        double const spacing = double(std::nextafter(far, std::numeric_limits<Real>::infinity()) - far);
        double const meant = norm(path_);
        if (meant < 16 * spacing) return {};
        auto const made = store.nearest(convert<double>(store.position(k)) - place_);
        if (norm(made - path_) <= 0.5 * meant) return stop({});
        return stop({particle_, meant, norm(made), spacing});
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(particle_, change_, begun_, velocity_, place_, path_);
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
    vec<double, Dim> place_{}, path_{};
};

} // namespace lacuna
