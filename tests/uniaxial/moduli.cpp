// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <limits>
#include <string>

#include "catch.hpp"
#include "reference.hpp"
#include "uniaxial/uniaxial.hpp"

/// \file
/// The compression test of the program uniaxial on lattices, against the moduli of the triangular lattice.

namespace {

uniaxial::request lattice(double shear_ratio) {
    uniaxial::request q;
    q.specimen = uniaxial::specimen_kind::lattice;
    q.radius = 1e-3;
    q.width = 0.02;
    q.height = 0.1; // long: every second chain is shorter, and the ends must be far from the middle half
    q.shear_ratio = shear_ratio;
    q.elastic = true;
    q.friction = 0;
    q.strain = 1e-5;
    q.steps = 40000;
    return q;
}

} // namespace

TEST_CASE("a lattice between platens has the moduli of the lattice", "[moduli]") {
    for (std::string const ratio : {"1", "0.5", "0"}) {
        auto const id = "3a.moduli_ks/kn=" + ratio;
        double const ks = std::stod(ratio), modulus = reference(id, "E"), poisson = reference(id, "nu");
        CHECK_THAT(uniaxial::lattice_modulus(ks), WithinRel(modulus, 1e-9));
        CHECK_THAT(uniaxial::lattice_poisson_ratio(ks), WithinAbs(poisson, 1e-9));
        auto const q = lattice(ks);
        auto const o = uniaxial::run(q);
        // 11 chains are ten layers of the lattice. The outer halves of the outer chains add k_n of one diameter, and
        // the outline is one diameter wider than the layers.
        double const layers = 10 * std::sqrt(0.75);
        INFO("k_s / k_n = " << ratio);
        CHECK_THAT(o.young_modulus / q.bond_modulus, WithinRel((layers * modulus + 1) / (layers + 1), 1e-4));
        CHECK_THAT(o.poisson_ratio, WithinAbs(poisson, 5e-4));
        CHECK(o.curve.back().tension_cracks + o.curve.back().shear_cracks == 0);
    }
}

TEST_CASE("a specimen with equal bonds is twice as strong if its bonds are", "[strength]") {
    // Twice the strength of all bonds gives twice the strength of the specimen at twice the strain. Everything is
    // linear except contacts between its parts and the rotation of its bonds.
    uniaxial::request q;
    q.width = 0.012;
    q.height = 0.024;
    q.steps = 30000;
    q.weibull_modulus = std::numeric_limits<double>::infinity();
    q.tensile_strength = 3e6;
    q.cohesion = 6e6;
    q.strain = 0.004;
    auto const weak = uniaxial::run(q);
    q.tensile_strength *= 2;
    q.cohesion *= 2;
    q.strain *= 2;
    q.steps *= 2;
    auto const strong = uniaxial::run(q);
    CHECK(weak.curve.back().tension_cracks > 0);
    CHECK_THAT(strong.strength, WithinRel(2 * weak.strength, 0.1));
    CHECK_THAT(strong.young_modulus, WithinRel(weak.young_modulus, 0.03));
}
