// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>

#include "catch.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

/// A square sheet of 24 x 24 discs by default, of mixed radii, half of its pairs bonded. It is torn, sheared and thrown
/// at a wall.
template <class Real>
lacuna::packing<Real, 2> sheet(int side = 24, bool tethers = false) {
    lacuna::packing<Real, 2> p;
    for (int r = 0; r < side; ++r)
        for (int c = 0; c < side; ++c) {
            auto const k = p.size();
            p.add({Real(c + 0.02 * noise(k, 1)), Real(r + 0.02 * noise(k, 2))}, Real(0.49 + 0.02 * noise(k, 3)));
            if (c > 0 && noise(k, 4) > 0) p.bonds.push_back({std::int32_t(k) - 1, std::int32_t(k)});
            if (r > 0 && noise(k, 5) > 0) p.bonds.push_back({std::int32_t(k) - side, std::int32_t(k)});
        }
    if (tethers) p.bonds.insert(p.bonds.end(), {{0, side * side - 1}, {side / 2, side * (side - 1)}});
    return p;
}

struct outcome {
    std::vector<lacuna::vec<double, 2>> position, velocity;
    std::vector<double> spin;
    std::vector<lacuna::break_event<2>> events;
    bool discards_forces = false; ///< whether forces were discarded once they were summed up
    int spans = 0;
};

template <class Model>
outcome play(lacuna::packing<typename Model::real, 2> const& packing, int threads, bool wall, auto const& original,
             bool keep_forces = true) {
    auto p = springs<Model>(100, 70, 0.4, unit_density(2), 1, 1);
    p.time_step = 5e-3;
    p.threads = threads;
    p.keep_pair_forces = keep_forces;
    p.interactions.initial_contact_tolerance = 0.02;
    p.allow_unstable_step = true; // the lever arms of tethers
    if (wall) p.walls = {{{0, -0.6}, {0, 1}, p.materials[0].contact}};
    lacuna::simulation<Model> run(packing, p);
    for (std::size_t k = 0; k < run.size(); ++k) {
        auto const id = original(k);
        run.set_velocity(k, {0.3 * noise(id, 6), 0.3 * noise(id, 7) - 0.2});
        run.set_spin(k, {noise(id, 8)});
    }
    outcome o;
    for (int n = 0; n < 60; ++n) {
        run.step();
        o.events.insert(o.events.end(), run.events().begin(), run.events().end());
    }
    o.discards_forces = run.pairs().forces_are_transient();
    o.spans = run.pairs().spans().count();
    for (std::size_t k = 0; k < run.size(); ++k) {
        o.position.push_back(run.position(k));
        o.velocity.push_back(run.velocity(k));
        o.spin.push_back(run.spin(k)[0]);
    }
    return o;
}

bool same(lacuna::break_event<2> const& a, lacuna::break_event<2> const& b) {
    return a.step == b.step && a.bond == b.bond && a.particles == b.particles && a.mode == b.mode &&
           a.position == b.position && a.normal_force == b.normal_force && a.shear_force == b.shear_force &&
           a.energy == b.energy;
}

template <class Model>
void check_threads(std::vector<int> const& counts) {
    auto const itself = [](std::size_t k) { return k; };
    for (bool const wall : {false, true}) {
        auto const one = play<Model>(sheet<typename Model::real>(), 1, wall, itself);
        REQUIRE(one.events.size() > 20);
        for (int const threads : counts) {
            if (threads > 2 && wall) continue; // more threads than cores are slow
            auto const more = play<Model>(sheet<typename Model::real>(), threads, wall, itself);
            REQUIRE(more.position == one.position);
            REQUIRE(more.velocity == one.velocity);
            REQUIRE(more.spin == one.spin);
            REQUIRE(more.events.size() == one.events.size());
            REQUIRE(std::equal(more.events.begin(), more.events.end(), one.events.begin(), same));
        }
    }
}

} // namespace

TEST_CASE("the same bits with any number of threads", "[determinism]") {
    check_threads<plane>({2, 4});
    check_threads<plane_in_single>({2});
}

TEST_CASE("the same bits whether pair forces are stored or not", "[determinism]") {
    // Without a wall particles move as soon as their forces are summed up; with a wall the sums wait for its forces.
    // The large sheet is cut into one span for each of two threads.
    auto const itself = [](std::size_t k) { return k; };
    auto const [side, threads] = GENERATE(table<int, int>({{24, 1}, {80, 1}, {80, 2}}));
    bool const wall = GENERATE(false, true), tethers = GENERATE(false, true);
    CAPTURE(side, threads, wall, tethers);
    auto const stored = play<plane>(sheet<double>(side, tethers), 1, wall, itself, true);
    auto const discarded = play<plane>(sheet<double>(side, tethers), threads, wall, itself, false);
    REQUIRE(stored.events.size() > 20);
    REQUIRE(!stored.discards_forces);
    REQUIRE(discarded.discards_forces);
    REQUIRE(discarded.spans == threads);
    REQUIRE(discarded.position == stored.position);
    REQUIRE(discarded.velocity == stored.velocity);
    REQUIRE(discarded.spin == stored.spin);
    REQUIRE(discarded.events.size() == stored.events.size());
    REQUIRE(std::equal(discarded.events.begin(), discarded.events.end(), stored.events.begin(), same));
}

TEST_CASE("the same bits for any order of particles and bonds in the input", "[determinism]") {
    auto const packing = sheet<double>();
    std::size_t const n = packing.size();
    auto const one = play<plane>(packing, 1, false, [](std::size_t k) { return k; });
    // new number = 181 * old modulo n: 181 and 576 share no factor.
    std::vector<std::size_t> old_number(n);
    for (std::size_t k = 0; k < n; ++k) old_number[k * 181 % n] = k;
    lacuna::packing<double, 2> shuffled;
    for (std::size_t k = 0; k < n; ++k) shuffled.add(packing.position[old_number[k]], packing.radius[old_number[k]]);
    for (auto b = packing.bonds.rbegin(); b != packing.bonds.rend(); ++b)
        shuffled.bonds.push_back(
            {std::int32_t(std::size_t((*b)[1]) * 181 % n), std::int32_t(std::size_t((*b)[0]) * 181 % n)});
    auto const other = play<plane>(shuffled, 1, false, [&](std::size_t k) { return old_number[k]; });
    for (std::size_t k = 0; k < n; ++k) {
        REQUIRE(other.position[k] == one.position[old_number[k]]);
        REQUIRE(other.spin[k] == one.spin[old_number[k]]);
    }
    REQUIRE(other.events.size() == one.events.size());
    for (std::size_t e = 0; e < one.events.size(); ++e) {
        REQUIRE(other.events[e].step == one.events[e].step);
        REQUIRE(other.events[e].position == one.events[e].position);
        REQUIRE(std::size_t(other.events[e].bond) == packing.bonds.size() - 1 - std::size_t(one.events[e].bond));
    }
}

TEST_CASE("a mirrored sheet has a mirrored motion", "[determinism]") {
    // Not bit by bit, because sums have another order, but within rounding as long as nothing bifurcates.
    auto p = springs<plane>(1, 0.5, 0.3, unit_density(2));
    p.time_step = 0.05;
    auto const packing = lattice(7, 4, false);
    lacuna::simulation<plane> run(packing, p);
    for (std::size_t k = 0; k < 7; ++k) run.fix(k);
    for (std::size_t k = 21; k < 28; ++k) run.apply(k, {0, -1e-3});
    for (int n = 0; n < 1000; ++n) run.step();
    REQUIRE(run.position(24)[1] < 3 - 1e-4);
    for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 7; ++c) {
            auto const a = run.position(7 * r + c), b = run.position(7 * r + 6 - c);
            REQUIRE_THAT(a[0] + b[0], WithinAbs(6, 1e-12));
            REQUIRE_THAT(a[1], WithinAbs(b[1], 1e-12));
        }
}
