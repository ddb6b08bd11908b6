// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <lacuna/core/state.hpp>
#include <lacuna/neighbors/fast_particles.hpp>
#include <lacuna/neighbors/own_reach.hpp>
#include <lacuna/neighbors/search.hpp>

namespace lacuna {

/// A list of candidate pairs that stays valid while the particles move by less than half a skin.
///
/// Built, it holds every pair with distance <= r_i + r_j + margin + skin. As long as no particle is further
/// than skin / 2 from where it was then, every pair with distance <= r_i + r_j + margin is among them.
/// Built by build_for_motion(), it holds those with distance <= r_i + s_i + r_j + s_j + margin, where s_i is skin / 2 but for
/// the few that are much faster than all others, which may go further: then paths are counted block by block, and the
/// list is due() when one of them may have left its own s_i.
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
        /// The furthest that two particles may reach for each other [m]: in a domain that repeats itself, half a period.
        real_type longest = std::numeric_limits<real_type>::infinity();
    };
    /// Particles whose paths are counted together: add_path().
    static constexpr std::size_t block_particles = 128;

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
            real_type const d2 = squared_norm(points[i] - reference_[i]);
            if (std::isnan(d2)) return d2;
            largest = std::max(largest, d2);
        }
        return std::sqrt(largest);
    }

    /// Half of how much two particles that are no pair of the list have come closer, at most, m: the list holds all pairs
    /// while no particle moves further than what this leaves of skin / 2. At most largest_displacement(); less where
    /// only some have moved far, and past their neighbours. Without those that may go further than skin / 2.
    real_type largest_approach(points_type const& points) {
        if (!built_ || points.size() != reference_.size()) return std::numeric_limits<real_type>::infinity();
        return find_approach(points).approach;
    }

    /// Counts the path of the particles of a block, of which none went further since the last call, m.
    void add_path(std::size_t block, real_type path) noexcept { path_[block] += path + grain_[block]; }
    /// How much closer two particles that are no pair of the list may come before they could touch, at least, m.
    real_type remaining() const noexcept {
        real_type least = std::numeric_limits<real_type>::infinity();
        for (std::size_t b = 0; b < path_.size(); ++b) least = std::min(least, room_[b] - path_[b]);
        return std::max(2 * least, real_type(0));
    }
    /// Whether the list may miss a pair, by the paths that were counted since it was built. Where these leave it open, it
    /// looks where the particles are.
    bool due(points_type const& points) {
        if (!built_ || points.size() != reference_.size()) return true;
        bool close = false;
        for (std::size_t b = 0; b < path_.size(); ++b) {
            if (path_[b] <= room_[b]) continue;
            room_[b] = measure(points, b);
            path_[b] = 0;
            close = close || !(room_[b] > least_room());
        }
        return close && !make_room(points);
    }

    /// Builds the list for these positions [m] and radii [m] in any case.
    void build(points_type const& points, std::span<real_type const> radii) {
        own_.reset(points.size(), parameters_.skin / 2);
        build_with_own(points, radii);
    }
    /// The same, for due(): particles that have come much further than all others since the last build may move further
    /// than skin / 2 until the next.
    void build_for_motion(points_type const& points, std::span<real_type const> radii) {
        real_type largest = 0;
        for (real_type const r : radii) largest = std::max(largest, r);
        real_type const room = parameters_.longest / 2 - largest - parameters_.margin / 2;
        own_.choose(points, reference_, radii, parameters_.skin / 2, room);
        build_with_own(points, radii);
    }
    /// Adds pairs to those of the last build, for any distance that they have.
    /// \param more sorted by (i, j), i < j
    void add(std::vector<neighbor_pair> const& more) {
        if (more.empty()) return;
        auto const before = [](neighbor_pair const& a, neighbor_pair const& b) { return a.i < b.i || (a.i == b.i && a.j < b.j); };
        // From the back, where there is room for the larger of the two.
        std::size_t old = pairs_.size(), further = more.size();
        pairs_.resize(old + further);
        for (std::size_t to = pairs_.size(); further > 0; --to)
            pairs_[to - 1] = old > 0 && before(more[further - 1], pairs_[old - 1]) ? pairs_[--old] : more[--further];
        pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    }

    /// The candidates of the last build, i < j, sorted by (i, j).
    std::vector<neighbor_pair> const& pairs() const noexcept { return pairs_; }
    /// How often the list was built so far.
    long long build_count() const noexcept { return build_count_; }
    parameters const& settings() const noexcept { return parameters_; }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(pairs_, fixed_length{reference_}, build_count_, own_, fixed_length{allowed_}, fixed_length{path_}, fixed_length{room_});
        require_state(own_.size() == reference_.size(), "how far its particles may move");
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            auto const [i, j] = pairs_[p];
            require_state(0 <= i && i < j && std::size_t(j) < reference_.size(), "a candidate that is no pair");
            if (p > 0)
                require_state(pairs_[p - 1].i < i || (pairs_[p - 1].i == i && pairs_[p - 1].j < j),
                              "candidates out of order");
        }
        count_grains();
    }

private:
    /// To look costs little beside a search: it pays where a few steps are gained.
    real_type least_room() const noexcept { return parameters_.skin * real_type(0.04); }

    void build_with_own(points_type const& points, std::span<real_type const> radii) {
        built_ = false;
        pairs_.clear();
        detail::require_radii(radii, points.size(), real_type(0));
        reach_.resize(points.size());
        ordinary_radius_ = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            // Without the slack, a pair a rounding beyond the reach now could be a rounding inside it later.
            reach_[i] = (radii[i] + own_[i] + parameters_.margin / 2) * (1 + detail::rounding_slack<real_type>);
            if (own_.ordinary(i)) ordinary_radius_ = std::max(ordinary_radius_, radii[i]);
        }
        search_.touching_pairs(points, reach_, real_type(0), pairs_);
        reference_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) reference_[i] = points[i];
        radii_.assign(radii.begin(), radii.end());
        fast_.clear(points.size());
        std::size_t const blocks = (points.size() + block_particles - 1) / block_particles;
        allowed_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) allowed_[i] = own_[i];
        path_.assign(blocks, real_type(0));
        room_.resize(blocks);
        for (std::size_t b = 0; b < blocks; ++b) room_[b] = measure(points, b);
        count_grains();
        built_ = true;
        ++build_count_;
    }
    /// What the rounding of a place may add to a path in a step.
    void count_grains() {
        grain_.assign(path_.size(), real_type(0));
        for (std::size_t i = 0; i < reference_.size(); ++i)
            for (int axis = 0; axis < dim; ++axis) {
                auto& grain = grain_[i / block_particles];
                grain = std::max(grain, std::abs(reference_[i][axis]) * std::numeric_limits<real_type>::epsilon());
            }
    }
    /// How much further all particles of a block may move.
    real_type measure(points_type const& points, std::size_t block) const noexcept {
        real_type room = std::numeric_limits<real_type>::infinity();
        std::size_t const first = block * block_particles, last = std::min(first + block_particles, points.size());
        for (std::size_t i = first; i < last; ++i) {
            real_type const left = allowed_[i] - norm(points[i] - reference_[i]);
            room = left >= room ? room : left; // a position that is no number leaves none
        }
        return room;
    }

    /// How particles that may move by skin / 2 have approached each other.
    struct approach_report {
        real_type approach; ///< see largest_approach()
        bool by_pairs;      ///< those in fast_ have been looked at two by two; the others have moved by a quarter of the skin at most
    };
    approach_report find_approach(points_type const& points) {
        real_type const far = parameters_.skin / 4;
        real_type largest = 0;
        fast_.clear(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!own_.ordinary(i)) continue;
            real_type const d2 = squared_norm(points[i] - reference_[i]);
            if (std::isnan(d2)) return {d2, false};
            largest = std::max(largest, d2);
            if (d2 > far * far) fast_.add(i);
        }
        largest = std::sqrt(largest);
        if (!(largest > far) || !std::isfinite(largest) || periodic() || fast_.too_many()) return {largest, false};
        real_type const listed = parameters_.margin + parameters_.skin;
        // Two that were further apart have not met, nor will before one of them has moved by another half of the skin.
        real_type const near = real_type(1.01) * (2 * ordinary_radius_ + listed + 2 * largest);
        // At least as much as if one of them has moved by less than `far`.
        real_type const approach = fast_.largest_approach(largest + far, points, reference_, radii_, listed, near);
        return {std::min(approach / 2, largest), true};
    }

    /// Lets particles move further where none has come close to another that it may meet unlisted.
    /// \return whether that gains anything: whether the list may be kept
    bool make_room(points_type const& points) {
        real_type const half = parameters_.skin / 2;
        auto const found = find_approach(points);
        real_type const room = half - found.approach;
        if (!(room >= least_room())) return false;
        // A fast one counts on the others to stay within a quarter of the skin, and what is left to it.
        real_type const shift = found.by_pairs ? half / 2 : 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            real_type const moved = norm(points[i] - reference_[i]);
            if (!own_.ordinary(i)) {
                allowed_[i] = own_[i] - shift;
                if (!(allowed_[i] - moved >= least_room())) return false;
            } else {
                allowed_[i] = !found.by_pairs ? half : (moved > half / 2 ? moved : half / 2) + room;
            }
        }
        for (std::size_t b = 0; b < path_.size(); ++b) {
            room_[b] = measure(points, b);
            path_[b] = 0;
        }
        return true;
    }

    static constexpr bool periodic() noexcept {
        return requires(Search s, vec<real_type, dim> p) { s.set_period(p); };
    }

    parameters parameters_;
    Search search_;
    std::vector<neighbor_pair> pairs_;
    std::vector<vec<real_type, dim>> reference_; // where the particles were at the build
    own_reach<real_type, dim> own_;
    std::vector<real_type> radii_, reach_, allowed_; // how far from there each may be
    std::vector<real_type> path_, room_, grain_;     // by block: path since the last look, what it may be, rounding of a step
    fast_particles<real_type, dim> fast_;
    real_type ordinary_radius_ = 0;                  // largest of those that may move by skin / 2
    long long build_count_ = 0;
    bool built_ = false;
};

} // namespace lacuna
