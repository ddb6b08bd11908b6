// SPDX-License-Identifier: BSD-3-Clause

#include <limits>

#include <lacuna/laws/aperture.hpp>
#include <lacuna/laws/brittle_spring_bond.hpp>
#include <lacuna/laws/damping.hpp>
#include <lacuna/laws/frictional_spring.hpp>
#include <lacuna/laws/no_contact.hpp>

#include "catch.hpp"
#include "reference.hpp"

using namespace lacuna;

namespace {

/// Two discs of radius 1 and 2: they touch at 3.
pair_motion<double, 2> at(double distance, double slip = 0) { return {distance, 1, 2, {slip}, 0}; }

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("contact: parameters of two materials", "[contact]") {
    auto const p = frictional_spring::combine({100, 60, 0.3}, {300, 20, 0.5}, 1);
    REQUIRE_THAT(p.normal_stiffness, WithinRel(150.0, 1e-15)); // 2 / (1/100 + 1/300)
    REQUIRE_THAT(p.shear_stiffness, WithinRel(30.0, 1e-15));   // 2 / (1/60 + 1/20)
    REQUIRE_THAT(p.shear_compliance, WithinRel(1 / 30.0, 1e-15));
    REQUIRE(p.friction == 0.3);
    auto const smooth = frictional_spring::combine({100, 0, 0.3}, {300, 20, 0.5}, 1);
    REQUIRE(smooth.shear_stiffness == 0);
    REQUIRE(smooth.shear_compliance == 0);
}

TEST_CASE("contact: separated, pressed, sticking, sliding", "[contact]") {
    frictional_spring::parameters<double> const p{100, 50, 1 / 50.0, 0.5};
    frictional_spring::history<double, 2> const unloaded{3, {0}};
    auto const apart = frictional_spring::evaluate(p, at(3.1, 0.2), unloaded);
    REQUIRE(apart.normal_force == 0);
    REQUIRE(apart.shear_force[0] == 0);
    REQUIRE(apart.history.shear_force[0] == 0);
    REQUIRE(apart.stored_energy == 0);
    REQUIRE(apart.dissipated_energy == 0);

    // Overlap 0.1: N = 10, Coulomb limit 5. A slip of 0.04 gives 2: sticks.
    auto const stick = frictional_spring::evaluate(p, at(2.9, 0.04), unloaded);
    REQUIRE_THAT(stick.normal_force, WithinRel(-10.0, 1e-12));
    REQUIRE_THAT(stick.shear_force[0], WithinRel(2.0, 1e-12));
    REQUIRE_THAT(stick.stored_energy, WithinRel(0.5 * 10 * 0.1 + 0.5 * 2 * 0.04, 1e-12));
    REQUIRE_THAT(stick.dissipated_energy, WithinAbs(0, 1e-15));

    // From there a slip of 0.16: trial 10, clipped to 5 after 0.06; 0.1 slid; mean force of the step 3.5.
    auto const slide = frictional_spring::evaluate(p, at(2.9, 0.16), stick.history);
    REQUIRE_THAT(slide.shear_force[0], WithinRel(5.0, 1e-12));
    REQUIRE_THAT(slide.dissipated_energy, WithinRel(3.5 * 0.1, 1e-12));
    auto const back = frictional_spring::evaluate(p, at(2.9, -0.4), slide.history);
    REQUIRE_THAT(back.shear_force[0], WithinRel(-5.0, 1e-12));
}

TEST_CASE("contact: a touching distance other than r_i + r_j lasts until the pair separates", "[contact]") {
    frictional_spring::parameters<double> const p{100, 50, 1 / 50.0, 0.5};
    for (double const start : {2.9, 3.05}) {
        auto const h = frictional_spring::initial<double, 2>(start, 3);
        REQUIRE(h.touching_distance == start);
        auto const rest = frictional_spring::evaluate(p, at(start), h);
        REQUIRE(rest.normal_force == 0);
        REQUIRE(rest.history.touching_distance == start);
        REQUIRE_THAT(frictional_spring::evaluate(p, at(start - 0.02), h).normal_force, WithinRel(-2.0, 1e-12));
        auto const away = frictional_spring::evaluate(p, at(3.06), h);
        REQUIRE(away.history.touching_distance == 3);
        REQUIRE(frictional_spring::evaluate(p, at(3.0), away.history).normal_force == 0);
    }
    // A pair that overlaps at its touching distance gets no force when it separates only in part.
    auto const part = frictional_spring::evaluate(p, at(2.95), frictional_spring::initial<double, 2>(2.9, 3));
    REQUIRE(part.normal_force == 0);
    REQUIRE(part.history.touching_distance == 2.9);
}

TEST_CASE("contact: taking over from a bond that failed in shear", "[contact]") {
    frictional_spring::parameters<double> const p{100, 50, 1 / 50.0, 0.5};
    auto const pressed = frictional_spring::hand_over<double, 2>(p, at(2.97), -4.0, {7.0});
    auto const on = frictional_spring::evaluate(p, at(2.97), pressed);
    REQUIRE_THAT(on.normal_force, WithinRel(-4.0, 1e-12));
    REQUIRE_THAT(on.shear_force[0], WithinRel(2.0, 1e-12));
    for (double const distance : {2.97, 3.03}) {
        auto const pulled = frictional_spring::hand_over<double, 2>(p, at(distance), 4.0, {7.0});
        auto const off = frictional_spring::evaluate(p, at(distance), pulled);
        REQUIRE(off.normal_force == 0);
        REQUIRE(off.shear_force[0] == 0);
    }
}

TEST_CASE("bond: parameters of two materials, and areas", "[bond]") {
    auto const p = brittle_spring_bond::combine({100, 60, 5, infinity}, {300, 20, 7, infinity}, 0.1);
    REQUIRE_THAT(p.normal_stiffness, WithinRel(150.0, 1e-15));
    REQUIRE_THAT(p.normal_compliance, WithinRel(1 / 150.0, 1e-15));
    REQUIRE(p.tensile_strength == 5);
    REQUIRE(p.shear_strength == 1e30); // never, but finite
    REQUIRE(p.thickness == 0.1);
    REQUIRE_THAT(smaller_particle_area::area<2>(1.0, 2.0, 0.1), WithinRel(0.2, 1e-15));
    REQUIRE_THAT(smaller_particle_area::area<3>(2.0, 1.0, 0.1), WithinRel(3.14159265358979324, 1e-15));
}

TEST_CASE("bond: tension, compression, shear, failure", "[bond]") {
    // Area 2 * 1 * 0.5 = 1 m^2: limits 4 N and 3 N.
    brittle_spring_bond::parameters<double> const p{100, 0.01, 50, 0.02, 4, 3, 0.5};
    auto const h = brittle_spring_bond::initial<double, 2>(3.2, 3);
    auto const pulled = brittle_spring_bond::evaluate(p, at(3.23, 0.04), h);
    REQUIRE_THAT(pulled.normal_force, WithinRel(3.0, 1e-10));
    REQUIRE_THAT(pulled.shear_force[0], WithinRel(2.0, 1e-12));
    REQUIRE_THAT(pulled.stored_energy, WithinRel(0.5 * 9 / 100 + 0.5 * 4 / 50, 1e-10));
    REQUIRE(pulled.dissipated_energy == 0);
    REQUIRE_FALSE(pulled.broken);

    auto const torn = brittle_spring_bond::evaluate(p, at(3.2401), h);
    REQUIRE(torn.broken);
    REQUIRE(torn.broken_in_tension);
    auto const sheared = brittle_spring_bond::evaluate(p, at(3.2, -0.0601), h);
    REQUIRE(sheared.broken);
    REQUIRE_FALSE(sheared.broken_in_tension);
    REQUIRE_FALSE(brittle_spring_bond::evaluate(p, at(3.2, 0.0599), h).broken);
    REQUIRE_FALSE(brittle_spring_bond::evaluate(p, at(3.2399), h).broken);
    // 5 N over 4 N and 3.6 N over 3 N: ratios 1.25 and 1.2; 4.4 N over 4 N: ratio 1.1.
    REQUIRE(brittle_spring_bond::evaluate(p, at(3.25, 0.072), h).broken_in_tension);
    REQUIRE_FALSE(brittle_spring_bond::evaluate(p, at(3.244, 0.072), h).broken_in_tension);

    // Compression by 0.1 m: 10 N, capped at 4 N; 0.06 m of it is plastic and dissipates 0.24 J.
    auto const crushed = brittle_spring_bond::evaluate(p, at(3.1), h);
    REQUIRE_FALSE(crushed.broken);
    REQUIRE_THAT(crushed.normal_force, WithinRel(-4.0, 1e-12));
    REQUIRE_THAT(crushed.history.rest_distance, WithinRel(3.14, 1e-12));
    REQUIRE_THAT(crushed.dissipated_energy, WithinRel(0.24, 1e-10));
    REQUIRE_THAT(brittle_spring_bond::evaluate(p, at(3.14), crushed.history).normal_force, WithinAbs(0, 1e-10));
    REQUIRE_THAT(brittle_spring_bond::evaluate(p, at(3.15), crushed.history).normal_force, WithinRel(1.0, 1e-9));
}

TEST_CASE("bond: shear strength does not depend on the normal force", "[bond]") {
    // Unit springs, strengths and area.
    brittle_spring_bond::parameters<double> const p{1, 1, 1, 1, 1, 1, 0.5};
    for (auto const& [name, normal] : {std::pair{"F_n=-2", -2.0}, std::pair{"F_n=-1", -1.0}, std::pair{"F_n=0", 0.0},
                                       std::pair{"F_n=0.5", 0.5}, std::pair{"F_n=0.99", 0.99}}) {
        double const strength = reference("8d.envelope_points", name);
        brittle_spring_bond::history<double, 2> const h{3, {0}};
        REQUIRE_FALSE(brittle_spring_bond::evaluate(p, at(3 + normal, strength * (1 - 1e-9)), h).broken);
        auto const beyond = brittle_spring_bond::evaluate(p, at(3 + normal, strength * (1 + 1e-9)), h);
        REQUIRE(beyond.broken);
        REQUIRE_FALSE(beyond.broken_in_tension);
    }
}

TEST_CASE("bond: a proportional path leaves the safety zone at the rectangle's edge", "[bond]") {
    double const pi = 3.14159265358979324;
    for (int const psi : {0, 15, 26, 27, 30, 44, 46, 60, 75, 90})
        for (std::string const key : {"kn=ks,sn=ss", "kn=ks,ss=0.5sn"}) {
            brittle_spring_bond::parameters<double> const p{1, 1, 1, 1, 1, key == "kn=ks,sn=ss" ? 1 : 0.5, 0.5};
            std::string const path = "psi=" + std::to_string(psi);
            double const delta = reference("8d.mixed_path", path, key, 0);
            bool const tension = reference_node("8d.mixed_path", path, key, 1).get<std::string>() == "tension";
            auto const answer = [&](double d) {
                return brittle_spring_bond::evaluate(
                    p, at(3 + d * std::cos(psi * pi / 180), d * std::sin(psi * pi / 180)),
                    brittle_spring_bond::history<double, 2>{3, {0}});
            };
            INFO(path << " " << key);
            REQUIRE_FALSE(answer(delta * (1 - 1e-9)).broken);
            REQUIRE(answer(delta * (1 + 1e-9)).broken);
            REQUIRE(answer(delta * (1 + 1e-9)).broken_in_tension == tension);
        }
}

TEST_CASE("damping policies", "[damping]") {
    REQUIRE(no_damping::particle_force({}, 3.0, 1.0) == 0);
    REQUIRE(no_damping::pair_force({}, 1.0, 1.0, 1.0, 1.0) == 0);
    local_damping::parameters const local{0.7};
    REQUIRE_THAT(local_damping::particle_force(local, -3.0, 2.0), WithinRel(-2.1, 1e-15));
    REQUIRE_THAT(local_damping::particle_force(local, -3.0, -2.0), WithinRel(2.1, 1e-15));
    REQUIRE(local_damping::particle_force(local, -3.0, 0.0) == 0);
    // c = 2 * 0.1 * sqrt(8 * (2 * 6 / 8)) = 0.2 sqrt(12)
    REQUIRE_THAT(viscous_damping::pair_force({0.1}, 8.0, 2.0, 6.0, 5.0), WithinRel(std::sqrt(12.0), 1e-14));
    REQUIRE(viscous_damping::particle_force({0.1}, 3.0, 1.0) == 0);
    for (std::string const zeta : {"0.1", "0.3"}) {
        double const mass = 785.398163397; // reference group 1: rho pi R^2 with R = 0.5 m
        REQUIRE_THAT(viscous_damping::pair_force({std::stod(zeta)}, 1e6, mass, mass, 1.0),
                     WithinRel(reference("1b.zeta=" + zeta, "c"), 1e-9));
    }
}

TEST_CASE("no_interaction has no force and no stiffness", "[contact]") {
    auto const p = no_contact::combine({}, {}, 1);
    auto const a = no_contact::evaluate(p, at(1, 1), no_contact::initial<double, 2>(3, 3));
    REQUIRE(a.normal_force == 0);
    REQUIRE(a.shear_force[0] == 0);
    REQUIRE_FALSE(a.broken);
    REQUIRE(no_contact::stiffness(p) == 0);
}

TEST_CASE("aperture laws", "[aperture]") {
    contact_force_aperture::parameters const p{1e-8, 1e-4, 0.5};
    REQUIRE_THAT(contact_force_aperture::aperture(p, -1e-4, -1e-9), WithinRel(0.5e-8, 1e-14)); // F_0 halves it
    REQUIRE_THAT(contact_force_aperture::aperture(p, -3e-4, -1e-9), WithinRel(0.25e-8, 1e-14));
    REQUIRE_THAT(contact_force_aperture::aperture(p, 0.0, 0.0), WithinRel(1e-8, 1e-14));
    REQUIRE_THAT(contact_force_aperture::aperture(p, 0.0, 4e-8), WithinRel(3e-8, 1e-14));
    REQUIRE_THAT(contact_force_aperture::aperture(p, 5.0, -4e-8), WithinRel(1e-8, 1e-14));
    REQUIRE(constant_aperture::aperture({2e-8}, 1.0, 1.0) == 2e-8);
}
