// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>

#include <lacuna/loads/compression.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

/// \file
/// Compression tests of square and cubic lattices: independent columns of springs in series.

using namespace setups;

namespace {

template <int Dim>
struct damped : lacuna::default_model<Dim> {
    using damping = lacuna::local_damping;
};

/// n particles of radius 0.5 along each axis, touching.
template <int Dim>
lacuna::packing<double, Dim> cube(int n) {
    lacuna::packing<double, Dim> p;
    for (int k = 0; k < (Dim == 2 ? n * n : n * n * n); ++k) {
        lacuna::vec<double, Dim> x{};
        for (int axis = 0, rest = k; axis < Dim; ++axis, rest /= n) x[axis] = rest % n;
        p.add(x, 0.5);
    }
    return p;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("biaxial and triaxial compression hold the sides and load the axis", "[compression]",
                       ((int Dim), Dim), 2, 3) {
    using model = damped<Dim>;
    int const n = 3;
    double const kn = 1e4, thickness = 0.4;
    auto p = springs<model>(kn, 0.5 * kn, 0, unit_density(Dim));
    p.thickness = thickness;
    p.damping = {0.6};
    p.safety = 0.5;
    auto const specimen = cube<Dim>(n);
    using wall = typename decltype(p.walls)::value_type;
    p.walls = lacuna::box_walls<wall>(specimen, p.materials[0].contact);
    lacuna::simulation<model> sim(specimen, p);
    lacuna::compression_parameters c;
    c.strain_rate = 2e-4;
    c.ramp_time = 1;
    c.confinement = 20;
    c.servo_speed = 0.02;
    c.axis = 1;
    lacuna::compression_test<Dim> test(c, specimen, true, thickness);
    test.confine(sim);
    while (sim.time() < 20) sim.step();
    auto const pressed = test.state(sim);
    for (int axis = 0; axis < Dim; ++axis) CHECK_THAT(pressed.stress[axis], WithinRel(20.0, 1e-3));
    // A column of n has n + 1 contacts in series, each of k_n.
    double const column = 20 * (Dim == 2 ? thickness : 1.0) * std::pow(n, Dim - 1) / std::pow(n, Dim - 1);
    CHECK_THAT(pressed.strain[0], WithinRel(column * (n + 1) / kn / n, 1e-2));
    test.load(sim);
    while (sim.time() < 40) sim.step_with_energy();
    auto const loaded = test.state(sim);
    CHECK_THAT(loaded.strain[1], WithinRel(2e-4 * (19.5 - 0), 1e-2));
    double const modulus =
        kn / (n + 1) * n * std::pow(n, Dim - 1) / (std::pow(n, Dim - 1) * (Dim == 2 ? thickness : 1.0));
    CHECK_THAT(loaded.stress[1] - 20, WithinRel(modulus * loaded.strain[1], 1e-2));
    for (int axis = 0; axis < Dim; ++axis)
        if (axis != 1) {
            CHECK_THAT(loaded.stress[axis], WithinRel(20.0, 1e-2));
            CHECK_THAT(loaded.strain[axis], WithinAbs(0, 1e-4));
        }
    // The work of the platens is stored in the springs.
    CHECK(std::fabs(sim.energy().residual()) < 1e-3 * sim.energy().largest());
}

TEST_CASE("compression tests refuse bad parameters by name", "[compression][refusal]") {
    auto const specimen = cube<2>(2);
    lacuna::compression_parameters c;
    auto const make = [&](bool box) { return lacuna::compression_test<2>(c, specimen, box); };
    CHECK_THROWS_WITH(make(false), contains_text("compression.strain_rate = 0"));
    c.strain_rate = 1;
    CHECK_NOTHROW(make(false));
    CHECK_THROWS_WITH(make(true), contains_text("compression.servo_speed = 0"));
    c.axis = 2;
    CHECK_THROWS_WITH(make(false), contains_text("compression.axis = 2"));
    c.axis = 1;
    c.confinement = -1;
    CHECK_THROWS_WITH(make(false), contains_text("compression.confinement = -1"));
    CHECK_THROWS_WITH(lacuna::extent(lacuna::packing<double, 2>{}, 0), contains_text("packing.size() = 0"));
}
