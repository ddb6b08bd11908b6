// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>

#include <nanoflann.hpp>

#include <lacuna/neighbors/search.hpp>

namespace lacuna {

namespace detail {

template <class Real, int Dim>
struct tree_points {
    std::vector<Real> coordinates; // Dim per point
    std::vector<Real> radii;
    Real margin = 0;

    std::size_t kdtree_get_point_count() const noexcept { return radii.size(); }
    Real kdtree_get_pt(std::size_t i, std::size_t axis) const noexcept { return coordinates[i * Dim + axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const noexcept {
        return false;
    }
};

/// Receives the points that the tree finds around point i. It takes the pairs in which i is the larger particle (of
/// equal ones the first). So no particle has to search as far as the largest one reaches. The members are those that
/// nanoflann requires of a result set, in version 1.4 as well as from 1.5 on, where search parameters and result types
/// differ.
template <class Real, int Dim>
class tree_row {
public:
    using DistanceType = Real;
    using IndexType = std::uint32_t;

    tree_row(tree_points<Real, Dim> const& points, std::size_t i, std::vector<neighbor_pair>& out)
        : points_(points), i_(i), out_(out) {
        Real const reach = (points.radii[i] + points.radii[i]) + points.margin;
        // Larger than the limit: the tree finds only smaller distances, rounds its sums, and a square may underflow.
        Real const squared = reach * reach * (1 + rounding_slack<Real>);
        worst_ = std::nextafter(std::max(squared, std::numeric_limits<Real>::min()), std::numeric_limits<Real>::max());
    }
    template <class Index>
    bool addPoint(Real, Index found) {
        auto const j = std::size_t(found);
        Real const own = points_.radii[i_], other = points_.radii[j];
        if (j == i_ || other > own || (other == own && j < i_)) return true;
        Real d2 = 0;
        for (std::size_t axis = 0; axis < Dim; ++axis)
            d2 = add_square(d2, points_.kdtree_get_pt(i_, axis) - points_.kdtree_get_pt(j, axis));
        if (in_reach(d2, own, other, points_.margin)) {
            out_.push_back({std::int32_t(std::min(i_, j)), std::int32_t(std::max(i_, j))});
            ++count_;
        }
        return true;
    }
    Real worstDist() const noexcept { return worst_; }
    bool full() const noexcept { return true; }
    std::size_t size() const noexcept { return count_; }
    bool empty() const noexcept { return count_ == 0; }
    void sort() noexcept {}

private:
    tree_points<Real, Dim> const& points_;
    std::size_t i_;
    std::vector<neighbor_pair>& out_;
    std::size_t count_ = 0;
    Real worst_;
};

} // namespace detail

/// Search by the k-d tree of nanoflann (1.4 or newer): cost n log n for any distribution of the points.
///
/// A particle searches only as far as one of its own size reaches it, so that a huge particle does not slow the others.
/// Each build allocates the nodes of the tree; all other memory is reused.
template <class Real, int Dim>
class kd_tree {
    using points_type = detail::tree_points<Real, Dim>;
    using index_type =
        nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<Real, points_type>, points_type, Dim>;

public:
    using real_type = Real;
    static constexpr int dim = Dim;

    kd_tree() = default;
    kd_tree(kd_tree&&) noexcept = default;
    kd_tree& operator=(kd_tree&&) noexcept = default;
    kd_tree(kd_tree const& other) { *this = other; }
    kd_tree& operator=(kd_tree const& other) {
        if (this == &other) return *this;
        index_.reset();
        points_.reset();
        most_pairs_ = other.most_pairs_;
        if (other.points_) {
            points_ = std::make_unique<points_type>(*other.points_);
            index_points();
        }
        return *this;
    }
    ~kd_tree() = default;

    /// See neighbor_search.
    void build(points_view<Real, Dim> const& points, Real cutoff) {
        detail::require_finite_points(points);
        detail::require_length("cutoff", cutoff);
        store(points);
        points_->radii.assign(points.size(), Real(0));
        points_->margin = cutoff;
        index_points();
    }
    void pairs(std::vector<neighbor_pair>& out) const {
        out.clear();
        if (!index_) return;
        for (std::size_t i = 0; i < points_->radii.size(); ++i) {
            detail::tree_row<Real, Dim> row(*points_, i, out);
            index_->findNeighbors(row, &points_->coordinates[i * Dim], {});
            if (out.size() > most_pairs_)
                throw std::length_error("kd_tree: more than " + std::to_string(most_pairs_) + " pairs");
        }
        detail::sort_pairs(out.data(), out.data() + out.size());
    }
    /// Sets the largest number of pairs. Beyond it, pairs() and touching_pairs() throw std::length_error, so that pairs
    /// do not exhaust the memory. By default there is no limit.
    void set_most_pairs(std::size_t most) noexcept { most_pairs_ = most; }
    void touching_pairs(points_view<Real, Dim> const& points, std::span<Real const> radii, Real margin,
                        std::vector<neighbor_pair>& out) {
        detail::require_finite_points(points);
        detail::require_radii(radii, points.size(), margin);
        store(points);
        points_->radii.assign(radii.begin(), radii.end());
        points_->margin = margin;
        index_points();
        pairs(out);
    }

private:
    void store(points_view<Real, Dim> const& points) {
        index_.reset();
        if (!points_) points_ = std::make_unique<points_type>();
        points_->coordinates.resize(points.size() * Dim);
        for (std::size_t i = 0; i < points.size(); ++i)
            for (int axis = 0; axis < Dim; ++axis) points_->coordinates[i * Dim + std::size_t(axis)] = points(i, axis);
    }
    void index_points() {
        if (!points_->radii.empty()) index_ = std::make_unique<index_type>(Dim, *points_);
    }

    // The index refers to the points: on the heap, both keep their address when the search is moved.
    std::unique_ptr<points_type> points_;
    std::unique_ptr<index_type> index_;
    std::size_t most_pairs_ = std::numeric_limits<std::size_t>::max();
};

} // namespace lacuna
