// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <lacuna/core/dual.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/laws/aperture.hpp>

using namespace lacuna;

TEST_CASE("aperture from the contact force") {
    contact_force_aperture::parameters const p{2e-7, 1e-4, 0.5};
    auto const a = [&](double force, double gap) { return contact_force_aperture::aperture(p, force, gap); };
    REQUIRE_THAT(a(0, 0), WithinRel(2e-7, 1e-15));
    REQUIRE_THAT(a(-1e-4, 0), WithinRel(1e-7, 1e-14));
    REQUIRE_THAT(a(-3e-4, -1e-8), WithinRel(0.5e-7, 1e-14));
    REQUIRE_THAT(a(1e-4, 3e-8), WithinRel(2e-7 + 1.5e-8, 1e-14));
    REQUIRE_THAT(a(0, 1e-6), WithinRel(7e-7, 1e-14));
    // An overlap without compression (a pair that starts at zero force) does not close the throat.
    REQUIRE_THAT(a(0, -1e-8), WithinRel(2e-7, 1e-15));
    REQUIRE_THAT(a(-1e-12, 0), WithinRel(2e-7, 1e-7));
}

TEST_CASE("aperture laws over packs and dual numbers") {
    contact_force_aperture::parameters const p{2e-7, 1e-4, 0.5};
    using row = pack<double, 2>;
    row force, gap;
    force.v[0] = -1e-4;
    force.v[1] = 1e-4;
    gap.v[0] = 0;
    gap.v[1] = 3e-8;
    auto const a = contact_force_aperture::aperture(p, force, gap);
    REQUIRE_THAT(a[0], WithinRel(1e-7, 1e-14));
    REQUIRE_THAT(a[1], WithinRel(2.15e-7, 1e-14));

    using number = dual<double, 2>;
    auto const squeezed = contact_force_aperture::aperture(p, number::variable(-1e-4, 0), number::variable(0, 1));
    // d/dF of a0 F0 / (F0 - F) at F = -F0 is a0 / (4 F0).
    REQUIRE_THAT(squeezed.derivative[0], WithinRel(2e-7 / 4e-4, 1e-13));
    REQUIRE_THAT(squeezed.derivative[1], WithinAbs(0, 0));
    auto const open = contact_force_aperture::aperture(p, number::variable(0, 0), number::variable(1e-7, 1));
    REQUIRE_THAT(open.derivative[1], WithinRel(0.5, 1e-15));

    REQUIRE_THAT(constant_aperture::aperture({3e-7}, -1.0, 1.0), WithinRel(3e-7, 1e-16));
    REQUIRE_THAT(constant_aperture::aperture({3e-7}, force, gap)[1], WithinRel(3e-7, 1e-16));
}

TEST_CASE("aperture parameters out of range are refused by name") {
    contact_force_aperture::parameters p;
    REQUIRE_NOTHROW(p.validate("aperture"));
    p.gap_factor = 1.5;
    REQUIRE_THROWS_WITH(p.validate("aperture"), contains_text("aperture.gap_factor = 1.5: must be from 0 to 1"));
    p.gap_factor = 1;
    p.half_force = 0;
    REQUIRE_THROWS_WITH(p.validate("aperture"), contains_text("aperture.half_force"));
    p.half_force = 1;
    p.residual_aperture = -1e-8;
    REQUIRE_THROWS_WITH(p.validate("aperture"), contains_text("aperture.residual_aperture"));
    REQUIRE_THROWS_WITH(constant_aperture::parameters{-1}.validate("x"), contains_text("x.aperture = -1"));
}
