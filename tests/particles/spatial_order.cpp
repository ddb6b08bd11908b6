// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

#include <lacuna/packings/random_numbers.hpp>
#include <lacuna/particles/spatial_order.hpp>

using lacuna::vec;

namespace {
template <int Dim>
void visits_neighbours(int edge) {
    // On a grid of 2^k points per axis a Hilbert curve visits every point once, one grid step at a time.
    std::vector<vec<double, Dim>> points;
    int count = 1;
    for (int axis = 0; axis < Dim; ++axis) count *= edge;
    for (int k = 0; k < count; ++k) {
        vec<double, Dim> x{};
        int rest = (k * 37) % count; // shuffled: 37 is prime to every power of 2
        for (int axis = 0; axis < Dim; ++axis, rest /= edge) x[axis] = 1e-6 * (rest % edge) - 3e-6;
        points.push_back(x);
    }
    auto const order = lacuna::spatial_order(lacuna::view_points(points));
    REQUIRE(std::set<int>(order.begin(), order.end()).size() == points.size());
    for (std::size_t k = 1; k < order.size(); ++k)
        REQUIRE(norm(points[std::size_t(order[k])] - points[std::size_t(order[k - 1])]) < 1.001e-6);
}
} // namespace

TEST_CASE("spatial order steps from neighbour to neighbour on a grid", "[particles]") {
    visits_neighbours<2>(2);
    visits_neighbours<2>(16);
    visits_neighbours<3>(2);
    visits_neighbours<3>(8);
}

TEST_CASE("spatial order shortens the path through random points", "[particles]") {
    lacuna::random_source random(7);
    std::vector<vec<double, 2>> points(2000);
    for (auto& x : points) x = {random.uniform(), random.uniform()};
    auto const order = lacuna::spatial_order(lacuna::view_points(points));
    double path = 0;
    for (std::size_t k = 1; k < order.size(); ++k)
        path += norm(points[std::size_t(order[k])] - points[std::size_t(order[k - 1])]);
    // Mean step in random order: 0.52. Along a Hilbert curve: of the order of the mean distance, 1/sqrt(2000) = 0.022.
    REQUIRE(path / 1999 < 0.03);
}

TEST_CASE("spatial order of no points, of coincident points, of bad numbers", "[particles]") {
    std::vector<vec<double, 2>> points;
    REQUIRE(lacuna::spatial_order(lacuna::view_points(points)).empty());
    points.assign(5, {1.0, 1.0});
    REQUIRE(lacuna::spatial_order(lacuna::view_points(points)) == std::vector<std::int32_t>{0, 1, 2, 3, 4});
    points[2][1] = std::numeric_limits<double>::quiet_NaN();
    REQUIRE_THROWS_AS(lacuna::spatial_order(lacuna::view_points(points)), std::invalid_argument);
}

TEST_CASE("strip order keeps the neighbours of a particle within two strips", "[particles]") {
    // 40 by 90 points, shuffled: strips of one row of 40, so that a row's neighbour is at most 2 * 40 - 1 away.
    std::vector<vec<double, 2>> points;
    int const columns = 40, rows = 90, count = columns * rows;
    for (int k = 0; k < count; ++k) {
        int const n = (k * 1777) % count; // 1777 is prime to 3600
        points.push_back({1e-6 * (n % columns) + 2e-6, 1e-6 * (n / columns) - 5e-5});
    }
    auto const order = lacuna::strip_order(lacuna::view_points(points));
    REQUIRE(std::set<int>(order.begin(), order.end()).size() == points.size());
    std::vector<int> index(points.size());
    for (int k = 0; k < count; ++k) index[std::size_t(order[std::size_t(k)])] = k;
    int farthest = 0;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < i; ++j)
            if (norm(points[std::size_t(i)] - points[std::size_t(j)]) < 1.1e-6)
                farthest = std::max(farthest, std::abs(index[std::size_t(i)] - index[std::size_t(j)]));
    REQUIRE(farthest < 3 * columns);

    REQUIRE(lacuna::strip_order(lacuna::points_view<double, 2>{}).empty());
    std::vector<vec<double, 2>> const line{{2, 0}, {0, 0}, {1, 0}};
    REQUIRE(lacuna::strip_order(lacuna::view_points(line)) == std::vector<std::int32_t>{1, 2, 0});
    std::vector<vec<double, 2>> const bad{{0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0}};
    REQUIRE_THROWS_WITH(lacuna::strip_order(lacuna::view_points(bad)), contains_text("particle 1.position"));
}

TEST_CASE("strip order does not depend on the order of the input, however close points are", "[particles]") {
    // Relative to the lowest coordinate, -1e-30 and 0 round to the same number.
    std::vector<vec<double, 2>> const points{{0, 0},  {3, 0},      {0.5, 0.75},    {-0.5, 0.75},
                                             {-1, 0}, {-1e-30, 0}, {0.25, -1e-30}, {0.5, -0.75}};
    auto reversed = points;
    std::reverse(reversed.begin(), reversed.end());
    auto const order = lacuna::strip_order(lacuna::view_points(points));
    auto const other = lacuna::strip_order(lacuna::view_points(reversed));
    for (std::size_t k = 0; k < order.size(); ++k)
        REQUIRE(order[k] == std::int32_t(points.size()) - 1 - other[k]);
}
