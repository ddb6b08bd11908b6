// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "setups.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <lacuna/laws/no_contact.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

/// \file
/// A fluid with weight: Archimedes' force on particles, and the hydrostatic balance of a wet bed.

using namespace lacuna;

namespace {

template <int Dim>
struct loose : default_model<Dim> {};

template <int Dim>
struct soaked : default_model<Dim> {
    using contact_law = no_contact;
    using damping = local_damping;
    using flow = explicit_flow_with<constant_aperture>;
};
template <int Dim>
struct soaked_implicit : soaked<Dim> {
    using flow = implicit_flow_with<constant_aperture>;
};

/// A triangular lattice of discs or a cubic lattice of spheres, with neighbours bonded; up is +y.
template <int Dim>
packing<double, Dim> bed() {
    packing<double, Dim> p;
    int const n = Dim == 2 ? 5 : 4;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            for (int z = 0; z < (Dim == 2 ? 1 : n); ++z) {
                vec<double, Dim> at{};
                at[0] = Dim == 2 ? x + 0.5 * (y % 2) : x;
                at[1] = Dim == 2 ? y * std::sqrt(0.75) : y;
                if constexpr (Dim == 3) at[2] = z;
                p.add(at, 0.5);
            }
    setups::bond_touching(p);
    return p;
}

template <class Model>
void check_bed() {
    constexpr int dim = Model::dim;
    auto const body = bed<dim>();
    double const g = 0.5, solid = setups::unit_density(dim), fluid = 0.4 * solid; // unit masses
    simulation_parameters<Model> p;
    p.materials[0].density = solid;
    p.materials[0].bond = {1e4, 5e3};
    p.damping.factor = 0.7;
    p.gravity[1] = -g;
    p.fluid_density = fluid;
    p.time_step = 1e-3;
    p.flow.bulk_modulus = 1e4;
    p.flow.aperture.aperture = 0.1;
    p.flow.conductivity = 1;
    p.flow.minimum_volume_fraction = 0.01;
    simulation<Model> sim(body, p);
    for (std::size_t k = 0; k < sim.size(); ++k)
        if (sim.position(k)[1] < 0.25) sim.fix(k);
    sim.fill_pores([](auto points, double const* radii) {
        return make_pore_network(triangulate_body(points, radii), points, radii,
                                 flow_boundaries(reservoir("top", on_side{body_side::top}, 0.0)));
    });
    double early = 0;
    for (int part = 0; part < 20; ++part) {
        sim.run(2);
        for (double const q : sim.flow().network().pressure) early = std::max(early, std::fabs(q));
    }
    sim.run(25000);

    // The water that the weight drives out must leave first: until then it carries part of the weight.
    double const submerged = 0.6 * g; // weight of one particle, N
    REQUIRE(early > submerged / 20);
    vec<double, dim> surface{};
    surface[1] = 7;
    auto const& net = sim.flow().network();
    for (std::size_t k = 0; k < net.pores(); ++k) {
        REQUIRE_THAT(net.pressure[k], WithinAbs(0, 1e-6 * early));
        auto const middle = pore_middle(net, k, view_points(body.position));
        double const depth = 7 - middle[1];
        REQUIRE_THAT(net.pressure[k] + p.hydrostatic_pressure(middle, surface), WithinRel(fluid * g * depth, 1e-6));
    }
    for (double const q : net.flow) REQUIRE_THAT(q, WithinAbs(0, 1e-9));
    double support = 0;
    for (std::size_t k = 0; k < sim.size(); ++k)
        if (sim.position(k)[1] < 0.25) support += sim.force(k)[1];
    REQUIRE_THAT(support, WithinRel(-submerged * double(sim.size()), 1e-6));
}

template <int Dim>
void check_free_body(mass_model mass, bool densities_of_particles) {
    double const g = 9.81, fluid = 1000;
    for (double const solid : {2500.0, 1000.0, 400.0}) {
        simulation_parameters<loose<Dim>> p;
        p.materials.resize(2);
        if (!densities_of_particles) {
            p.materials[0].density = 3 * solid;
            p.materials[1].density = solid;
        }
        p.mass = mass;
        p.gravity[1] = -g;
        p.fluid_density = fluid;
        p.time_step = 1e-4;
        packing<double, Dim> body;
        vec<double, Dim> aside{};
        aside[0] = 5;
        body.add(aside, 0.3, 0);
        body.add({}, 0.2, 1);
        if (densities_of_particles) body.density = {3 * solid, solid};
        simulation<loose<Dim>> sim(body, p);
        double const volume = mass == mass_model::disc ? setups::pi * 0.09 : 4 * setups::pi / 3 * 0.027;
        REQUIRE_THAT(sim.mass(0), WithinRel(3 * solid * volume, 1e-14));
        sim.run(1000);
        // Velocities hold half a step before the positions.
        double const t = 0.1 - 0.5e-4;
        REQUIRE_THAT(sim.velocity(0)[1], WithinRel(-g * (1 - fluid / (3 * solid)) * t, 1e-3));
        REQUIRE_THAT(sim.velocity(1)[1], WithinAbs(-g * (1 - fluid / solid) * t, 1e-3 * g * t));
        auto const e = [&] {
            sim.step_with_energy();
            return sim.energy();
        }();
        REQUIRE_THAT(e.residual(), WithinAbs(0, 1e-9 * e.largest()));
    }
}

} // namespace

TEST_CASE("a particle in a fluid at rest loses the weight of the displaced fluid", "[buoyancy]") {
    for (bool const of_particles : {false, true}) {
        check_free_body<2>(mass_model::disc, of_particles);
        check_free_body<2>(mass_model::sphere, of_particles);
        check_free_body<3>(mass_model::sphere, of_particles);
    }
}

TEMPLATE_TEST_CASE("hydrostatic balance: a wet bed stands on its submerged weight and nothing flows", "[buoyancy]",
                   soaked<2>, soaked_implicit<2>, soaked<3>, soaked_implicit<3>) {
    check_bed<TestType>();
}
