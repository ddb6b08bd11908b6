// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// \file
/// The nanoflann at hand, with the names and the habits that the tree has had since nanoflann 1.5, so that
/// lacuna/neighbors/kd_tree.hpp can be compiled against both generations where only the older is installed:
///
/// * `SearchParams` is called `SearchParameters`, and has a default value in every search (from 1.5 on);
/// * a result set must name its `DistanceType` and offer `empty()` (later ones, as 1.12);
/// * it must name its `IndexType`, that of the tree (1.10 and later);
/// * a search that is to be sorted, the default, calls `sort()` of the result set (later ones, as 1.12).
///
/// The tree itself is the real one. Where nanoflann is 1.5 or newer itself, only the last two are laid on top.
/// Include this before kd_tree.hpp: everything, the search too, then carries another name, so that one program
/// can hold both.

#include <cstdint>
#include <type_traits>
#include <utility>

#define nanoflann nanoflann_1_5
#define KDTreeSingleIndexAdaptor wrapped_single_index_adaptor
#define SearchParams SearchParameters
#include <nanoflann.hpp>
#undef SearchParams
#undef KDTreeSingleIndexAdaptor

namespace nanoflann_1_5 {

template <class Distance, class Points, std::int32_t Dim = -1, class Index = std::uint32_t>
class KDTreeSingleIndexAdaptor : public wrapped_single_index_adaptor<Distance, Points, Dim, Index> {
    using base = wrapped_single_index_adaptor<Distance, Points, Dim, Index>;

public:
    using base::base;

    static inline int sorted_searches = 0;

    template <class ResultSet>
    bool findNeighbors(ResultSet& result, typename Distance::ElementType const* at,
                       SearchParameters const& parameters = {}) const {
        auto const worst = static_cast<typename ResultSet::DistanceType>(result.worstDist());
        static_assert(std::is_same_v<decltype(worst), typename Distance::DistanceType const>);
        static_assert(std::is_same_v<decltype(std::as_const(result).empty()), bool>);
        static_assert(std::is_same_v<typename ResultSet::IndexType, Index>);
        SearchParameters unsorted = parameters;
        unsorted.sorted = false;
        base::findNeighbors(result, at, unsorted);
        if (parameters.sorted) {
            result.sort();
            ++sorted_searches;
        }
        return result.full();
    }
};

} // namespace nanoflann_1_5

#define kd_tree kd_tree_on_nanoflann_1_5
#define tree_points tree_points_on_nanoflann_1_5
#define tree_row tree_row_on_nanoflann_1_5
