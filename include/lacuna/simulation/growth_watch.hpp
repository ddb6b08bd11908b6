// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Upper bounds of the motion of all particles in one step, m.
template <class Real>
struct largest_motion {
    Real path = 0; ///< of the centres
    Real arc = 0;  ///< of the surfaces, by spin
};

/// Distinguishes a time step above the stable limit from physical growth: a row that buckles, a load that rises, an
/// impact.
///
/// Above the stable step a mode is multiplied by a number below -1 in each step. Velocities then grow and reverse in
/// nearly every step. Physical growth keeps its sign. The watch works in windows of 16 steps. Once the largest speed
/// has grown fourfold in each of two windows, it follows the few fastest particles. Energy runs away if the speed grows
/// fourfold in a further window and these particles reverse in nearly every step of it. Spins are watched in the same
/// way.
template <class Real, int Dim>
class growth_watch {
public:
    static constexpr int window = 16;

    /// Examines the state after a step.
    /// \param least motion below this is rounding, m
    void look(particle_store<Real, Dim> const& store, long long step, largest_motion<Real> const& moved,
              Real least) noexcept {
        if (follows_) count_reversals(store);
        if (step % window != 0) return;
        std::array<Real, 2> const now{moved.path, moved.arc};
        bool suspicious = false;
        runs_away_ = false;
        for (std::size_t kind = 0; kind < 2; ++kind) {
            bool const again = now[kind] > least && before_[kind] > 0 && now[kind] >= 4 * before_[kind];
            growing_[kind] = again ? growing_[kind] + 1 : 0;
            runs_away_ = runs_away_ || (again && oscillates(kind));
            suspicious = suspicious || growing_[kind] >= 2;
        }
        before_ = now;
        follows_ = suspicious;
        if (suspicious) follow_fastest(store);
    }
    /// Whether energy ran away in the last complete window.
    bool runs_away() const noexcept { return runs_away_; }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(before_, growing_, runs_away_, follows_, followed_);
    }
    /// Whether all followed particles have indices below `count`.
    bool fits(std::size_t count) const noexcept {
        for (auto const& kind : followed_)
            for (one const& f : kind)
                if (f.particle >= std::int64_t(count) || f.particle < -1) return false;
        return true;
    }

private:
    struct one {
        std::int32_t particle = -1; // none
        std::int32_t reversals = 0; // number of reversals of its velocity or spin
        vec<Real, 3> speed{};       // its velocity, or spin times radius, in the last step
    };
    /// Velocity (kind 0), or spin times radius (kind 1), m/s.
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
    void count_reversals(particle_store<Real, Dim> const& store) noexcept {
        for (std::size_t kind = 0; kind < 2; ++kind)
            for (one& f : followed_[kind]) {
                if (f.particle < 0) continue;
                auto const now = speed_of(store, std::size_t(f.particle), kind);
                if (dot(now, f.speed) < 0) ++f.reversals;
                f.speed = now;
            }
    }
    /// Whether at least half of the followed particles have reversed in all but three steps of a window.
    bool oscillates(std::size_t kind) const noexcept {
        if (!follows_) return false;
        int all = 0, oscillating = 0;
        for (one const& f : followed_[kind]) {
            all += f.particle >= 0;
            oscillating += f.particle >= 0 && f.reversals >= window - 3;
        }
        return all > 0 && 2 * oscillating >= all;
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
