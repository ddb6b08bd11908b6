// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// \file
/// Wraps the installed nanoflann in the interface that it has had since 1.5. So lacuna/neighbors/kd_tree.hpp can be
/// compiled with both interfaces, even if only an older nanoflann is installed:
///
/// * `SearchParams` is called `SearchParameters`, and has a default value in every search (from 1.5 on);
/// * a result set must name its `DistanceType` and have `empty()` (later versions, such as 1.12);
/// * it must name its `IndexType`, that of the tree (from 1.10 on);
/// * a sorted search, the default, calls `sort()` of the result set (later versions, such as 1.12).
///
/// The tree itself is the installed one. If the installed nanoflann is 1.5 or newer, the wrapper adds only the last
/// two. Include this file before kd_tree.hpp: all names, also that of the search, are then different, so that one
/// program can use both.

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
