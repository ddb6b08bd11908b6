// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Upper bounds of what any particle moved in one step, m.
template <class Real>
struct largest_motion {
    Real path = 0; ///< of the centres
    Real arc = 0;  ///< of the surfaces, by spin
};

/// Tells a time step above the stable one from physics that grows: a row that buckles, a load that rises, an impact.
///
/// Above the stable step a mode is multiplied by a number below -1 in each step: what it moves turns round in nearly every
/// step, while it grows. All that grows by itself otherwise keeps its sign. So once the largest speed has grown fourfold
/// in each of two runs of sixteen steps, the few fastest particles are followed, and only when they turn round in nearly
/// every step of a further run, in which the speed grows fourfold again, energy runs away. The same for spins.
template <class Real, int Dim>
class growth_watch {
public:
    static constexpr int window = 16;

    /// Looks at the state after a step.
    /// \param least below which motion is nothing but rounding, m
    void look(particle_store<Real, Dim> const& store, long long step, largest_motion<Real> const& moved, Real least) noexcept {
        if (follows_) count_turns(store);
        if (step % window != 0) return;
        std::array<Real, 2> const now{moved.path, moved.arc};
        bool suspicious = false;
        runs_away_ = false;
        for (std::size_t kind = 0; kind < 2; ++kind) {
            bool const again = now[kind] > least && before_[kind] > 0 && now[kind] >= 4 * before_[kind];
            growing_[kind] = again ? growing_[kind] + 1 : 0;
            runs_away_ = runs_away_ || (again && turns_round(kind));
            suspicious = suspicious || growing_[kind] >= 2;
        }
        before_ = now;
        follows_ = suspicious;
        if (suspicious) follow_fastest(store);
    }
    /// What the last run of sixteen steps says.
    bool runs_away() const noexcept { return runs_away_; }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(before_, growing_, runs_away_, follows_, followed_);
    }
    /// Whether all that is followed are particles below `count`.
    bool fits(std::size_t count) const noexcept {
        for (auto const& kind : followed_)
            for (one const& f : kind)
                if (f.particle >= std::int64_t(count) || f.particle < -1) return false;
        return true;
    }

private:
    struct one {
        std::int32_t particle = -1; // none
        std::int32_t turns = 0;     // how often its velocity, or spin, has turned round
        vec<Real, 3> speed{};       // its velocity, or spin times radius, in the last step
    };
    /// A velocity, or a spin as the surface sees it, m/s.
    static vec<Real, 3> speed_of(particle_store<Real, Dim> const& store, std::size_t k, std::size_t kind) noexcept {
        vec<Real, 3> v{};
        if (kind == 0) {
            auto const u = store.velocity(k);
            for (int axis = 0; axis < Dim; ++axis) v[axis] = u[axis];
        } else {
            auto const w = store.spin(k) * store.radius(k);
            for (int axis = 0; axis < rotation_dim<Dim>; ++axis) v[axis] = w[axis];
        }
        return v;
    }
    void count_turns(particle_store<Real, Dim> const& store) noexcept {
        for (std::size_t kind = 0; kind < 2; ++kind)
            for (one& f : followed_[kind]) {
                if (f.particle < 0) continue;
                auto const now = speed_of(store, std::size_t(f.particle), kind);
                if (dot(now, f.speed) < 0) ++f.turns;
                f.speed = now;
            }
    }
    /// Whether at least half of those that are followed have turned round in all but three steps of a window.
    bool turns_round(std::size_t kind) const noexcept {
        if (!follows_) return false;
        int all = 0, turning = 0;
        for (one const& f : followed_[kind]) {
            all += f.particle >= 0;
            turning += f.particle >= 0 && f.turns >= window - 3;
        }
        return all > 0 && 2 * turning >= all;
    }
    void follow_fastest(particle_store<Real, Dim> const& store) noexcept {
        for (std::size_t kind = 0; kind < 2; ++kind) {
            auto& fastest = followed_[kind];
            fastest = {};
            for (std::size_t k = 0; k < store.size(); ++k) {
                one next{std::int32_t(k), 0, speed_of(store, k, kind)};
                for (one& f : fastest)
                    if (squared_norm(next.speed) > squared_norm(f.speed)) std::swap(f, next);
            }
        }
    }

    std::array<Real, 2> before_{};
    std::array<int, 2> growing_{};
    std::array<std::array<one, 4>, 2> followed_{}; // by speed, by spin
    bool follows_ = false, runs_away_ = false;
};

} // namespace lacuna
