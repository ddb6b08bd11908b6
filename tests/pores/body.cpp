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

#include <lacuna/pores/explicit_flow.hpp>
#include <lacuna/pores/triangulation.hpp>

using namespace lacuna;
using point = vec<double, 2>;
using solver = explicit_flow::solver<double, 2>;

namespace {

constexpr double pi = 3.14159265358979323846;

double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

/// A body of discs with its pores; K_f = 1000, k = 1, thickness 1 unless changed.
struct body {
    std::vector<point> x;
    std::vector<double> r;
    solver::parameters p;

    body() {
        p.bulk_modulus = 1000;
        p.conductivity = 1;
        p.thickness = 1;
        p.skip_ratio = std::numeric_limits<double>::infinity();
        p.aperture = {0.1, 1, 1};
    }
    points_view<double, 2> points() const { return view_points(x); }
    pore_mesh<2> mesh() const { return triangulate_body(points(), r.data()); }
    template <class Boundary = all_sealed>
    solver flow(Boundary const& boundary = {}) const {
        return {p, make_pore_network(mesh(), points(), r.data(), boundary), points(), r.data()};
    }
    /// Forces of a solver's pressures, at a stride of three numbers a particle; the third stays 0.
    std::vector<double> tractions(solver const& flow) const {
        std::vector<double> force(3 * x.size(), 0.0);
        flow.add_tractions(points(), r.data(), force.data(), 3);
        return force;
    }
};

/// A disc with six touching neighbours; the middle one is number 0.
body hexagon() {
    body b;
    b.x.push_back({0, 0});
    for (int k = 0; k < 6; ++k) b.x.push_back({2 * std::cos(k * pi / 3), 2 * std::sin(k * pi / 3)});
    b.r.assign(7, 1.0);
    return b;
}

/// Discs of different radii on a disturbed lattice, some apart, some overlapping.
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
        REQUIRE(flow.network().place[k] == pore_place::sealed);
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

TEST_CASE("any uniform pressure leaves a body's momentum and spin alone, and its inner discs") {
    auto const b = scattered(29);
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

TEST_CASE("tractions summed by throats are those summed by pores, and the same bits in pieces") {
    auto const b = scattered(31);
    auto flow = b.flow();
    std::mt19937_64 engine(1);
    std::vector<double> expected(3 * b.x.size(), 0.0);
    for (std::size_t k = 0; k < flow.network().pores(); ++k) {
        double const p = uniform(engine) - 0.5;
        flow.set_pressure(k, p);
        for (std::size_t c = 0; c < 3; ++c) {
            auto const at = [&](std::size_t turn) { return std::size_t(flow.network().corner[(c + turn) % 3][k]); };
            std::size_t const i = at(0), j = at(1), m = at(2);
            auto const t = pore_traction(b.x[i], b.x[j], b.x[m], b.r[i], b.r[j], b.r[m], 1.0);
            expected[3 * i] += p * t[0];
            expected[3 * i + 1] += p * t[1];
            REQUIRE(flow.pore_tractions(k, b.points(), b.r.data())[c] == t);
        }
    }
    auto const force = b.tractions(flow);
    for (std::size_t k = 0; k < force.size(); ++k) REQUIRE_THAT(force[k], WithinAbs(expected[k], 1e-13));

    // Added to what is there, at another stride, and in pieces.
    std::vector<double> pieces(5 * b.x.size(), 0.0);
    for (std::size_t begin = 0; begin < b.x.size(); begin += 7)
        flow.add_tractions(b.points(), b.r.data(), pieces.data(), 5, begin, std::min(begin + 7, b.x.size()));
    for (std::size_t i = 0; i < b.x.size(); ++i)
        for (std::size_t c = 0; c < 5; ++c) REQUIRE(pieces[5 * i + c] == (c < 3 ? force[3 * i + c] : 0.0));
}

TEST_CASE("the pressures' work on moving discs is that of the pores' change of volume") {
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
            REQUIRE(net.reservoir_pressure[t] == (b.x[i][0] == 10 && b.x[j][0] == 10 ? 7.0 : 0.0));
    }
}

TEST_CASE("a throat equally near to two sides of the body belongs to the one it faces") {
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

TEST_CASE("a body drains through the sides chosen, and through no other") {
    auto b = scattered(37, 6, 8, 0.6, 0.9);
    auto sealed = b.flow();
    auto drained = b.flow([](auto const& throat) -> throat_boundary<double> {
        return {throat.side == body_side::top ? boundary_kind::drained : boundary_kind::sealed, 0.0};
    });
    auto const start = [](solver& flow) {
        for (std::size_t k = 0; k < flow.network().pores(); ++k) flow.set_pressure(k, 1.0);
        flow.refresh_apertures([](int, int) { return throat_state<double>{0, 0}; });
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

TEST_CASE("mass and energy balance in every step while the body moves") {
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
        flow.refresh_geometry(b.points(), b.r.data());
        auto const gap_of = [&](int one, int other) {
            auto const i = std::size_t(one), j = std::size_t(other);
            return norm(b.x[j] - b.x[i]) - b.r[i] - b.r[j];
        };
        flow.refresh_apertures([&](int i, int j) {
            return throat_state<double>{std::min(10 * gap_of(i, j), 0.0), gap_of(i, j)};
        });
        flow.advance(dt);
        auto const& net = flow.network();
        double content = 0, gross = 0, inflow = 0;
        for (std::size_t k = 0; k < net.pores(); ++k) {
            double const grown = net.volume[k] - before.volume[k];
            content += net.volume[k] * (net.pressure[k] - before.pressure[k]) / b.p.bulk_modulus + grown -
                       (net.vapour[k] - before.vapour[k]);
            gross += std::fabs(grown);
            REQUIRE((net.vapour[k] == 0 || net.pressure[k] == -0.5));
            vapour_seen = std::max(vapour_seen, net.vapour[k]);
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

TEST_CASE("a sealed body squeezed as a whole carries p = -K_f dV / V") {
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
    REQUIRE_THAT(flow.network().vapour[0], WithinRel(widest - v0 - widest / 1000, 1e-9));
    stretch(1.005);
    REQUIRE(flow.network().pressure[0] == -1);
    REQUIRE(flow.network().vapour[0] > 0);
    stretch(1.0);
    REQUIRE(flow.network().vapour[0] == 0);
    // By hand: to the pressure -1 the liquid grew by V_1 / K_f, at the volume V_1 of the widest pore; the same volume
    // of liquid is pressed in at V_0.
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

TEST_CASE("skipped throats are looked at again when they may have opened") {
    auto b = hexagon();
    b.p.skip_ratio = 10;
    auto flow = b.flow();
    int calls = 0;
    double gap = 0;
    auto const lookup = [&](std::size_t throat, int i, int j) {
        ++calls;
        REQUIRE(flow.network().throat_particle[0][throat] == i);
        REQUIRE(flow.network().throat_particle[1][throat] == j);
        return throat_state<double>{0, throat == 2 ? gap : 0.0};
    };
    // Limit of a throat: V / (K_f C) = 0.161 / (1000 * 0.0005) = 0.32.
    REQUIRE(flow.skip_idle_throats(0.01) == 6);
    flow.refresh_apertures(lookup);
    REQUIRE(calls == 0);
    gap = 0.9;
    flow.refresh_apertures(lookup, true);
    REQUIRE(calls == 6);
    REQUIRE(flow.skip_idle_throats(0.01) == 5);
    flow.refresh_apertures(lookup);
    REQUIRE(calls == 7);
    REQUIRE_THAT(flow.network().aperture[2], WithinRel(1.0, 1e-15));
}

TEST_CASE("an earlier state can be restored, and goes on with the same bits") {
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

TEST_CASE("an empty body has no pores and no limits") {
    body b;
    auto flow = b.flow();
    flow.refresh_geometry(b.points(), b.r.data());
    flow.advance(1);
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
        b.p, make_pore_network(triangulate_body(view_points(x), r.data()), view_points(x), r.data()), view_points(x),
        r.data());
    flow.set_pressure(0, 1);
    single.set_pressure(0, 1);
    double const dt = 0.5 * flow.critical_time_step();
    for (int i = 0; i < 20; ++i) {
        flow.advance(dt);
        single.advance(float(dt));
    }
    for (std::size_t k = 0; k < 6; ++k)
        REQUIRE_THAT(double(single.network().pressure[k]), WithinAbs(flow.network().pressure[k], 1e-4));
}
