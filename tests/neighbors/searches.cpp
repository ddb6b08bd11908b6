// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <stdexcept>
#include <utility>

#include <lacuna/neighbors/brute_force.hpp>
#include <lacuna/neighbors/cell_grid.hpp>
#include <lacuna/neighbors/kd_tree.hpp>

#include "catch.hpp"
#include "clouds.hpp"

using clouds::neighbor_pair;
template <class Real, int Dim>
using vectors = std::vector<lacuna::vec<Real, Dim>>;

static_assert(lacuna::neighbor_search<lacuna::brute_force<double, 2>>);
static_assert(lacuna::neighbor_search<lacuna::kd_tree<float, 3>>);
static_assert(lacuna::neighbor_search<lacuna::cell_grid<double, 3>>);
static_assert(!lacuna::neighbor_search<std::vector<int>>);

namespace {

std::string message_of(auto const& action) {
    try {
        action();
    } catch (std::invalid_argument const& e) {
        return e.what();
    }
    return "nothing was thrown";
}

bool contains(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

template <class Search>
void agrees_with_definition() {
    using Real = typename Search::real_type;
    constexpr int Dim = Search::dim;
    Search search; // one for all inputs: no input may affect the next
    std::vector<neighbor_pair> found{{5, 6}};
    std::size_t most = 0;
    for (auto const& c : clouds::all_clouds<Real, Dim>())
        for (Real const margin : {Real(0), Real(0.3e-6), Real(6e-6)}) {
            INFO(c.name << ", margin " << margin);
            int doubtful = 0;
            auto const expected = clouds::reference_pairs(c.points, c.radii, margin, doubtful);
            REQUIRE(doubtful == 0);
            search.touching_pairs(c.view(), c.radii, margin, found);
            REQUIRE(found == expected);
            most = std::max(most, found.size());

            std::vector<Real> const none(c.points.size(), Real(0));
            auto const close = clouds::reference_pairs(c.points, none, margin, doubtful);
            REQUIRE(doubtful == 0);
            search.build(c.view(), margin);
            std::as_const(search).pairs(found);
            REQUIRE(found == close);
        }
    REQUIRE(most > 1000);
}

template <class Search>
void includes_its_limit() {
    using Real = typename Search::real_type;
    constexpr int Dim = Search::dim;
    // A 9 x 9 lattice of spacing 1, also shifted by -37; all numbers are exact.
    for (Real const shift : {Real(0), Real(-37)}) {
        vectors<Real, Dim> points;
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 9; ++x) {
                lacuna::vec<Real, Dim> p{};
                p[0] = Real(x) + shift;
                p[Dim - 1] = Real(y) + shift;
                points.push_back(p);
            }
        Search search;
        std::vector<neighbor_pair> found;
        search.build(lacuna::view_points(points), Real(1));
        search.pairs(found);
        CHECK(found.size() == 2 * 9 * 8);
        Real const just_below = std::nextafter(Real(1), Real(0));
        search.build(lacuna::view_points(points), just_below);
        search.pairs(found);
        CHECK(found.empty());
        search.touching_pairs(lacuna::view_points(points), std::vector<Real>(81, Real(0.25)), Real(0.5), found);
        CHECK(found.size() == 2 * 9 * 8);
        search.touching_pairs(lacuna::view_points(points), std::vector<Real>(81, Real(0.5)), Real(0), found);
        CHECK(found.size() == 2 * 9 * 8);
        // Distance 5 exactly: (5, 0), (3, 4) and (4, 3). The count includes these and all shorter offsets.
        std::size_t within_five = 0;
        for (int a = 0; a < 81; ++a)
            for (int b = a + 1; b < 81; ++b) {
                int const dx = a % 9 - b % 9;
                int const dy = a / 9 - b / 9;
                within_five += dx * dx + dy * dy <= 25;
            }
        search.build(lacuna::view_points(points), Real(5));
        search.pairs(found);
        CHECK(found.size() == within_five);
    }
}

template <class Search>
void reads_strided_points() {
    using Real = typename Search::real_type;
    constexpr int Dim = Search::dim;
    constexpr std::size_t stride = Dim + 2;
    std::mt19937_64 rng(3);
    std::vector<Real> memory(120 * stride, std::numeric_limits<Real>::quiet_NaN());
    vectors<Real, Dim> points;
    for (std::size_t i = 0; i < 120; ++i) {
        points.push_back(clouds::random_point<Real, Dim>(rng, 10));
        for (int axis = 0; axis < Dim; ++axis) memory[i * stride + std::size_t(axis)] = points[i][axis];
    }
    int doubtful = 0;
    auto const expected = clouds::reference_pairs(points, std::vector<Real>(120, Real(0.5)), Real(0.25), doubtful);
    REQUIRE(doubtful == 0);
    REQUIRE(expected.size() > 10);
    Search search;
    std::vector<neighbor_pair> found;
    search.touching_pairs({memory.data(), 120, stride}, std::vector<Real>(120, Real(0.5)), Real(0.25), found);
    CHECK(found == expected);
}

template <class Search>
void refuses_bad_input() {
    using Real = typename Search::real_type;
    constexpr int Dim = Search::dim;
    Search search;
    std::vector<neighbor_pair> found;
    vectors<Real, Dim> points(20);
    std::vector<Real> radii(20, Real(1));
    auto const touching = [&](Real margin) {
        return [&, margin] { search.touching_pairs(lacuna::view_points(points), radii, margin, found); };
    };
    CHECK(message_of(touching(Real(0))) == "nothing was thrown");
    CHECK(contains(message_of(touching(Real(-1))), "margin = -1"));
    CHECK(contains(message_of(touching(std::numeric_limits<Real>::quiet_NaN())), "margin = nan"));
    CHECK(contains(message_of(touching(std::numeric_limits<Real>::max() / 4)), "square"));
    CHECK(contains(message_of([&] { search.build(lacuna::view_points(points), Real(-2)); }), "cutoff = -2"));
    radii[7] = Real(-3);
    CHECK(contains(message_of(touching(Real(0))), "particle 7 = -3"));
    radii[7] = std::numeric_limits<Real>::infinity();
    CHECK(contains(message_of(touching(Real(0))), "particle 7 = inf"));
    radii.assign(19, Real(1));
    CHECK(contains(message_of(touching(Real(0))), "number of radii = 19"));
    radii.assign(20, Real(1));
    points[13][Dim - 1] = std::numeric_limits<Real>::quiet_NaN();
    CHECK(contains(message_of(touching(Real(0))), "particle 13, coordinate " + std::to_string(Dim - 1) + " = nan"));
    points[13][Dim - 1] = -std::numeric_limits<Real>::infinity();
    CHECK(contains(message_of([&] { search.build(lacuna::view_points(points), Real(1)); }), "particle 13"));
}

template <template <class, int> class Search, class Check>
void for_all_types(Check check) {
    check.template operator()<Search<double, 2>>();
    check.template operator()<Search<double, 3>>();
    check.template operator()<Search<float, 2>>();
    check.template operator()<Search<float, 3>>();
}

template <template <class, int> class Search>
void check_search() {
    SECTION("finds the pairs of the definition on all inputs") {
        for_all_types<Search>([]<class S> { agrees_with_definition<S>(); });
    }
    SECTION("includes pairs exactly at the limit, and none beyond") {
        for_all_types<Search>([]<class S> { includes_its_limit<S>(); });
    }
    SECTION("reads strided points") {
        for_all_types<Search>([]<class S> { reads_strided_points<S>(); });
    }
    SECTION("refuses bad input and names it") {
        for_all_types<Search>([]<class S> { refuses_bad_input<S>(); });
    }
}

} // namespace

TEST_CASE("brute force search", "[neighbors]") { check_search<lacuna::brute_force>(); }
TEST_CASE("k-d tree search", "[neighbors]") { check_search<lacuna::kd_tree>(); }
TEST_CASE("cell grid search", "[neighbors]") { check_search<lacuna::cell_grid>(); }

TEST_CASE("a copied or moved k-d tree has its own points", "[neighbors]") {
    vectors<double, 2> const points{{0, 0}, {1, 0}, {5, 5}};
    std::vector<neighbor_pair> found;
    lacuna::kd_tree<double, 2> copy;
    {
        lacuna::kd_tree<double, 2> original;
        original.build(lacuna::view_points(points), 1.5);
        copy = original;
        lacuna::kd_tree<double, 2> const moved = std::move(original);
        moved.pairs(found);
        CHECK(found == std::vector<neighbor_pair>{{0, 1}});
    }
    copy.pairs(found);
    CHECK(found == std::vector<neighbor_pair>{{0, 1}});
}

TEST_CASE("the cell grid copes with particles that have flown away", "[neighbors]") {
    // About 20,000 discs of radius 1 on a square lattice of spacing 2, and five up to 1e12 radii away. A table over the
    // bounding box would have 1e24 cells. With all lattice discs in one cell, the search would take 1e8 steps.
    vectors<float, 2> points;
    int const side = 140;
    for (int k = 0; k < side * side; ++k) points.push_back({float(2 * (k % side)), float(2 * (k / side))});
    std::vector<float> radii(points.size(), 1.0f);
    for (std::size_t k = 0; k < 5; ++k) {
        points.push_back({-1e12f + float(k) * 1e9f, 3e11f * float(k)});
        radii.push_back(1.0f);
    }
    lacuna::cell_grid<float, 2> search;
    std::vector<neighbor_pair> found;
    search.touching_pairs(lacuna::view_points(points), radii, 0.1f, found);
    CHECK(found.size() == std::size_t(2 * side * (side - 1)));
    bool lattice_neighbors = true;
    for (auto const& p : found) lattice_neighbors &= p.j - p.i == side || (p.j - p.i == 1 && p.j % side != 0);
    CHECK(lattice_neighbors);
}

TEST_CASE("a search reuses the memory of its output", "[neighbors]") {
    std::mt19937_64 rng(8);
    vectors<double, 2> points;
    for (int k = 0; k < 3000; ++k) points.push_back(clouds::random_point<double, 2>(rng, 100));
    std::vector<double> const radii(points.size(), 1.0);
    std::vector<neighbor_pair> found;
    lacuna::cell_grid<double, 2> search;
    search.touching_pairs(lacuna::view_points(points), radii, 0.1, found);
    auto const* const before = found.data();
    std::size_t const count = found.size();
    REQUIRE(count > 1000);
    search.touching_pairs(lacuna::view_points(points), radii, 0.1, found);
    CHECK(found.size() == count);
    CHECK(found.data() == before);
}
