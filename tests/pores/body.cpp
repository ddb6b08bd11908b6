// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

using namespace lacuna;
using point = vec<double, 2>;
using solver = explicit_flow::solver<double, 2>;

namespace {

constexpr double pi = 3.14159265358979323846;

double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

/// A packing of discs with its pores; K_f = 1000 Pa, k = 1 and thickness 1 m unless changed.
struct body {
    std::vector<point> x;
    std::vector<double> r;
    solver::parameters p;

    body() {
        p.bulk_modulus = 1000;
        p.conductivity = 1;
        p.skip_ratio = std::numeric_limits<double>::infinity();
        p.aperture = {0.1, 1, 1};
    }
    points_view<double, 2> points() const { return view_points(x); }
    pore_mesh<2> mesh() const { return triangulate_body(points(), r.data()); }
    template <class Boundary = all_sealed>
    solver flow(Boundary const& boundary = {}) const {
        return {p, make_pore_network(mesh(), points(), r.data(), boundary), 1.0, points(), r.data()};
    }
    /// Records as in a particle store: {x, y, arc, radius}, and those of two padding particles.
    particle_column<double> records() const {
        particle_column<double> column;
        column.resize(x.size() + 2);
        for (std::size_t i = 0; i < x.size() + 2; ++i) {
            bool const padding = i >= x.size();
            column.at(i, 0) = padding ? double(i - x.size()) : x[i][0];
            column.at(i, 1) = padding ? 0 : x[i][1];
            column.at(i, 2) = 77;
            column.at(i, 3) = padding ? 0.25 : r[i];
        }
        return column;
    }
    /// One step without forces between particles.
    void step(solver& flow, double dt) const { flow.step<true>(records(), no_force, dt); }
    /// Forces of a solver's pressures, three numbers per particle; the third stays 0.
    std::vector<double> tractions(solver flow) const {
        return written(std::move(flow));
    }
    /// The same on several threads.
    std::vector<double> written(solver flow, int threads = 1) const {
        record_column<double> extra;
        extra.assign(x.size(), record<double>(9.0));
        flow.step<false>(records(), no_force, 0, threads, &extra);
        std::vector<double> force;
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (int lane = 0; lane < 3; ++lane) force.push_back(extra.at(i, lane));
            REQUIRE(extra.at(i, 3) == 0);
        }
        return force;
    }
    /// Void of a pore by the cosine rule and the standard library, at a thickness of 1.
    double void_of(std::array<std::int32_t, 3> const& corners) const {
        double area = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            auto const i = std::size_t(corners[c]), j = std::size_t(corners[(c + 1) % 3]),
                       k = std::size_t(corners[(c + 2) % 3]);
            double const one = norm(x[j] - x[i]), other = norm(x[k] - x[i]), across = norm(x[k] - x[j]);
            area += cross(x[i], x[j]) / 2 - r[i] * r[i] / 2 *
                    std::acos((one * one + other * other - across * across) / (2 * one * other));
        }
        return area;
    }
    /// Eq. 16 on corner `c` of a pore at 1 Pa: over the chord between its two joints.
    point push_on(std::array<std::int32_t, 3> const& corners, std::size_t c) const {
        auto const i = std::size_t(corners[c]), j = std::size_t(corners[(c + 1) % 3]),
                   k = std::size_t(corners[(c + 2) % 3]);
        return perpendicular(joint_point(x[i], x[k], r[i], r[k]) - joint_point(x[i], x[j], r[i], r[j]));
    }
    static constexpr double no_force[4] = {0, 0, 0, 0};
};

std::array<std::int32_t, 3> corners_of(pore_network<double, 2> const& net, std::size_t pore) {
    return {net.corner[0][pore], net.corner[1][pore], net.corner[2][pore]};
}

/// A disc with six touching neighbours; the middle one is number 0.
body hexagon() {
    body b;
    b.x.push_back({0, 0});
    for (int k = 0; k < 6; ++k) b.x.push_back({2 * std::cos(k * pi / 3), 2 * std::sin(k * pi / 3)});
    b.r.assign(7, 1.0);
    return b;
}

/// Discs of different radii on a disturbed lattice; some overlap, some have gaps.
body scattered(std::uint64_t seed, int rows = 9, int columns = 12, double least = 0.75, double most = 1.05) {
    std::mt19937_64 engine(seed);
    body b;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            b.x.push_back({2 * j + (i % 2) + 0.4 * (uniform(engine) - 0.5),
                           std::sqrt(3.0) * i + 0.4 * (uniform(engine) - 0.5)});
            b.r.push_back(least + (most - least) * uniform(engine));
        }
    return b;
}

} // namespace

TEST_CASE("a uniform pressure in a hexagon of discs pushes its rim, not its middle") {
    auto const b = hexagon();
    auto flow = b.flow();
    REQUIRE(flow.network().pores() == 6);
    REQUIRE(flow.network().interior_throats == 6);
    REQUIRE(flow.network().throats() == 12);
    for (std::size_t k = 0; k < 6; ++k) {
        REQUIRE_THAT(flow.network().volume[k], WithinRel(reference("9a.three_equal", "area/R^2"), 1e-11));
        REQUIRE(flow.network().location[k] == pore_location::sealed);
        flow.set_pressure(k, 2.5);
    }
    auto const force = b.tractions(flow);
    for (int c = 0; c < 3; ++c)
        REQUIRE_THAT(force[std::size_t(c)], WithinAbs(reference("9e.uniform_pressure", "interior_net_force"), 1e-12));
    double virial[2][2] = {};
    for (std::size_t i = 0; i < 7; ++i)
        for (std::size_t a = 0; a < 2; ++a)
            for (std::size_t c = 0; c < 2; ++c) virial[a][c] += b.x[i][int(a)] * force[3 * i + c];
    double const whole = 2.5 * reference("9e.uniform_pressure", "7-disc hexagon virial/(p R^2)");
    REQUIRE_THAT(virial[0][0], WithinRel(whole, 1e-11));
    REQUIRE_THAT(virial[1][1], WithinRel(whole, 1e-11));
    REQUIRE_THAT(virial[0][1], WithinAbs(0, 1e-12));
    REQUIRE_THAT(virial[1][0], WithinAbs(0, 1e-12));
    for (std::size_t i = 1; i < 7; ++i) {
        point const f{force[3 * i], force[3 * i + 1]};
        REQUIRE_THAT(dot(f, b.x[i]) / 2,
                     WithinRel(2.5 * reference("9e.uniform_pressure", "rim_disc_outward_force/(pR)"), 1e-11));
        REQUIRE_THAT(cross(f, b.x[i]), WithinAbs(0, 1e-12));
        REQUIRE(force[3 * i + 2] == 0);
    }
}

TEST_CASE("pores of a rhombus and of a ring add up to the merged ones") {
    body b;
    b.x = {{0, 0}, {2, 0}, {1, std::sqrt(3.0)}, {3, std::sqrt(3.0)}};
    b.r.assign(4, 1.0);
    auto const rhombus = b.flow();
    REQUIRE(rhombus.network().pores() == 2);
    REQUIRE_THAT(rhombus.network().volume[0] + rhombus.network().volume[1],
                 WithinRel(reference("9d.merged", "rhombus_two_triangles"), 1e-11));
    auto const ring = hexagon().flow();
    double total = pi;
    for (double const v : ring.network().volume) total += v;
    REQUIRE_THAT(total, WithinRel(reference("9d.merged", "hex_ring_6_discs"), 1e-11));
    // Four discs on a square: two triangles, whichever diagonal.
    b.x = {{0, 0}, {2, 0}, {0, 2}, {2, 2}};
    auto const square = b.flow();
    REQUIRE(square.network().pores() == 2);
    REQUIRE_THAT(square.network().volume[0] + square.network().volume[1],
                 WithinRel(reference("9d.merged", "square_4_discs"), 1e-11));
}

TEST_CASE("a uniform pressure exerts no net force or moment on a packing, and no force on inner discs") {
    auto const b = scattered(29, 9, 12, 0.6, 0.9);
    auto flow = b.flow();
    auto const& net = flow.network();
    REQUIRE(net.pores() > 150);
    for (std::size_t k = 0; k < net.pores(); ++k) flow.set_pressure(k, 3.0);
    std::set<int> rim;
    for (std::size_t t = net.interior_throats; t < net.throats(); ++t) {
        rim.insert(net.throat_particle[0][t]);
        rim.insert(net.throat_particle[1][t]);
    }
    auto const force = b.tractions(flow);
    double sum[2] = {}, moment = 0, largest = 0;
    for (std::size_t i = 0; i < b.x.size(); ++i) {
        point const f{force[3 * i], force[3 * i + 1]};
        if (!rim.count(int(i)))
            for (std::size_t c = 0; c < 3; ++c) REQUIRE_THAT(force[3 * i + c], WithinAbs(0, 1e-12));
        sum[0] += f[0];
        sum[1] += f[1];
        moment += cross(b.x[i], f);
        largest = std::max(largest, norm(f));
    }
    REQUIRE(largest > 1);
    REQUIRE_THAT(sum[0], WithinAbs(0, 1e-12));
    REQUIRE_THAT(sum[1], WithinAbs(0, 1e-12));
    REQUIRE_THAT(moment, WithinAbs(0, 1e-10));
}

TEST_CASE("tractions are those of eq. 16, pore by pore") {
    auto const b = scattered(31, 9, 12, 0.6, 0.9);
    auto flow = b.flow();
    std::mt19937_64 engine(1);
    std::vector<double> expected(3 * b.x.size(), 0.0);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) {
        double const p = uniform(engine) - 0.5;
        flow.set_pressure(k, p);
        auto const corners = corners_of(flow.network(), k);
        for (std::size_t c = 0; c < 3; ++c) {
            auto const t = b.push_on(corners, c);
            for (std::size_t axis = 0; axis < 2; ++axis) {
                expected[3 * std::size_t(corners[c]) + axis] += p * t[int(axis)];
                REQUIRE_THAT(flow.pore_tractions(k, b.points(), b.r.data())[c][int(axis)],
                             WithinAbs(t[int(axis)], 1e-14));
            }
        }
    }
    auto const force = b.tractions(flow);
    for (std::size_t k = 0; k < force.size(); ++k) REQUIRE_THAT(force[k], WithinAbs(expected[k], 1e-13));
}

TEST_CASE("a step follows its formulas throat by throat and pore by pore, for any number of pores") {
    // From fewer pores than a pack holds to many packs, the last of them full or not.
    int const columns = GENERATE(2, 3, 4, 5, 6, 7, 8, 9, 10, 30);
    auto b = scattered(53, columns < 30 ? 2 : 9, columns, 0.6, 1.05);
    auto flow = b.flow([](auto const& throat) -> throat_boundary<double> {
        return {throat.side == body_side::left ? boundary_kind::drained : boundary_kind::sealed, 0.4};
    });
    auto const before = flow.network();
    std::mt19937_64 engine(6);
    auto pressure = before.pressure;
    for (std::size_t k = 0; k < before.pores(); ++k) flow.set_pressure(k, pressure[k] = uniform(engine) - 0.5);
    double const energy = flow.storage_energy();
    double stored = 0;
    for (std::size_t k = 0; k < before.pores(); ++k) stored += before.volume[k] * pressure[k] * pressure[k] / 2000;
    REQUIRE_THAT(energy, WithinRel(stored, 1e-13));

    // Normal forces: in the reverse order of the throats, none for every fourth.
    std::vector<double> forces(before.throats() + 1, 99.0);
    forces[0] = 0;
    std::size_t const open = before.open_throats();
    std::vector<double> normal(open, 0.0);
    flow.map_throats([&](std::int32_t i, std::int32_t j) -> int {
        std::size_t t = 0;
        while (before.throat_particle[0][t] != i || before.throat_particle[1][t] != j) ++t;
        REQUIRE(t < open);
        if (t % 4 == 3) return 0;
        normal[t] = 4 * uniform(engine) - 3;
        forces[open - t] = normal[t];
        return int(open - t);
    });
    for (auto& x : b.x) x += point{0.01 * (uniform(engine) - 0.5), 0.01 * (uniform(engine) - 0.5)};
    double const dt = 1e-4;
    flow.step<true>(b.records(), forces.data(), dt);

    auto const& net = flow.network();
    std::vector<double> inflow(net.pores(), 0.0), expected(3 * b.x.size(), 0.0);
    for (std::size_t t = 0; t < open; ++t) {
        auto const i = std::size_t(net.throat_particle[0][t]), j = std::size_t(net.throat_particle[1][t]);
        double const gap = norm(b.x[j] - b.x[i]) - b.r[i] - b.r[j];
        double const aperture = normal[t] < 0 ? 0.1 / (1 - normal[t]) : 0.1 + std::max(gap, 0.0);
        REQUIRE_THAT(net.aperture[t], WithinRel(aperture, 1e-13));
        double const conductance = aperture * aperture * aperture / (b.r[i] + b.r[j]);
        REQUIRE_THAT(net.conductance[t], WithinRel(conductance, 1e-12));
        auto const one = std::size_t(net.throat_pore[0][t]);
        double const far = t < net.interior_throats ? pressure[std::size_t(net.throat_pore[1][t])] : 0.4;
        double const q = conductance * (far - pressure[one]);
        REQUIRE_THAT(net.flow[t], WithinAbs(q, 1e-16 + 1e-12 * std::fabs(q)));
        inflow[one] += q * dt;
        if (t < net.interior_throats) inflow[std::size_t(net.throat_pore[1][t])] -= q * dt;
    }
    double after = 0;
    for (std::size_t k = 0; k < net.pores(); ++k) {
        auto const corners = corners_of(net, k);
        double const least = 1e-3 * net.size[k], free = b.void_of(corners), volume = std::max(free, least);
        REQUIRE_THAT(net.volume[k], WithinAbs(volume, 1e-13));
        double const p = pressure[k] + 1000 / volume * (inflow[k] - (volume - before.volume[k]));
        REQUIRE_THAT(net.pressure[k], WithinAbs(p, 1e-13 * 1000 / volume));
        after += volume * p * p / 2000;
        for (std::size_t c = 0; c < 3; ++c) {
            auto const t = b.push_on(corners, c);
            for (std::size_t axis = 0; axis < 2; ++axis)
                if (free > least) expected[3 * std::size_t(corners[c]) + axis] += net.pressure[k] * t[int(axis)];
        }
    }
    REQUIRE_THAT(flow.storage_energy(), WithinRel(after, 1e-9));
    REQUIRE_THAT(flow.ledger().mass_residual, WithinAbs(0, 1e-13 * double(net.pores())));
    auto const force = b.written(flow);
    for (std::size_t k = 0; k < force.size(); ++k)
        REQUIRE_THAT(force[k], WithinAbs(expected[k], 1e-11 * (1 + std::fabs(expected[k]))));

    // Padding beyond the last pore and throat contributes nothing, in 20 more steps.
    double content = 0;
    for (int s = 0; s < 20; ++s) {
        auto const old = flow.network();
        flow.step<true>(b.records(), forces.data(), dt);
        content = 0;
        for (std::size_t k = 0; k < net.pores(); ++k)
            content += net.volume[k] * (net.pressure[k] - old.pressure[k]) / 1000 + net.volume[k] - old.volume[k];
        double in = 0;
        for (std::size_t t = net.interior_throats; t < open; ++t) in += net.flow[t] * dt;
        REQUIRE_THAT(content, WithinAbs(in, 1e-12));
    }
}

TEST_CASE("threads and the ledger change no bit of a step") {
    auto const b = scattered(59, 40, 40, 0.6, 0.95);
    auto const start = b.flow([](auto const& throat) -> throat_boundary<double> {
        return {throat.side == body_side::top ? boundary_kind::drained : boundary_kind::sealed, 0.3};
    });
    REQUIRE(start.network().pores() > 2048);
    auto const run = [&](int threads, bool ledger) {
        auto flow = start;
        std::mt19937_64 engine(8);
        for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
        auto moved = b;
        for (int s = 0; s < 5; ++s) {
            for (auto& x : moved.x) x += point{0.01 * (uniform(engine) - 0.5), 0.01 * (uniform(engine) - 0.5)};
            if (ledger)
                flow.step<true>(moved.records(), body::no_force, 1e-4, threads);
            else
                flow.step<false>(moved.records(), body::no_force, 1e-4, threads);
        }
        return flow;
    };
    auto const one = run(1, true);
    auto const forces = b.written(one);
    for (int threads : {2, 3, 5}) {
        auto const many = run(threads, true);
        REQUIRE(many.network().pressure == one.network().pressure);
        REQUIRE(many.network().flow == one.network().flow);
        REQUIRE(many.ledger().dissipation == one.ledger().dissipation);
        REQUIRE(many.ledger().pressure_work == one.ledger().pressure_work);
        REQUIRE(many.ledger().mass_residual == one.ledger().mass_residual);
        REQUIRE(b.written(many, threads) == forces);
    }
    REQUIRE(one.ledger().dissipation > 0);
    auto const bare = run(2, false);
    for (std::size_t k = 0; k < one.network().pores(); ++k)
        REQUIRE_THAT(bare.network().pressure[k], WithinRel(one.network().pressure[k], 1e-9));
    REQUIRE(bare.ledger().dissipation == 0);
}

TEST_CASE("the work of pressures on moving discs equals their work on the change of volume") {
    auto b = scattered(47, 9, 12, 0.6, 0.9);
    auto flow = b.flow();
    std::mt19937_64 engine(4);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, 1 + uniform(engine));
    auto const force = b.tractions(flow);
    auto const pressure = flow.network().pressure;
    // No pore is at its least volume, where pressures work on discs and volumes do not change.
    REQUIRE(*std::min_element(flow.network().volume.begin(), flow.network().volume.end()) > 0.01);
    auto const rest = b.x;
    double work = 0, scale = 0;
    std::vector<point> direction;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        direction.push_back({uniform(engine) - 0.5, uniform(engine) - 0.5});
        work += dot(direction[i], point{force[3 * i], force[3 * i + 1]});
    }
    double const h = 1e-5;
    double volume_work = 0;
    for (double const side : {1.0, -1.0}) {
        for (std::size_t i = 0; i < rest.size(); ++i) b.x[i] = rest[i] + direction[i] * (side * h);
        flow.refresh_geometry(b.points(), b.r.data());
        for (std::size_t k = 0; k < pressure.size(); ++k) {
            volume_work += side * pressure[k] * flow.network().volume[k] / (2 * h);
            scale += pressure[k] * flow.network().volume[k];
        }
    }
    REQUIRE(std::fabs(work) > 1);
    REQUIRE_THAT(volume_work, WithinAbs(work, 1e-9 * scale));
}

TEST_CASE("throats: length, conductance, order, sides") {
    body b;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 6; ++j) {
            b.x.push_back({2.0 * j, 2.0 * i});
            b.r.push_back(1);
        }
    int asked = 0;
    auto const flow = b.flow([&](boundary_throat<double, 2> const& throat) -> throat_boundary<double> {
        ++asked;
        bool const top = throat.middle[1] == 6, left = throat.middle[0] == 0;
        REQUIRE((throat.side == body_side::top) == top);
        REQUIRE((throat.side == body_side::left) == left);
        if (top) REQUIRE(throat.outward == point{0, 1});
        if (left) REQUIRE(throat.outward == point{-1, 0});
        if (throat.side == body_side::right) return {boundary_kind::drained, 7.0};
        return {top ? boundary_kind::drained : boundary_kind::sealed, 0.0};
    });
    auto const& net = flow.network();
    REQUIRE(asked == 16);
    REQUIRE(net.pores() == 30);
    REQUIRE(net.throats() == 53);
    REQUIRE(net.interior_throats == 37);
    REQUIRE(net.drained_throats == 8);
    for (std::size_t t = 0; t < net.throats(); ++t) {
        auto const i = std::size_t(net.throat_particle[0][t]), j = std::size_t(net.throat_particle[1][t]);
        REQUIRE(net.length[t] == 2.0);
        REQUIRE((net.throat_pore[1][t] >= 0) == (t < net.interior_throats));
        REQUIRE((net.kind(t) == boundary_kind::sealed) == (t >= 45));
        if (t < 45) REQUIRE_THAT(net.conductance[t], WithinRel(0.001 / 2, 1e-14));
        if (t >= 45) REQUIRE(net.conductance[t] == 0);
        // Pore 0 lies to the left of the line from particle 0 to particle 1.
        auto const middle = pore_middle(net, std::size_t(net.throat_pore[0][t]), b.points());
        REQUIRE(cross(b.x[j] - b.x[i], middle - b.x[i]) > 0);
        if (t >= net.interior_throats && t < 45)
            REQUIRE(net.reservoir_pressure(t) == (b.x[i][0] == 10 && b.x[j][0] == 10 ? 7.0 : 0.0));
    }
}

TEST_CASE("a throat equally near to two sides of the bounding box belongs to the one it faces") {
    pore_mesh<2> mesh;
    mesh.simplices = {{0, 1, 2}, {3, 4, 5}};
    detail::connect(mesh);
    std::vector<point> const x{{0, 0.5}, {2, 1.5}, {0, 4}, {4, 0}, {6, 0}, {5, 2}};
    std::vector<double> const r(6, 0.2);
    make_pore_network(mesh, view_points(x), r.data(), [](auto const& throat) -> throat_boundary<double> {
        if (throat.particles[0] == 0) {
            REQUIRE(throat.middle == point{1, 1});
            REQUIRE(throat.side == body_side::bottom);
        }
        return {};
    });
}

TEST_CASE("a packing drains through the chosen sides only") {
    auto b = scattered(37, 6, 8, 0.6, 0.9);
    auto sealed = b.flow();
    auto drained = b.flow([](auto const& throat) -> throat_boundary<double> {
        return {throat.side == body_side::top ? boundary_kind::drained : boundary_kind::sealed, 0.0};
    });
    auto records = b.records();
    for (std::size_t i = 0; i < b.x.size(); ++i) records.at(i, 3) = 2; // overlaps everywhere: closed gaps, no force
    auto const start = [&](solver& flow) {
        for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, 1.0);
        flow.refresh_apertures(records, body::no_force);
    };
    start(sealed);
    start(drained);
    double const dt = drained.critical_time_step();
    for (int i = 0; i < 20000; ++i) drained.advance(dt);
    for (int i = 0; i < 1000; ++i) sealed.advance(dt);
    double fluid = 0;
    for (std::size_t k = 0; k < drained.network().pores(); ++k) {
        REQUIRE_THAT(drained.network().pressure[k], WithinAbs(0, 1e-3));
        REQUIRE_THAT(sealed.network().pressure[k], WithinAbs(1, 1e-13));
        fluid += drained.network().volume[k] * (1 - drained.network().pressure[k]) / b.p.bulk_modulus;
    }
    REQUIRE_THAT(-drained.ledger().boundary_inflow, WithinRel(fluid, 1e-9));
    REQUIRE(sealed.ledger().boundary_inflow == 0);
}

TEST_CASE("mass and energy balance in every step while the packing moves") {
    auto const tears = GENERATE(false, true);
    auto b = scattered(41);
    if (tears) b.p.minimum_pressure = -0.5;
    auto flow = b.flow([](auto const& throat) -> throat_boundary<double> {
        return {throat.side == body_side::top ? boundary_kind::drained : boundary_kind::sealed, 0.3};
    });
    std::mt19937_64 engine(2);
    auto const rest = b.x;
    double const dt = 0.3 * flow.critical_time_step();
    double vapour_seen = 0;
    for (int step = 0; step < 300; ++step) {
        for (std::size_t i = 0; i < b.x.size(); ++i)
            b.x[i] = rest[i] + point{std::sin(0.05 * step + 0.3 * double(i)),
                                     std::cos(0.04 * step + 0.7 * double(i))} * 0.01;
        auto const before = flow.network();
        auto const totals = flow.ledger();
        double const energy = flow.storage_energy();
        auto const gap_of = [&](int one, int other) {
            auto const i = std::size_t(one), j = std::size_t(other);
            return norm(b.x[j] - b.x[i]) - b.r[i] - b.r[j];
        };
        std::vector<double> forces{0};
        flow.map_throats([&](int i, int j) {
            forces.push_back(std::min(10 * gap_of(i, j), 0.0));
            return int(forces.size()) - 1;
        });
        flow.step<true>(b.records(), forces.data(), dt);
        auto const& net = flow.network();
        double content = 0, gross = 0, inflow = 0;
        for (std::size_t k = 0; k < net.pores(); ++k) {
            double const grown = net.volume[k] - before.volume[k];
            content += net.volume[k] * (net.pressure[k] - before.pressure[k]) / b.p.bulk_modulus + grown -
                       (net.vapour_of(k) - before.vapour_of(k));
            gross += std::fabs(grown);
            REQUIRE((net.vapour_of(k) == 0 || net.pressure[k] == -0.5));
            vapour_seen = std::max(vapour_seen, net.vapour_of(k));
        }
        for (std::size_t t = 0; t < net.open_throats(); ++t) {
            auto const a = std::size_t(net.throat_pore[0][t]);
            double const far = t < net.interior_throats ? before.pressure[std::size_t(net.throat_pore[1][t])] : 0.3;
            double const gap = gap_of(net.throat_particle[0][t], net.throat_particle[1][t]);
            double const aperture = gap < 0 ? 0.1 / (1 - 10 * gap) : 0.1 + gap;
            double const q = std::pow(aperture, 3) / net.length[t] * (far - before.pressure[a]);
            REQUIRE_THAT(net.flow[t], WithinAbs(q, 1e-12 * std::fabs(q) + 1e-15));
            gross += std::fabs(q) * dt;
            if (t >= net.interior_throats) inflow += q * dt;
        }
        REQUIRE_THAT(content - inflow, WithinAbs(0, 1e-12 * gross));
        REQUIRE_THAT(flow.ledger().mass_residual, WithinAbs(0, 1e-12 * gross));
        REQUIRE_THAT(flow.ledger().gross_volume, WithinRel(gross, 1e-10));
        auto const& l = flow.ledger();
        double const gained = (l.reservoir_work - totals.reservoir_work) - (l.dissipation - totals.dissipation) -
                              (l.pressure_work - totals.pressure_work) + (l.vapour_work - totals.vapour_work) +
                              (l.prefactor_work - totals.prefactor_work);
        REQUIRE_THAT(flow.storage_energy() - energy, WithinAbs(gained, 1e-12 * (1 + energy)));
    }
    REQUIRE((vapour_seen > 0) == tears);
}

TEST_CASE("a sealed packing that is scaled as a whole has p = -K_f dV / V") {
    auto b = hexagon();
    auto flow = b.flow();
    double const v0 = flow.network().volume[0];
    for (auto& x : b.x) x = x * 1.0001;
    flow.refresh_geometry(b.points(), b.r.data());
    flow.refresh_geometry(b.points(), b.r.data());
    flow.advance(1e-6);
    // The triangle grows by 1.0001^2, the sectors stay.
    double const v1 = std::sqrt(3.0) * 1.0001 * 1.0001 - pi / 2;
    for (std::size_t k = 0; k < 6; ++k)
        REQUIRE_THAT(flow.network().pressure[k], WithinRel(-1000 * (v1 - v0) / v1, 1e-9));
    auto const once = flow.network().pressure;
    flow.advance(1e-6);
    for (std::size_t k = 0; k < 6; ++k) REQUIRE_THAT(flow.network().pressure[k], WithinRel(once[k], 1e-12));
}

TEST_CASE("vapour closes before the pressure rises again") {
    auto b = hexagon();
    b.p.minimum_pressure = -1;
    auto flow = b.flow();
    auto const rest = b.x;
    auto const stretch = [&](double factor) {
        for (std::size_t i = 0; i < 7; ++i) b.x[i] = rest[i] * factor;
        flow.refresh_geometry(b.points(), b.r.data());
        flow.advance(1e-9);
    };
    double const v0 = flow.network().volume[0];
    stretch(1.01);
    REQUIRE(flow.network().pressure[0] == -1);
    double const widest = flow.network().volume[0];
    REQUIRE_THAT(flow.network().vapour_of(0), WithinRel(widest - v0 - widest / 1000, 1e-9));
    stretch(1.005);
    REQUIRE(flow.network().pressure[0] == -1);
    REQUIRE(flow.network().vapour_of(0) > 0);
    stretch(1.0);
    REQUIRE(flow.network().vapour_of(0) == 0);
    // By hand: at pressure -1 the liquid grew by V_1 / K_f, where V_1 is the volume of the widest pore. The same volume
    // of liquid is compressed into V_0.
    REQUIRE_THAT(flow.network().pressure[0], WithinRel(widest / v0 - 1, 1e-9));
}

TEST_CASE("a pore crushed flat keeps its least volume and a finite time step") {
    auto b = hexagon();
    b.p.minimum_volume_fraction = 0.01;
    auto flow = b.flow();
    for (auto& x : b.x) x = {x[0], 0.5 * x[1]};
    flow.refresh_geometry(b.points(), b.r.data());
    for (std::size_t k = 0; k < 6; ++k)
        REQUIRE_THAT(flow.network().volume[k], WithinRel(0.01 * std::sqrt(3.0), 1e-12));
    REQUIRE(flow.critical_time_step() > 0);
}

TEST_CASE("a pore at its least volume exerts no force, and the energy balances") {
    auto b = hexagon();
    auto flow = b.flow();
    for (std::size_t k = 0; k < 6; ++k) flow.set_pressure(k, 2.0);
    auto const rest = b.x;
    for (auto& x : b.x) x = {x[0], 0.5 * x[1]};
    b.step(flow, 1e-9);
    auto const flat = b.written(flow);
    for (double const f : flat) REQUIRE(f == 0);
    // Compressed to a thousandth of the triangle: the pore has the pressure of that volume, but it does no more work.
    double const least = 1e-3 * std::sqrt(3.0), v0 = std::sqrt(3.0) - pi / 2;
    REQUIRE_THAT(flow.network().pressure[0], WithinRel(2 + 1000 * (v0 - least) / least, 1e-9));
    auto const totals = flow.ledger();
    double const energy = flow.storage_energy();
    for (auto& x : b.x) x = x * 0.99;
    b.step(flow, 1e-9);
    REQUIRE(flow.ledger().pressure_work == totals.pressure_work);
    REQUIRE_THAT(flow.storage_energy(), WithinRel(energy, 1e-12));
    b.x = rest;
    b.step(flow, 1e-9);
    auto const force = b.written(flow);
    for (std::size_t i = 1; i < 7; ++i) REQUIRE(std::fabs(force[3 * i]) + std::fabs(force[3 * i + 1]) > 1);
    auto const& l = flow.ledger();
    double const gained = l.prefactor_work - totals.prefactor_work - (l.pressure_work - totals.pressure_work) -
                          (l.dissipation - totals.dissipation);
    REQUIRE_THAT(flow.storage_energy() - energy, WithinAbs(gained, 1e-12 * energy));
}

TEST_CASE("skipped throats are checked again when they may have opened") {
    auto b = scattered(61, 6, 6, 0.95, 1.0);
    b.p.skip_ratio = 10;
    auto flow = b.flow();
    auto const open = flow.network().open_throats();
    REQUIRE(open > 40);
    auto const limit = [&](std::size_t t) {
        auto const& net = flow.network();
        return 2 / (1000 * net.conductance[t] * (1 / net.volume[std::size_t(net.throat_pore[0][t])] +
                                                 1 / net.volume[std::size_t(net.throat_pore[1][t])]));
    };
    REQUIRE(flow.deactivate_slow_throats(1e-9) == open);
    flow.set_pressure(0, 1.0);
    b.step(flow, 1e-6);
    for (double const q : flow.network().flow) REQUIRE(q == 0);
    double const aperture = flow.network().aperture[2];
    flow.refresh_apertures(b.records(), body::no_force);
    REQUIRE(flow.network().aperture[2] != aperture);
    std::vector<double> limits;
    for (std::size_t t = 0; t < open; ++t) limits.push_back(limit(t));
    auto sorted = limits;
    std::sort(sorted.begin(), sorted.end());
    double const duration = (sorted[9] + sorted[10]) / 2 / 10;
    REQUIRE(flow.deactivate_slow_throats(duration) == open - 10);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, double(k));
    b.step(flow, 1e-9);
    for (std::size_t t = 0; t < open; ++t) {
        REQUIRE((flow.network().flow[t] != 0) == (limits[t] < 10 * duration));
        REQUIRE((flow.network().inactive[t] == 0) == (limits[t] < 10 * duration));
    }
}

TEST_CASE("an earlier state can be restored, and continues with the same bits") {
    auto b = scattered(43, 5, 5);
    auto flow = b.flow();
    std::mt19937_64 engine(3);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, uniform(engine));
    double const dt = 0.5 * flow.critical_time_step();
    for (int i = 0; i < 10; ++i) flow.advance(dt);
    auto const net = flow.network();
    auto const ledger = flow.ledger();
    for (int i = 0; i < 10; ++i) flow.advance(dt);
    auto later = b.flow();
    later.restore(net, ledger);
    for (int i = 0; i < 10; ++i) later.advance(dt);
    REQUIRE(later.network().pressure == flow.network().pressure);
    REQUIRE(later.ledger().dissipation == flow.ledger().dissipation);
}

TEST_CASE("an empty packing has no pores and no limits") {
    body b;
    auto flow = b.flow();
    b.step(flow, 1);
    REQUIRE(flow.network().pores() == 0);
    REQUIRE(flow.storage_energy() == 0);
    REQUIRE(flow.critical_time_step() == std::numeric_limits<double>::infinity());
    b.x = {{0, 0}, {1, 0}};
    b.r = {0.5, 0.5};
    auto pair = b.flow();
    auto const force = b.tractions(pair);
    REQUIRE(std::count(force.begin(), force.end(), 0.0) == 6);
}

TEST_CASE("a mesh that does not fit its particles is refused") {
    auto const b = hexagon();
    auto mesh = b.mesh();
    mesh.simplices[1][2] = 9;
    REQUIRE_THROWS_WITH(make_pore_network(mesh, b.points(), b.r.data()), contains_text("corner of triangle 1 = 9"));
    auto radii = b.r;
    radii[3] = 0;
    REQUIRE_THROWS_WITH(make_pore_network(b.mesh(), b.points(), radii.data()),
                        contains_text("radius of particle 3 = 0"));
}

TEST_CASE("single precision follows double") {
    auto b = hexagon();
    std::vector<vec<float, 2>> x;
    std::vector<float> r(7, 1.0f);
    for (auto const& y : b.x) x.push_back({float(y[0]), float(y[1])});
    auto flow = b.flow();
    explicit_flow::solver<float, 2> single(
        b.p, make_pore_network(triangulate_body(view_points(x), r.data()), view_points(x), r.data()), 1.0f,
        view_points(x), r.data());
    flow.set_pressure(0, 1);
    single.set_pressure(0, 1);
    double const dt = 0.5 * flow.critical_time_step();
    particle_column<float> records;
    record_column<float> extra;
    records.resize(9);
    for (std::size_t i = 0; i < 9; ++i) {
        records.at(i, 0) = i < 7 ? x[i][0] : float(i);
        records.at(i, 1) = i < 7 ? x[i][1] : 0.0f;
        records.at(i, 3) = 1;
    }
    float const none[4] = {0, 0, 0, 0};
    for (int i = 0; i < 20; ++i) {
        b.step(flow, dt);
        single.step<true>(records, none, float(dt));
    }
    for (std::size_t k = 0; k < 6; ++k)
        REQUIRE_THAT(double(single.network().pressure[k]), WithinAbs(flow.network().pressure[k], 1e-4));
    extra.resize(7);
    single.step<false>(records, none, 0, 1, &extra);
    auto const force = b.written(flow);
    for (std::size_t i = 0; i < 7; ++i)
        for (int axis = 0; axis < 2; ++axis)
            REQUIRE_THAT(double(extra.at(i, axis)), WithinAbs(force[3 * i + std::size_t(axis)], 1e-4));
}
