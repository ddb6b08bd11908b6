// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/laws/beam_bond.hpp>
#include <lacuna/simulation.hpp>

#include "catch.hpp"

using namespace lacuna;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

struct plane_of_beams : default_model<2> {
    using bond_law = beam_bond;
};
struct space_of_springs : default_model<3> {};

/// Two bonded particles 1 m apart along x, and a third that overlaps the second by 0.01 m along y.
template <class Model>
simulation<Model> three() {
    packing<double, Model::dim> p;
    for (int k = 0; k < 3; ++k) {
        vec<double, Model::dim> x{};
        x[0] = k == 0 ? 0 : 1;
        x[1] = k == 2 ? 0.99 : 0;
        p.add(x, 0.5);
    }
    p.bonds.push_back({0, 1});
    simulation_parameters<Model> q;
    q.materials[0].contact = {.normal_stiffness = 5e5, .shear_stiffness = 2e5, .friction = 0.3};
    return simulation<Model>(p, q);
}

} // namespace

TEST_CASE("pair tangents: bonds, then contacts, with stiffness, force and levers", "[interactions][tangent]") {
    auto const run = three<space_of_springs>();
    std::vector<pair_tangent<3>> found;
    run.pairs().for_each_pair_tangent(run.particles(), run.assumed_contacts(),
                                      [&](auto const& t) { found.push_back(t); });
    REQUIRE(found.size() == 2);
    auto const& bond = found[0];
    auto const& contact = found[1];
    CHECK(bond.bonded);
    CHECK_FALSE(contact.bonded);
    auto const& material = run.settings().materials[0];
    CHECK_THAT(bond.normal_stiffness, WithinRel(material.bond.normal_stiffness, 1e-12));
    CHECK_THAT(bond.shear_stiffness, WithinRel(material.bond.shear_stiffness, 1e-12));
    CHECK(bond.prestress == 0);
    CHECK_THAT(contact.normal_stiffness, WithinRel(5e5, 1e-12));
    CHECK_THAT(contact.shear_stiffness, WithinRel(2e5, 1e-12));
    CHECK_THAT(contact.prestress, WithinRel(5e5 * 0.01 / 0.99, 1e-9)); // force over distance
    CHECK_THAT(contact.lever_i, WithinRel(0.495, 1e-12));
    CHECK_THAT(std::fabs(contact.normal[1]), WithinRel(1.0, 1e-12));
    CHECK(contact.moments.bending == 0);
}

TEST_CASE("pair tangents of a beam carry its resistance to bending", "[interactions][tangent]") {
    auto const run = three<plane_of_beams>();
    int beams = 0;
    run.pairs().for_each_pair_tangent(run.particles(), run.assumed_contacts(), [&](pair_tangent<2> const& t) {
        if (!t.bonded) return;
        ++beams;
        auto const& row = run.pairs().bond_parameters().row[0];
        CHECK_THAT(t.moments.bending, WithinRel(beam_bond::rotational_stiffness<2>(row, 0.5, 0.5, 1.0).bending, 1e-12));
        CHECK(t.moments.bending > 0);
        CHECK(t.lever_i == 0.5);
    });
    CHECK(beams == 1);
}

TEST_CASE("a trial evaluation has the forces of a step and leaves histories and bonds as they are",
          "[interactions][trial]") {
    auto run = three<space_of_springs>();
    run.set_velocity(2, {0.1, -0.05, 0});
    run.run(5);
    auto trial = run.pairs(), committed = run.pairs();
    auto const& store = run.particles();
    double const dt = run.time_step();
    for (int c = 0; c < trial.chunks(); ++c) {
        trial.evaluate<true, false>(store, c, dt);
        committed.evaluate<true, true>(store, c, dt);
    }
    auto const at = committed.find_force(store.internal(1), store.internal(2));
    REQUIRE(at >= 0);
    for (int n = 0; n < 8; ++n) CHECK(trial.force_column()[at + n] == committed.force_column()[at + n]);
    CHECK(trial.energy().stored == committed.energy().stored);
    auto const slot = std::size_t(run.pairs().contacts().find(std::min(store.internal(1), store.internal(2)),
                                                              std::max(store.internal(1), store.internal(2))));
    auto const before = run.pairs().contacts().get(slot).state, left = trial.contacts().get(slot).state;
    auto const moved = committed.contacts().get(slot).state;
    CHECK(norm(before.shear_force - left.shear_force) == 0);
    CHECK(norm(before.shear_force - moved.shear_force) > 0);
    // A bond beyond its strength: a trial says nothing of it.
    packing<double, 2> pair;
    pair.add({0, 0}, 0.5);
    pair.add({1, 0}, 0.5);
    pair.bonds.push_back({0, 1});
    simulation_parameters<default_model<2>> weak;
    weak.materials[0].bond.tensile_strength = 1e-6;
    weak.time_step = 1e-5;
    weak.allow_unstable_step = true;
    simulation<default_model<2>> pulled(pair, weak);
    pulled.fix(0);
    pulled.prescribe_velocity(1, {1, 0});
    pulled.run(1);
    auto quiet = pulled.pairs(), loud = pulled.pairs();
    quiet.evaluate<false, false>(pulled.particles(), 0, 1e-5);
    loud.evaluate<false>(pulled.particles(), 0, 1e-5);
    CHECK(quiet.collect_events().empty());
    CHECK(loud.collect_events().size() == 1);
}
