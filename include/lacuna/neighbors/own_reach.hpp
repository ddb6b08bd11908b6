// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <lacuna/core/points.hpp>

namespace lacuna {

/// The median radius, m; 0 without particles. A single very large or small particle does not change it.
template <class Real>
Real median_radius(std::span<Real const> radii) {
    if (radii.empty()) return Real(0);
    std::vector<Real> sorted(radii.begin(), radii.end());
    auto const middle = sorted.begin() + std::ptrdiff_t((sorted.size() - 1) / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

/// The distance that each particle may move before a neighbour list must be rebuilt, m. It is half a skin, and more for
/// a few particles that are much faster than the others, so that these do not force rebuilds for all.
template <class Real, int Dim>
class own_reach {
public:
    /// Sets the reach of all particles to half a skin, m.
    void reset(std::size_t particles, Real half) {
        half_ = half;
        own_.assign(particles, half);
    }
    /// Chooses the reaches from the displacements of the particles during the life of the last list.
    /// \param points current positions, m
    /// \param before positions when the last list was built, m; ignored if their number differs
    /// \param half half a skin, m
    /// \param room largest reach that a particle may get, m
    void choose(points_view<Real, Dim> const& points, std::vector<vec<Real, Dim>> const& before,
                std::span<Real const> radii, Real half, Real room) {
        reset(points.size(), half);
        Real const typical = median_radius(radii);
        if (!(room >= Real(1.5) * half) || !(half > 0) || !(typical > 0)) return;
        for (std::size_t i = 0; i < radii.size(); ++i)
            if (radii[i] > 4 * typical) own_[i] = Real(1.5) * half;
        if (before.size() != points.size() || points.size() == 0) return;
        std::size_t const few = std::max<std::size_t>(1, points.size() / 256);
        moved_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) moved_[i] = squared_norm(points[i] - before[i]);
        sorted_ = moved_;
        auto const last = sorted_.end() - std::ptrdiff_t(std::min(few + 1, sorted_.size()));
        std::nth_element(sorted_.begin(), last, sorted_.end());
        Real const others = std::sqrt(points.size() > 1 ? *last : Real(0));
        Real const fast = std::max(2 * others, half);
        std::size_t count = 0;
        for (Real const d2 : moved_) count += d2 > fast * fast;
        if (count == 0 || count > few) return;
        // Together the fast particles get at most as many candidates as 1/32 of all particles, or 32.
        Real const share = std::max(Real(32), Real(points.size()) / 32) / Real(count);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!(moved_[i] > fast * fast)) continue;
            Real const wanted = Real(1.25) * std::sqrt(moved_[i]) * (half / std::max(others, half / 64));
            Real const most = std::min({wanted + half / 2, within(share, radii[i], typical), room});
            if (most > Real(1.5) * half) own_[i] = most;
        }
    }

    Real operator[](std::size_t i) const noexcept { return own_[i]; }
    /// True if a particle's reach is half a skin, as for almost all. Any other reach is at least 1.5 times as large.
    bool ordinary(std::size_t i) const noexcept { return own_[i] == half_; }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(own_);
    }
    std::size_t size() const noexcept { return own_.size(); }

private:
    /// The distance from a particle's surface within which there are about `count` particles of the typical radius, m.
    static Real within(Real count, Real radius, Real typical) noexcept {
        Real const n = radius / typical;
        Real const filled = Dim == 2 ? std::sqrt(count + n * n) : std::cbrt(count + n * n * n);
        return (filled - n) * typical;
    }

    Real half_ = 0;
    std::vector<Real> own_;
    std::vector<Real> moved_, sorted_;
};

} // namespace lacuna
