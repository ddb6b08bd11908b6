// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>

#include "catch.hpp"
#include "reference.hpp"
#include "simulation/setups.hpp"

#include <lacuna/laws/beam_bond.hpp>
#include <lacuna/laws/brittle_beam_bond.hpp>
#include <lacuna/laws/parallel_bond.hpp>

using namespace setups;

namespace {

template <int Dim, class Bond = lacuna::parallel_bond>
struct beams : lacuna::default_model<Dim> {
    using contact_law = lacuna::no_contact;
    using bond_law = Bond;
};
template <int Dim, class Bond = lacuna::parallel_bond>
struct damped_beams_of : beams<Dim, Bond> {
    using damping = lacuna::combined_damping;
};
using damped_beams = damped_beams_of<2>;

template <class Model>
lacuna::simulation_parameters<Model> beam(double kn, double ks, double tensile = never, double shear = never) {
    lacuna::simulation_parameters<Model> p;
    p.materials[0].density = unit_density(Model::dim);
    p.materials[0].bond = {kn, ks, tensile, shear, 1};
    return p;
}

} // namespace

TEST_CASE("a tip-loaded beam of parallel bonds bends as in reference 4d", "[moment]") {
    for (int const count : {5, 10}) {
        lacuna::simulation_parameters<damped_beams> p = beam<damped_beams>(1, 1);
        p.bonds.assign(std::size_t(count), {.bending_stiffness = 0.3});
        // Near the critical damping of the slowest mode: a static state within few periods.
        p.damping = {0, count == 5 ? 0.15 : 0.04, 0.3};
        p.safety = 0.5;
        lacuna::simulation<damped_beams> sim(chain<2>(count + 1), p);
        sim.fix(0);
        double const force = 1e-9;
        sim.apply(std::size_t(count), {0, force});
        sim.run(count == 5 ? 6000 : 30000);
        std::string const n = std::to_string(count);
        REQUIRE_THAT(sim.position(std::size_t(count))[1] / force,
                     WithinRel(reference("4d.with_bending_spring", n, "tip"), 1e-6));
        auto const e = sim.orientation(std::size_t(count));
        REQUIRE_THAT(std::atan2(e[1], e[0]) / force,
                     WithinRel(reference("4d.with_bending_spring", n, "tip_rotation"), 1e-6));
    }
}

namespace {

/// Particles along x with alternating radii of 0.5 and `other`; neighbours touch and are bonded.
template <int Dim>
lacuna::packing<double, Dim> uneven_chain(int count, double other) {
    lacuna::packing<double, Dim> p;
    lacuna::vec<double, Dim> x{};
    for (int k = 0; k < count; ++k) {
        p.add(x, k % 2 == 0 ? 0.5 : other);
        x[0] += 0.5 + other;
        if (k > 0) p.bonds.push_back({k - 1, k});
    }
    return p;
}

/// Deflection and rotation of the tip of a cantilever of `count` beams under a transverse force, over the force.
template <int Dim>
std::array<double, 2> tip_of_cantilever(lacuna::packing<double, Dim> const& discs,
                                        lacuna::beam_bond::material const& bond, double drag, long long steps) {
    using model = damped_beams_of<Dim, lacuna::beam_bond>;
    lacuna::simulation_parameters<model> p;
    p.materials[0].density = unit_density(Dim);
    p.materials[0].bond = bond;
    p.damping = {0, drag, 0.3};
    p.safety = 0.5;
    lacuna::simulation<model> sim(discs, p);
    std::size_t const last = discs.size() - 1;
    sim.fix(0);
    lacuna::vec<double, Dim> force{};
    force[1] = 0.6e-9;
    force[Dim - 1] += Dim == 2 ? 0.4e-9 : 0.8e-9;
    sim.apply(last, force);
    sim.run(steps);
    auto const moved = sim.position(last) - discs.position[last];
    auto const e = sim.orientation(last);
    if constexpr (Dim == 2)
        return {moved[1] / 1e-9, std::atan2(e[1], e[0]) / 1e-9};
    else
        return {std::hypot(moved[1], moved[2]) / 1e-9, 2 * std::hypot(e[2], e[3]) / 1e-9};
}

} // namespace

TEST_CASE("a tip-loaded beam of elastic beams bends as in reference 4d", "[moment]") {
    // Its springs, k_n = k_s = 1 and 0.3 against bending, as a section and moduli: k_theta / k_n = R^2 / 3, and
    // 12 k_theta / (1 + phi) = k_s, phi = 12 k_theta / (kappa G A).
    double const R = std::sqrt(0.9), young = 1 / (2 * R), kappa = 3.6 / 2.6 / (young / 2 * 2 * R);
    for (int const count : {5, 10}) {
        auto const tip = tip_of_cantilever(chain<2>(count + 1), {young, 0, never, never, R / 0.5, kappa},
                                           count == 5 ? 0.15 : 0.04, count == 5 ? 6000 : 30000);
        std::string const n = std::to_string(count);
        REQUIRE_THAT(tip[0], WithinRel(reference("4d.with_bending_spring", n, "tip"), 1e-6));
        REQUIRE_THAT(tip[1], WithinRel(reference("4d.with_bending_spring", n, "tip_rotation"), 1e-6));
    }
}

TEST_CASE("a cantilever of any number of elastic beams has the beam's deflection", "[moment]") {
    // F L^3 / (3 E I) + F L / (kappa G A), and a rotation of F L^2 / (2 E I): exact for one beam, for five, and for
    // unequal radii.
    double const young = 3, nu = 0.2, shear = young / 2.4;
    for (double const kappa : {never, 0.8})
        for (int const count : {1, 5}) {
            INFO(count << " beams, kappa = " << kappa);
            double const length = count, area = 1, inertia = 1.0 / 12;
            auto const tip = tip_of_cantilever(chain<2>(count + 1), {young, nu, never, never, 1, kappa}, 0.2, 8000);
            CHECK_THAT(
                tip[0],
                WithinRel(length * length * length / (3 * young * inertia) + length / (kappa * shear * area), 1e-6));
            CHECK_THAT(tip[1], WithinRel(length * length / (2 * young * inertia), 1e-6));
        }
    {
        double const length = 4 * 0.8, area = pi * 0.09, inertia = pi * 0.0081 / 4;
        auto const tip = tip_of_cantilever(uneven_chain<3>(5, 0.3), {young, nu, never, never, 1, 0.8}, 0.12, 20000);
        CHECK_THAT(tip[0],
                   WithinRel(length * length * length / (3 * young * inertia) + length / (0.8 * shear * area), 1e-6));
        CHECK_THAT(tip[1], WithinRel(length * length / (2 * young * inertia), 1e-6));
    }
}

TEST_CASE("elastic beams of unequal radii are stable up to the bound of the step", "[moment]") {
    lacuna::simulation_parameters<beams<2, lacuna::beam_bond>> p;
    p.materials[0].density = unit_density(2);
    p.materials[0].bond = {1e4, 0.3, never, never, 1, 0.8};
    p.safety = 0.99;
    lacuna::simulation<beams<2, lacuna::beam_bond>> sim(uneven_chain<2>(8, 0.2), p);
    sim.set_velocity(3, {0, 1e-6});
    double const start = sim.kinetic_energy();
    double most = 0;
    for (int k = 0; k < 20000; ++k) {
        sim.step();
        most = std::max(most, sim.kinetic_energy());
    }
    CHECK(most < 3 * start);
}

TEST_CASE("the bending stiffness is that of reference 4e", "[moment]") {
    // kbar_n of 1 N/m^3: k_n = kbar_n A
    double const area = 2 * 0.5 * 1.0;
    auto const p = lacuna::parallel_bond::combine({area, area}, {area, area}, 1.0);
    REQUIRE_THAT(lacuna::parallel_bond::rotational_stiffness<2>(p, 0.5, 0.7).bending,
                 WithinRel(reference("4e.parallel_bond_2D", "k_theta/(kn_bar_per_area)"), 1e-12));
    REQUIRE_THAT(p.normal_stiffness, WithinRel(area * reference("4e.parallel_bond_2D", "kn/(kn_bar)"), 1e-12));
    // In 3D pi R^4 / 4 and pi R^4 / 2, with k = pi R^2.
    double const round = pi * 0.25;
    auto const q = lacuna::parallel_bond::combine({round, round}, {round, round}, 1.0);
    REQUIRE_THAT(lacuna::parallel_bond::rotational_stiffness<3>(q, 0.5, 0.7).bending,
                 WithinRel(pi * 0.0625 / 4, 1e-12));
    REQUIRE_THAT(lacuna::parallel_bond::rotational_stiffness<3>(q, 0.5, 0.7).twisting,
                 WithinRel(pi * 0.0625 / 2, 1e-12));
}

TEST_CASE("a parallel bond breaks when the stress at its rim reaches the strength", "[moment]") {
    using law = lacuna::parallel_bond;
    double const strength = 3, radius = 0.5, thickness = 2;
    auto const p = law::combine({1e3, 1e3, strength, strength}, {1e3, 1e3, strength, strength}, thickness);
    lacuna::pair_motion<double, 2> const still{1, radius, radius, {}, 0};
    double const area = 2 * radius * thickness, inertia = 2.0 / 3 * radius * radius * radius * thickness;
    double const k = law::rotational_stiffness<2>(p, radius, radius).bending;
    for (double const axial : {-4.0, 0.0, 2.0}) {
        // F/A + |M| R/I reaches the strength at this moment.
        double const moment = (strength - axial / area) * inertia / radius;
        for (double const over : {0.999, 1.001}) {
            auto h = law::initial<double, 2>(1 - axial / 1e3, 1);
            auto const r = law::evaluate(p, still, {{-over * moment / k}, 0}, h);
            REQUIRE_THAT(r.bending_moment[0], WithinRel(-over * moment, 1e-12));
            REQUIRE_THAT(r.stored_energy,
                         WithinRel(0.5 * (axial * axial / 1e3 + over * over * moment * moment / k), 1e-12));
            REQUIRE(r.broken == (over > 1));
            REQUIRE((!r.broken || r.broken_in_tension));
        }
    }
    // In 3D a twist adds to the shear stress: F/A + M R/J.
    auto const q = law::combine({1e3, 1e3, never, strength}, {1e3, 1e3, never, strength}, 1);
    lacuna::pair_motion<double, 3> ball{1, radius, radius, {}, 0};
    double const twist_limit = strength * pi * radius * radius * radius / 2;
    for (double const over : {0.999, 1.001}) {
        auto const r =
            law::evaluate(q, ball, {{}, over * twist_limit / law::rotational_stiffness<3>(q, radius, radius).twisting},
                          law::initial<double, 3>(1, 1));
        REQUIRE(r.broken == (over > 1));
        REQUIRE_FALSE(r.broken_in_tension);
    }
}

TEMPLATE_TEST_CASE_SIG("free beams conserve momenta and energy", "[moment]", ((int Dim, class Bond), Dim, Bond),
                       (2, lacuna::parallel_bond), (3, lacuna::parallel_bond), (2, lacuna::beam_bond),
                       (3, lacuna::beam_bond)) {
    lacuna::simulation_parameters<beams<Dim, Bond>> p;
    p.materials[0].density = unit_density(Dim);
    if constexpr (std::is_same_v<Bond, lacuna::parallel_bond>)
        p.materials[0].bond = {1e4, 4e3, never, never, 1};
    else
        p.materials[0].bond = {1e4, 0.3, never, never, 1, 0.8};
    p.safety = 0.1;
    auto discs = chain<Dim>(4);
    discs.position[2][1] += 0.3; // bent, with unequal radii
    discs.radius[1] = 0.4;
    lacuna::simulation<beams<Dim, Bond>> sim(discs, p);
    lacuna::vec<double, Dim> v{};
    v[1] = 1;
    v[Dim - 1] += 0.5;
    sim.set_velocity(3, v);
    lacuna::vec<double, lacuna::rotation_dim<Dim>> spin{};
    spin[0] = 2;
    spin[lacuna::rotation_dim<Dim> - 1] += 1;
    sim.set_spin(0, spin);
    auto const momentum_before = momentum(sim);
    auto const angular_before = angular_momentum(sim);
    double worst = 0, largest = 0;
    for (int k = 0; k < 4000; ++k) {
        sim.step_with_energy();
        worst = std::max(worst, std::fabs(sim.energy().residual()));
        largest = std::max(largest, sim.energy().largest());
    }
    for (int axis = 0; axis < Dim; ++axis)
        REQUIRE_THAT(momentum(sim)[axis] - momentum_before[axis], WithinAbs(0, 1e-10));
    // Velocities hold half a step before positions: x_n cross v_(n+1/2) is conserved up to that shift.
    for (int axis = 0; axis < lacuna::rotation_dim<Dim>; ++axis)
        REQUIRE_THAT(angular_momentum(sim)[axis] - angular_before[axis], WithinAbs(0, 1e-9));
    REQUIRE(largest > 0.5);
    // With large rotations of the bonds the error of the ledger depends on the step, and is above rounding.
    REQUIRE(worst < 5e-3 * largest);
}

TEST_CASE("a rigid rotation loads no beam", "[moment]") {
    auto p = beam<beams<3>>(1e4, 1e4);
    lacuna::simulation<beams<3>> sim(chain<3>(3), p);
    lacuna::vec<double, 3> const spin{0, 0.3, 1}; // across the chain: a steady motion
    for (std::size_t k = 0; k < 3; ++k) {
        sim.set_spin(k, spin);
        sim.set_velocity(k, cross(spin, sim.position(k) - sim.position(1)));
        sim.fix(k, {});
    }
    for (int k = 0; k < 2000; ++k) sim.step_with_energy();
    // Only the stretch for the centripetal force remains.
    double const stretch_energy = 2 * 0.5 * std::pow(1.09, 2) / 1e4;
    REQUIRE(sim.energy().strain < 4.5 * stretch_energy); // a sudden start overshoots by a factor of two
    REQUIRE(squared_norm(sim.spin(0) - spin) < 1e-4);
}

TEST_CASE("bonds with individual values", "[bond values]") {
    // A chain pulled at its end: the bond with the smallest force breaks, stretched by force / stiffness.
    for (bool const with_moments : {false, true}) {
        auto const pull = [&](auto model) {
            using chosen = decltype(model);
            lacuna::simulation_parameters<chosen> p;
            p.materials[0].density = 4 / pi;
            p.materials[0].bond.normal_stiffness = 1e3;
            p.bonds.resize(3);
            p.bonds[1] = {.normal_stiffness = 500.0,
                          .shear_stiffness = {},
                          .bending_stiffness = {},
                          .tensile_force = 2.0,
                          .shear_force = {}};
            lacuna::simulation<chosen> sim(chain<2>(4), p);
            sim.fix(0);
            sim.prescribe_velocity(3, {1e-4, 0});
            while (sim.events().empty() && sim.steps() < 10000000) sim.step();
            REQUIRE(sim.events().size() == 1);
            auto const& e = sim.events().front();
            REQUIRE(e.bond == 1);
            REQUIRE_THAT(e.normal_force, WithinRel(2.0, 1e-4));
            // Springs in series: 1e3, 500, 1e3.
            REQUIRE_THAT(sim.position(3)[0] - 3, WithinRel(2.0 / 1e3 + 2.0 / 500 + 2.0 / 1e3, 5e-3));
        };
        if (with_moments)
            pull(beams<2>{});
        else
            pull(plane{});
    }
    lacuna::simulation_parameters<plane> p;
    p.bonds.resize(1);
    REQUIRE_THROWS_WITH(lacuna::simulation<plane>(chain<2>(3), p), contains_text("bonds.size() = 1"));
    p.bonds.resize(2);
    p.bonds[1].bending_stiffness = 1;
    REQUIRE_THROWS_WITH(lacuna::simulation<plane>(chain<2>(3), p), contains_text("bending_stiffness = 1"));
    p.bonds[1] = {};
    p.bonds[1].tensile_force = -1;
    REQUIRE_THROWS_WITH(lacuna::simulation<plane>(chain<2>(3), p), contains_text("bonds[1].tensile_force = -1"));
}

TEST_CASE("the paper's bond with a moment", "[moment]") {
    using law = lacuna::brittle_beam_bond;
    double const strength = 3, radius = 0.5, thickness = 2, share = 0.25;
    law::material const m{1e3, 800, strength, 2 * strength, share};
    auto const p = law::combine(m, {1e3, 800, strength, 2 * strength, 2 * share}, thickness);
    lacuna::pair_motion<double, 2> still{1, radius, radius, {}, 0};
    double const area = 2 * radius * thickness;
    // k_n R^2 / 3, a quarter of it
    double const k = law::rotational_stiffness<2>(p, radius, radius).bending;
    REQUIRE_THAT(k, WithinRel(share * 1e3 * 0.25 / 3, 1e-12));
    auto const q = law::rotational_stiffness<3>(p, radius, 0.7);
    REQUIRE_THAT(q.bending, WithinRel(share * 1e3 * 0.25 / 4, 1e-12));
    REQUIRE_THAT(q.twisting, WithinRel(share * 800 * 0.25 / 2, 1e-12));
    for (double const axial : {-4.0, 0.0, 2.0}) {
        double const moment = (strength * area - axial) * radius / 3; // F_n + 3 |M| / R = sigma A
        for (double const over : {0.999, 1.001}) {
            auto const h = law::initial<double, 2>(1 - axial / 1e3, 1);
            auto const r = law::evaluate(p, still, {{-over * moment / k}, 0}, h);
            REQUIRE_THAT(r.bending_moment[0], WithinRel(-over * moment, 1e-12));
            REQUIRE_THAT(r.stored_energy,
                         WithinRel(0.5 * (axial * axial / 1e3 + over * over * moment * moment / k), 1e-12));
            REQUIRE(r.broken == (over > 1));
            REQUIRE((!r.broken || r.broken_in_tension));
        }
    }
    // Yields at -sigma A = -6 N, unlike a parallel bond: the rest of the 10 N shortens the bond permanently.
    auto const crushed = law::evaluate(p, still, law::initial<double, 2>(1 + 10 / 1e3, 1));
    REQUIRE_THAT(crushed.normal_force, WithinRel(-6.0, 1e-12));
    REQUIRE_THAT(crushed.history.rest_distance, WithinRel(1 + 6 / 1e3, 1e-12));
    REQUIRE_FALSE(crushed.broken);
    // In shear at twice the strength: slips of 12 N / 800 N/m.
    for (double const over : {0.999, 1.001}) {
        still.slip[0] = over * 12 / 800;
        auto const r = law::evaluate(p, still, law::initial<double, 2>(1, 1));
        REQUIRE(r.broken == (over > 1));
        REQUIRE_FALSE(r.broken_in_tension);
    }
    // Individual stiffness and strength.
    auto const own =
        law::with_values<2>(p, {.normal_stiffness = 500, .bending_stiffness = 7, .tensile_force = 1}, 0.5, 0.7);
    REQUIRE_THAT(law::rotational_stiffness<2>(own, 0.5, 0.7).bending, WithinRel(7.0, 1e-12));
    REQUIRE(own.spring.normal_stiffness == 500);
    REQUIRE_THAT(own.spring.tensile_strength * area, WithinRel(1.0, 1e-12));
    REQUIRE_THROWS_WITH((law::material{1, 1, 1, 1, -1}.validate("m")), "m.bending_ratio = -1: must be >= 0 and finite");
}

TEST_CASE("without a moment it is the paper's bond, run by run", "[moment]") {
    struct beam_model : lacuna::default_model<2> {
        using bond_law = lacuna::brittle_beam_bond;
    };
    auto discs = chain<2>(5);
    discs.position[2][1] += 0.2;
    auto const run = [&](auto sim) {
        sim.fix(0);
        sim.apply(4, {-3, 20});
        sim.run(600);
        REQUIRE(std::any_of(sim.pairs().bond_records().begin(), sim.pairs().bond_records().end(),
                            [](auto const& b) { return b.state != lacuna::bond_state::intact; }));
        std::vector<double> found;
        for (std::size_t id = 0; id < 5; ++id) {
            found.push_back(sim.position(id)[0]);
            found.push_back(sim.position(id)[1]);
            found.push_back(sim.orientation(id)[1]);
        }
        return found;
    };
    auto plain = springs<plane>(1e4, 4e3, 0.1, unit_density(2), 12, 12);
    lacuna::simulation_parameters<beam_model> beam;
    beam.materials = {{unit_density(2), {1e4, 4e3, 0.1}, {1e4, 4e3, 12, 12, 0}}};
    plain.time_step = beam.time_step = 2e-3;
    auto const expected = run(lacuna::simulation<plane>(discs, plain));
    auto const found = run(lacuna::simulation<beam_model>(discs, beam));
    for (std::size_t k = 0; k < found.size(); ++k) REQUIRE_THAT(found[k], WithinAbs(expected[k], 1e-9));
}
