// SPDX-License-Identifier: BSD-3-Clause
// refused: neighbor_search

#include <lacuna/neighbors/cell_grid.hpp>
#include <lacuna/neighbors/verlet_list.hpp>

/// Has everything that a neighbour search needs except `pairs`.
struct half_a_search {
    using real_type = double;
    static constexpr int dim = 2;
    void build(lacuna::points_view<double, 2> const&, double);
    void touching_pairs(lacuna::points_view<double, 2> const&, std::span<double const>, double,
                        std::vector<lacuna::neighbor_pair>&);
};

#ifdef LACUNA_GOOD
lacuna::verlet_list<lacuna::cell_grid<double, 2>> list;
#else
lacuna::verlet_list<half_a_search> list;
#endif
