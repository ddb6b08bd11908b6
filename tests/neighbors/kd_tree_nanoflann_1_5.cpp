// SPDX-License-Identifier: BSD-3-Clause

// First, so that its macros rename nothing in other headers.
#include "nanoflann_1_5.hpp"

#include <lacuna/neighbors/kd_tree.hpp>

#include "catch.hpp"
#include "clouds.hpp"

namespace {

template <class Real, int Dim>
void agrees_with_definition() {
    lacuna::kd_tree<Real, Dim> search; // compiled with the newer interface
    std::vector<lacuna::neighbor_pair> found;
    for (auto const& c : clouds::all_clouds<Real, Dim>()) {
        INFO(c.name);
        int doubtful = 0;
        auto const expected = clouds::reference_pairs(c.points, c.radii, Real(0.3e-6), doubtful);
        REQUIRE(doubtful == 0);
        search.touching_pairs(c.view(), c.radii, Real(0.3e-6), found);
        REQUIRE(found == expected);
    }
}

} // namespace

TEST_CASE("k-d tree search on the interface of nanoflann 1.5 and newer", "[neighbors]") {
    agrees_with_definition<double, 2>();
    agrees_with_definition<double, 3>();
    agrees_with_definition<float, 2>();
    agrees_with_definition<float, 3>();

    using points_type = lacuna::detail::tree_points<double, 2>;
    using tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, points_type>, points_type, 2>;
    CHECK(tree::sorted_searches > 0);
}
