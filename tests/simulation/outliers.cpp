// SPDX-License-Identifier: BSD-3-Clause
// One long bond, one huge particle or one fast particle among many: it changes
// neither the motion of the others nor the cost.

#include <cstdio>
#include <string>

#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

/// Touching discs of radius 0.5 in `side` rows and columns, without bonds.
template <class Real>
lacuna::packing<Real, 2> square(int side) {
    lacuna::packing<Real, 2> p;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) p.add({Real(x + 0.5), Real(y + 0.5)}, Real(0.5));
    return p;
}

template <class Model>
std::size_t candidates(lacuna::packing<typename Model::real, Model::dim> const& p,
                       lacuna::simulation_parameters<Model> const& s) {
    return lacuna::simulation<Model>(p, s).pairs().neighbors().pairs().size();
}

} // namespace

TEMPLATE_TEST_CASE("a long bond does not widen the search for contacts", "[outliers]", plane, plane_in_single) {
    using real = typename TestType::real;
    int const side = 30;
    auto particles = square<real>(side);
    auto p = springs<TestType>(1e6, 5e5, 0.2, 2500);
    // Only neighbours in a row or column have a gap below a tenth of the radius: (side - 1) * side pairs of each kind.
    std::size_t const by_hand = 2 * std::size_t(side - 1) * std::size_t(side);
    CHECK(candidates<TestType>(particles, p) == by_hand);
    particles.bonds.push_back({0, side * side - 1});
    CHECK(candidates<TestType>(particles, p) == by_hand);
    // The diagonal bond is without force at its initial distance, and is no contact.
    lacuna::simulation<TestType> run(particles, p);
    CHECK(run.pairs().contacts().size() == by_hand);
    CHECK(run.pairs().bonds().size() == 1);
}

TEST_CASE("a huge particle does not widen the search or the tolerance of the others", "[outliers]") {
    int const side = 30;
    auto particles = square<double>(side);
    auto p = springs<plane>(1e6, 5e5, 0.2, 2500);
    std::size_t const by_hand = 2 * std::size_t(side - 1) * std::size_t(side);
    // It touches the two discs in the middle of the lowest row, and has a gap of x^2 / 2 R to those at the distance x.
    double const huge = 5000;
    particles.add({side / 2.0, -std::sqrt((huge + 0.5) * (huge + 0.5) - 0.25) + 0.5}, huge);
    std::size_t const below = candidates<plane>(particles, p) - by_hand;
    // Half a skin of its own more than theirs, 0.0375 + 0.025: x^2 / 2 (R + 0.5) below that, x = 0.5, 1.5, ...: all 30
    // discs.
    CHECK(below == 30);
    p.interactions.initial_contact_tolerance = 0.2; // 0.1 for discs, by the smaller radius; 1000 for the huge one alone
    CHECK(candidates<plane>(particles, p) == by_hand + 30);
    p.interactions.initial_contact_tolerance = 0.5; // 0.25: still below the gap of discs across a corner, 0.414
    CHECK(candidates<plane>(particles, p) == by_hand + 30);
    p.interactions.skin = 0; // without a skin only the tolerance is left: x^2 / 2 R <= 0.25, all of them
    CHECK(candidates<plane>(particles, p) == by_hand + 30);
}

namespace {

/// A bond of 3 m between two discs of radius 0.5 that are far from all others. Its second disc is moved.
struct long_bond {
    lacuna::simulation<plane> run;
    double normal = 0, jump = 0;

    explicit long_bond(double skin) : run([&] {
        auto p = springs<plane>(100, 100, 0.5, unit_density(2), never, 1);
        p.interactions.skin = skin;
        p.time_step = 1e-3;
        lacuna::packing<double, 2> two;
        two.add({0, 0}, 0.5);
        two.add({3, 0}, 0.5);
        for (int k = 0; k < 20; ++k) two.add({-20.0, 2.0 * k}, 0.5);
        two.bonds.push_back({0, 1});
        lacuna::simulation<plane> s(two, p);
        for (std::size_t k : {0, 1}) s.fix(k);
        s.set_velocity(12, {0.0, 0.05}); // its list becomes outdated, too
        return s;
    }()) {}
    void move(double dx, double dy, int steps) {
        run.set_velocity(1, {dx / (steps * 1e-3), dy / (steps * 1e-3)});
        for (int n = 0; n < steps; ++n) advance();
        run.set_velocity(1, {});
        advance();
    }
    void advance() {
        auto const arm = run.position(1) - run.position(0);
        double const before = normal;
        run.step();
        normal = dot(pair_force(run, 0, 1), arm / norm(arm));
        jump = std::max(jump, std::fabs(normal) - std::fabs(before));
    }
};

} // namespace

TEST_CASE("a long bond that fails becomes a contact, at any distance", "[outliers][hand-over]") {
    for (double const skin : {0.0, 0.1, 8.0}) {
        INFO("skin " << skin);
        long_bond b(skin);
        b.move(-0.1, 0, 200); // compression: 10 N
        REQUIRE_THAT(b.normal, WithinRel(-10, 1e-9));
        b.move(0, 0.02, 100); // shear beyond 1 N: fails, and keeps the compressive force
        REQUIRE(b.run.pairs().bonds().size() == 0);
        REQUIRE_THAT(b.normal, WithinRel(-10, 1e-3));
        double const broken = b.normal;
        b.move(0, 0, 2000); // meanwhile the motion of others rebuilds the list
        CHECK(b.normal == broken);
        if (skin < 1) CHECK(b.run.pairs().neighbors().build_count() > 2);
        b.move(-0.05, 0, 200); // closer again
        CHECK_THAT(b.normal, WithinRel(-15, 1e-3));
        b.move(0.2, 0, 400); // beyond its initial distance: it separates permanently
        CHECK(b.normal == 0);
        b.move(-0.5, 0, 400); // at distances where the bond was compressed there is no force any more
        CHECK(b.normal == 0);
        // Until they touch at the sum of their radii, with a force that starts from zero.
        auto const arm = b.run.position(1) - b.run.position(0);
        double const gap = norm(arm) - 1;
        b.move(-(gap + 0.02), -arm[1], 4000);
        CHECK_THAT(b.normal, WithinAbs(-2, 0.2));
        CHECK(b.jump < 100 * 0.6e-3 * 2); // at most stiffness times the path of a step
    }
}

TEST_CASE("particles of a long bond that fails in tension touch again at the sum of the radii",
          "[outliers][hand-over]") {
    auto p = springs<plane>(100, 100, 0.5, unit_density(2), 1, never);
    p.time_step = 1e-3;
    lacuna::packing<double, 2> two;
    two.add({0, 0}, 0.5);
    two.add({3, 0}, 0.5);
    two.bonds.push_back({0, 1});
    lacuna::simulation<plane> run(two, p);
    for (std::size_t k : {0, 1}) run.fix(k);
    run.set_velocity(1, {0.1, 0});
    run.run(200);
    REQUIRE(run.pairs().bonds().size() == 0);
    CHECK(run.pairs().contacts().size() == 0); // far away: no candidate
    run.set_velocity(1, {-0.5, 0});
    double distance = 0;
    while (distance == 0 || run.position(1)[0] > 0.95) {
        distance = run.position(1)[0];
        run.step();
        CHECK_THAT(pair_force(run, 0, 1)[0], WithinAbs(-100 * std::max(1 - distance, 0.0), 1e-9));
    }
}

namespace {

/// Discs in frictional contact. Some start with a gap and an individual touching distance; one is fast, one is huge.
template <class Model>
lacuna::simulation<Model> crowd(double skin, int threads = 1, bool reversed = false) {
    using real = typename Model::real;
    auto p = springs<Model>(1000, 500, 0.3, 1.0, 5, 4);
    p.interactions.skin = skin;
    p.interactions.initial_contact_tolerance = 0.05;
    p.time_step = 4e-4;
    p.allow_unstable_step = true; // the bound may count pairs that are far from touching
    p.threads = threads;
    lacuna::packing<real, 2> all;
    if constexpr (Model::domain::periodic) p.domain.period = {60, 0};
    int const columns = 20, rows = 10, n = columns * rows + 2;
    auto const index = [&](int k) { return reversed ? n - 1 - k : k; };
    for (int at = 0; at < n; ++at) {
        int const k = index(at);
        if (k == n - 2) all.add({real(-3), real(4.3)}, real(0.4));         // the fast one
        else if (k == n - 1) all.add({real(10), real(-12.52)}, real(12));  // the huge one
        else all.add({real(k % columns * 1.01), real(k / columns * 1.02)}, real(0.5));
    }
    all.bonds.push_back({index(0), index(columns * rows - 1)}); // a long bond
    for (int k = 0; k < 60; ++k) all.bonds.push_back({index(3 * k), index(3 * k + 1)});
    lacuna::simulation<Model> run(all, p);
    for (int k = 0; k < columns * rows; ++k)
        run.set_velocity(std::size_t(index(k)), {0.3 * std::sin(3.7 * k), 0.3 * std::cos(2.3 * k)});
    run.set_velocity(std::size_t(index(n - 2)), {8.0, 0.3});
    return run;
}

} // namespace

TEST_CASE("results do not depend on the range of the search", "[outliers][determinism]") {
    // Wide: every pair is always a candidate. Narrow: no skin, and a search after every step.
    auto narrow = crowd<plane>(0), usual = crowd<plane>(0.1), wide = crowd<plane>(200);
    std::size_t broken = 0;
    for (int n = 0; n < 1500; ++n) {
        narrow.step(), usual.step(), wide.step();
        broken += wide.events().size();
    }
    CHECK(broken > 5);
    CHECK(wide.pairs().neighbors().build_count() == 1);
    CHECK(narrow.pairs().neighbors().build_count() > 1000);
    for (std::size_t k = 0; k < wide.size(); ++k)
        for (int axis = 0; axis < 2; ++axis) {
            REQUIRE(usual.position(k)[axis] == wide.position(k)[axis]);
            REQUIRE(narrow.position(k)[axis] == wide.position(k)[axis]);
        }
}

TEMPLATE_TEST_CASE("a crowd with outliers has the same bits with threads and after a restart",
                   "[outliers][determinism][checkpoint]", plane, plane_in_single, ring) {
    auto one = crowd<TestType>(0.2), two = crowd<TestType>(0.2, 2), reversed = crowd<TestType>(0.2, 1, true);
    auto resumed = crowd<TestType>(0.2);
    std::string const file = "outliers" + std::to_string(sizeof(typename TestType::real)) +
                             std::to_string(TestType::domain::periodic) + ".bin";
    for (int n = 0; n < 900; ++n) {
        one.step(), two.step(), reversed.step();
        if (n == 400) {
            lacuna::save_checkpoint(file, one);
            lacuna::load_checkpoint(file, resumed);
            std::remove(file.c_str());
        }
        if (n > 400) resumed.step();
    }
    CHECK(one.pairs().neighbors().build_count() > 2);
    CHECK(lacuna::state_hash(one) == lacuna::state_hash(two));
    CHECK(lacuna::state_hash(one) == lacuna::state_hash(resumed));
    for (std::size_t k = 0; k < one.size(); ++k)
        for (int axis = 0; axis < 2; ++axis)
            CHECK(one.position(k)[axis] == reversed.position(one.size() - 1 - k)[axis]);
}

TEST_CASE("a particle with many more contacts than its neighbours gets the sum of their forces", "[outliers]") {
    // Rows of its chunk are uneven: 60 discs around a disc of radius 10, each with its own overlap. The sum of their
    // forces is computed by hand.
    auto p = springs<plane>(100, 0, 0, 1);
    p.time_step = 1e-6;
    lacuna::packing<double, 2> all;
    all.add({0, 0}, 10);
    for (int k = 0; k < 60; ++k)
        all.add({(10.45 - 0.001 * k) * std::cos(0.1047 * k), (10.45 - 0.001 * k) * std::sin(0.1047 * k)}, 0.5);
    lacuna::simulation<plane> run(all, p);
    run.step();
    lacuna::vec<double, 2> sum{};
    for (int k = 0; k < 60; ++k) {
        double const push = 100 * (0.05 + 0.001 * k);
        sum += lacuna::vec<double, 2>{-push * std::cos(0.1047 * k), -push * std::sin(0.1047 * k)};
    }
    CHECK_THAT(run.force(0)[0], WithinRel(sum[0], 1e-9));
    CHECK_THAT(run.force(0)[1], WithinRel(sum[1], 1e-9));
    CHECK_THAT(run.velocity(0)[0], WithinRel(sum[0] / run.mass(0) * 1e-6, 1e-9));
}

TEST_CASE("a fast particle misses no wall, and does not make the walls check all particles", "[outliers][walls]") {
    auto particles = square<double>(20);
    particles.add({-2.0, 25.0}, 0.5);
    auto p = springs<plane>(4e4, 2e4, 0, 1);
    p.time_step = 1e-4;
    for (double const x : {-3.0, 30.0}) {
        lacuna::wall<plane::contact_law, 2> w;
        w.point = {x, 0};
        w.normal = {x < 0 ? 1.0 : -1.0, 0};
        w.material = p.materials[0].contact;
        p.walls.push_back(w);
    }
    lacuna::simulation<plane> run(particles, p);
    run.set_velocity(400, {100, 0}); // 0.01 m per step
    double farthest = 0, nearest = 30;
    int turns = 0;
    for (int n = 0; n < 12000; ++n) {
        double const before = run.velocity(400)[0];
        run.step();
        turns += before * run.velocity(400)[0] < 0;
        farthest = std::max(farthest, run.position(400)[0]);
        nearest = std::min(nearest, run.position(400)[0]);
    }
    // Between the walls there are 32 m: it comes back three times; springs turn it within v sqrt(m / k)
    // = 100 sqrt(0.785 / 4e4) = 0.443.
    CHECK(turns == 3);
    CHECK(farthest < 29.5 + 0.45);
    CHECK(nearest > -2.5 - 0.45);
    CHECK_THAT(std::fabs(run.velocity(400)[0]), WithinRel(100, 1e-3));
    // Of 120 m, 2.4 m at a time (as much as 32 others take), where half a skin is 0.025 m.
    CHECK(run.pairs().neighbors().build_count() < 80);
}
