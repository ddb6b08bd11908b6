// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include <lacuna/neighbors/brute_force.hpp>
#include <lacuna/neighbors/cell_grid.hpp>
#include <lacuna/neighbors/kd_tree.hpp>
#include <lacuna/neighbors/periodic_search.hpp>

#include "catch.hpp"

using namespace lacuna;

namespace {

template <class Real, int Dim>
struct cloud {
    std::vector<vec<Real, Dim>> points;
    std::vector<Real> radii;
};

/// Random particles, some of them in other periods.
template <class Real, int Dim>
cloud<Real, Dim> scattered(int count, vec<Real, Dim> const& size, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    auto const number = [&](double low, double high) { return low + (high - low) * double(engine() >> 11) * 0x1p-53; };
    cloud<Real, Dim> c;
    for (int k = 0; k < count; ++k) {
        vec<Real, Dim> x{};
        for (int axis = 0; axis < Dim; ++axis) x[axis] = Real(number(-1.5, 2.5)) * size[axis];
        c.points.push_back(x);
        c.radii.push_back(Real(number(0.2, 0.6)));
    }
    return c;
}

/// The reference: tests all pairs and images, in double precision.
template <class Real, int Dim>
std::vector<neighbor_pair> by_definition(cloud<Real, Dim> const& c, vec<Real, Dim> const& period, double margin) {
    std::vector<neighbor_pair> pairs;
    for (std::size_t i = 0; i < c.points.size(); ++i)
        for (std::size_t j = i + 1; j < c.points.size(); ++j) {
            double shortest = 0;
            for (int axis = 0; axis < Dim; ++axis) {
                double const d = double(c.points[j][axis]) - double(c.points[i][axis]), length = double(period[axis]);
                double best = std::fabs(d);
                for (int n = -5; n <= 5 && length > 0; ++n) best = std::min(best, std::fabs(d + n * length));
                shortest += best * best;
            }
            if (std::sqrt(shortest) <= double(c.radii[i]) + double(c.radii[j]) + margin)
                pairs.push_back({std::int32_t(i), std::int32_t(j)});
        }
    return pairs;
}

/// The list must have all pairs of the definition. Others may only be due to rounded positions.
template <class Real, int Dim>
void check_list(std::vector<neighbor_pair> const& found, cloud<Real, Dim> const& c, vec<Real, Dim> const& period,
                double margin) {
    auto const before = [](neighbor_pair const& a, neighbor_pair const& b) {
        return a.i < b.i || (a.i == b.i && a.j < b.j);
    };
    double const rounding = 500 * double(std::numeric_limits<Real>::epsilon());
    auto const inside = by_definition(c, period, margin), around = by_definition(c, period, margin + rounding);
    REQUIRE(inside.size() > 50);
    CHECK(std::adjacent_find(found.begin(), found.end(), std::not_fn(before)) ==
          found.end()); // sorted, without duplicates
    CHECK(std::includes(found.begin(), found.end(), inside.begin(), inside.end(), before));
    CHECK(std::includes(around.begin(), around.end(), found.begin(), found.end(), before));
}

template <class Search>
void check() {
    using real = typename Search::real_type;
    constexpr int dim = Search::dim;
    for (int which = 1; which < 1 << dim; ++which) // bits: the periodic axes
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            vec<real, dim> size{}, period{};
            for (int axis = 0; axis < dim; ++axis) {
                size[axis] = real(dim == 2 ? 9 + axis : 4.5 + axis);
                if (which >> axis & 1) period[axis] = size[axis];
            }
            auto const c = scattered<real, dim>(300, size, seed);
            periodic_search<Search> search;
            search.set_period(period);
            std::vector<neighbor_pair> found;
            search.touching_pairs(view_points(c.points), c.radii, real(0.3), found);
            INFO("axes " << which << ", seed " << seed);
            check_list(found, c, period, 0.3);
            auto equal = c;
            equal.radii.assign(c.radii.size(), real(0.7));
            search.build(view_points(c.points), real(1.4));
            search.pairs(found);
            check_list(found, equal, period, 0);
        }
}

} // namespace

TEST_CASE("searches in a periodic domain agree with the definition", "[periodic]") {
    check<brute_force<double, 2>>();
    check<cell_grid<double, 2>>();
    check<kd_tree<double, 2>>();
    check<cell_grid<double, 3>>();
    check<kd_tree<double, 3>>();
    check<cell_grid<float, 2>>();
}

TEST_CASE("a period too short for a particle and its image is refused", "[periodic][refusal]") {
    auto const c = scattered<double, 2>(20, {5, 5}, 1);
    periodic_search<cell_grid<double, 2>> search;
    search.set_period({3.2, 0});
    std::vector<neighbor_pair> found;
    CHECK_THROWS_WITH(search.touching_pairs(view_points(c.points), c.radii, 0.6, found),
                      contains_text("period = 3.2: must be at least twice the distance at which particles meet"));
}
