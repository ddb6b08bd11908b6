// SPDX-License-Identifier: BSD-3-Clause
// One huge, fast or distant particle among many ordinary ones: searches miss no pair, and the others cost no more.

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <lacuna/neighbors/brute_force.hpp>
#include <lacuna/neighbors/cell_grid.hpp>
#include <lacuna/neighbors/kd_tree.hpp>
#include <lacuna/neighbors/periodic_search.hpp>
#include <lacuna/neighbors/verlet_list.hpp>
#include <lacuna/particles/domain.hpp>

#include "catch.hpp"
#include "clouds.hpp"

using clouds::neighbor_pair;

namespace {

enum class outlier { none, fast, huge };

struct course {
    long long builds = 0;
    std::size_t candidates = 0;
};

/// Moves a crowd of particles, of which the last is an outlier. Rebuilds the list whenever it is due().
template <class Search>
course follow(outlier kind, std::size_t n, int steps, bool brute = true) {
    using Real = typename Search::real_type;
    constexpr int Dim = Search::dim;
    std::mt19937_64 rng(5);
    std::vector<lacuna::vec<Real, Dim>> points, velocities;
    std::vector<Real> radii;
    for (std::size_t i = 0; i < n; ++i) {
        points.push_back(clouds::random_point<Real, Dim>(rng, Dim == 2 ? 60 : 18));
        auto v = clouds::random_point<Real, Dim>(rng, 1);
        for (int axis = 0; axis < Dim; ++axis) v[axis] = (v[axis] - Real(0.5)) * Real(0.01);
        velocities.push_back(v);
        radii.push_back(Real(0.6 + 0.6 * clouds::uniform(rng)));
    }
    if (kind == outlier::huge) {
        radii.back() = 500;
        points.back()[1] = -500;
    }
    if (kind == outlier::fast) velocities.back()[0] = Real(0.06);
    lacuna::verlet_list<Search> list({.skin = Real(0.5), .margin = 0});
    list.build_for_motion(lacuna::view_points(points), radii);
    int missed = 0, touching = 0;
    for (int step = 0; step < steps; ++step) {
        for (std::size_t i = 0; i < n; ++i) {
            points[i] += velocities[i];
            for (int axis = 0; axis < Dim; ++axis) // within the box
                if (i + 1 < n && std::fabs(points[i][axis] - Real(Dim == 2 ? 30 : 9)) > Real(Dim == 2 ? 30 : 9))
                    velocities[i][axis] *= -1;
        }
        if (points.back()[0] > Real(Dim == 2 ? 60 : 18)) velocities.back()[0] = -std::fabs(velocities.back()[0]);
        if (points.back()[0] < 0) velocities.back()[0] = std::fabs(velocities.back()[0]);
        for (std::size_t b = 0; b * list.block_particles < n; ++b) {
            Real most = 0;
            for (std::size_t i = b * list.block_particles; i < std::min(n, (b + 1) * list.block_particles); ++i)
                most = std::max(most, norm(velocities[i]));
            list.add_path(b, most);
        }
        if (list.due(lacuna::view_points(points))) list.build_for_motion(lacuna::view_points(points), radii);
        if (!brute || step % 3 != 0) continue;
        std::vector<std::vector<bool>> listed(n, std::vector<bool>(n, false));
        for (auto const& p : list.pairs()) listed[std::size_t(p.i)][std::size_t(p.j)] = true;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 1; j < n; ++j)
                if (norm(points[j] - points[i]) <= radii[i] + radii[j]) {
                    ++touching;
                    missed += !listed[i][j];
                }
    }
    CHECK(missed == 0);
    CHECK((!brute || touching > 1000));
    return {list.build_count(), list.pairs().size()};
}

} // namespace

TEMPLATE_TEST_CASE("a list of particles of all speeds and sizes misses no pair, and is built no more often",
                   "[neighbors][outliers]", (lacuna::cell_grid<double, 2>), (lacuna::cell_grid<float, 2>),
                   (lacuna::cell_grid<double, 3>), (lacuna::cell_grid<float, 3>), (lacuna::kd_tree<double, 2>)) {
    auto const usual = follow<TestType>(outlier::none, 400, 300);
    auto const fast = follow<TestType>(outlier::fast, 400, 300);
    auto const huge = follow<TestType>(outlier::huge, 400, 300);
    CHECK(usual.builds >= 3);
    // The first build has no information on motion, so the fast particle causes one more. With half a skin for all, it
    // would cause 300 * 0.06 / 0.25 = 72.
    CHECK(fast.builds <= usual.builds + 4);
    CHECK(fast.candidates < usual.candidates + 150);
    CHECK(huge.builds <= usual.builds + 2);
}

TEST_CASE("only a few particles that are much faster than all others get a larger reach", "[neighbors][outliers]") {
    // 300 particles in a row. Half a skin is 1. The reach of a single fast particle may contain 32 others in the plane:
    // sqrt(32 + 1) - 1.
    std::vector<lacuna::vec<double, 2>> before, now;
    std::vector<double> const radii(300, 1.0);
    for (int k = 0; k < 300; ++k) {
        before.push_back({3.0 * k, 0});
        now.push_back({3.0 * k, 0.5});
    }
    lacuna::own_reach<double, 2> own;
    auto const choose = [&] { own.choose(lacuna::view_points(now), before, radii, 1.0, 1e30); };
    choose();
    for (std::size_t k = 0; k < 300; ++k) CHECK(own.ordinary(k));
    now[7][1] =
        1.5; // 3 times the displacement of the others: 3 times half a skin, 25 % more, plus a quarter of the skin
    choose();
    CHECK_THAT(own[7], Catch::Matchers::WithinRel(1.5 * 2 * 1.25 + 0.5, 1e-12));
    now[7][1] = 180;
    choose();
    CHECK_THAT(own[7], Catch::Matchers::WithinRel(std::sqrt(33.0) - 1, 1e-12));
    own.choose(lacuna::view_points(now), before, radii, 1.0, 2.5); // limits the reach to 2.5
    CHECK(own[7] == 2.5);
    for (std::size_t k = 0; k < 20; ++k) now[k][1] = 180; // too many to be outliers
    choose();
    for (std::size_t k = 0; k < 300; ++k) CHECK(own.ordinary(k));
}

TEST_CASE("outliers do not change the median radius", "[neighbors][outliers]") {
    CHECK(lacuna::median_radius(std::span<double const>{}) == 0);
    CHECK(lacuna::median_radius(std::span<double const>(std::vector<double>{2, 1e9, 1, 1e-9, 3})) == 2);
    CHECK(lacuna::median_radius(std::span<double const>(std::vector<double>{4, 1})) == 1);
}

TEST_CASE("pairs of any distance can be added to a Verlet list", "[neighbors][outliers]") {
    std::vector<lacuna::vec<double, 2>> const points{{0, 0}, {2, 0}, {50, 0}};
    std::vector<double> const radii{1, 1, 1};
    lacuna::verlet_list<lacuna::brute_force<double, 2>> list({.skin = 0.5, .margin = 0});
    list.build(lacuna::view_points(points), radii);
    list.add({{0, 1}, {0, 2}});
    CHECK(list.pairs() == std::vector<neighbor_pair>{{0, 1}, {0, 2}});
    list.build(lacuna::view_points(points), radii);
    CHECK(list.pairs() == std::vector<neighbor_pair>{{0, 1}});
}

TEST_CASE("a k-d tree stops at the largest number of pairs", "[neighbors][outliers]") {
    std::vector<lacuna::vec<double, 2>> const points(100, lacuna::vec<double, 2>{1, 1}); // 4950 pairs
    std::vector<double> const radii(100, 1.0);
    std::vector<neighbor_pair> found;
    lacuna::kd_tree<double, 2> tree;
    tree.set_most_pairs(4950);
    tree.touching_pairs(lacuna::view_points(points), radii, 0.0, found);
    CHECK(found.size() == 4950);
    tree.set_most_pairs(4949);
    CHECK_THROWS_AS(tree.touching_pairs(lacuna::view_points(points), radii, 1e30, found), std::length_error);
    CHECK(found.size() <= 4949 + 99);
}

namespace {

/// One particle of radius 4 among others of 0.2 to 0.3 in a periodic box: compares with a test of all pairs and images.
template <class Search>
void check_huge_in_period() {
    using Real = typename Search::real_type;
    constexpr int Dim = Search::dim;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        std::mt19937_64 rng(seed);
        Real const length = 20, margin = Real(0.1);
        std::vector<lacuna::vec<Real, Dim>> points;
        std::vector<Real> radii;
        for (int k = 0; k < 500; ++k) {
            points.push_back(clouds::random_point<Real, Dim>(rng, 3 * length));
            radii.push_back(Real(0.2 + 0.1 * clouds::uniform(rng)));
        }
        radii[100] = 4;
        for (int axis = 0; axis < Dim; ++axis)
            points[100][axis] = seed == 1 ? Real(0.5) : seed == 2 ? length - 1 : length / 2;
        lacuna::vec<Real, Dim> period{};
        for (int axis = 0; axis < Dim; ++axis) period[axis] = length;
        lacuna::periodic_search<Search> search;
        search.set_period(period);
        std::vector<neighbor_pair> found, expected;
        search.touching_pairs(lacuna::view_points(points), radii, margin, found);
        auto const periods = lacuna::periods<double, Dim>::of(lacuna::convert<double>(period));
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = i + 1; j < points.size(); ++j) {
                auto const between =
                    periods.shortest(lacuna::convert<double>(points[j]) - lacuna::convert<double>(points[i]));
                if (norm(between) <= double(radii[i]) + double(radii[j]) + double(margin))
                    expected.push_back({std::int32_t(i), std::int32_t(j)});
            }
        CHECK(expected.size() > 20);
        CHECK(found == expected);
    }
}

} // namespace

TEST_CASE("a huge particle at the ends of a period finds all that it touches", "[neighbors][outliers][periodic]") {
    check_huge_in_period<lacuna::brute_force<double, 2>>();
    check_huge_in_period<lacuna::cell_grid<double, 2>>();
    check_huge_in_period<lacuna::cell_grid<double, 3>>();
    check_huge_in_period<lacuna::kd_tree<double, 3>>();
}
