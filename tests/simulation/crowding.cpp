// SPDX-License-Identifier: BSD-3-Clause

#include <lacuna/simulation/checkpoint.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

/// \file
/// Discs that are far apart at first and then crowd together: contact tables start empty and have to grow during the
/// run.

using namespace setups;

namespace {

constexpr int side = 24; // 576 discs, five chunks
constexpr double stiffness = 100;

lacuna::simulation<plane> crowd(int threads = 1, bool keep_forces = true) {
    lacuna::packing<double, 2> packing;
    auto const noise = [](std::size_t k, int salt) { return std::sin(12.9898 * double(k) + 78.233 * salt); };
    for (int r = 0; r < side; ++r)
        for (int c = 0; c < side; ++c) {
            auto const k = packing.size();
            packing.add({1.5 * c + 0.1 * noise(k, 1), 1.5 * r + 0.1 * noise(k, 2)}, 0.48 + 0.02 * noise(k, 3));
        }
    auto p = springs<plane>(stiffness, 70, 0.4, unit_density(2));
    p.time_step = 5e-3;
    p.threads = threads;
    p.keep_pair_forces = keep_forces;
    lacuna::simulation<plane> run(packing, p);
    // Towards the centre, with a speed that grows with the distance.
    for (std::size_t k = 0; k < run.size(); ++k)
        run.set_velocity(k, (lacuna::vec<double, 2>{0.75 * (side - 1), 0.75 * (side - 1)} - run.position(k)) * 0.3);
    return run;
}

std::size_t packs(lacuna::simulation<plane> const& run) { return run.pairs().contacts().packs(); }

} // namespace

TEST_CASE("every pair has the force of its spring after the table of contacts has grown", "[interactions]") {
    auto run = crowd();
    auto const at_first = packs(run);
    REQUIRE(run.pairs().contacts().size() == 0);
    int layouts = 0;
    std::size_t touching = 0;
    for (int n = 0; n < 300; ++n) {
        auto const before = packs(run);
        std::vector<lacuna::vec<double, 2>> x;
        for (std::size_t k = 0; k < run.size(); ++k) x.push_back(run.position(k));
        run.step();
        layouts += packs(run) != before;
        if (n % 10 > 0) continue;
        touching = 0;
        for (std::size_t a = 0; a < run.size(); ++a)
            for (std::size_t b = a + 1; b < run.size(); ++b) {
                auto const arm = x[b] - x[a];
                double const overlap = run.radius(a) + run.radius(b) - norm(arm);
                if (overlap < -0.2) continue; // possibly no candidate
                touching += overlap > 0;
                double const normal = overlap > 0 ? -stiffness * overlap : 0;
                REQUIRE_THAT(dot(run.pair_force(a, b), arm) / norm(arm), WithinAbs(normal, 1e-9));
            }
    }
    REQUIRE(layouts > 1);
    REQUIRE(packs(run) > 4 * at_first);
    REQUIRE(touching > 500);
}

TEST_CASE("a resumed run has the same bits although its table of contacts has another layout", "[checkpoint]") {
    auto whole = crowd();
    for (int n = 0; n < 300; ++n) whole.step();
    bool another_layout = false;
    for (int const at : {150, 200, 240, 280}) {
        CAPTURE(at);
        auto first = crowd();
        for (int n = 0; n < at; ++n) first.step();
        auto const file = lacuna::checkpoint_of(first);
        auto second = crowd(at == 200 ? 2 : 1, at != 240);
        lacuna::resume_from(file, "in memory", second);
        another_layout = another_layout || packs(second) != packs(first);
        REQUIRE(lacuna::checkpoint_of(second).state == file.state);
        for (int n = at; n < 300; ++n) second.step();
        REQUIRE(lacuna::checkpoint_of(second).state == lacuna::checkpoint_of(whole).state);
    }
    REQUIRE(another_layout);
}

TEST_CASE("the same bits with any number of threads while the table of contacts grows", "[determinism]") {
    auto const end = [](int threads, bool keep_forces) {
        auto run = crowd(threads, keep_forces);
        for (int n = 0; n < 300; ++n) run.step();
        return lacuna::state_hash(run);
    };
    auto const one = end(1, true);
    for (int const threads : {1, 2, 3}) REQUIRE(end(threads, false) == one);
    REQUIRE(end(2, true) == one);
}
