// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>

#include <lacuna/laws/rolling_spring.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

/// \file
/// Discs and spheres with rolling resistance, compared with rigid bodies under a constant resisting moment.

using namespace setups;

namespace {

template <int Dim>
struct rolling : lacuna::default_model<Dim> {
    using contact_law = lacuna::rolling_spring;
};

/// Earth's gravity, a floor with the given slope along x, and one particle on it with the overlap that carries its
/// weight.
template <int Dim>
struct slope {
    static constexpr double radius = 0.1, g = 9.81, kn = 1e6, mass = 1;
    lacuna::simulation_parameters<rolling<Dim>> p;
    lacuna::packing<double, Dim> body;

    slope(double resistance, double angle) {
        p.materials[0].density = mass / (Dim == 2 ? pi * radius * radius : 4.0 / 3 * pi * radius * radius * radius);
        p.materials[0].contact = {kn, 0.5 * kn, 0.6, resistance, 1};
        p.gravity[0] = g * std::sin(angle);
        p.gravity[1] = -g * std::cos(angle);
        lacuna::vec<double, Dim> up{}, x{};
        up[1] = 1;
        x[1] = radius - mass * g * std::cos(angle) / kn;
        p.walls = {{{}, up, p.materials[0].contact}};
        body.add(x, radius);
    }
    /// m + I / r^2 over m.
    static constexpr double rolling_mass = Dim == 2 ? 1.5 : 1.4;
};

} // namespace

TEMPLATE_TEST_CASE_SIG("rolling resistance brings a particle to rest", "[rolling]", ((int Dim), Dim), 2, 3) {
    double const resistance = 0.05, speed = 0.2;
    slope<Dim> s(resistance, 0);
    lacuna::simulation<rolling<Dim>> sim(s.body, s.p);
    lacuna::vec<double, Dim> v{};
    v[0] = speed;
    lacuna::vec<double, lacuna::rotation_dim<Dim>> spin{};
    spin[Dim == 2 ? 0 : 2] = -speed / s.radius;
    sim.set_velocity(0, v);
    sim.set_spin(0, spin);
    // Rolling without slip: m a = -F, I a / r = F r - M, M = mu_r r m g.
    double const slowing = resistance * s.g / s.rolling_mass;
    double before = 0, worst = 0;
    bool halfway = false;
    do {
        before = sim.position(0)[0];
        sim.step_with_energy();
        worst = std::max(worst, std::fabs(sim.energy().residual()));
        if (!halfway && sim.time() > 0.5 * speed / slowing) {
            halfway = true;
            // The velocity oscillates slightly on the spring of the floor: the position gives the deceleration.
            double const t = sim.time();
            CHECK_THAT(sim.position(0)[0], WithinRel(speed * t - 0.5 * slowing * t * t, 1e-3));
        }
    } while (sim.position(0)[0] > before || sim.steps() < 10);
    CHECK(halfway);
    CHECK_THAT(sim.time(), WithinRel(speed / slowing, 2e-3));
    CHECK_THAT(sim.position(0)[0], WithinRel(speed * speed / (2 * slowing), 2e-3));
    double const kinetic = 0.5 * s.rolling_mass * speed * speed;
    CHECK(worst < 2e-3 * kinetic);
    CHECK_THAT(sim.energy().friction, WithinRel(kinetic, 2e-3));
}

TEST_CASE("a disc stays on a slope up to the limit angle and rolls down beyond", "[rolling]") {
    double const resistance = 0.2;
    for (double const share : {0.9, 1.1}) {
        double const angle = std::atan(share * resistance);
        slope<2> s(resistance, angle);
        lacuna::simulation<rolling<2>> sim(s.body, s.p);
        auto const place_at = [&](double time) {
            while (sim.time() < time) sim.step();
            return sim.position(0)[0];
        };
        double const early = place_at(0.1), halfway = place_at(0.45);
        place_at(0.8);
        if (share < 1) {
            // It only oscillates on its spring, with a strain of mu_r m g / (k_s r).
            CHECK(std::fabs(sim.position(0)[0]) < 10 * resistance * s.g / (0.5 * s.kn));
        } else {
            double const down = s.g * (std::sin(angle) - resistance * std::cos(angle)) / 1.5;
            // From three positions, because the spring gave it an initial speed.
            CHECK_THAT(sim.position(0)[0] - 2 * halfway + early, WithinRel(down * 0.35 * 0.35, 5e-3));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("two particles pressed together stop rolling on each other",
                       "[rolling]", ((int Dim), Dim), 2, 3) {
    // They rotate in opposite directions like gear wheels, without slip; the moment mu_r R P decelerates both.
    double const resistance = 0.1, press = 20, spin = 3;
    lacuna::simulation_parameters<rolling<Dim>> p;
    p.materials[0].density = unit_density(Dim);
    p.materials[0].contact = {1e6, 4e5, 0.5, resistance, 1};
    auto two = chain<Dim>(2, false);
    two.position[1][0] -= press / 1e6;
    lacuna::simulation<rolling<Dim>> sim(two, p);
    lacuna::vec<double, Dim> force{};
    lacuna::vec<double, lacuna::rotation_dim<Dim>> w{};
    int const about = Dim == 2 ? 0 : 1;
    for (std::size_t k = 0; k < 2; ++k) {
        force[0] = k == 0 ? press : -press;
        w[about] = k == 0 ? spin : -spin;
        sim.apply(k, force);
        sim.set_spin(k, w);
    }
    double const slowing = resistance * 0.25 * press / sim.moment_of_inertia(0);
    while (sim.time() < 0.5 * spin / slowing) sim.step_with_energy();
    CHECK_THAT(sim.spin(0)[about], WithinRel(spin - slowing * sim.time(), 1e-3));
    CHECK_THAT(sim.spin(1)[about], WithinRel(-sim.spin(0)[about], 1e-9));
    CHECK_THAT(sim.position(1)[0] - sim.position(0)[0], WithinAbs(1 - press / 1e6, 1e-6));
    // Half of the time takes three quarters of the energy.
    CHECK_THAT(sim.energy().friction, WithinRel(0.75 * sim.moment_of_inertia(0) * spin * spin, 2e-3));
    CHECK(std::fabs(sim.energy().residual()) < 1e-3 * sim.energy().largest());
    while (sim.time() < 1.2 * spin / slowing) sim.step();
    CHECK(std::fabs(sim.spin(0)[about]) < 0.01 * spin);
}

TEST_CASE("the bound of the step includes the rolling stiffness", "[rolling]") {
    // One disc on a wall that can only rotate: omega^2 = (k_s r^2 + c k_s r^2) / I.
    slope<2> s(0.1, 0);
    s.p.materials[0].contact.rolling_factor = 50;
    s.p.walls[0].material = s.p.materials[0].contact;
    lacuna::simulation<rolling<2>> sim(s.body, s.p);
    sim.fix(0, {true, true, true, false});
    double const inertia = 0.5 * s.mass * s.radius * s.radius, k = 0.5 * s.kn * s.radius * s.radius;
    CHECK_THAT(sim.limits().rigorous, WithinRel(2 / std::sqrt(51 * k / inertia), 1e-3));
}
