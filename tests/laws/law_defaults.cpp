// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <string>

#include <lacuna/laws/law_defaults.hpp>
#include <lacuna/simulation.hpp>

#include "catch.hpp"

using namespace lacuna;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// F = -k overlap^2 (1 + overlap / c): all but the formula by default.
struct cubic : law_defaults<cubic> {
    struct material {
        double stiffness = 100, length = 1; // N/m^2, m
        void validate(std::string const& name) const { require_positive(name + ".stiffness", stiffness); }
    };
    template <class T>
    struct parameters {
        T stiffness, length;
    };
    template <class T, int Dim>
    struct history {
        T touching_distance;
        vec<T, shear_dim<Dim>> shear_force;
    };
    template <class T, int Dim>
    static force_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                            history<T, Dim> const& h) {
        T overlap = max(h.touching_distance - m.distance, T(0));
        return {-(p.stiffness * overlap * overlap * (T(1) + overlap / p.length)), h.shear_force, h};
    }
    static constexpr std::array combined_by{combine_rule::series, combine_rule::larger};
};
struct mean_of_all : cubic {
    static constexpr combine_rule combined_by = combine_rule::mean;
};
static_assert(contact_law<cubic, 2> && contact_law<cubic, 3>);
static_assert(!states_energies<cubic, 2> && states_energies<frictional_spring, 2>);

struct dashed : default_model<2> {
    using contact_law = cubic;
    using damping = viscous_damping;
};

} // namespace

TEST_CASE("law_defaults: two materials combine by a named rule", "[laws][law_defaults]") {
    CHECK(combined(combine_rule::series, 2, 6) == 3);
    CHECK(combined(combine_rule::series, 2, 0) == 0);
    CHECK(combined(combine_rule::mean, 2, 6) == 4);
    CHECK(combined(combine_rule::smaller, 2, 6) == 2);
    CHECK(combined(combine_rule::larger, 2, 6) == 6);
    auto const p = cubic::combine({2, 3}, {6, 5}, 1);
    CHECK(p.stiffness == 3);
    CHECK(p.length == 5);
    auto const q = law_defaults<mean_of_all>::combine({2, 3}, {6, 5}, 1);
    CHECK(q.stiffness == 4);
    CHECK(q.length == 4);
}

TEST_CASE("law_defaults: a contact starts without force, and takes the shear force of a bond over",
          "[laws][law_defaults]") {
    auto const h = cubic::initial<double, 3>(0.75, 1.0);
    CHECK(h.touching_distance == 0.75);
    CHECK(squared_norm(h.shear_force) == 0);
    pair_motion<double, 2> const m{0.9, 0.5, 0.5, {}, 0};
    auto const taken = cubic::hand_over(cubic::parameters<double>{1, 1}, m, -3.0, vec<double, 1>{2.0});
    CHECK(taken.touching_distance == 0.9);
    CHECK(taken.shear_force[0] == 2);
    CHECK(cubic::evaluate(cubic::parameters<double>{1, 1}, m, taken).normal_force == 0);
}

TEST_CASE("law_defaults: the stiffness is the formula's derivative, for numbers and packs", "[laws][law_defaults]") {
    // d/dx k x^2 (1 + x / c) = k (2 x + 3 x^2 / c).
    auto const exact = [](double x) { return 100 * (2 * x + 3 * x * x / 0.4); };
    cubic::parameters<double> const p{100, 0.4};
    cubic::history<double, 2> const h{1.0, {}};
    for (double const x : {0.01, 0.2, 0.5}) {
        pair_motion<double, 2> const m{1 - x, 0.5, 0.5, {}, 0};
        CHECK_THAT((cubic::stiffness(p, m, h)), WithinRel(exact(x), 1e-13));
    }
    using lanes = pack<double, 4>;
    lanes distance;
    for (int k = 0; k < 4; ++k) distance.v[k] = 1.05 - 0.1 * k; // the first is open
    auto const k = cubic::stiffness(cubic::parameters<lanes>{lanes(100), lanes(0.4)},
                                    pair_motion<lanes, 2>{distance, lanes(0.5), lanes(0.5), {}, lanes(0)},
                                    cubic::history<lanes, 2>{lanes(1), {}});
    CHECK(k[0] == 0);
    for (int lane = 1; lane < 4; ++lane) CHECK_THAT(k[lane], WithinRel(exact(0.1 * lane - 0.05), 1e-12));
}

TEST_CASE("a law without energies: its forces act, and the ledger says that it is incomplete",
          "[laws][law_defaults][energy]") {
    packing<double, 2> discs;
    discs.add({0, 0}, 0.5);
    discs.add({1.01, 0}, 0.5);
    simulation_parameters<dashed> p;
    p.materials[0].contact = {1e6, 0.1};
    simulation<dashed> run(discs, p);
    run.set_velocity(0, {0.05, 0});
    for (int n = 0; n < 200000 && !(run.velocity(1)[0] > 0.02); ++n) run.step_with_energy();
    CHECK(run.velocity(1)[0] > 0.02);
    CHECK_FALSE(run.energy().complete);
    CHECK(std::isnan(run.energy().residual()));
    CHECK_THAT(run.mass(0) * run.velocity(0)[0] + run.mass(1) * run.velocity(1)[0],
               WithinRel(run.mass(0) * 0.05, 1e-12));
    struct complete : default_model<2> {};
    simulation<complete> other(discs);
    other.step_with_energy();
    CHECK(other.energy().complete);
}
