// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "reference.hpp"
#include "setups.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

#include <lacuna/laws/no_contact.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation/checkpoint.hpp>

using namespace lacuna;
using setups::noise;
using point = vec<double, 3>;

namespace {

struct wet : default_model<3> {
    using flow = explicit_flow_with<hydraulic_section>;
};
struct wet_implicit : default_model<3> {
    using flow = implicit_flow_with<hydraulic_section>;
};
struct porous : default_model<3> {
    using contact_law = no_contact;
    using damping = local_damping;
    using flow = explicit_flow_with<constant_aperture>;
};

simulation_parameters<porous> bonded(double kn, double ks) {
    simulation_parameters<porous> p;
    p.materials[0].density = setups::unit_density(3);
    p.materials[0].bond = {kn, ks};
    return p;
}

/// Spheres in a slightly disturbed cubic lattice, bonded if they nearly touch.
packing<double, 3> cluster(int n, double disturbance) {
    packing<double, 3> p;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
                auto const id = p.size();
                p.add(point{i + disturbance * noise(id, 1), j + disturbance * noise(id, 2),
                            k + disturbance * noise(id, 3)},
                      0.49 + 0.3 * disturbance * noise(id, 4));
            }
    setups::bond_touching(p, 0.02 + disturbance);
    return p;
}

template <class Model>
void fill(simulation<Model>& sim, double pressure = 0) {
    sim.fill_pores([pressure](auto points, double const* radii) {
        return make_pore_network(triangulate_body(points, radii), points, radii,
                                 flow_boundaries(reservoir("front", on_side{body_side::front}, pressure)));
    });
}

/// A free cluster with flowing fluid that its own motion tears apart and shears along cracks.
template <class Model>
simulation<Model> torn(int threads = 1) {
    auto const spheres = cluster(5, 0.03);
    double const area = setups::pi * 0.25;
    auto p = setups::springs<Model>(100, 70, 0.4, setups::unit_density(3), 0.3 / area, 0.3 / area);
    p.interactions.initial_contact_tolerance = 0.1;
    p.time_step = 4e-3;
    p.threads = threads;
    p.flow.bulk_modulus = 20;
    p.flow.initial_pressure = 0.1;
    p.flow.conductivity = 0.05;
    p.flow.minimum_volume_fraction = 0.05;
    simulation<Model> sim(spheres, p);
    fill(sim);
    for (std::size_t k = 0; k < sim.size(); ++k) {
        auto const x = sim.position(k);
        sim.set_velocity(k, point{0.08 * (x[0] - 2), -0.04 * (x[0] - 2), 0.03 * (x[1] - 2)} +
                                point{noise(k, 5), noise(k, 6), noise(k, 7)} * 0.03);
        sim.set_spin(k, point{noise(k, 8), noise(k, 9), noise(k, 10)} * 0.05);
    }
    return sim;
}

template <class Model>
std::size_t broken(simulation<Model> const& sim) {
    std::size_t count = 0;
    for (auto const& bond : sim.pairs().bond_records()) count += bond.state != bond_state::intact;
    return count;
}

} // namespace

TEMPLATE_TEST_CASE("a wet cluster of spheres that is torn: ledger, momenta, mass, threads, checkpoint", "", wet,
                   wet_implicit) {
    auto sim = torn<TestType>();
    REQUIRE(sim.limits().critical() > sim.settings().time_step);
    auto const linear = setups::momentum(sim), angular = setups::angular_momentum(sim);
    int const steps = 200;
    double missing = 0, gross = 0;
    struct scratch_file {
        // Tests of both models may run at the same time.
        std::string path = "wet_space_" + std::to_string(std::is_same_v<TestType, wet_implicit>) + ".bin";
        ~scratch_file() { std::remove(path.c_str()); }
    } const file;
    for (int s = 0; s < steps; ++s) {
        if (s == steps / 2) save_checkpoint(file.path, sim);
        sim.step_with_energy();
        missing += std::fabs(sim.flow().ledger().mass_residual);
        gross += sim.flow().ledger().gross_volume;
    }
    auto const& e = sim.energy();
    INFO("residual " << e.residual() << " of " << e.largest() << " J, " << broken(sim) << " broken");
    REQUIRE(broken(sim) > 10);
    REQUIRE(e.friction > 0);
    REQUIRE(e.fluid_viscous > 0);
    REQUIRE(e.fluid_storage > 0);
    REQUIRE(std::fabs(e.fluid_work) > 1e-2 * e.largest());
    REQUIRE_THAT(e.residual(), WithinAbs(0, 2e-3 * e.largest()));
    REQUIRE(missing <= 1e-12 * gross);
    double scale = 0;
    for (std::size_t k = 0; k < sim.size(); ++k) scale += sim.mass(k) * norm(sim.velocity(k));
    REQUIRE_THAT(norm(setups::momentum(sim) - linear), WithinAbs(0, 1e-13 * scale));
    // Velocities hold half a step before the positions: a force F shifts x x v by (F x v) dt / 2 at both ends.
    REQUIRE_THAT(norm(setups::angular_momentum(sim) - angular), WithinAbs(0, 1e-11 * 5 * scale));

    auto resumed = torn<TestType>();
    load_checkpoint(file.path, resumed);
    auto threaded = torn<TestType>(3);
    for (int s = 0; s < steps; ++s) threaded.step_with_energy();
    for (int s = steps / 2; s < steps; ++s) resumed.step_with_energy();
    REQUIRE(state_hash(resumed) == state_hash(sim));
    REQUIRE(state_hash(threaded) == state_hash(sim));
}

TEST_CASE("uniform pressure and the load that balances it leave a packing of spheres at rest") {
    auto const spheres = cluster(4, 0.03);
    auto p = bonded(1e4, 5e3);
    p.flow.bulk_modulus = 1e4;
    p.flow.initial_pressure = 7;
    p.flow.aperture.aperture = 0.1;
    p.flow.conductivity = 1e-3;
    p.time_step = 1e-3;
    double const pressure = 7;
    simulation<porous> sim(spheres, p), heavy(spheres, p);
    fill(sim, pressure);
    // The force of a uniform pressure, by differences of the volume of all voids.
    auto const mesh = triangulate_body(view_points(spheres.position), spheres.radius.data());
    auto const voids = [&](std::vector<point> const& x) {
        double sum = 0;
        for (auto const& s : mesh.simplices) sum += simplex_void(s, view_points(x), spheres.radius.data());
        return sum;
    };
    std::size_t loaded = 0;
    for (std::size_t k = 0; k < sim.size(); ++k) {
        point slope{};
        for (int axis = 0; axis < 3; ++axis) {
            auto x = spheres.position;
            double const h = 1e-4;
            x[k][axis] += h;
            double const above = voids(x);
            x[k][axis] -= 2 * h;
            slope[axis] = (above - voids(x)) / (2 * h);
        }
        if (norm(slope) < 1e-6) continue;
        sim.apply(k, slope * -pressure);
        ++loaded;
    }
    REQUIRE(loaded == 56); // all but the inner 2 x 2 x 2
    sim.run(500);
    double const stored = 0.5 * pressure * pressure / p.flow.bulk_modulus * 14;
    REQUIRE(sim.kinetic_energy() < 1e-12 * stored);
    for (double const q : sim.flow().network().pressure) REQUIRE_THAT(q, WithinRel(pressure, 1e-6));
}

TEST_CASE("undrained spheres: the bound of the step lies below the largest stable step") {
    auto const spheres = cluster(4, 0);
    auto const grows = [&](double share, double& bound) {
        auto p = bonded(1, 0.5);
        p.damping.factor = 0;
        p.flow.bulk_modulus = 3;
        p.flow.conductivity = 0;
        p.allow_unstable_step = true;
        p.time_step = 1e-3;
        simulation<porous> probe(spheres, p);
        fill(probe);
        bound = probe.limits().rigorous;
        p.time_step = share * bound;
        simulation<porous> sim(spheres, p);
        fill(sim);
        for (std::size_t k = 0; k < sim.size(); ++k)
            sim.set_velocity(k, point{noise(k, 1), noise(k, 2), noise(k, 3)} * 1e-8);
        double const before = sim.kinetic_energy();
        try {
            sim.run(400);
        } catch (unstable_run const&) {
            return true;
        }
        return sim.kinetic_energy() > 1e3 * before;
    };
    double bound = 0;
    REQUIRE_FALSE(grows(0.999, bound));
    // Without fluid it would be at least 2 / sqrt(20 k_s): the fluid has an effect.
    REQUIRE(bound < 2 / std::sqrt(10.0));
    // The bound is close.
    REQUIRE(grows(2, bound));
}

TEST_CASE("Terzaghi's column in space") {
    // A column of cubes, one wide, each cut into the six tetrahedra 0, e_a, e_a + e_b, (1, 1, 1): with throats of one
    // conductance C two paths of two throats in series lead through a cube, and one throat each to the next: K = 2 C /
    // 3 d. Four rows of springs carry it: M = 4 k_n / d. Grains are rigid: S = 1 / M + phi / K_f, phi = 1 - pi / 6.
    int const layers = 12;
    packing<double, 3> spheres;
    for (int z = 0; z <= layers; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) spheres.add({double(x), double(y), double(z)}, 0.5);
    setups::bond_touching(spheres);
    double const kn = 1, bulk_modulus = 8, modulus = 4 * kn;
    double const storage = 1 / modulus + (1 - setups::pi / 6) / bulk_modulus;
    // Sound takes 1/400 of the time that the column takes to consolidate.
    double const time_scale = 400 * layers * std::sqrt(1.0 / (4 * kn / 4));
    double const conductance = 1.5 * storage * layers * layers / time_scale;
    auto p = bonded(kn, 10 * kn);
    p.damping.factor = 0.5;
    p.safety = 0.8;
    p.flow.bulk_modulus = bulk_modulus;
    p.flow.aperture.aperture = 0.1;
    p.flow.conductivity = conductance / 1e-3;
    simulation<porous> sim(spheres, p);
    for (std::size_t k = 0; k < sim.size(); ++k) {
        bool const base = spheres.position[k][2] < 0.5;
        sim.fix(k, {.x = true, .y = true, .z = base, .rotation = true});
    }
    // The mesh uses the positions of the spheres in the simulation's own order.
    sim.fill_pores([&](points_view<double, 3> points, double const* radii) {
        auto const at = [&](int x, int y, int z) {
            for (std::size_t k = 0; k < points.size(); ++k)
                if (norm(points[k] - point{double(x), double(y), double(z)}) < 0.1) return std::int32_t(k);
            return std::int32_t(-1);
        };
        pore_mesh<3> mesh;
        std::array<int, 3> order{0, 1, 2};
        do {
            for (int z = 0; z < layers; ++z) {
                std::array<int, 3> corner{0, 0, z};
                pore_mesh<3>::simplex s;
                for (std::size_t c = 0; c < 4; ++c) {
                    s[c] = at(corner[0], corner[1], corner[2]);
                    if (c < 3) ++corner[std::size_t(order[c])];
                }
                if (simplex_size<double, 3>(s, points) < 0) std::swap(s[2], s[3]);
                mesh.simplices.push_back(s);
            }
        } while (std::next_permutation(order.begin(), order.end()));
        detail::connect(mesh);
        auto net = make_pore_network(mesh, points, radii,
                                     flow_boundaries(reservoir("top", on_side{body_side::front}, 0.0)));
        // They reach only to the surface, half as far as to the next cube.
        for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t) net.length[t] *= 0.5;
        return net;
    });
    REQUIRE(sim.flow().network().pores() == std::size_t(6 * layers));
    REQUIRE(sim.flow().network().drained_throats == 2);
    double const load = 1e-4;
    std::vector<std::size_t> top;
    for (std::size_t k = 0; k < sim.size(); ++k)
        if (spheres.position[k][2] > layers - 0.5) top.push_back(k);
    for (auto const k : top) sim.apply(k, {0, 0, -load / 4});
    double const undrained = load * layers / (modulus + bulk_modulus / (1 - setups::pi / 6)),
                 full = load * layers / modulus;
    double const consolidation = storage * layers * layers / (2 * conductance / 3);
    double missing = 0, gross = 0;
    for (std::string const key : {"0.05", "0.1", "0.2", "0.5", "1"}) {
        while (sim.time() < std::stod(key) * consolidation) {
            sim.step_with_energy();
            missing += std::fabs(sim.flow().ledger().mass_residual);
            gross += sim.flow().ledger().gross_volume;
        }
        double settlement = 0;
        for (auto const k : top) settlement += (layers - sim.position(k)[2]) / 4;
        double const degree = (settlement - undrained) / (full - undrained);
        INFO("T = " << key << ": U = " << degree);
        CHECK_THAT(degree, WithinRel(reference("6a.terzaghi_U", key), 0.03));
    }
    REQUIRE(missing <= 1e-12 * gross);
}
