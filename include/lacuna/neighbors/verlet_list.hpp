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
/// build() lists every pair with distance <= r_i + r_j + margin + skin. While no particle is further than skin / 2 from
/// its position at the build, the list contains every pair with distance <= r_i + r_j + margin.
///
/// build_for_motion() lists every pair with distance <= r_i + s_i + r_j + s_j + margin. s_i is skin / 2, but larger for
/// a few particles that are much faster than all others. The caller then adds up paths block by block by add_path().
/// The list is due() for a rebuild when a particle may have moved further than its s_i.
/// \tparam Search any neighbor_search: `verlet_list<cell_grid<double, 2>>`
template <neighbor_search Search>
class verlet_list {
public:
    using search_type = Search;
    using real_type = typename Search::real_type;
    static constexpr int dim = Search::dim;
    using points_type = points_view<real_type, dim>;

    struct parameters {
        /// Distance by which two particles may approach before the list is rebuilt [m], >= 0. A larger skin means fewer
        /// builds and more candidates; 0 means a build after every motion.
        real_type skin = 0;
        /// Gap at which two particles already count as neighbours [m], >= 0.
        real_type margin = 0;
        /// Largest distance of a listed pair [m]: in a periodic domain half a period.
        real_type longest = std::numeric_limits<real_type>::infinity();
    };
    /// Number of particles in a block, see add_path().
    static constexpr std::size_t block_particles = 128;

    verlet_list() = default;
    /// \throws std::invalid_argument for a skin or margin that is negative or not finite
    explicit verlet_list(parameters const& p) : parameters_(p) {
        detail::require_length("skin", p.skin);
        detail::require_length("margin", p.margin);
    }

    /// Sets the number of threads of a search that can use several.
    void set_threads(int threads) {
        if constexpr (requires { search_.set_threads(threads); }) search_.set_threads(threads);
    }

    /// Sets the period of a periodic_search.
    /// \param period m; 0 along open axes
    void set_period(vec<real_type, dim> const& period)
        requires(requires(Search s) { s.set_period(period); })
    {
        search_.set_period(period);
    }

    /// Rebuilds the list if it may miss a pair: if it was never built, if the number of particles or a radius has
    /// changed, or if a particle has moved more than skin / 2 since the last build.
    /// \return true if it was rebuilt
    /// \throws std::invalid_argument for positions or radii that the search refuses, see neighbor_search
    bool update(points_type const& points, std::span<real_type const> radii) {
        if (!needs_rebuild(points) && std::equal(radii.begin(), radii.end(), radii_.begin(), radii_.end()))
            return false;
        build(points, radii);
        return true;
    }

    /// True if the list was never built, if the number of particles has changed, or if one of them has moved more than
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

    /// Largest displacement of a particle since the last build [m]. It is not-a-number if a position is, and infinite
    /// if the list was not built for this number of particles.
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

    /// Half the largest approach of two particles that are not listed as a pair [m]. The list contains all pairs while
    /// no particle moves further than skin / 2 minus this value. It is at most largest_displacement(). It is less if
    /// only some particles have moved far, without approaching unlisted ones. Particles that may move further than skin
    /// / 2 do not count.
    real_type largest_approach(points_type const& points) {
        if (!built_ || points.size() != reference_.size()) return std::numeric_limits<real_type>::infinity();
        return find_approach(points).approach;
    }

    /// Adds a path to that of a block: no particle of the block has moved further since the last call [m].
    void add_path(std::size_t block, real_type path) noexcept { path_[block] += path + rounding_[block]; }
    /// Lower bound of the distance by which two unlisted particles may approach before they could touch [m].
    real_type remaining() const noexcept {
        real_type least = std::numeric_limits<real_type>::infinity();
        for (std::size_t b = 0; b < path_.size(); ++b) least = std::min(least, room_[b] - path_[b]);
        return std::max(2 * least, real_type(0));
    }
    /// True if the list may miss a pair, according to the paths since the last build. If a path exceeds its limit, the
    /// positions decide.
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

    /// Builds the list for these positions [m] and radii [m] unconditionally.
    void build(points_type const& points, std::span<real_type const> radii) {
        own_.reset(points.size(), parameters_.skin / 2);
        build_with_own(points, radii);
    }
    /// Builds the list for use with due(). Particles that have moved much further than all others since the last build
    /// may then move further than skin / 2 before the next one.
    void build_for_motion(points_type const& points, std::span<real_type const> radii) {
        real_type largest = 0;
        for (real_type const r : radii) largest = std::max(largest, r);
        real_type const room = parameters_.longest / 2 - largest - parameters_.margin / 2;
        own_.choose(points, reference_, radii, parameters_.skin / 2, room);
        build_with_own(points, radii);
    }
    /// Adds pairs to those of the last build, whatever their distance.
    /// \param more sorted by (i, j), i < j
    void add(std::vector<neighbor_pair> const& more) {
        if (more.empty()) return;
        auto const before = [](neighbor_pair const& a, neighbor_pair const& b) {
            return a.i < b.i || (a.i == b.i && a.j < b.j);
        };
        // Merges from the back, so that no pair is overwritten before it has moved.
        std::size_t old = pairs_.size(), left = more.size();
        pairs_.resize(old + left);
        for (std::size_t to = pairs_.size(); left > 0; --to)
            pairs_[to - 1] = old > 0 && before(more[left - 1], pairs_[old - 1]) ? pairs_[--old] : more[--left];
        pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    }

    /// The candidates of the last build, i < j, sorted by (i, j).
    std::vector<neighbor_pair> const& pairs() const noexcept { return pairs_; }
    /// Number of builds so far.
    long long build_count() const noexcept { return build_count_; }
    parameters const& settings() const noexcept { return parameters_; }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(pairs_, fixed_length{reference_}, build_count_, own_, fixed_length{allowed_}, fixed_length{path_},
           fixed_length{room_});
        require_state(own_.size() == reference_.size(), "the reach of its particles");
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            auto const [i, j] = pairs_[p];
            require_state(0 <= i && i < j && std::size_t(j) < reference_.size(), "the indices of a candidate pair");
            if (p > 0)
                require_state(pairs_[p - 1].i < i || (pairs_[p - 1].i == i && pairs_[p - 1].j < j),
                              "the order of candidate pairs");
        }
        find_rounding();
    }

private:
    /// Measuring the room costs little compared with a search: it pays if it gains a few steps.
    real_type least_room() const noexcept { return parameters_.skin * real_type(0.04); }

    void build_with_own(points_type const& points, std::span<real_type const> radii) {
        built_ = false;
        pairs_.clear();
        detail::require_radii(radii, points.size(), real_type(0));
        reach_.resize(points.size());
        ordinary_radius_ = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            // Without the slack, rounding could put a pair outside the reach now and inside it later.
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
        find_rounding();
        built_ = true;
        ++build_count_;
    }
    /// Finds for each block the error of a path in one step due to the rounding of positions.
    void find_rounding() {
        rounding_.assign(path_.size(), real_type(0));
        for (std::size_t i = 0; i < reference_.size(); ++i)
            for (int axis = 0; axis < dim; ++axis) {
                auto& largest = rounding_[i / block_particles];
                largest = std::max(largest, std::abs(reference_[i][axis]) * std::numeric_limits<real_type>::epsilon());
            }
    }
    /// The distance that every particle of a block may still move.
    real_type measure(points_type const& points, std::size_t block) const noexcept {
        real_type room = std::numeric_limits<real_type>::infinity();
        std::size_t const first = block * block_particles, last = std::min(first + block_particles, points.size());
        for (std::size_t i = first; i < last; ++i) {
            real_type const left = allowed_[i] - norm(points[i] - reference_[i]);
            room = left >= room ? room : left; // not-a-number becomes the room
        }
        return room;
    }

    /// The approach of particles that may move by skin / 2.
    struct approach_report {
        real_type approach; ///< see largest_approach()
        /// True if the pairs in fast_ were checked one by one. All other particles have moved by at most skin / 4.
        bool by_pairs;
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
        // Two that were further apart have not met, and will not before one of them moves by another skin / 2.
        real_type const near = real_type(1.01) * (2 * ordinary_radius_ + listed + 2 * largest);
        // At least largest + far: a fast particle may approach one that has moved by up to `far`.
        real_type const approach = fast_.largest_approach(largest + far, points, reference_, radii_, listed, near);
        return {std::min(approach / 2, largest), true};
    }

    /// Lets particles move further if no two unlisted ones have come close to each other.
    /// \return true if the list stays valid for a few more steps
    bool make_room(points_type const& points) {
        real_type const half = parameters_.skin / 2;
        auto const found = find_approach(points);
        real_type const room = half - found.approach;
        if (!(room >= least_room())) return false;
        // Ordinary particles may now move by up to 3/4 of the skin; the limit of fast ones makes up for the excess.
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
    std::vector<vec<real_type, dim>> reference_; // positions at the last build
    own_reach<real_type, dim> own_;
    std::vector<real_type> radii_, reach_, allowed_; // allowed_: largest distance of each particle from its reference
    std::vector<real_type> path_, room_, rounding_;  // by block: path since the last measurement, its limit, its error
    fast_particles<real_type, dim> fast_;
    real_type ordinary_radius_ = 0;                  // largest radius of particles that may move by skin / 2
    long long build_count_ = 0;
    bool built_ = false;
};

} // namespace lacuna
