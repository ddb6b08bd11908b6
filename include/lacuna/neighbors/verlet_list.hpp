// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <lacuna/core/state.hpp>
#include <lacuna/neighbors/search.hpp>

namespace lacuna {

/// A list of candidate pairs that stays valid while the particles move by less than half a skin.
///
/// Built, it holds every pair with distance <= r_i + r_j + margin + skin. As long as no particle is further
/// than skin / 2 from where it was then, every pair with distance <= r_i + r_j + margin is among them.
/// \tparam Search any neighbor_search: `verlet_list<cell_grid<double, 2>>`
template <neighbor_search Search>
class verlet_list {
public:
    using search_type = Search;
    using real_type = typename Search::real_type;
    static constexpr int dim = Search::dim;
    using points_type = points_view<real_type, dim>;

    struct parameters {
        /// How much two particles may come closer before the list is built anew [m], >= 0. A larger skin means
        /// rarer builds and more candidates; 0 means a build after every motion.
        real_type skin = 0;
        /// Gap at which two particles already count as neighbours [m], >= 0.
        real_type margin = 0;
    };

    verlet_list() = default;
    /// \throws std::invalid_argument for a skin or margin that is negative or not finite
    explicit verlet_list(parameters const& p) : parameters_(p) {
        detail::require_length("skin", p.skin);
        detail::require_length("margin", p.margin);
    }

    /// Lets a search that can use several threads do so.
    void set_threads(int threads) {
        if constexpr (requires { search_.set_threads(threads); }) search_.set_threads(threads);
    }

    /// Of a periodic_search. \param period m; 0 along open axes
    void set_period(vec<real_type, dim> const& period)
        requires(requires(Search s) { s.set_period(period); })
    {
        search_.set_period(period);
    }

    /// Builds the list anew when it may miss a pair: when it was never built, the number of particles or a
    /// radius changed, or a particle moved more than skin / 2 since the last build.
    /// \return whether it was built anew
    /// \throws std::invalid_argument as the search does, for positions or radii that are no numbers
    bool update(points_type const& points, std::span<real_type const> radii) {
        if (!needs_rebuild(points) && std::equal(radii.begin(), radii.end(), radii_.begin(), radii_.end()))
            return false;
        build(points, radii);
        return true;
    }

    /// Whether the list was never built, the number of particles changed, or one of them moved more than
    /// skin / 2 since the last build. A position that is not a number counts as moved.
    bool needs_rebuild(points_type const& points) const noexcept {
        if (!built_ || points.size() != reference_.size()) return true;
        real_type const half = parameters_.skin / 2;
        real_type const limit = half * half * (1 - detail::rounding_slack<real_type>);
        constexpr std::size_t block = 1024;
        for (std::size_t first = 0; first < points.size(); first += block) {
            std::size_t const last = std::min(first + block, points.size());
            bool still = true;
            for (std::size_t i = first; i < last; ++i) {
                real_type d2 = 0;
                for (int axis = 0; axis < dim; ++axis) {
                    real_type const d = points(i, axis) - reference_[i][axis];
                    d2 += d * d;
                }
                still = still && d2 <= limit;
            }
            if (!still) return true;
        }
        return false;
    }

    /// Distance [m] of the particle that is furthest from where it was at the last build; not a number when a
    /// position is none, infinite when the list was not built for this number of particles.
    real_type largest_displacement(points_type const& points) const noexcept {
        if (!built_ || points.size() != reference_.size()) return std::numeric_limits<real_type>::infinity();
        real_type largest = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            real_type d2 = 0;
            for (int axis = 0; axis < dim; ++axis) {
                real_type const d = points(i, axis) - reference_[i][axis];
                d2 += d * d;
            }
            if (std::isnan(d2)) return d2;
            largest = std::max(largest, d2);
        }
        return std::sqrt(largest);
    }

    /// Half of how much two particles that are no pair of the list have come closer, at most, m: the list holds all pairs
    /// while no particle moves further than what this leaves of skin / 2. At most largest_displacement(); less where
    /// only some have moved far, and past their neighbours.
    real_type largest_approach(points_type const& points) {
        real_type const largest = largest_displacement(points), far = parameters_.skin / 4;
        fast_.clear();
        if (!(largest > far) || !std::isfinite(largest) || periodic()) return largest;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (squared_norm(points[i] - reference_[i]) > far * far) fast_.push_back(std::int32_t(i));
            // Where many move there is nothing to gain.
            if (fast_.size() > most_fast(points.size())) return largest;
        }
        // If one of them has moved by less than `far`.
        real_type approach = largest + far;
        real_type const listed = parameters_.margin + parameters_.skin;
        // Two that were further apart have not met, nor will before one of them has moved by another half of the skin.
        real_type const near = real_type(1.01) * (2 * largest_radius_ + listed + 2 * largest);
        auto const was = [&](std::size_t k) { return reference_[std::size_t(fast_[k])]; };
        int const along = widest_axis();
        std::sort(fast_.begin(), fast_.end(), [&](std::int32_t a, std::int32_t b) {
            return reference_[std::size_t(a)][along] < reference_[std::size_t(b)][along];
        });
        for (std::size_t a = 0; a < fast_.size(); ++a)
            for (std::size_t b = a + 1; b < fast_.size() && was(b)[along] - was(a)[along] <= near; ++b) {
                auto const i = std::size_t(fast_[a]), j = std::size_t(fast_[b]);
                real_type const before = norm(was(b) - was(a)), touching = radii_[i] + radii_[j];
                if (before <= near && before > touching + listed)
                    approach = std::max(approach, touching + listed - norm(points[j] - points[i]));
            }
        return std::min(approach / 2, largest);
    }

    /// Builds the list for these positions [m] and radii [m] in any case.
    void build(points_type const& points, std::span<real_type const> radii) {
        built_ = false;
        pairs_.clear();
        real_type largest = 0;
        for (real_type const r : radii) largest = std::max(largest, r);
        real_type const reach = parameters_.margin + parameters_.skin;
        // Without the slack, a pair a rounding beyond the reach now could be a rounding inside it later.
        real_type const slack = detail::rounding_slack<real_type> * (2 * largest + reach);
        search_.touching_pairs(points, radii, reach + slack, pairs_);
        reference_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) reference_[i] = points[i];
        radii_.assign(radii.begin(), radii.end());
        largest_radius_ = largest;
        fast_.reserve(most_fast(points.size()) + 1);
        built_ = true;
        ++build_count_;
    }

    /// The candidates of the last build, i < j, sorted by (i, j).
    std::vector<neighbor_pair> const& pairs() const noexcept { return pairs_; }
    /// How often the list was built so far.
    long long build_count() const noexcept { return build_count_; }
    parameters const& settings() const noexcept { return parameters_; }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(pairs_, fixed_length{reference_}, build_count_);
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            auto const [i, j] = pairs_[p];
            require_state(0 <= i && i < j && std::size_t(j) < reference_.size(), "a candidate that is no pair");
            if (p > 0)
                require_state(pairs_[p - 1].i < i || (pairs_[p - 1].i == i && pairs_[p - 1].j < j),
                              "candidates out of order");
        }
    }

private:
    static constexpr std::size_t most_fast(std::size_t particles) noexcept { return 64 + particles / 16; }
    /// Along which the particles in fast_ are furthest from each other.
    int widest_axis() const noexcept {
        int widest = 0;
        real_type most = 0;
        for (int axis = 0; axis < dim; ++axis) {
            auto const [low, high] = std::minmax_element(fast_.begin(), fast_.end(), [&](std::int32_t a, std::int32_t b) {
                return reference_[std::size_t(a)][axis] < reference_[std::size_t(b)][axis];
            });
            real_type const width = reference_[std::size_t(*high)][axis] - reference_[std::size_t(*low)][axis];
            if (width > most) widest = axis;
            most = std::max(most, width);
        }
        return widest;
    }
    static constexpr bool periodic() noexcept {
        return requires(Search s, vec<real_type, dim> p) { s.set_period(p); };
    }

    parameters parameters_;
    Search search_;
    std::vector<neighbor_pair> pairs_;
    std::vector<vec<real_type, dim>> reference_;
    std::vector<real_type> radii_;
    std::vector<std::int32_t> fast_; // particles that have moved far
    real_type largest_radius_ = 0;
    long long build_count_ = 0;
    bool built_ = false;
};

} // namespace lacuna
