// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <lacuna/core/fields.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/laws/beam_bond.hpp>
#include <lacuna/laws/brittle_spring_bond.hpp>
#include <lacuna/laws/parallel_bond.hpp>
#include <lacuna/laws/rolling_spring.hpp>
#include <lacuna/laws/weibull.hpp>

#include "catch.hpp"

using namespace lacuna;

namespace {

std::vector<std::array<std::int32_t, 2>> many_bonds(int count) {
    std::vector<std::array<std::int32_t, 2>> bonds;
    for (int b = 0; b < count; ++b) bonds.push_back({b / 3, b / 3 + 1 + b % 3});
    return bonds;
}

} // namespace

TEST_CASE("strengths by Weibull have his distribution and moments", "[weibull]") {
    int const count = 20000;
    auto const bonds = many_bonds(count);
    for (double const m : {1.0, 2.0, 5.0, 20.0})
        for (std::uint64_t const seed : {0u, 1u, 77u}) {
            auto const values = weibull_strengths{m, seed}.draw(bonds);
            std::vector<double> x;
            for (auto const& v : values) x.push_back(*v.strength_factor);
            std::sort(x.begin(), x.end());
            double const gamma = std::tgamma(1 + 1 / m);
            double mean = 0, square = 0, distance = 0;
            for (int k = 0; k < count; ++k) {
                double const at = x[std::size_t(k)], closed = 1 - std::exp(-std::pow(at * gamma, m));
                mean += at / count;
                square += at * at / count;
                distance = std::max({distance, closed - double(k) / count, double(k + 1) / count - closed});
            }
            double const variance = std::tgamma(1 + 2 / m) / (gamma * gamma) - 1;
            INFO("m = " << m << ", seed " << seed);
            // Limits: four standard errors of the mean, and the 99.9 % point of Kolmogorov's distribution.
            CHECK_THAT(mean, WithinAbs(1, 4 * std::sqrt(variance / count)));
            CHECK_THAT(std::sqrt(square - mean * mean), WithinRel(std::sqrt(variance), 0.03));
            CHECK(distance < 1.95 / std::sqrt(double(count)));
        }
}

TEST_CASE("a bond's strength depends on its particles and the seed alone", "[weibull]") {
    auto bonds = many_bonds(300);
    weibull_strengths const law{5, 3};
    auto const values = law.draw(bonds);
    auto reversed = bonds;
    std::reverse(reversed.begin(), reversed.end());
    for (auto& b : reversed) std::swap(b[0], b[1]);
    auto const again = law.draw(reversed);
    for (std::size_t b = 0; b < bonds.size(); ++b)
        REQUIRE(*values[b].strength_factor == *again[bonds.size() - 1 - b].strength_factor);
    REQUIRE(*values[0].strength_factor != *weibull_strengths{5, 4}.draw(bonds)[0].strength_factor);
    REQUIRE(*values[0].strength_factor != *values[1].strength_factor);
    REQUIRE_THROWS_WITH((weibull_strengths{0.0, 1}.draw(bonds)),
                        contains_text("weibull_strengths.modulus = 0: must be > 0"));
    REQUIRE_THROWS_WITH((weibull_strengths{0.05, 1}.draw(bonds)),
                        contains_text("weibull_strengths.modulus = 0.05: must be at least 0.1"));
}

TEST_CASE("a strength factor scales the strengths of the materials", "[bond values]") {
    bond_values weak;
    weak.strength_factor = 0.25;
    REQUIRE_FALSE(weak.empty());
    auto const spring = brittle_spring_bond::combine({100, 50, 8, 4}, {100, 50, 8, 4}, 1);
    auto const p = brittle_spring_bond::with_values<2>(spring, weak, 0.5, 0.7);
    REQUIRE(p.tensile_strength == 2);
    REQUIRE(p.shear_strength == 1);
    auto const cement = parallel_bond::combine({100, 50, 8, 4}, {100, 50, 8, 4}, 1);
    REQUIRE(parallel_bond::with_values<2>(cement, weak, 0.5, 0.7).tensile_strength == 2);
    beam_bond::material const steel{100, 0.25, 8, 4};
    REQUIRE(beam_bond::with_values<3>(beam_bond::combine(steel, steel, 1), weak, 0.5, 0.7).shear_strength == 1);
    // The bond's own breaking force takes precedence over the factor.
    weak.tensile_force = 3.0;
    REQUIRE(brittle_spring_bond::with_values<2>(spring, weak, 0.5, 0.7).tensile_strength == 3);
    weak.strength_factor = -1;
    REQUIRE_THROWS_WITH(weak.validate("bonds[2]"), contains_text("bonds[2].strength_factor = -1"));
    weak = {};
    weak.normal_stiffness = 1;
    REQUIRE_THROWS_WITH(beam_bond::with_values<2>(beam_bond::combine(steel, steel, 1), weak, 0.5, 0.7),
                        contains_text("normal_stiffness = 1: must be left out"));
}

TEST_CASE("Mohr-Coulomb's line with a tension cut-off by hand", "[envelope]") {
    // c = 10 N, tan phi = 0.5, cut-off at 4 N: the area is 1 m^2.
    auto const p = mohr_coulomb_envelope::combine({0.5}, {0.8});
    REQUIRE(p.internal_friction == 0.5);
    struct row {
        double normal, shear;
        bool broken, in_tension;
    };
    for (row const& r : {row{0, 9.99, false, false}, row{0, 10.01, true, false},      // cohesion
                         row{-20, 19.9, false, false}, row{-20, 20.1, true, false},   // 10 + 20/2
                         row{3, 8.4, false, false}, row{3, 8.6, true, false},         // 10 - 3/2
                         row{3.99, 0, false, false}, row{4.01, 0, true, true},        // cut-off
                         row{6, 8, true, true},                                       // 6/4 > 8/7
                         row{4.2, 9, true, false},                                    // 1.05 < 9/7.9
                         row{-1e6, 0, false, false}}) {                               // pure compression
        auto const failure = mohr_coulomb_envelope::check_strength(p, r.normal, r.shear, 4.0, 10.0);
        INFO(r.normal << ", " << r.shear);
        CHECK(failure.broken == r.broken);
        if (r.broken) CHECK(failure.in_tension == r.in_tension);
    }
    // Without a cut-off, the apex of the line, c / tan phi = 20 N, is the tensile strength.
    CHECK_FALSE(mohr_coulomb_envelope::check_strength(p, 19.9, 0.0, 1e30, 10.0).broken);
    CHECK(mohr_coulomb_envelope::check_strength(p, 20.1, 0.0, 1e30, 10.0).broken);
    CHECK(mohr_coulomb_envelope::check_strength(p, 20.1, 0.0, 1e30, 10.0).in_tension);
    // Without internal friction the line is level.
    auto const level = mohr_coulomb_envelope::combine({0}, {0.8});
    CHECK_FALSE(mohr_coulomb_envelope::check_strength(level, -1e3, 9.9, 4.0, 10.0).broken);
    CHECK(mohr_coulomb_envelope::check_strength(level, -1e3, 10.1, 4.0, 10.0).broken);
}

TEST_CASE("Mohr-Coulomb's bond has the paper's springs, and does not yield in compression", "[envelope][pack]") {
    using law = mohr_coulomb_bond;
    law::material const rock{100, 60, 5, 7, {0.6}};
    rock.validate("rock");
    REQUIRE_THROWS_WITH((law::material{100, 60, 5, 7, {-0.1}}.validate("rock")),
                        contains_text("rock.envelope.internal_friction = -0.1: must be >= 0"));
    auto const p = law::combine(rock, rock, 0.1);
    auto const box = brittle_spring_bond::combine({100, 60, 5, 7}, {100, 60, 5, 7}, 0.1);
    double const area = 2 * 0.5 * 0.1;
    for (double const stretch : {-0.02, -0.001, 0.002}) {
        pair_motion<double, 2> const m{1.2 + stretch, 0.5, 0.7, {0.003}, 0};
        auto const h = law::initial<double, 2>(1.2, 1.2);
        auto const a = law::evaluate(p, m, h);
        REQUIRE_THAT(a.normal_force, WithinRel(100 * stretch, 1e-9));
        REQUIRE_THAT(a.shear_force[0], WithinRel(60 * 0.003, 1e-12));
        REQUIRE(a.dissipated_energy == 0);
        REQUIRE(a.history.rest_distance == 1.2);
        REQUIRE(a.broken == (0.18 > 7 * area - 0.6 * 100 * stretch));
        if (stretch == -0.001) {
            auto const b = brittle_spring_bond::evaluate(box, m, {h.rest_distance, h.shear_force});
            REQUIRE(a.normal_force == b.normal_force);
            REQUIRE(a.stored_energy == b.stored_energy);
        }
    }
    using P = pack<double, 4>;
    law::parameters<P> lanes{};
    auto const* from = reinterpret_cast<double const*>(&p);
    static_assert(sizeof p == 9 * sizeof(double) && sizeof box == 7 * sizeof(double));
    for (std::size_t f = 0; f < 9; ++f) detail::field<P>(lanes, f) = P(from[f]);
    pair_motion<P, 2> m{P(1.2), P(0.5), P(0.7), {P(0.0)}, P(0.0)};
    double const slips[4] = {0.0, 0.0115, 0.0118, -0.0118}; // the limit: 0.7 N / 60 N/m
    m.slip = {P::load(slips)};
    auto const answer = law::evaluate(lanes, m, law::initial<P, 2>(P(1.2), P(1.2)));
    for (int k = 0; k < 4; ++k) REQUIRE(answer.broken[k] == (k >= 2));
}

TEST_CASE("the moment against rolling: spring, limit and energy", "[rolling]") {
    using law = rolling_spring;
    law::material const sand{1e4, 2e3, 0.5, 0.1, 1.5};
    auto const p = law::combine(sand, {1e4, 2e3, 0.5, 0.3, 0.5}, 1);
    double const ri = 0.3, rj = 0.6, R = 0.2, k = 1.0 * 2e3 * R * R, overlap = 1e-3;
    REQUIRE_THAT(law::rotational_stiffness<2>(p, ri, rj).bending, WithinRel(k, 1e-12));
    REQUIRE_THAT(law::rotational_stiffness<3>(p, ri, 0.0).bending, WithinRel(2e3 * ri * ri, 1e-12)); // a wall
    double const limit = 0.1 * R * 1e4 * overlap;
    pair_motion<double, 2> const m{ri + rj - overlap, ri, rj, {0.0}, 0};
    auto state = law::initial<double, 2>(ri + rj, ri + rj);
    double const part = 0.25 * limit / k;
    auto a = law::evaluate(p, m, {{part}, 0.0}, state);
    REQUIRE_THAT(a.bending_moment[0], WithinRel(0.25 * limit, 1e-9));
    REQUIRE_THAT(a.stored_energy, WithinRel(0.5 * 1e4 * overlap * overlap + 0.5 * k * part * part, 1e-9));
    REQUIRE_THAT(a.dissipated_energy, WithinAbs(0, 1e-15));
    double const far = 10 * limit / k;
    auto b = law::evaluate(p, m, {{far}, 0.0}, a.history);
    REQUIRE_THAT(b.bending_moment[0], WithinRel(limit, 1e-9));
    // Work of the step = increase of the stored energy + dissipated energy.
    double const work = 0.5 * (0.25 * limit + limit) * far;
    REQUIRE_THAT(b.dissipated_energy + b.stored_energy - a.stored_energy, WithinRel(work, 1e-9));
    auto c = law::evaluate(p, m, {{-far}, 0.0}, b.history);
    REQUIRE_THAT(c.bending_moment[0], WithinRel(-limit, 1e-9));
    // A separated pair has no moment.
    pair_motion<double, 2> const apart{ri + rj + 1e-6, ri, rj, {0.0}, 0};
    REQUIRE(law::evaluate(p, apart, {{part}, 0.0}, b.history).bending_moment[0] == 0);
    // In space the moment is a vector, clipped in length.
    pair_motion<double, 3> const ball{ri + rj - overlap, ri, rj, {}, 0};
    auto const d =
        law::evaluate(p, ball, {{0, 3 * far, 4 * far}, 0.0, {1, 0, 0}}, law::initial<double, 3>(ri + rj, ri + rj));
    REQUIRE_THAT(d.bending_moment[1], WithinRel(0.6 * limit, 1e-9));
    REQUIRE_THAT(d.bending_moment[2], WithinRel(0.8 * limit, 1e-9));
    REQUIRE(d.twisting_moment == 0);
    // Springs and friction are those of frictional_spring.
    auto const plain = frictional_spring::combine({1e4, 2e3, 0.5}, {1e4, 2e3, 0.5}, 1);
    pair_motion<double, 2> const slides{ri + rj - overlap, ri, rj, {0.02}, 0};
    auto const e = law::evaluate(p, slides, law::initial<double, 2>(ri + rj, ri + rj));
    auto const f = frictional_spring::evaluate(plain, slides, frictional_spring::initial<double, 2>(ri + rj, ri + rj));
    REQUIRE(e.normal_force == f.normal_force);
    REQUIRE(e.shear_force[0] == f.shear_force[0]);
    REQUIRE(e.dissipated_energy == f.dissipated_energy);
    REQUIRE_THROWS_WITH((law::material{1, 1, 0, -1}.validate("m")), contains_text("m.rolling_friction = -1"));
    REQUIRE_THROWS_WITH((law::material{1, 1, 0, 0, -1}.validate("m")), contains_text("m.rolling_factor = -1"));
}

TEST_CASE("a beam's stiffness and the stress at its rim by hand", "[moment]") {
    using law = beam_bond;
    double const E = 200, nu = 0.25, kappa = 0.8, t = 0.5, L = 1.2, ri = 0.5, rj = 0.7, R = 0.4;
    law::material const steel{E, nu, 10, 6, 0.8, kappa};
    auto const p = law::combine(steel, steel, t);
    double const A = 2 * R * t, I = 2.0 / 3 * R * R * R * t, G = E / 2.5, phi = 12 * E * I / (kappa * G * A * L * L);
    pair_motion<double, 2> const m{L * 1.001, ri, rj, {1e-3}, 0};
    pair_rotation<double, 2> const rotation{{2e-3}, 0.0, {1, 0}};
    auto const a = law::evaluate(p, m, rotation, law::initial<double, 2>(L, ri + rj));
    double const e = 0.5 * 1.001 * L * (rj - ri) / (ri + rj);
    double const V = 12 * E * I / (L * L * L * (1 + phi)) * (1e-3 + e * 2e-3), M = E * I / L * 2e-3;
    REQUIRE_THAT(a.normal_force, WithinRel(E * A * 0.001, 1e-9));
    REQUIRE_THAT(a.shear_force[0], WithinRel(V, 1e-12));
    REQUIRE_THAT(a.bending_moment[0], WithinRel(M + e * V, 1e-12));
    // The stored energy is the work of forces and moments.
    REQUIRE_THAT(a.stored_energy, WithinRel(0.5 * (E * A * 0.001 * 0.001 * L + V * 1e-3 + (M + e * V) * 2e-3), 1e-9));
    // The stress is largest at the end of the beam where the moment is M + V L/2.
    double const stress = E * 0.001 + (std::fabs(M) + std::fabs(V) * 1.001 * L / 2) * R / I;
    for (double const over : {0.999, 1.001}) {
        law::material weak = steel;
        weak.tensile_strength = stress / over;
        auto const b = law::evaluate(law::combine(weak, weak, t), m, rotation, law::initial<double, 2>(L, ri + rj));
        REQUIRE(b.broken == (over > 1));
        if (b.broken) REQUIRE(b.broken_in_tension);
        weak = steel;
        weak.tensile_strength = 1e9;
        weak.shear_strength = V / A / over;
        auto const c = law::evaluate(law::combine(weak, weak, t), m, rotation, law::initial<double, 2>(L, ri + rj));
        REQUIRE(c.broken == (over > 1));
        if (c.broken) REQUIRE_FALSE(c.broken_in_tension);
    }
    // In space, without shear deformation: 12 E I / L^3, G J / L. The normal is along x, the slip along y, the rotation
    // about z.
    law::material const slim{E, nu, 1e9, 1e9, 0.8};
    auto const q = law::combine(slim, slim, t);
    double const round = 3.14159265358979 * R * R * R * R / 4;
    pair_motion<double, 3> const ball{L, ri, rj, {0, 1e-3, 0}, 0};
    auto const s = law::evaluate(q, ball, {{0, 0, 2e-3}, 1e-3, {1, 0, 0}}, law::initial<double, 3>(L, ri + rj));
    double const off = 0.5 * L * (rj - ri) / (ri + rj), W = 12 * E * round / (L * L * L) * (1e-3 + off * 2e-3);
    REQUIRE_THAT(s.shear_force[1], WithinRel(W, 1e-9));
    REQUIRE_THAT(s.bending_moment[2], WithinRel(E * round / L * 2e-3 + off * W, 1e-9));
    REQUIRE_THAT(s.twisting_moment, WithinRel(G * 2 * round / L * 1e-3, 1e-9));
    REQUIRE_THROWS_WITH((law::material{1, 0.6}.validate("m")), contains_text("m.poisson_ratio = 0.6"));
    REQUIRE_THROWS_WITH((law::material{1, 0.2, 1, 1, 1, 0}.validate("m")), contains_text("m.shear_correction = 0"));
}
