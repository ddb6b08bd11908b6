// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "reference.hpp"

#include "bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <Eigen/Dense>

#include <lacuna/core/dual.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>

using namespace lacuna;
using bodies::space_body;
using bodies::uniform;
using point = vec<double, 3>;

namespace {

using explicit_solver = explicit_flow::solver<double, 3>;
using implicit_solver = implicit_flow::solver<double, 3>;
using section_solver = explicit_flow_with<hydraulic_section>::solver<double, 3>;
constexpr double pi = 3.14159265358979323846;

std::set<std::size_t> rim_of(pore_network<double, 3> const& net) {
    std::set<std::size_t> rim;
    for (std::size_t t = net.interior_throats; t < net.throats(); ++t)
        for (auto const& side : net.throat_particle) rim.insert(std::size_t(side[t]));
    return rim;
}

double void_of(space_body const& b, pore_network<double, 3> const& net, std::size_t pore) {
    auto const at = [&](std::size_t c) { return std::size_t(net.corner[c][pore]); };
    return void_volume(b.x[at(0)], b.x[at(1)], b.x[at(2)], b.x[at(3)], b.r[at(0)], b.r[at(1)], b.r[at(2)], b.r[at(3)]);
}

/// A motion that deforms and rotates pores.
void stir(space_body& b, space_body const& rest, double phase, double amplitude) {
    for (std::size_t i = 0; i < b.x.size(); ++i)
        b.x[i] = rest.x[i] + point{std::sin(5 * phase + 0.3 * double(i)), std::cos(4 * phase + 0.7 * double(i)),
                                   std::sin(3 * phase + 1.1 * double(i))} *
                                 amplitude;
}

auto const drained_front = [](auto const& throat) -> throat_boundary<double> {
    return {throat.side == body_side::front ? boundary_kind::drained : boundary_kind::sealed, 0.4};
};

} // namespace

TEST_CASE("tractions in space are the derivatives of the void, without sum and moment") {
    std::mt19937_64 engine(41);
    for (int trial = 0; trial < 200; ++trial) {
        std::array<point, 4> x;
        std::array<double, 4> r;
        for (auto& p : x) p = {2 * uniform(engine), 2 * uniform(engine), 2 * uniform(engine)};
        for (auto& q : r) q = 0.2 + 0.8 * uniform(engine); // touching, apart or overlapping
        if (tetrahedron_volume(x[0], x[1], x[2], x[3]) < 0) std::swap(x[0], x[1]);
        double const size = tetrahedron_volume(x[0], x[1], x[2], x[3]);
        if (size < 0.05) continue;
        auto const shape = measure_simplex(x, r);
        auto const moved = [&](std::size_t c, int axis, double step) {
            auto y = x;
            y[c][axis] += step;
            return void_volume(y[0], y[1], y[2], y[3], r[0], r[1], r[2], r[3]);
        };
        point sum{}, moment{};
        double virial = 0;
        for (std::size_t c = 0; c < 4; ++c) {
            for (int axis = 0; axis < 3; ++axis) {
                double const h = 1e-3;
                // Five-point formula, of fourth order.
                double const slope = (8 * (moved(c, axis, h) - moved(c, axis, -h)) - moved(c, axis, 2 * h) +
                                      moved(c, axis, -2 * h)) / (12 * h);
                REQUIRE_THAT(shape.traction[c][axis], WithinAbs(slope, 1e-6));
            }
            sum += shape.traction[c];
            moment += cross(x[c], shape.traction[c]);
            virial += dot(x[c], shape.traction[c]);
        }
        REQUIRE_THAT(norm(sum), WithinAbs(0, 1e-12));
        REQUIRE_THAT(norm(moment), WithinAbs(0, 1e-12));
        // Scaling keeps the angles of a tetrahedron, and so the sectors.
        REQUIRE_THAT(virial, WithinRel(3 * size, 1e-11));

        using number = dual<double, 12>;
        std::array<vec<number, 3>, 4> y;
        std::array<number, 4> q;
        for (std::size_t c = 0; c < 4; ++c) {
            q[c] = number(r[c]);
            for (int axis = 0; axis < 3; ++axis) y[c][axis] = number::variable(x[c][axis], int(3 * c) + axis);
        }
        auto const exact = measure_simplex(y, q).void_volume;
        REQUIRE_THAT(shape.void_volume, WithinAbs(exact.value, 1e-14));
        for (std::size_t c = 0; c < 4; ++c)
            for (int axis = 0; axis < 3; ++axis)
                REQUIRE_THAT(shape.traction[c][axis], WithinAbs(exact.derivative[3 * c + std::size_t(axis)], 1e-11));
    }
}

TEMPLATE_TEST_CASE("a uniform pressure between spheres stays, and exerts no force on inner spheres", "", explicit_flow,
                   implicit_flow) {
    using solver = typename TestType::template solver<double, 3>;
    auto const b = GENERATE(bodies::cubic(4), bodies::scattered_spheres(42, 5, 0.6, 0.95));
    auto p = space_body::settings<solver>();
    p.substeps = GENERATE(1, 4);
    p.initial_pressure = 3;
    p.minimum_volume_fraction = 1e-9; // no pore at rest at its least volume
    auto flow = b.template flow<solver>(p);
    double const dt = 0.2 * flow_critical_time_step(flow.network(), p.bulk_modulus);
    for (int s = 0; s < 20; ++s) flow.template step<true>(b.records(), space_body::no_force, dt);
    for (double const q : flow.network().pressure) REQUIRE_THAT(q, WithinRel(3.0, 1e-12));
    for (std::size_t k = 0; k < flow.network().pores(); ++k) REQUIRE(void_of(b, flow.network(), k) > 1e-4);
    auto const force = b.tractions(flow);
    auto const rim = rim_of(flow.network());
    REQUIRE(rim.size() < b.x.size());
    point sum{}, moment{};
    double virial = 0, least = 1e9;
    for (std::size_t i = 0; i < b.x.size(); ++i) {
        sum += force[i];
        moment += cross(b.x[i], force[i]);
        virial += dot(b.x[i], force[i]);
        if (rim.count(i))
            least = std::min(least, norm(force[i]));
        else
            REQUIRE_THAT(norm(force[i]), WithinAbs(0, 1e-11));
    }
    REQUIRE(least > 0.1);
    REQUIRE_THAT(norm(sum), WithinAbs(0, 1e-11));
    REQUIRE_THAT(norm(moment), WithinAbs(0, 1e-9));
    double const volume = mesh_size(triangulate_body(b.points(), b.r.data()), b.points());
    REQUIRE_THAT(virial, WithinRel(3 * 3.0 * volume, 1e-11));
}

TEST_CASE("along a finite path pressures do the work p dV on the spheres") {
    auto const rest = bodies::scattered_spheres(43, 4, 0.6, 0.9);
    auto p = space_body::settings<explicit_solver>();
    p.bulk_modulus = 1e-12; // volumes do not change the pressures, and nothing flows
    p.conductivity = 0;
    auto const path = [&](int steps) {
        auto flow = rest.flow<explicit_solver>(p);
        auto const& net = flow.network();
        for (std::size_t k = 0; k < net.pores(); ++k) flow.set_pressure(k, 1 + 0.5 * std::sin(double(k)));
        auto b = rest, before = rest;
        flow.step<true>(b.records(), space_body::no_force, 1e-3);
        auto const start = net.volume;
        auto force = b.tractions(flow);
        double work = 0;
        for (int s = 1; s <= steps; ++s) {
            before.x = b.x;
            double const t = double(s) / steps;
            stir(b, rest, 0.5 * t, 0.03);
            for (auto& x : b.x) x = {x[0] * (1 + 0.03 * t), x[1] + 0.05 * t * x[2], x[2] * (1 + 0.02 * t)};
            flow.step<true>(b.records(), space_body::no_force, 1e-3);
            auto const next = b.tractions(flow);
            for (std::size_t i = 0; i < b.x.size(); ++i) work += dot(force[i] + next[i], b.x[i] - before.x[i]) / 2;
            force = next;
        }
        double on_pores = 0;
        for (std::size_t k = 0; k < net.pores(); ++k)
            on_pores += (1 + 0.5 * std::sin(double(k))) * (net.volume[k] - start[k]);
        REQUIRE(std::fabs(on_pores) > 1);
        REQUIRE_THAT(flow.ledger().pressure_work, WithinAbs(on_pores, 1e-9 * std::fabs(on_pores) + 1e-6));
        return std::fabs(work / on_pores - 1);
    };
    double const coarse = path(20), fine = path(40);
    INFO("relative difference " << coarse << " and " << fine);
    REQUIRE(fine < 1e-3);
    REQUIRE_THAT(std::log2(coarse / fine), WithinAbs(2, 0.15));
}

TEST_CASE("a step of facet throats follows its formulas throat by throat and pore by pore") {
    auto b = bodies::scattered_spheres(44, GENERATE(2, 3, 4), 0.6, 1.05);
    auto p = space_body::settings<explicit_solver>();
    auto flow = b.flow<explicit_solver>(p, drained_front);
    auto const before = flow.network();
    std::mt19937_64 engine(6);
    auto pressure = before.pressure;
    for (std::size_t k = 0; k < before.pores(); ++k) flow.set_pressure(k, pressure[k] = uniform(engine) - 0.5);
    // Normal forces, none for every fourth pair.
    std::map<std::array<std::int32_t, 2>, double> normal;
    std::vector<double> forces{0};
    flow.map_throats([&](std::int32_t i, std::int32_t j) -> int {
        std::array<std::int32_t, 2> const pair{std::min(i, j), std::max(i, j)};
        if (auto const known = normal.find(pair); known != normal.end() && known->second != 0) {
            for (std::size_t k = 1; k < forces.size(); ++k)
                if (forces[k] == known->second) return int(k);
        }
        if ((i + j) % 4 == 3) return normal[pair] = 0, 0;
        normal[pair] = 4 * uniform(engine) - 3;
        forces.push_back(normal[pair]);
        return int(forces.size()) - 1;
    });
    for (auto& x : b.x) x += point{uniform(engine) - 0.5, uniform(engine) - 0.5, uniform(engine) - 0.5} * 0.01;
    double const dt = 1e-4;
    flow.step<true>(b.records(), forces.data(), dt);
    auto const& net = flow.network();
    REQUIRE(net.drained_throats > 0);
    std::vector<double> inflow(net.pores(), 0.0);
    std::vector<point> expected(b.x.size());
    for (std::size_t t = 0; t < net.open_throats(); ++t) {
        double aperture = 0, length = 0;
        for (std::size_t e = 0; e < 3; ++e) {
            auto const i = net.throat_particle[e][t], j = net.throat_particle[(e + 1) % 3][t];
            auto const a = std::size_t(i), c = std::size_t(j);
            double const gap = norm(b.x[c] - b.x[a]) - b.r[a] - b.r[c];
            double const f = normal.at({std::min(i, j), std::max(i, j)});
            aperture += (f < 0 ? 0.1 / (1 - f) : 0.1 + std::max(gap, 0.0)) / 3;
            length += (b.r[a] + b.r[c]) / 3;
        }
        REQUIRE_THAT(net.aperture[t], WithinRel(aperture, 1e-12));
        REQUIRE_THAT(net.length[t], WithinRel(length, 1e-13));
        double const conductance = aperture * aperture * aperture / length;
        REQUIRE_THAT(net.conductance[t], WithinRel(conductance, 1e-11));
        auto const one = std::size_t(net.throat_pore[0][t]);
        double const far = t < net.interior_throats ? pressure[std::size_t(net.throat_pore[1][t])] : 0.4;
        double const q = conductance * (far - pressure[one]);
        REQUIRE_THAT(net.flow[t], WithinAbs(q, 1e-15 + 1e-11 * std::fabs(q)));
        inflow[one] += q * dt;
        if (t < net.interior_throats) inflow[std::size_t(net.throat_pore[1][t])] -= q * dt;
    }
    for (std::size_t k = 0; k < net.pores(); ++k) {
        double const free = void_of(b, net, k), least = 1e-3 * net.size[k], volume = std::max(free, least);
        REQUIRE_THAT(net.volume[k], WithinAbs(volume, 1e-12));
        double const q = pressure[k] + 1000 / volume * (inflow[k] - (volume - before.volume[k]));
        REQUIRE_THAT(net.pressure[k], WithinAbs(q, 1e-12 * 1000 / volume));
        auto const force = flow.pore_tractions(k, b.points(), b.r.data());
        for (std::size_t c = 0; c < 4 && free > least; ++c)
            expected[std::size_t(net.corner[c][k])] += force[c] * net.pressure[k];
    }
    auto const force = b.tractions(flow);
    for (std::size_t k = 0; k < force.size(); ++k)
        REQUIRE_THAT(norm(force[k] - expected[k]), WithinAbs(0, 1e-10 * (1 + norm(expected[k]))));
}

TEMPLATE_TEST_CASE("in space mass is conserved, and the volumes of sources add up", "", explicit_solver,
                   implicit_solver, section_solver) {
    auto const rest = bodies::scattered_spheres(45, 4, 0.6, 0.95);
    auto p = space_body::settings<TestType>();
    auto net = rest.network(flow_boundaries(reservoir("front", on_side{body_side::front}, 0.4),
                                            injection("left", on_side{body_side::left}, 0.02)));
    inject_at(net, rest.points(), "jet", point{3, 3, 3}, 0.01);
    TestType flow(p, net, 1.0, rest.points(), rest.r.data());
    double const dt = 0.2 * flow_critical_time_step(flow.network(), p.bulk_modulus);
    auto b = rest;
    double inflow = 0;
    for (int s = 0; s < 40; ++s) {
        auto const before = flow.network();
        stir(b, rest, 0.02 * s, 0.01);
        flow.template step<true>(b.records(), space_body::no_force, dt);
        auto const& now = flow.network();
        double content = 0, scale = 0, brought = 0;
        for (std::size_t k = 0; k < now.pores(); ++k) {
            double const part = now.volume[k] * (now.pressure[k] - before.pressure[k]) / p.bulk_modulus +
                                (now.volume[k] - before.volume[k]);
            content += part;
            scale += std::fabs(part) + now.volume[k] * std::fabs(now.pressure[k]) / p.bulk_modulus;
        }
        for (std::size_t k = 0; k < now.sources.size(); ++k)
            brought += now.sources[k].volume - before.sources[k].volume;
        inflow += brought;
        REQUIRE_THAT(content - brought, WithinAbs(0, 1e-12 * scale));
        REQUIRE_THAT(flow.ledger().mass_residual, WithinAbs(0, 1e-12 * flow.ledger().gross_volume));
    }
    REQUIRE_THAT(flow.ledger().boundary_inflow, WithinRel(inflow, 1e-10));
    REQUIRE_THAT(flow.network().sources[find_source(flow.network(), "left")].rate, WithinRel(0.02, 1e-12));
    REQUIRE(flow.network().sources[0].volume != 0);
}

TEST_CASE("the step limit of flow in space is below 2 / lambda_max, by dense eigenvalues") {
    auto const b = bodies::scattered_spheres(46, 4, 0.6, 0.95);
    auto const p = space_body::settings<section_solver>();
    auto const flow = b.flow<section_solver>(p, drained_front);
    auto const& net = flow.network();
    auto const n = Eigen::Index(net.pores());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t t = 0; t < net.open_throats(); ++t) {
        auto const i = Eigen::Index(net.throat_pore[0][t]), j = Eigen::Index(net.throat_pore[1][t]);
        a(i, i) += net.conductance[t];
        if (j < 0) continue;
        a(j, j) += net.conductance[t];
        a(i, j) -= net.conductance[t];
        a(j, i) -= net.conductance[t];
    }
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            a(i, j) *= p.bulk_modulus / std::sqrt(net.volume[std::size_t(i)] * net.volume[std::size_t(j)]);
    double const exact = 2 / Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues()[n - 1];
    INFO(flow.critical_time_step() << " of " << exact);
    REQUIRE(flow.critical_time_step() > 0.3 * exact);
    REQUIRE(flow.critical_time_step() <= exact);
    REQUIRE(flow.mean_throat_limit() == std::numeric_limits<double>::infinity());
}

TEST_CASE("a facet's section conducts as a tube of its hydraulic radius") {
    // Three touching spheres, the facet of 9a, between two tetrahedra.
    double const h = std::sqrt(8.0 / 3);
    double const middle = std::sqrt(1.0 / 3);
    space_body b{{{0, 0, 0}, {2, 0, 0}, {1, 3 * middle, 0}, {1, middle, h}, {1, middle, -h}},
                 std::vector<double>(5, 1.0)};
    auto p = space_body::settings<section_solver>();
    double const viscosity = 0.25;
    p.conductivity = 1 / (2 * viscosity);
    p.aperture.shape_factor = 0.8;
    auto const flow = b.flow<section_solver>(p);
    auto const& net = flow.network();
    REQUIRE(net.pores() == 2);
    REQUIRE(net.interior_throats == 1);
    double const area = reference("9a.three_equal", "area/R^2"), radius = area / pi;
    REQUIRE_THAT(net.aperture[0], WithinRel(radius, 1e-11));
    REQUIRE_THAT(net.conductance[0], WithinRel(0.8 * area * radius * radius / (2 * viscosity * 2), 1e-10));
    // Overlapping spheres close it.
    b.r.assign(5, 1.2);
    auto const shut = b.flow<section_solver>(p);
    REQUIRE(shut.network().conductance[0] == 0);
    REQUIRE(shut.critical_time_step() == std::numeric_limits<double>::infinity());
    REQUIRE_THROWS_WITH((p.aperture.shape_factor = 0, b.flow<section_solver>(p)), contains_text("shape_factor = 0"));
    auto const settings = space_body::settings<section_solver>();
    REQUIRE_THROWS_WITH((section_solver{settings, b.network(), 2.0, b.points(), b.r.data()}),
                        contains_text("thickness = 2"));
}

TEST_CASE("steady flow between spheres solves the full system of equations") {
    auto const b = bodies::scattered_spheres(47, 4, 0.62, 0.75);
    auto const net = make_pore_network(triangulate_body(b.points(), b.r.data(), 4.0), b.points(), b.r.data(),
                                       flow_boundaries(reservoir("in", on_side{body_side::back}, 5.0),
                                                       reservoir("out", on_side{body_side::front}, 0.0)));
    implicit_flow_with<hydraulic_section>::solver<double, 3> flow({}, net, 1.0, b.points(), b.r.data());
    double const dt = 1e4 * flow_critical_time_step(flow.network(), flow.settings().bulk_modulus);
    for (int s = 0; s < 200; ++s) flow.advance<false>(dt);
    auto const& now = flow.network();
    auto const n = Eigen::Index(now.pores());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(n);
    for (std::size_t t = 0; t < now.open_throats(); ++t) {
        auto const i = Eigen::Index(now.throat_pore[0][t]), j = Eigen::Index(now.throat_pore[1][t]);
        double const c = now.conductance[t];
        a(i, i) += c;
        if (j < 0) {
            wanted[i] += c * now.reservoir_pressure(t);
            continue;
        }
        a(j, j) += c;
        a(i, j) -= c;
        a(j, i) -= c;
    }
    Eigen::VectorXd const exact = a.ldlt().solve(wanted);
    for (Eigen::Index i = 0; i < n; ++i) REQUIRE_THAT(now.pressure[std::size_t(i)], WithinAbs(exact[i], 1e-9 * 5));
    REQUIRE(now.sources[0].rate > 0);
    REQUIRE_THAT(now.sources[1].rate, WithinRel(-now.sources[0].rate, 1e-9));
}

TEST_CASE("facets on the boundary of a cube: kinds, sides, areas, locations of pores") {
    int const n = 4;
    auto const b = bodies::cubic(n);
    std::array<double, 6> area{};
    std::array<int, 6> count{};
    auto const net = b.network([&](boundary_throat<double, 3> const& throat) -> throat_boundary<double> {
        auto const s = std::size_t(throat.side);
        ++count[s];
        auto const at = [&](std::size_t k) { return b.x[std::size_t(throat.particles[k])]; };
        area[s] += triangle_area(at(0), at(1), at(2));
        REQUIRE_THAT(throat.outward[int(s / 2)], WithinAbs(s % 2 == 0 ? -1 : 1, 1e-12));
        REQUIRE(norm(throat.middle - (at(0) + at(1) + at(2)) / 3.0) < 1e-12);
        return {throat.side == body_side::bottom ? boundary_kind::drained : boundary_kind::sealed, 2.0};
    });
    for (std::size_t s = 0; s < 6; ++s) {
        REQUIRE(count[s] == 2 * (n - 1) * (n - 1));
        REQUIRE_THAT(area[s], WithinRel(4.0 * (n - 1) * (n - 1), 1e-12));
    }
    REQUIRE(net.drained_throats == 18);
    REQUIRE(net.throats() - net.open_throats() == 5 * 18);
    REQUIRE(net.sources.size() == 1);
    // A tetrahedron has four facets; an inner facet belongs to two tetrahedra.
    REQUIRE(2 * net.interior_throats + 6 * 18 == 4 * net.pores());
    for (std::size_t t = 0; t < net.throats(); ++t) {
        auto const one = std::size_t(net.throat_pore[0][t]);
        if (t >= net.interior_throats) REQUIRE(net.location[one] != pore_location::interior);
        // Its particles are counter-clockwise as seen from outside pore [0].
        auto const at = [&](std::size_t k) { return b.x[std::size_t(net.throat_particle[k][t])]; };
        point const inward = pore_middle(net, one, b.points()) - at(0);
        REQUIRE(dot(cross(at(1) - at(0), at(2) - at(0)), inward) < 0);
    }
    REQUIRE(find_pore(net, b.points(), pore_middle(net, 17, b.points())) == 17);
    REQUIRE(net.location[find_pore(net, b.points(), point{-9, 3, 3})] == pore_location::sealed);
}

TEST_CASE("a flat tetrahedron is a pore at its least volume, and exerts no force") {
    // Four spheres nearly on a circle: their tetrahedron is nearly flat.
    space_body b{{{1, 0, 0}, {0, 1, 0}, {-1, 0, 1e-5}, {0, -1, 0}}, std::vector<double>(4, 0.5)};
    pore_mesh<3> mesh;
    mesh.simplices = {{0, 1, 2, 3}};
    auto& corners = mesh.simplices[0];
    if (simplex_size<double, 3>(corners, b.points()) < 0) std::swap(corners[2], corners[3]);
    detail::connect(mesh);
    auto const net = make_pore_network(mesh, b.points(), b.r.data());
    REQUIRE_THAT(net.size[0], WithinRel(1 / std::sqrt(72.0), 1e-12)); // edge 1
    auto p = space_body::settings<explicit_solver>();
    p.initial_pressure = 7;
    explicit_solver flow(p, net, 1.0, b.points(), b.r.data());
    flow.step<true>(b.records(), space_body::no_force, 1e-3);
    REQUIRE(flow.network().volume[0] == 1e-3 * net.size[0]);
    for (auto const& f : b.tractions(flow)) REQUIRE(norm(f) == 0);
}

TEST_CASE("threads, float and merged pores in space") {
    auto const rest = bodies::scattered_spheres(48, 6, 0.6, 0.95);
    auto p = space_body::settings<explicit_solver>();
    p.merge_conductance = GENERATE(std::numeric_limits<double>::infinity(), 2e-2);
    auto one = rest.flow<explicit_solver>(p, drained_front), two = one;
    using single = explicit_flow::solver<float, 3>;
    std::vector<vec<float, 3>> x;
    std::vector<float> r;
    for (std::size_t i = 0; i < rest.x.size(); ++i) {
        x.push_back(convert<float>(rest.x[i]));
        r.push_back(float(rest.r[i]));
    }
    single::parameters q;
    static_cast<flow_parameters<contact_force_aperture>&>(q) = p;
    single third(q, make_pore_network(triangulate_body(view_points(rest.x), rest.r.data()), view_points(x), r.data(),
                                      [](auto const& throat) -> throat_boundary<float> {
                                          return {throat.side == body_side::front ? boundary_kind::drained
                                                                                  : boundary_kind::sealed,
                                                  0.4f};
                                      }),
                 1.0f, view_points(x), r.data());
    for (std::size_t k = 0; k < one.network().pores(); ++k) {
        double const pressure = std::sin(double(k));
        one.set_pressure(k, pressure);
        two.set_pressure(k, pressure);
        third.set_pressure(k, float(pressure));
    }
    double const dt = 0.2 * one.critical_time_step();
    float const no_force[4] = {0, 0, 0, 0};
    auto b = rest;
    double missing = 0, gross = 0;
    for (int s = 0; s < 10; ++s) {
        stir(b, rest, 0.01 * s, 0.002);
        one.step<true>(b.records(), space_body::no_force, dt, 1);
        two.step<true>(b.records(), space_body::no_force, dt, 3);
        third.step<true>(b.records<float>(), no_force, float(dt));
        missing += std::fabs(one.ledger().mass_residual);
        gross += one.ledger().gross_volume;
    }
    REQUIRE(one.network().pressure == two.network().pressure);
    auto const forces = b.tractions(one), others = b.tractions(two, 3);
    for (std::size_t i = 0; i < forces.size(); ++i) REQUIRE(forces[i] == others[i]);
    REQUIRE(missing <= 1e-12 * gross);
    std::vector<double> difference;
    for (std::size_t k = 0; k < one.network().pores(); ++k)
        difference.push_back(std::fabs(one.network().pressure[k] - double(third.network().pressure[k])));
    std::nth_element(difference.begin(), difference.begin() + std::ptrdiff_t(difference.size() / 2), difference.end());
    REQUIRE(difference[difference.size() / 2] < 1e-3);
    if (p.merge_conductance < 1) REQUIRE(one.clusters().clusters() > 0);
}
