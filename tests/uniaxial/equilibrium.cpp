// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>

#include "catch.hpp"
#include "reference.hpp"
#include "uniaxial/uniaxial.hpp"

/// \file
/// The compression test of the program uniaxial by static equilibria.

TEST_CASE("equilibria of a lattice between platens have the moduli of the lattice", "[equilibrium]") {
    double const modulus = reference("3a.moduli_ks/kn=0.5", "E"), poisson = reference("3a.moduli_ks/kn=0.5", "nu");
    uniaxial::request q;
    q.specimen = uniaxial::specimen_kind::lattice;
    q.radius = 1e-3;
    q.width = 0.02;
    q.height = 0.1;
    q.shear_ratio = 0.5;
    q.elastic = true;
    q.friction = 0;
    q.strain = 1e-5;
    q.equilibrium = true;
    q.load_steps = 2;
    auto const o = uniaxial::run(q);
    double const layers = 10 * std::sqrt(0.75); // as in moduli.cpp
    CHECK(o.ended == "strain");
    CHECK(o.load_steps == 2);
    CHECK_THAT(o.young_modulus / q.bond_modulus, WithinRel((layers * modulus + 1) / (layers + 1), 1e-4));
    CHECK_THAT(o.poisson_ratio, WithinAbs(poisson, 5e-4));
}

TEST_CASE("bonds fail at stresses that do not depend on the load step", "[equilibrium][strength]") {
    uniaxial::request q;
    q.width = 0.012;
    q.height = 0.024;
    q.friction = 0.3;
    q.equilibrium = true;
    q.strain = 0.0032;
    q.load_steps = 2;
    auto const coarse = uniaxial::run(q);
    q.load_steps = 5;
    auto const fine = uniaxial::run(q);
    REQUIRE(coarse.ended == "strain");
    REQUIRE(fine.ended == "strain");
    CHECK(fine.curve.back().tension_cracks > 0);
    CHECK(fine.curve.back().tension_cracks == coarse.curve.back().tension_cracks);
    CHECK_THAT(fine.strength, WithinRel(coarse.strength, 0.01));
}

TEST_CASE("a bonded specimen between platens comes to rest with any friction", "[equilibrium][friction]") {
    for (double const friction : {0.0, 0.5, 1.0}) {
        uniaxial::request q;
        q.width = 0.012;
        q.height = 0.024;
        q.friction = friction;
        q.elastic = true;
        q.equilibrium = true;
        q.strain = 0.002;
        q.load_steps = 2;
        auto const o = uniaxial::run(q);
        CAPTURE(friction);
        CHECK(o.ended == "strain");
        // The platens hold the ends: a little stiffer with more friction.
        CHECK_THAT(o.curve.back().stress, WithinRel(1.79e7, 0.03));
    }
}
