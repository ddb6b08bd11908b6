// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <stdexcept>

#include <lacuna/neighbors/brute_force.hpp>
#include <lacuna/neighbors/cell_grid.hpp>
#include <lacuna/neighbors/kd_tree.hpp>
#include <lacuna/neighbors/verlet_list.hpp>

#include "catch.hpp"
#include "clouds.hpp"

using clouds::neighbor_pair;

namespace {

template <class Real, int Dim>
Real distance(lacuna::vec<Real, Dim> const& a, lacuna::vec<Real, Dim> const& b) {
    Real square = 0;
    for (int axis = 0; axis < Dim; ++axis) square += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    return std::sqrt(square);
}

template <class Search>
void follows_random_motion() {
    using Real = typename Search::real_type;
    constexpr int Dim = Search::dim;
    std::mt19937_64 rng(77);
    std::size_t const n = 250;
    Real const skin = Real(0.4);
    Real const margin = Real(0.1);
    std::vector<lacuna::vec<Real, Dim>> points;
    std::vector<lacuna::vec<Real, Dim>> velocities;
    std::vector<Real> radii;
    for (std::size_t i = 0; i < n; ++i) {
        points.push_back(clouds::random_point<Real, Dim>(rng, Dim == 2 ? 40 : 16));
        velocities.push_back(clouds::random_point<Real, Dim>(rng, 0.1));
        for (int axis = 0; axis < Dim; ++axis) velocities[i][axis] -= Real(0.05);
        radii.push_back(Real(0.8 + 0.6 * clouds::uniform(rng)));
    }
    lacuna::verlet_list<Search> list({.skin = skin, .margin = margin});
    auto reference = points;
    long long builds = 0;
    int missed = 0;
    int too_late = 0;
    int too_early = 0;
    int touching = 0;
    for (int step = 0; step < 60; ++step) {
        Real furthest = 0;
        for (std::size_t i = 0; i < n; ++i) furthest = std::max(furthest, distance(points[i], reference[i]));
        bool const built = list.update(lacuna::view_points(points), radii);
        if (built) {
            ++builds;
            reference = points;
            if (step > 0 && furthest < skin / 2 * Real(0.9999)) ++too_early;
        } else if (furthest > skin / 2) {
            ++too_late;
        }
        std::vector<std::vector<bool>> listed(n, std::vector<bool>(n, false));
        for (auto const& p : list.pairs()) listed[std::size_t(p.i)][std::size_t(p.j)] = true;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 1; j < n; ++j)
                if (distance(points[i], points[j]) <= radii[i] + radii[j] + margin) {
                    ++touching;
                    missed += !listed[i][j];
                }
        for (std::size_t i = 0; i < n; ++i) points[i] += velocities[i];
    }
    CHECK(touching > 1000);
    CHECK(missed == 0);
    CHECK(too_late == 0);
    CHECK(too_early == 0);
    CHECK(list.build_count() == builds);
    // The fastest particle moves at most 0.05 sqrt(Dim) per step: several steps pass between two builds.
    CHECK(builds > 5);
    CHECK(builds < 30);
}

} // namespace

TEST_CASE("a Verlet list misses no touching pair and is built only when needed", "[neighbors]") {
    follows_random_motion<lacuna::brute_force<double, 2>>();
    follows_random_motion<lacuna::kd_tree<double, 2>>();
    follows_random_motion<lacuna::cell_grid<double, 2>>();
    follows_random_motion<lacuna::cell_grid<double, 3>>();
    follows_random_motion<lacuna::cell_grid<float, 2>>();
    follows_random_motion<lacuna::cell_grid<float, 3>>();
}

TEST_CASE("when a Verlet list is built", "[neighbors]") {
    using list_type = lacuna::verlet_list<lacuna::cell_grid<double, 2>>;
    std::vector<lacuna::vec<double, 2>> points{{0, 0}, {2.25, 0}, {9, 0}};
    std::vector<double> radii{1, 1, 1};
    list_type list({.skin = 0.5, .margin = 0});
    CHECK(list.needs_rebuild(lacuna::view_points(points)));
    CHECK(list.pairs().empty());
    REQUIRE(list.update(lacuna::view_points(points), radii));
    CHECK(list.pairs() == std::vector<neighbor_pair>{{0, 1}});
    CHECK_FALSE(list.update(lacuna::view_points(points), radii));
    CHECK(list.build_count() == 1);

    SECTION("not for displacements within half the skin since the build") {
        for (int step = 0; step < 3; ++step) {
            points[2][0] += 0.08;
            CHECK_FALSE(list.update(lacuna::view_points(points), radii));
        }
        points[2][0] += 0.08;
        CHECK(list.update(lacuna::view_points(points), radii));
        CHECK(list.build_count() == 2);
    }
    SECTION("not for motion back and forth") {
        for (int step = 0; step < 20; ++step) {
            points[0][1] = step % 2 == 0 ? 0.2 : -0.2;
            CHECK_FALSE(list.update(lacuna::view_points(points), radii));
        }
    }
    SECTION("when a particle is added or removed") {
        points.push_back({2.25, 2});
        radii.push_back(1);
        CHECK(list.update(lacuna::view_points(points), radii));
        CHECK(list.pairs() == std::vector<neighbor_pair>{{0, 1}, {1, 3}});
        points.resize(1);
        radii.resize(1);
        CHECK(list.update(lacuna::view_points(points), radii));
        CHECK(list.pairs().empty());
        points.clear();
        radii.clear();
        CHECK(list.update(lacuna::view_points(points), radii));
        CHECK_FALSE(list.update(lacuna::view_points(points), radii));
        CHECK(list.pairs().empty());
    }
    SECTION("when a radius changes") {
        radii[2] = 6;
        CHECK(list.update(lacuna::view_points(points), radii));
        CHECK(list.pairs() == std::vector<neighbor_pair>{{0, 1}, {1, 2}});
    }
    SECTION("on demand") {
        list.build(lacuna::view_points(points), radii);
        CHECK(list.build_count() == 2);
    }
    SECTION("after any motion when there is no skin") {
        list_type bare;
        CHECK(bare.update(lacuna::view_points(points), radii));
        CHECK_FALSE(bare.update(lacuna::view_points(points), radii));
        points[1][1] = 1e-9;
        CHECK(bare.update(lacuna::view_points(points), radii));
    }
    SECTION("after a position that is not a number, which is refused and named") {
        points[1][1] = std::numeric_limits<double>::quiet_NaN();
        CHECK(list.needs_rebuild(lacuna::view_points(points)));
        std::string message;
        try {
            list.update(lacuna::view_points(points), radii);
        } catch (std::invalid_argument const& e) {
            message = e.what();
        }
        CHECK(message == "position of particle 1, coordinate 1 = nan: must be finite");
        points[1][1] = 0;
        CHECK(list.update(lacuna::view_points(points), radii));
        CHECK(list.pairs() == std::vector<neighbor_pair>{{0, 1}});
    }
}

TEST_CASE("the largest displacement since a Verlet list was built", "[neighbors]") {
    std::vector<lacuna::vec<double, 2>> points{{0, 0}, {5, 0}, {9, 0}};
    std::vector<double> const radii{1, 1, 1};
    lacuna::verlet_list<lacuna::cell_grid<double, 2>> list({.skin = 0.5, .margin = 0});
    CHECK(list.largest_displacement(lacuna::view_points(points)) == std::numeric_limits<double>::infinity());
    list.build(lacuna::view_points(points), radii);
    CHECK(list.largest_displacement(lacuna::view_points(points)) == 0);
    points[1] = {8, -4}; // by (3, -4)
    points[2] = {9, 1};
    CHECK(list.largest_displacement(lacuna::view_points(points)) == 5);
    points[0][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(list.largest_displacement(lacuna::view_points(points))));
    points.pop_back();
    CHECK(list.largest_displacement(lacuna::view_points(points)) == std::numeric_limits<double>::infinity());
}

TEST_CASE("the largest approach of particles that are not a pair of a Verlet list", "[neighbors]") {
    // Particles in a row. Skin 1, margin 0.1: pairs are listed up to a gap of 1.1. This is 0-1 (gap 0.4), but not 1-2
    // (gap 1.2) and no pair with 3 or 4.
    std::vector<lacuna::vec<double, 2>> points{{0, 0}, {2.4, 0}, {5.6, 0}, {20, 0}, {40, 0}};
    std::vector<double> const radii{1, 1, 1, 1, 1};
    lacuna::verlet_list<lacuna::cell_grid<double, 2>> list({.skin = 1, .margin = 0.1});
    list.build(lacuna::view_points(points), radii);
    auto const approach = [&] { return list.largest_approach(lacuna::view_points(points)); };
    REQUIRE(list.pairs() == std::vector<neighbor_pair>{{0, 1}});
    CHECK(approach() == 0);
    points[3][1] = 0.2;
    CHECK(approach() == 0.2); // less than a quarter of the skin: the displacement itself
    points[3][1] = 0.75;      // one fast particle: another may have approached it by a quarter of the skin
    CHECK(approach() == 0.5);
    points[0][0] = -0.6; // the approach of a listed pair does not count
    points[1][0] = 1.8;
    CHECK(approach() == 0.5);
    points[0][0] = 0;
    points[1][0] = 2.4 + 0.6; // 1 and 2 approach each other: their gap is now 0.2, listed are gaps up to 1.1
    points[2][0] = 5.6 - 0.4;
    CHECK_THAT(approach(), Catch::Matchers::WithinAbs(0.5, 1e-15)); // 0.9 / 2 is less than the 0.5 due to 3
    points[3][1] = 0;
    CHECK_THAT(approach(), Catch::Matchers::WithinAbs(0.45, 1e-15));
    points[4][0] = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(approach()));
}

namespace {

/// Few of the particles are fast. The list lasts as long as the approach allows, but must miss no pair in the margin.
template <class Search>
long long builds_by_approach(std::uint64_t seed, bool by_approach) {
    using Real = typename Search::real_type;
    constexpr int Dim = Search::dim;
    std::mt19937_64 rng(seed);
    std::size_t const n = 400;
    Real const skin = 1, margin = Real(0.05);
    std::vector<lacuna::vec<Real, Dim>> points, velocities;
    std::vector<Real> radii;
    Real fastest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        points.push_back(clouds::random_point<Real, Dim>(rng, Dim == 2 ? 60 : 18));
        auto v = clouds::random_point<Real, Dim>(rng, 1);
        for (int axis = 0; axis < Dim; ++axis) v[axis] = (v[axis] - Real(0.5)) * Real(i % 40 == 0 ? 0.08 : 0.004);
        velocities.push_back(v);
        radii.push_back(Real(0.6 + 0.6 * clouds::uniform(rng)));
        fastest = std::max(fastest, norm(v));
    }
    lacuna::verlet_list<Search> list({.skin = skin, .margin = margin});
    list.build(lacuna::view_points(points), radii);
    Real path = 0;
    int missed = 0, close = 0;
    for (int step = 0; step < 150; ++step) {
        for (std::size_t i = 0; i < n; ++i) points[i] += velocities[i];
        path += fastest * Real(1.0001);
        if (path > skin / 2) {
            auto const view = lacuna::view_points(points);
            Real const far = list.largest_displacement(view);
            path = by_approach ? list.largest_approach(view) : far;
            if (path > far) ++missed;
            if (path > skin * Real(0.45)) {
                list.build(view, radii);
                path = 0;
            }
        }
        std::vector<std::vector<bool>> listed(n, std::vector<bool>(n, false));
        for (auto const& p : list.pairs()) listed[std::size_t(p.i)][std::size_t(p.j)] = true;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 1; j < n; ++j)
                if (distance(points[i], points[j]) <= radii[i] + radii[j] + margin) {
                    ++close;
                    missed += !listed[i][j];
                }
    }
    CHECK(missed == 0);
    CHECK(close > 1000);
    return list.build_count();
}

} // namespace

TEST_CASE("a Verlet list lasts longer if the approach of unlisted particles is measured", "[neighbors]") {
    long long with = 0, without = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        with += builds_by_approach<lacuna::cell_grid<double, 2>>(seed, true);
        without += builds_by_approach<lacuna::cell_grid<double, 2>>(seed, false);
        with += builds_by_approach<lacuna::cell_grid<float, 3>>(seed, true);
        without += builds_by_approach<lacuna::cell_grid<float, 3>>(seed, false);
    }
    CHECK(with < without);
}

TEST_CASE("a Verlet list refuses a bad skin or margin", "[neighbors]") {
    using list_type = lacuna::verlet_list<lacuna::brute_force<double, 2>>;
    double const nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(list_type({.skin = -1, .margin = 0}), std::invalid_argument);
    CHECK_THROWS_AS(list_type({.skin = nan, .margin = 0}), std::invalid_argument);
    CHECK_THROWS_AS(list_type({.skin = 0, .margin = -1e-9}), std::invalid_argument);
    CHECK_THROWS_AS(list_type({.skin = 0, .margin = 1 / 0.0}), std::invalid_argument);
    CHECK(list_type({.skin = 0.5, .margin = 0.25}).settings().skin == 0.5);
}
