// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <lacuna/neighbors/own_reach.hpp>
#include <lacuna/neighbors/search.hpp>

namespace lacuna {

/// A search in a periodic domain. It passes particles and the images of those near an end to another search.
///
/// Distances are the shortest between any images. The list may also contain pairs beyond the limit by a rounding of the
/// period, because the position of an image is rounded.
template <neighbor_search Search>
class periodic_search {
public:
    using real_type = typename Search::real_type;
    static constexpr int dim = Search::dim;
    using point = vec<real_type, dim>;

    /// \param period m; 0 along open axes
    void set_period(point const& period) { period_ = period; }
    void set_threads(int threads) {
        if constexpr (requires { search_.set_threads(threads); }) search_.set_threads(threads);
    }

    /// See neighbor_search.
    /// \throws std::invalid_argument also for a period below twice the reach: two images could be in reach
    void build(points_view<real_type, dim> const& points, real_type cutoff) {
        detail::require_finite_points(points);
        detail::require_length("cutoff", cutoff);
        add_images(points, {}, cutoff);
        search_.build(view_points(points_), cutoff + slack());
    }
    void pairs(std::vector<neighbor_pair>& out) const {
        search_.pairs(out);
        join_images(out);
    }
    void touching_pairs(points_view<real_type, dim> const& points, std::span<real_type const> radii, real_type margin,
                        std::vector<neighbor_pair>& out) {
        detail::require_finite_points(points);
        detail::require_radii(radii, points.size(), margin);
        add_images(points, radii, margin);
        search_.touching_pairs(view_points(points_), radii_, margin + slack(), out);
        join_images(out);
    }

private:
    /// Distances within which particles meet. Exceptionally large particles get images at both ends. So all others need
    /// images at one end only, and only within the reach of two usual particles.
    struct reaches {
        real_type usual, pair; ///< of two usual particles; of the two largest, m
        real_type large;       ///< radius beyond which a particle is exceptionally large, m
    };
    static reaches reaches_of(std::span<real_type const> radii, real_type margin) {
        real_type first = 0, second = 0, usual = 0, large = 2 * median_radius(radii);
        for (real_type const r : radii) {
            second = std::max(second, std::min(first, r));
            first = std::max(first, r);
            if (r <= large) usual = std::max(usual, r);
        }
        return {2 * usual + margin, first + second + margin, large};
    }
    /// Wraps the points into one period and adds an image beyond the upper end for each point near the lower end. A
    /// large particle near the upper end also gets an image beyond the lower end.
    void add_images(points_view<real_type, dim> const& points, std::span<real_type const> radii, real_type margin) {
        points_.resize(points.size());
        of_.resize(points.size());
        radii_.assign(radii.begin(), radii.end());
        for (std::size_t k = 0; k < points.size(); ++k) {
            points_[k] = points[k];
            of_[k] = std::int32_t(k);
        }
        auto const reach = reaches_of(radii, margin);
        for (int axis = 0; axis < dim; ++axis) {
            real_type const length = period_[axis];
            if (!(length > 0)) continue;
            if (!(length >= 2 * reach.pair))
                refuse("period", double(length),
                       "at least twice the distance at which particles meet, " + to_text(double(2 * reach.pair)));
            for (auto& x : points_) x[axis] -= length * std::floor(x[axis] / length);
            // Includes the images along earlier axes: they give the images at corners.
            std::size_t const present = points_.size();
            for (std::size_t k = 0; k < present; ++k) {
                bool const large = !radii.empty() && radii_[k] > reach.large;
                real_type const own = (large ? 2 * radii_[k] + margin : reach.usual) + slack();
                if (points_[k][axis] <= own) add_image(k, axis, length);
                if (large && points_[k][axis] >= length - own) add_image(k, axis, -length);
            }
        }
    }
    void add_image(std::size_t k, int axis, real_type shift) {
        point image = points_[k];
        image[axis] += shift;
        points_.push_back(image);
        of_.push_back(of_[k]);
        if (!radii_.empty()) radii_.push_back(real_type(radii_[k]));
    }
    /// The error of a distance due to the rounding of an image's position, m.
    real_type slack() const noexcept {
        real_type longest = 0;
        for (int axis = 0; axis < dim; ++axis) longest = std::max(longest, period_[axis]);
        return 16 * std::numeric_limits<real_type>::epsilon() * longest;
    }
    void join_images(std::vector<neighbor_pair>& out) const {
        for (auto& pair : out) {
            pair = {of_[std::size_t(pair.i)], of_[std::size_t(pair.j)]};
            if (pair.i > pair.j) std::swap(pair.i, pair.j);
        }
        detail::sort_pairs(out.data(), out.data() + out.size());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        std::erase_if(out, [](neighbor_pair const& pair) { return pair.i == pair.j; });
    }

    Search search_;
    point period_{};
    std::vector<point> points_;
    std::vector<real_type> radii_;
    std::vector<std::int32_t> of_;
};

} // namespace lacuna
