// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <lacuna/pores/flow/corner_forces.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/pore_throats.hpp>

#include "bodies.hpp"

using namespace lacuna;

namespace {

using solver = explicit_flow::solver<double, 2>;
using space_solver = explicit_flow::solver<double, 3>;

/// Force of the network's pressures on each particle, pore by pore, from the definition (eq. 16).
template <class Solver, class Body>
auto expected(Solver const& flow, Body const& b) {
    auto const& net = flow.network();
    std::vector<typename Body::position_type> sum(b.x.size());
    for (std::size_t k = 0; k < net.pores(); ++k) {
        if (net.volume[k] <= 1.000001e-3 * net.size[k]) continue;
        auto const push = flow.pore_tractions(k, b.points(), b.r.data());
        for (std::size_t c = 0; c < net.corner.size(); ++c)
            sum[std::size_t(net.corner[c][k])] += push[c] * net.pressure[k];
    }
    return sum;
}

/// Steps of a packing with many more pores than one chunk holds.
template <class Solver, class Body>
void compare(Body b, double dt) {
    auto const drained = [](auto const& throat) {
        bool const top = throat.side == body_side::top;
        return throat_boundary<double>{top ? boundary_kind::drained : boundary_kind::sealed, 3.0};
    };
    auto one = b.template flow<Solver>(Body::template settings<Solver>(), drained);
    std::mt19937_64 engine(5);
    for (std::size_t k = 0; k < one.network().pores(); ++k) one.set_pressure(k, bodies::uniform(engine));
    auto two = one, kept = one;
    REQUIRE(one.network().pores() > 2 * pore_table<double, 2>::chunk_packs * pore_table<double, 2>::width);
    std::size_t const records = b.x[0].size() == 2 ? 1 : 2;
    record_column<double> of_one, of_two, of_kept;
    for (auto* column : {&of_one, &of_two, &of_kept}) column->resize(records * b.x.size());
    for (int s = 0; s < 3; ++s) {
        for (auto& x : b.x) x[0] += 0.01 * (bodies::uniform(engine) - 0.5);
        one.template step<false>(b.records(), Body::no_force, dt, 1, &of_one);
        two.template step<true>(b.records(), Body::no_force, dt, 1, &of_two);
        kept.template step<false>(b.records(), Body::no_force, dt, 3, &of_kept);
    }
    REQUIRE(one.network().pressure == two.network().pressure);
    REQUIRE(one.network().pressure == kept.network().pressure);
    REQUIRE(one.network().flow == kept.network().flow);
    auto const sum = expected(one, b);
    double largest = 0;
    for (auto const& f : sum) largest = std::max(largest, norm(f));
    REQUIRE(largest > 0.1);
    for (std::size_t i = 0; i < b.x.size(); ++i)
        for (int lane = 0; lane < 4; ++lane) {
            REQUIRE(of_one.at(records * i, lane) == of_two.at(records * i, lane));
            REQUIRE(of_one.at(records * i, lane) == of_kept.at(records * i, lane));
            REQUIRE(std::fabs(of_one.at(records * i, lane) - (lane < sum[i].size() ? sum[i][lane] : 0.0)) <=
                    1e-12 * largest);
        }
}

/// The particles numbered in another order.
template <class Body>
Body shuffled(Body const& b) {
    std::vector<std::size_t> order(b.x.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::shuffle(order.begin(), order.end(), std::mt19937_64(9));
    Body other;
    for (auto const k : order) {
        other.x.push_back(b.x[k]);
        other.r.push_back(b.r[k]);
    }
    return other;
}

} // namespace

TEST_CASE("forces summed at once equal stored forces, and those of the pressures") {
    auto const b = bodies::scattered(3, 44, 40, 0.7, 0.95);
    compare<solver>(b, 1e-5);
    // With particles numbered at random, nearly all forces are needed until the end.
    compare<solver>(shuffled(b), 1e-5);
    compare<space_solver>(bodies::scattered_spheres(7, 9, 0.8, 1.0), 1e-5);
}

TEST_CASE("a force is stored until its particle's group is complete") {
    // A strip of triangles (k, k + 1, k + 2): the last pore of particle k is number k, in block k / block.
    struct strip {
        std::size_t particles;
        std::array<std::vector<std::int32_t>, 3> corner;
        std::size_t pores() const { return corner[0].size(); }
    } net{1000, {}};
    for (std::int32_t p = 0; p < 998; ++p)
        for (std::int32_t c = 0; c < 3; ++c) net.corner[std::size_t(c)].push_back(p + c);
    using forces = corner_forces<double, 2>;
    constexpr std::size_t block = 4 * std::size_t(forces::width);
    for (bool const transient : {true, false}) {
        forces f;
        f.build(net, block, transient);
        // A group of 32 particles is complete after the block with the last pore of its last particle.
        std::set<double*> addresses;
        record_column<double> sum;
        sum.assign(1000, record<double>(-1.0));
        for (std::size_t n = 0; n * block < 998; ++n) {
            for (std::size_t p = n * block; p < std::min<std::size_t>((n + 1) * block, 998); ++p)
                for (std::size_t c = 0; c < 3; ++c) {
                    double* at = f.of(p, c);
                    addresses.insert(at);
                    at[0] = double(p);
                    at[1] = double(c);
                }
            f.write_complete(n, sum);
            for (std::size_t k = 0; k < 1000; ++k) {
                std::size_t const group_end = std::min<std::size_t>(k / 32 * 32 + 32, 1000);
                std::size_t const block_end = std::min<std::size_t>((n + 1) * block, 998);
                bool const complete = std::min<std::size_t>(group_end - 1, 997) < block_end;
                if (!complete) {
                    REQUIRE(sum.at(k, 0) == -1);
                    continue;
                }
                // Pores k - 2 (its third corner), k - 1 (its second), k (its first), if they exist.
                double pores = 0, corners = 0;
                for (std::size_t c = 0; c < 3; ++c)
                    if (k >= c && k - c < 998) {
                        pores += double(k - c);
                        corners += double(c);
                    }
                REQUIRE(sum.at(k, 0) == pores);
                REQUIRE(sum.at(k, 1) == corners);
            }
        }
        if (transient)
            REQUIRE(addresses.size() < 3 * 998 / 2);
        else
            REQUIRE(addresses.size() == 3 * 998);
    }
}

TEST_CASE("throats of a pore: first those for which it is on side 1, both parts in ascending order") {
    // Throats 0 to 5 between pores 2-0, 1-2, 0-1, 2-1, and from reservoirs to 0 and 2.
    std::array<std::vector<std::int32_t>, 2> const ends{{{2, 1, 0, 2, 0, 2}, {0, 2, 1, 1, -1, -1}}};
    pore_throats<double> table;
    table.build(ends, 3);
    REQUIRE(table.row() == 4);
    using entry = std::pair<std::size_t, int>;
    std::vector<std::vector<entry>> const wanted{
        {{0, 1}, {2, 0}, {4, 0}}, {{2, 1}, {3, 1}, {1, 0}}, {{1, 1}, {0, 0}, {3, 0}, {5, 0}}};
    for (std::size_t p = 0; p < 3; ++p) {
        std::vector<entry> seen;
        table.for_each(p, [&](std::size_t t, int side) { seen.emplace_back(t, side); });
        REQUIRE(seen == wanted[p]);
        if (p < std::size_t(table.width)) REQUIRE(table.outflows(0)[p] == (p == 1 ? 2.0f : 1.0f));
    }
    // Rows are padded with the number after the last throat.
    REQUIRE(table.throats(0, 3)[0] == 6);
}

TEST_CASE("a step is the same if throats are not in the order of their pores") {
    auto const b = bodies::scattered(3, 44, 40, 0.7, 0.95);
    auto net = b.network();
    auto const reverse_interior = [&](auto& column) {
        std::reverse(column.begin(), column.begin() + std::ptrdiff_t(net.interior_throats));
    };
    for (auto& column : net.throat_particle) reverse_interior(column);
    for (auto& column : net.throat_pore) reverse_interior(column);
    reverse_interior(net.length);
    net.throats_of.build(net.throat_pore, net.pores());
    auto const p = bodies::body::settings<solver>();
    solver other(p, net, 1.0, b.points(), b.r.data()), usual = b.flow<solver>(p);
    std::mt19937_64 engine(5);
    for (std::size_t k = 0; k < net.pores(); ++k) {
        double const pressure = bodies::uniform(engine);
        other.set_pressure(k, pressure);
        usual.set_pressure(k, pressure);
    }
    for (int s = 0; s < 3; ++s) {
        other.step<false>(b.records(), bodies::body::no_force, 1e-5);
        usual.step<false>(b.records(), bodies::body::no_force, 1e-5);
    }
    double moved = 0;
    for (std::size_t k = 0; k < net.pores(); ++k) {
        REQUIRE_THAT(other.network().pressure[k], WithinAbs(usual.network().pressure[k], 1e-12));
        moved = std::max(moved, std::fabs(usual.network().pressure[k] - 0.5));
    }
    REQUIRE(moved > 0.1);
}

TEST_CASE("a fluid that can tear continues from the network of one that cannot") {
    auto const b = bodies::triangular(4, 5);
    auto p = bodies::body::settings<solver>();
    auto const firm = b.flow<solver>(p);
    REQUIRE(firm.network().vapour.empty());
    p.minimum_pressure = -1;
    auto weak = b.flow<solver>(p);
    weak.restore(firm.network(), firm.ledger());
    REQUIRE(weak.network().vapour.size() == firm.network().pores());
    solver also(p, firm.network(), 1.0, b.points(), b.r.data());
    auto wide = b;
    for (auto& x : wide.x) x = x * 1.01;
    for (auto* flow : {&weak, &also}) {
        flow->step<true>(wide.records(), bodies::body::no_force, 0);
        // Volumes have grown by far more than 1 Pa over K_f = 1000 Pa allows: vapour fills the rest.
        auto const& net = flow->network();
        for (std::size_t k = 0; k < net.pores(); ++k) {
            REQUIRE(net.pressure[k] == -1);
            REQUIRE_THAT(net.vapour[k], WithinRel(net.volume[k] * (1 - 1.0 / 1000) - firm.network().volume[k], 1e-9));
        }
    }
}
