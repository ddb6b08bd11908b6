// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <cmath>

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

TEST_CASE("aperture of a crack between plates") {
    cubic_crack_aperture::parameters const smooth{2e-7, 1};
    auto const a = [](auto const& p, double force, double gap) {
        return cubic_crack_aperture::aperture(p, force, gap);
    };
    REQUIRE_THAT(a(smooth, 0, 0), WithinRel(2e-7, 1e-15));
    REQUIRE_THAT(a(smooth, -5, -1e-6), WithinRel(2e-7, 1e-15));
    REQUIRE_THAT(a(smooth, 5, 3e-7), WithinRel(5e-7, 1e-15));
    REQUIRE_THAT(a(smooth, 0, 1e-12), WithinRel(2e-7, 1e-5));
    // Flow between plates 5e-7 m apart, 1 m deep and 1e-3 m long, of water (mu = 1e-3 Pa s), under 1 Pa, by hand:
    // w^3 / (12 mu) / l = 1.25e-19 / 0.012 / 1e-3 = 1.0416667e-14 m^3/s; 1.65 times less in a rough crack.
    auto const flow = [&](auto const& p) { return std::pow(a(p, 0, 3e-7), 3) / (12 * 1e-3) / 1e-3; };
    REQUIRE_THAT(flow(smooth), WithinRel(1.0416666666666667e-14, 1e-13));
    cubic_crack_aperture::parameters const rough{2e-7, std::pow(1.65, -1.0 / 3)};
    REQUIRE_THAT(flow(smooth) / flow(rough), WithinRel(1.65, 1e-13));
    using number = dual<double, 2>;
    auto const open = cubic_crack_aperture::aperture(rough, number::variable(1, 0), number::variable(1e-7, 1));
    REQUIRE(open.derivative[0] == 0);
    REQUIRE_THAT(open.derivative[1], WithinRel(std::pow(1.65, -1.0 / 3), 1e-15));
    using row = pack<double, 2>;
    row gap;
    gap.v[0] = -1e-7;
    gap.v[1] = 1e-7;
    auto const both = cubic_crack_aperture::aperture(rough, row(0.0), gap);
    for (int k = 0; k < 2; ++k) REQUIRE(both[k] == a(rough, 0, gap[k]));
}

TEST_CASE("aperture that compression closes exponentially") {
    exponential_aperture::parameters const p{2e-7, 5e-8, 1e-4, 0.5};
    auto const a = [&](double force, double gap) { return exponential_aperture::aperture(p, force, gap); };
    REQUIRE_THAT(a(0, 0), WithinRel(2e-7, 1e-15));
    REQUIRE_THAT(a(-1e-4, 0), WithinRel(5e-8 + 1.5e-7 * 0.36787944117144233, 1e-14));
    // Halfway between at F_d ln 2.
    REQUIRE_THAT(a(-1e-4 * 0.6931471805599453, -1e-8), WithinRel(1.25e-7, 1e-14));
    REQUIRE_THAT(a(-1, 0), WithinRel(5e-8, 1e-15));
    REQUIRE_THAT(a(-1e-14, 0), WithinRel(2e-7, 1e-9));
    REQUIRE_THAT(a(1e-4, 3e-8), WithinRel(2e-7 + 1.5e-8, 1e-14));
    REQUIRE_THAT(a(0, -1e-8), WithinRel(2e-7, 1e-15));
    using number = dual<double, 2>;
    auto const squeezed = exponential_aperture::aperture(p, number::variable(-1e-4, 0), number::variable(0, 1));
    // d/dF of (a_0 - a_inf) exp(F / F_d) at F = -F_d.
    REQUIRE_THAT(squeezed.derivative[0], WithinRel(1.5e-7 / 1e-4 * 0.36787944117144233, 1e-13));
    REQUIRE(squeezed.derivative[1] == 0);
    auto const open = exponential_aperture::aperture(p, number::variable(0, 0), number::variable(1e-7, 1));
    REQUIRE_THAT(open.derivative[1], WithinRel(0.5, 1e-15));
    using row = pack<double, 2>;
    row force;
    force.v[0] = -3e-5;
    force.v[1] = 3e-5;
    auto const both = exponential_aperture::aperture(p, force, row(1e-8));
    for (int k = 0; k < 2; ++k) REQUIRE(both[k] == a(force[k], 1e-8));
    // If nothing can close, it is constant.
    REQUIRE_THAT(exponential_aperture::aperture({2e-7, 2e-7, 1e-4, 0}, -3.0, 0.0), WithinRel(2e-7, 1e-15));
}

TEMPLATE_TEST_CASE("apertures never shrink as a pair is pulled apart", "", constant_aperture, contact_force_aperture,
                   cubic_crack_aperture, exponential_aperture) {
    typename TestType::parameters const p;
    REQUIRE_NOTHROW(p.validate("aperture"));
    // A bond of 1e5 N/m: the force is proportional to the gap.
    double last = TestType::aperture(p, -1.0, -1e-5);
    REQUIRE(last > 0);
    for (int k = -9999; k <= 10000; ++k) {
        double const gap = 1e-9 * k, now = TestType::aperture(p, 1e5 * gap, gap);
        REQUIRE(now >= last);
        // No jump: gaps of successive states differ by 1e-9 m, and apertures by hardly more.
        REQUIRE(now - last <= 1.0001e-9 + 1e-8 * 0.5 * (k < 1 ? 1 : 0));
        last = now;
    }
    REQUIRE_THAT(TestType::aperture(p, -1e-15, -1e-20), WithinRel(TestType::aperture(p, 1e-15, 1e-20), 1e-10));
    REQUIRE(aperture_law<TestType>);
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
    cubic_crack_aperture::parameters c;
    c.hydraulic_factor = 1.2;
    REQUIRE_THROWS_WITH(c.validate("a"), contains_text("a.hydraulic_factor = 1.2: must be > 0 and <= 1"));
    c = {0, 1};
    REQUIRE_THROWS_WITH(c.validate("a"), contains_text("a.residual_aperture = 0"));
    exponential_aperture::parameters e;
    e.residual_aperture = 2e-8;
    REQUIRE_THROWS_WITH(e.validate("a"),
                        contains_text("a.residual_aperture = 2e-08: must be at most zero_force_aperture"));
    e = {};
    e.decay_force = 0;
    REQUIRE_THROWS_WITH(e.validate("a"), contains_text("a.decay_force"));
    e = {};
    e.gap_factor = -1;
    REQUIRE_THROWS_WITH(e.validate("a"), contains_text("a.gap_factor"));
    e = {};
    e.zero_force_aperture = std::nan("");
    REQUIRE_THROWS_WITH(e.validate("a"), contains_text("a.zero_force_aperture"));
    REQUIRE_THROWS_WITH(constant_aperture::parameters{-1}.validate("x"), contains_text("x.aperture = -1"));
}
