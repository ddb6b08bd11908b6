// SPDX-License-Identifier: BSD-3-Clause

#include <random>

#include <lacuna/core/dual.hpp>
#include <lacuna/core/fields.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/laws/brittle_spring_bond.hpp>
#include <lacuna/laws/damping.hpp>
#include <lacuna/laws/frictional_spring.hpp>

#include "catch.hpp"

/// \file
/// One formula for many scalar types: lanes of packs against plain numbers, dual numbers against tangents by hand.

using namespace lacuna;

namespace {

struct random_numbers {
    std::mt19937_64 engine{7};
    double operator()(double low, double high) { return low + (high - low) * double(engine() >> 11) * 0x1p-53; }
};

template <class Law>
auto random_parameters(random_numbers& r) {
    double const kn = r(50, 200), ks = r(0, 1) < 0.1 ? 0 : r(20, 100);
    if constexpr (std::is_same_v<Law, frictional_spring>)
        return frictional_spring::parameters<double>{kn, ks, ks > 0 ? 1 / ks : 0, r(0, 1) < 0.2 ? 0 : r(0, 0.8)};
    else
        return brittle_spring_bond::parameters<double>{kn,          1 / kn,     ks, ks > 0 ? 1 / ks : 0,
                                                       r(0.5, 5.0), r(0.5, 5.0), 0.7};
}

/// The scalars of lane k of an aggregate of packs.
template <class Real, int W, class Aggregate>
auto lane(Aggregate const& all, int k) {
    std::array<Real, sizeof(Aggregate) / sizeof(pack<Real, W>)> r{};
    std::array<pack<Real, W>, r.size()> from;
    __builtin_memcpy(&from, &all, sizeof all);
    for (std::size_t f = 0; f < r.size(); ++f) r[f] = from[f][k];
    return r;
}
/// The scalars of an aggregate.
template <class Real, class Aggregate>
auto row(Aggregate const& one) {
    std::array<Real, sizeof(Aggregate) / sizeof(Real)> r;
    __builtin_memcpy(&r, &one, sizeof one);
    return r;
}

template <class Law, class Real, int W, int Dim>
void check_lanes() {
    using P = pack<Real, W>;
    random_numbers r;
    int broken = 0, capped = 0, slid = 0, apart = 0;
    for (int round = 0; round < 200; ++round) {
        // All inputs are aggregates of one scalar type and are filled lane by lane.
        std::array<pair_motion<Real, Dim>, W> motion;
        std::array<typename Law::template parameters<Real>, W> parameter;
        std::array<typename Law::template history<Real, Dim>, W> history;
        pair_motion<P, Dim> motions;
        typename Law::template parameters<P> parameters;
        typename Law::template history<P, Dim> histories;
        auto const fill = [&](auto& all, auto const& each) {
            std::array<P, sizeof(all) / sizeof(P)> to;
            for (int k = 0; k < W; ++k) {
                auto const numbers = row<Real>(each[std::size_t(k)]);
                for (std::size_t f = 0; f < to.size(); ++f) to[f].v[k] = numbers[f];
            }
            __builtin_memcpy(static_cast<void*>(&all), &to, sizeof all);
        };
        for (std::size_t k = 0; k < std::size_t(W); ++k) {
            double const ri = r(0.5, 1.5), rj = r(0.5, 1.5);
            motion[k] = {Real((ri + rj) * r(0.93, 1.05)), Real(ri), Real(rj), {}, Real(r(-1, 1))};
            history[k] = Law::template initial<Real, Dim>(Real((ri + rj) * r(0.98, 1.02)), Real(ri + rj));
            for (int a = 0; a < shear_dim<Dim>; ++a) {
                motion[k].slip[a] = Real(r(-0.02, 0.02));
                history[k].shear_force[a] = Real(r(-2, 2));
            }
            parameter[k] = convert_fields<Real, double, typename Law::template parameters<Real>>(
                random_parameters<Law>(r), [](double x) { return Real(x); });
        }
        fill(motions, motion);
        fill(parameters, parameter);
        fill(histories, history);
        auto const all = Law::evaluate(parameters, motions, histories);
        for (int k = 0; k < W; ++k) {
            auto const s = std::size_t(k);
            auto const one = Law::evaluate(parameter[s], motion[s], history[s]);
            // The compiler may contract products and sums differently: a few roundings of the largest terms are
            // allowed.
            double const eps = 16 * double(std::numeric_limits<Real>::epsilon());
            auto const same = [&](Real a, Real b, double scale) {
                REQUIRE_THAT(double(a), WithinAbs(double(b), eps * scale));
            };
            double const force = double(parameter[s].normal_stiffness) * 3;
            same(all.normal_force[k], one.normal_force, force);
            for (int a = 0; a < shear_dim<Dim>; ++a) same(all.shear_force[a][k], one.shear_force[a], force);
            same(all.stored_energy[k], one.stored_energy, force * 0.3);
            same(all.dissipated_energy[k], one.dissipated_energy, force * 0.3);
            auto const found = lane<Real, W>(all.history, k);
            auto const expected = row<Real>(one.history);
            for (std::size_t f = 0; f < found.size(); ++f) same(found[f], expected[f], f == 0 ? 3 : force);
            apart += one.normal_force == 0;
            if constexpr (std::is_same_v<Law, brittle_spring_bond>) {
                REQUIRE(all.broken[k] == one.broken);
                if (one.broken) REQUIRE(all.broken_in_tension[k] == one.broken_in_tension);
                broken += one.broken;
                capped += one.history.rest_distance < history[s].rest_distance;
            } else {
                slid += one.dissipated_energy > 1e-3;
            }
        }
    }
    if constexpr (std::is_same_v<Law, brittle_spring_bond>) {
        REQUIRE(broken > 10 * W);
        REQUIRE(capped > 10 * W);
    } else {
        REQUIRE(slid > 10 * W);
        REQUIRE(apart > 10 * W);
    }
}

using two = dual<double, 2>; // with derivatives by distance and slip

template <class Law>
auto tangent(typename Law::template parameters<double> const& p, double distance, double slip, double shear_before,
             double reference_distance) {
    auto const q = convert_fields<two, double, typename Law::template parameters<two>>(
        p, [](double x) { return two(x); });
    pair_motion<two, 2> const m{two::variable(distance, 0), 1.0, 2.0, {two::variable(slip, 1)}, 0.0};
    typename Law::template history<two, 2> const h{reference_distance, {two(shear_before)}};
    return Law::evaluate(q, m, h);
}
template <class Law>
void check_against_differences(typename Law::template parameters<double> const& p, double distance, double slip,
                               double shear_before, double reference_distance) {
    auto const exact = tangent<Law>(p, distance, slip, shear_before, reference_distance);
    double const h = 1e-6;
    auto const at = [&](double d, double s) {
        return Law::evaluate(p, pair_motion<double, 2>{d, 1, 2, {s}, 0},
                             typename Law::template history<double, 2>{reference_distance, {shear_before}});
    };
    auto const check = [&](int variable, auto const& high, auto const& low) {
        REQUIRE_THAT(exact.normal_force.derivative[variable],
                     WithinAbs((high.normal_force - low.normal_force) / (2 * h), 1e-5));
        REQUIRE_THAT(exact.shear_force[0].derivative[variable],
                     WithinAbs((high.shear_force[0] - low.shear_force[0]) / (2 * h), 1e-5));
        REQUIRE_THAT(exact.stored_energy.derivative[variable],
                     WithinAbs((high.stored_energy - low.stored_energy) / (2 * h), 1e-5));
    };
    check(0, at(distance + h, slip), at(distance - h, slip));
    check(1, at(distance, slip + h), at(distance, slip - h));
}

} // namespace

TEST_CASE("each lane of a pack agrees with the plain formula", "[pack]") {
    check_lanes<frictional_spring, double, 2, 2>();
    check_lanes<frictional_spring, double, 4, 3>();
    check_lanes<frictional_spring, double, 8, 2>();
    check_lanes<frictional_spring, float, 4, 3>();
    check_lanes<frictional_spring, float, 16, 2>();
    check_lanes<brittle_spring_bond, double, 2, 3>();
    check_lanes<brittle_spring_bond, double, 4, 2>();
    check_lanes<brittle_spring_bond, double, 8, 3>();
    check_lanes<brittle_spring_bond, float, 8, 2>();
    check_lanes<brittle_spring_bond, float, 16, 3>();
}

TEST_CASE("damping in packs", "[pack][damping]") {
    using P = pack<double, 4>;
    P force, velocity;
    double const f[4] = {3, -3, 2, -1}, v[4] = {1, 1, -1, 0};
    force = P::load(f);
    velocity = P::load(v);
    P const local = local_damping::particle_force({0.5}, force, velocity);
    P const viscous = viscous_damping::pair_force({0.5}, P(4.0), P(2.0), P(2.0), velocity);
    for (int k = 0; k < 4; ++k) {
        REQUIRE(local[k] == local_damping::particle_force({0.5}, f[k], v[k]));
        REQUIRE(viscous[k] == 2 * v[k]); // 2 * 0.5 * sqrt(4 * 1)
    }
}

TEST_CASE("tangents of the contact", "[dual]") {
    frictional_spring::parameters<double> const p{100, 50, 0.02, 0.5};
    auto const stick = tangent<frictional_spring>(p, 2.9, 0.01, 1, 3);
    REQUIRE(stick.normal_force.derivative[0] == 100); // dF_n/dd = k_n
    REQUIRE(stick.normal_force.derivative[1] == 0);
    REQUIRE(stick.shear_force[0].derivative[0] == 0);
    REQUIRE(stick.shear_force[0].derivative[1] == 50);
    auto const slide = tangent<frictional_spring>(p, 2.9, 0.2, 1, 3);
    REQUIRE(slide.shear_force[0].derivative[0] == -50); // F_s = mu k_n (L - d)
    REQUIRE(slide.shear_force[0].derivative[1] == 0);
    auto const apart = tangent<frictional_spring>(p, 3.1, 0.2, 1, 3);
    REQUIRE(apart.normal_force.derivative[0] == 0);
    REQUIRE(apart.shear_force[0].derivative[1] == 0);
    for (double const distance : {2.9, 3.1})
        for (double const slip : {0.01, 0.2, -0.3})
            check_against_differences<frictional_spring>(p, distance, slip, 1, 3);
}

TEST_CASE("tangents of the bond", "[dual]") {
    brittle_spring_bond::parameters<double> const p{100, 0.01, 50, 0.02, 4, 3, 0.5};
    auto const elastic = tangent<brittle_spring_bond>(p, 3.01, 0.01, 1, 3);
    REQUIRE(elastic.normal_force.derivative[0] == 100);
    REQUIRE(elastic.shear_force[0].derivative[1] == 50);
    REQUIRE(elastic.normal_force.derivative[1] == 0);
    REQUIRE(elastic.shear_force[0].derivative[0] == 0);
    auto const capped = tangent<brittle_spring_bond>(p, 2.9, 0.01, 1, 3);
    REQUIRE(capped.normal_force.derivative[0] == 0);
    REQUIRE(capped.history.rest_distance.derivative[0] == 1);
    for (double const distance : {2.9, 2.99, 3.02})
        check_against_differences<brittle_spring_bond>(p, distance, 0.01, 1, 3);
}
