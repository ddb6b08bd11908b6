// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "bodies.hpp"

#include <lacuna/pores/remesh/transfer_fluid.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/remesh/remesh.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

using namespace lacuna;
using bodies::uniform;
using point = vec<double, 2>;
using solver = explicit_flow::solver<double, 2>;
using network = pore_network<double, 2>;

namespace {

constexpr double modulus = 1000;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A network with volumes, from triangles given by hand.
network made(bodies::body const& b, std::vector<std::array<std::int32_t, 3>> const& triangles) {
    pore_mesh<2> mesh;
    mesh.simplices = triangles;
    detail::connect(mesh);
    auto p = bodies::body::settings<solver>();
    return solver(p, make_pore_network(mesh, b.points(), b.r.data()), 1.0, b.points(), b.r.data()).network();
}
/// Another triangulation of the same particles, by other weights.
network made_with(bodies::body const& b, std::vector<double> const& weights) {
    return made(b, regular_triangulation(b.points(), weights.data()).simplices);
}

double content(network const& net) {
    double sum = 0;
    for (std::size_t p = 0; p < net.pores(); ++p) sum += net.volume[p] * net.pressure[p] / modulus - net.vapour_of(p);
    return sum;
}
double volume(network const& net) {
    double sum = 0;
    for (double const v : net.volume) sum += v;
    return sum;
}
std::array<std::int32_t, 3> corners_of(network const& net, std::size_t p) {
    return {net.corner[0][p], net.corner[1][p], net.corner[2][p]};
}

/// Separate discs near the points of a square lattice: small displacements decide which diagonal is an edge.
bodies::body cloud(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    bodies::body b;
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) {
            b.x.push_back({2 * j + 0.3 * uniform(engine), 2 * i + 0.3 * uniform(engine)});
            b.r.push_back(0.55 + 0.2 * uniform(engine));
        }
    return b;
}

bodies::body square() { return {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {0.3, 0.3, 0.3, 0.3}}; }

} // namespace

TEST_CASE("a square whose diagonal flips: both pores take the mean, the content stays") {
    auto const b = square();
    auto from = made(b, {{0, 1, 2}, {0, 2, 3}}), to = made(b, {{0, 1, 3}, {1, 2, 3}});
    from.pressure[0] = 5;
    from.pressure[1] = -1;
    auto const report = transfer_fluid(from, to, b.points(), modulus, -infinity);
    for (std::size_t p = 0; p < 2; ++p) REQUIRE_THAT(to.pressure[p], WithinRel(2.0, 1e-14));
    REQUIRE_THAT(content(to), WithinRel(content(from), 1e-14));
    REQUIRE(report.kept == 0);
    REQUIRE(report.changed == 2);
    REQUIRE(report.regions == 1);
    // (1 - pi 0.09) / 2 each, with 5 and -1 Pa.
    REQUIRE_THAT(report.content, WithinRel((1 - std::numbers::pi * 0.09) / 2 * 6 / modulus, 1e-13));
    REQUIRE_THAT(report.residual, WithinAbs(0, 1e-16 * report.content));
    REQUIRE_THAT(report.volume, WithinAbs(0, 1e-15));
}

TEST_CASE("vapour is content too: it closes before the pressure rises") {
    auto const b = square();
    auto from = made(b, {{0, 1, 2}, {0, 2, 3}}), to = made(b, {{0, 1, 3}, {1, 2, 3}});
    from.pressure[0] = from.pressure[1] = -2;
    for (auto* net : {&from, &to}) net->vapour.assign(2, 0.0); // as for a fluid that can tear
    from.vapour[0] = 0.01;
    auto const report = transfer_fluid(from, to, b.points(), modulus, -2.0);
    REQUIRE(to.pressure[0] == -2);
    REQUIRE_THAT(to.vapour[0] + to.vapour[1], WithinRel(0.01, 1e-12));
    REQUIRE_THAT(content(to), WithinRel(content(from), 1e-13));
    REQUIRE_THAT(report.residual, WithinAbs(0, 1e-14 * report.content));
    from.pressure[1] = 98; // more than closes the vapour: 0.01 * 1000 Pa over a pore of 0.36
    transfer_fluid(from, to, b.points(), modulus, -2.0);
    REQUIRE(to.vapour[0] == 0);
    REQUIRE_THAT(to.pressure[0], WithinRel(96.0 / 2 - 0.01 * modulus / volume(from), 1e-12));
}

TEST_CASE("two triangulations of the same discs: areas, content, bits of unchanged pores, a uniform pressure") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        auto const b = cloud(seed);
        std::mt19937_64 engine(seed);
        std::vector<double> weights;
        for (double const r : b.r) weights.push_back(r * (0.8 + 0.4 * uniform(engine)));
        auto from = made_with(b, b.r), to = made_with(b, weights);
        for (std::size_t p = 0; p < from.pores(); ++p) from.pressure[p] = 10 + uniform(engine);
        auto const report = transfer_fluid(from, to, b.points(), modulus, -infinity);
        REQUIRE(report.kept > 20);
        REQUIRE(report.changed > 5);
        REQUIRE(report.regions > 1);
        REQUIRE_THAT(content(to), WithinRel(content(from), 1e-12));
        REQUIRE_THAT(report.residual, WithinAbs(0, 1e-12 * report.content));
        // Both meshes fill the hull, and no pore is at its least volume: sectors and voids have the same sums.
        REQUIRE_THAT(volume(to), WithinRel(volume(from), 1e-12));
        REQUIRE_THAT(report.volume, WithinAbs(0, 1e-11));
        std::size_t same = 0;
        for (std::size_t q = 0; q < to.pores(); ++q) {
            REQUIRE((to.pressure[q] > 9 && to.pressure[q] < 12));
            for (std::size_t p = 0; p < from.pores(); ++p)
                if (corners_of(from, p) == corners_of(to, q)) {
                    REQUIRE(to.pressure[q] == from.pressure[p]);
                    REQUIRE(to.old_volume[q] == from.old_volume[p]);
                    ++same;
                }
            // The old triangles cover each new one exactly once.
            double covered = 0;
            auto const corner = [&](network const& net, std::size_t p) {
                std::array<point, 3> x;
                for (std::size_t c = 0; c < 3; ++c) x[c] = b.x[std::size_t(net.corner[c][p])];
                return x;
            };
            for (std::size_t p = 0; p < from.pores(); ++p)
                covered += detail::common_area(corner(from, p), corner(to, q));
            REQUIRE_THAT(covered, WithinRel(to.size[q], 1e-11));
        }
        REQUIRE(same == report.kept);

        for (auto& p : from.pressure) p = 7.5;
        transfer_fluid(from, to, b.points(), modulus, -infinity);
        for (double const p : to.pressure) REQUIRE_THAT(p, WithinRel(7.5, 1e-12));
        auto again = from;
        auto const none = transfer_fluid(from, again, b.points(), modulus, -infinity);
        REQUIRE(none.changed == 0);
        REQUIRE(again.pressure == from.pressure);
        REQUIRE(none.residual == 0);
    }
}

TEST_CASE("at the boundary: removed pores give their content to neighbours, new ones start at zero") {
    auto b = square();
    b.x.push_back({2, 0.5});
    b.r.push_back(0.3);
    auto big = made(b, {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}), small = made(b, {{0, 1, 2}, {0, 2, 3}});
    for (std::size_t p = 0; p < 3; ++p) big.pressure[p] = 4;
    auto lessened = small;
    auto const less = transfer_fluid(big, lessened, b.points(), modulus, -infinity);
    REQUIRE(less.lost == 0);
    REQUIRE_THAT(content(lessened), WithinRel(content(big), 1e-14));
    // Of the two, pore 0 is next to the removed one.
    REQUIRE(lessened.pressure[1] == 4);
    std::size_t went = 0;
    while (corners_of(big, went) != std::array<std::int32_t, 3>{1, 4, 2}) ++went;
    REQUIRE_THAT(lessened.pressure[0], WithinRel(4 + 4 * big.volume[went] / small.volume[0], 1e-13));
    REQUIRE_THAT(less.volume, WithinRel(-big.volume[went], 1e-12));

    auto grown = big;
    for (auto& p : grown.pressure) p = 99;
    small.pressure[0] = small.pressure[1] = 4;
    auto const more = transfer_fluid(small, grown, b.points(), modulus, -infinity);
    REQUIRE(grown.pressure[went] == 0);
    REQUIRE_THAT(content(grown), WithinRel(content(small), 1e-14));
    REQUIRE_THAT(more.volume, WithinRel(big.volume[went], 1e-12));

    auto away = made(b, {{1, 4, 2}});
    for (auto& p : big.pressure) p = 4;
    auto const apart = transfer_fluid(made(b, {{0, 2, 3}}), away, b.points(), modulus, -infinity);
    REQUIRE(apart.lost == 0);
    auto lone = made(b, {{1, 4, 2}});
    lone.pressure[0] = 3;
    auto elsewhere = made(b, {{0, 2, 3}});
    auto const lost = transfer_fluid(lone, elsewhere, b.points(), modulus, -infinity);
    REQUIRE_THAT(lost.lost, WithinRel(content(lone), 1e-14));
    REQUIRE(elsewhere.pressure[0] == 0);
}

TEST_CASE("an inverted triangle gives its fluid to the pores that replace it") {
    // Disc 3 has moved across the edge 0-1: the old pore {0, 1, 3} is inverted, and covers a part of {0, 2, 1}.
    bodies::body b{{{0, 0}, {2, 0}, {1, -2}, {1, -0.2}}, {0.2, 0.2, 0.2, 0.2}};
    network from = made(b, {{0, 2, 1}}), to = made(b, {{0, 2, 3}, {2, 1, 3}});
    from.pressure[0] = 6;
    auto const report = transfer_fluid(from, to, b.points(), modulus, -infinity);
    REQUIRE_THAT(content(to), WithinRel(content(from), 1e-13));
    for (double const p : to.pressure) REQUIRE((std::isfinite(p) && p > 6));
    REQUIRE(report.changed == 2);
}

TEST_CASE("flows and sources are transferred to the new network") {
    auto const b = square();
    auto from = made(b, {{0, 1, 2}, {0, 2, 3}}), to = made(b, {{0, 1, 2}, {0, 2, 3}});
    from.flow[0] = 0.25;
    from.sources.push_back({"top", flow_source_kind::rate, 3.0, {1}, {1.0}, 0.5, 0.1});
    to.sources.push_back({"top", flow_source_kind::rate, 1.0, {0}, {1.0}, 0.0, 0.0});
    transfer_fluid(from, to, b.points(), modulus, -infinity);
    REQUIRE(to.flow[0] == 0.25);
    REQUIRE(to.sources[0].value == 3.0);
    REQUIRE(to.sources[0].volume == 0.5);
    REQUIRE(to.sources[0].pores[0] == 0);
}

TEST_CASE("solvers continue from a transferred network") {
    auto const b = cloud(3);
    auto const check = [&](auto flow) {
        using type = decltype(flow);
        std::mt19937_64 engine(5);
        for (std::size_t p = 0; p < flow.network().pores(); ++p) flow.set_pressure(p, uniform(engine));
        auto weights = b.r;
        for (auto& w : weights) w *= 0.8 + 0.4 * uniform(engine);
        auto fresh = type(flow.settings(),
                          make_pore_network(regular_triangulation(b.points(), weights.data()), b.points(), b.r.data()),
                          1.0, b.points(), b.r.data())
                         .network();
        transfer_fluid(flow.network(), fresh, b.points(), modulus, -infinity);
        double const before = content(fresh);
        flow.restore(fresh, flow.ledger());
        double const dt = 1e-5;
        for (int n = 0; n < 50; ++n) flow.template step<true>(b.records(), bodies::body::no_force, dt);
        auto const [least, most] = std::minmax_element(flow.network().pressure.begin(), flow.network().pressure.end());
        REQUIRE(*least > 0);
        REQUIRE(*most < 1);
        REQUIRE_THAT(content(flow.network()), WithinRel(before, 1e-11));
    };
    auto p = bodies::body::settings<solver>();
    p.substeps = 0;
    check(solver(p, made_with(b, b.r), 1.0, b.points(), b.r.data()));
    using implicit_solver = implicit_flow::solver<double, 2>;
    check(implicit_solver(bodies::body::settings<implicit_solver>(), made_with(b, b.r), 1.0, b.points(), b.r.data()));
}

TEST_CASE("a mesh is unfit with an inverted triangle, a filled pore, a contact without an edge, each once") {
    auto const rest = square();
    auto const net = made(rest, {{0, 1, 2}, {0, 2, 3}});
    mesh_watch<double> watch;
    auto const all_pairs = [](auto const& visit) {
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j) visit(i, j);
    };
    auto const accept = [&](network const& n, bodies::body const& b) {
        watch.accept(n, b.points(), b.r.data(), 1.0, 1e-3, all_pairs);
    };
    auto const unfit = [&](network const& n, bodies::body const& b) {
        return watch.unfit(n, b.points(), b.r.data(), 1.0, 1e-3, all_pairs);
    };
    accept(net, rest);
    REQUIRE_FALSE(unfit(net, rest));

    auto b = rest;
    b.x[1] = {0.4, 0.6};
    REQUIRE(unfit(net, b));
    accept(net, rest);
    REQUIRE_FALSE(unfit(net, rest));

    // 1 and 3 come to touch across the diagonal 0-2.
    b = rest;
    b.x[1] = {0.72, 0.28};
    b.x[3] = {0.30, 0.70};
    REQUIRE(norm(b.x[1] - b.x[3]) < 0.6);
    REQUIRE(unfit(net, b));
    accept(net, b); // a new mesh without that edge is accepted: the contact does not count,
    REQUIRE_FALSE(unfit(net, b));
    REQUIRE_FALSE(unfit(net, rest)); // until it has opened
    REQUIRE(unfit(net, b));

    auto filled = net;
    accept(filled, rest);
    filled.volume[1] = 1e-3 * filled.size[1];
    REQUIRE(unfit(filled, rest));
    accept(filled, rest);
    REQUIRE_FALSE(unfit(filled, rest));
}
