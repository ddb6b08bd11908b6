// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lacuna/core/points.hpp>

namespace lacuna {

/// The particles that have moved far since a neighbour list was built. Their pairs are checked one by one.
template <class Real, int Dim>
class fast_particles {
public:
    using point = vec<Real, Dim>;

    /// Removes all.
    /// \param particles number of all particles
    void clear(std::size_t particles) {
        fast_.clear();
        most_ = 64 + particles / 16;
        fast_.reserve(most_ + 1);
    }
    void add(std::size_t i) {
        if (!too_many()) fast_.push_back(std::int32_t(i));
    }
    /// True if so many particles move far that checking their pairs does not pay.
    bool too_many() const noexcept { return fast_.size() > most_; }

    /// The largest approach of two of them that are not listed as a pair, m; at least `start`.
    /// \param points current positions, m
    /// \param reference positions when the list was built, m
    /// \param listed gap up to which pairs were listed, m
    /// \param near distance at that time beyond which two particles cannot have met since, m
    Real largest_approach(Real start, points_view<Real, Dim> const& points, std::vector<point> const& reference,
                          std::span<Real const> radii, Real listed, Real near) {
        auto const was = [&](std::size_t k) { return reference[std::size_t(fast_[k])]; };
        int const along = widest_axis(reference);
        std::sort(fast_.begin(), fast_.end(), [&](std::int32_t a, std::int32_t b) {
            return reference[std::size_t(a)][along] < reference[std::size_t(b)][along];
        });
        Real approach = start;
        for (std::size_t a = 0; a < fast_.size(); ++a)
            for (std::size_t b = a + 1; b < fast_.size() && was(b)[along] - was(a)[along] <= near; ++b) {
                auto const i = std::size_t(fast_[a]), j = std::size_t(fast_[b]);
                Real const before = norm(was(b) - was(a)), touching = radii[i] + radii[j];
                if (before <= near && before > touching + listed)
                    approach = std::max(approach, touching + listed - norm(points[j] - points[i]));
            }
        return approach;
    }

private:
    int widest_axis(std::vector<point> const& reference) const noexcept {
        int widest = 0;
        Real most = 0;
        for (int axis = 0; axis < Dim; ++axis) {
            auto const [low, high] =
                std::minmax_element(fast_.begin(), fast_.end(), [&](std::int32_t a, std::int32_t b) {
                    return reference[std::size_t(a)][axis] < reference[std::size_t(b)][axis];
                });
            Real const width = reference[std::size_t(*high)][axis] - reference[std::size_t(*low)][axis];
            if (width > most) widest = axis;
            most = std::max(most, width);
        }
        return widest;
    }

    std::vector<std::int32_t> fast_;
    std::size_t most_ = 0;
};

} // namespace lacuna
