// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/neighbors/search.hpp>

namespace lacuna {

/// Checks every pair: cost n^2, no set-up. It suits a few hundred particles, and tests of the other searches.
template <class Real, int Dim>
class brute_force {
public:
    using real_type = Real;
    static constexpr int dim = Dim;

    /// See neighbor_search.
    void build(points_view<Real, Dim> const& points, Real cutoff) {
        detail::require_finite_points(points);
        detail::require_length("cutoff", cutoff);
        radii_.assign(points.size(), Real(0));
        store(points, cutoff);
    }
    void pairs(std::vector<neighbor_pair>& out) const {
        out.clear();
        for (std::size_t i = 0; i < points_.size(); ++i)
            for (std::size_t j = i + 1; j < points_.size(); ++j) {
                Real d2 = 0;
                for (int axis = 0; axis < Dim; ++axis) d2 = detail::add_square(d2, points_[i][axis] - points_[j][axis]);
                if (detail::in_reach(d2, radii_[i], radii_[j], margin_))
                    out.push_back({std::int32_t(i), std::int32_t(j)});
            }
    }
    void touching_pairs(points_view<Real, Dim> const& points, std::span<Real const> radii, Real margin,
                        std::vector<neighbor_pair>& out) {
        detail::require_finite_points(points);
        detail::require_radii(radii, points.size(), margin);
        radii_.assign(radii.begin(), radii.end());
        store(points, margin);
        pairs(out);
    }

private:
    void store(points_view<Real, Dim> const& points, Real margin) {
        margin_ = margin;
        points_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) points_[i] = points[i];
    }

    std::vector<vec<Real, Dim>> points_;
    std::vector<Real> radii_;
    Real margin_ = 0;
};

} // namespace lacuna
