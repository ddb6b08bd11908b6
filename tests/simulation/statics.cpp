// SPDX-License-Identifier: BSD-3-Clause

#include <map>

#include "catch.hpp"
#include "reference.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

lacuna::simulation_parameters<plane_locally_damped> damped(double ks = 1, double factor = 0.7) {
    auto p = springs<plane_locally_damped>(1, ks, 0, unit_density(2));
    p.damping.factor = factor;
    p.safety = 0.9;
    return p;
}

} // namespace

TEST_CASE("a chain without bending stiffness is a gear train: it has no transverse static stiffness",
          "[statics][reference]") {
    // Under a transverse force rolling balances the moments: with free rotations no bond can carry a static shear
    // force.
    double const force = 1e-7;
    auto p = springs<plane_viscous>(1, 1, 0, unit_density(2));
    p.damping.ratio = 0.1;
    p.safety = 0.5;
    lacuna::simulation<plane_viscous> run(chain<2>(11), p);
    run.fix(0);
    run.apply(10, {0, force});
    double previous = 0;
    for (int block = 0; block < 4; ++block) {
        while (run.time() < 25 * (block + 1)) run.step();
        double const tip = run.position(10)[1];
        // With any stiffness k_t the tip would oscillate about force / k_t. Here it accelerates, at least like the
        // heaviest mechanism: all ten discs and their spins.
        REQUIRE(tip - previous > force * 0.5 * 25 * 25 / 20.0);
        previous = tip;
    }
    REQUIRE(reference("4a.zero_modes", "transverse_static_stiffness") == 0);
}

TEST_CASE("a chain whose discs cannot rotate is a shear beam", "[statics][reference]") {
    double const force = 1e-6;
    lacuna::simulation<plane_locally_damped> run(chain<2>(11), damped());
    run.fix(0);
    for (std::size_t k = 1; k <= 10; ++k) run.fix(k, {.rotation = true});
    run.apply(10, {0, force});
    for (int n = 0; n < 20000; ++n) run.step();
    REQUIRE(run.kinetic_energy() < 1e-20 * force);
    REQUIRE_THAT(run.position(10)[1] / force, WithinRel(reference("4b.rotations_locked", "N=10 tip deflection"), 1e-6));
    for (int k = 1; k <= 10; ++k) REQUIRE_THAT(run.position(std::size_t(k))[1] / force, WithinRel(double(k), 1e-6));
}

TEST_CASE("a chain under tension is a rope along the tip's force", "[statics][reference]") {
    // The rope's modes are slow: their speed is sqrt(T/k) = 0.1 of the chain's.
    lacuna::simulation<plane_locally_damped> run(chain<2>(11), damped(1, 0.5));
    run.fix(0);
    run.apply(10, {0.01, 1e-5});
    for (int n = 0; n < 100000; ++n) run.step();
    auto const tip = run.position(10);
    REQUIRE_THAT(tip[1], WithinRel(reference("4c.tension_rope", "tip"), 1e-3));
    for (std::size_t k = 1; k <= 10; ++k)
        REQUIRE_THAT(run.position(k)[1] / run.position(k)[0], WithinRel(reference("4c.tension_rope", "slope"), 1e-3));
}

TEST_CASE("patch test: the interior of a lattice follows an affine motion of its rim", "[statics][reference]") {
    int const n = 8;
    auto const packing = lattice(n, n, true);
    auto const g = reference_table("3b.patch_test", "G");
    auto const stress = reference_list("3b.patch_test", "sigma_xx,yy,xy");
    double const turn = reference("3b.patch_test", "theta");
    lacuna::simulation<plane_locally_damped> run(packing, damped());
    auto const on_rim = [&](std::size_t k) {
        std::size_t const c = k % n, r = k / n;
        return c == 0 || c == n - 1 || r == 0 || r == n - 1;
    };
    auto const affine = [&](std::size_t k) {
        auto const& x = packing.position[k];
        return lacuna::vec<double, 2>{g[0][0] * x[0] + g[0][1] * x[1], g[1][0] * x[0] + g[1][1] * x[1]};
    };
    int const moving = 100;
    double const duration = moving * run.resolve_time_step();
    for (std::size_t k = 0; k < run.size(); ++k) {
        if (!on_rim(k)) continue;
        run.fix(k);
        run.set_velocity(k, affine(k) / duration);
        run.set_spin(k, {turn / duration});
    }
    for (int s = 0; s < moving; ++s) run.step();
    for (std::size_t k = 0; k < run.size(); ++k) {
        if (!on_rim(k)) continue;
        run.set_velocity(k, {});
        run.set_spin(k, {});
    }
    for (int s = 0; s < 20000; ++s) run.step();

    std::size_t inside = 0;
    for (std::size_t k = 0; k < run.size(); ++k) {
        if (on_rim(k)) continue;
        ++inside;
        auto const u = run.position(k) - packing.position[k];
        for (int axis = 0; axis < 2; ++axis) REQUIRE_THAT(u[axis], WithinAbs(affine(k)[axis], 1e-5 * 1e-5));
        // Stress by the sum of (branch vector) x (force) over the six bonds, each shared by two discs of area
        // sqrt(3) / 2; the pair force on i points from i to j in tension.
        lacuna::vec<double, 4> sum{};
        for (auto const& b : packing.bonds) {
            if (std::size_t(b[0]) != k && std::size_t(b[1]) != k) continue;
            auto const branch = packing.position[std::size_t(b[1])] - packing.position[std::size_t(b[0])];
            auto const force = pair_force(run, b[0], b[1]);
            for (int r = 0; r < 2; ++r)
                for (int c = 0; c < 2; ++c) sum[2 * r + c] += 0.5 * branch[r] * force[c] / std::sqrt(0.75);
        }
        REQUIRE_THAT(sum[0], WithinRel(stress[0], 1e-5));
        REQUIRE_THAT(sum[3], WithinRel(stress[1], 1e-5));
        REQUIRE_THAT(sum[1], WithinRel(stress[2], 1e-5));
        REQUIRE_THAT(sum[2], WithinRel(stress[2], 1e-5));
    }
    REQUIRE(inside == 36);
}

TEST_CASE("moduli of the triangular lattice", "[statics][reference]") {
    // All discs are moved: the stress at a middle disc is then exactly that of the affine field.
    int const n = 5;
    auto const packing = lattice(n, n, true);
    std::size_t const middle = 12;
    for (std::string const ratio : {"1", "0.5", "0"}) {
        std::string const id = "3a.moduli_ks/kn=" + ratio;
        double const strain = 1e-7;
        std::map<std::string, double> found;
        for (std::string const kind : {"stretch", "shear"}) {
            auto p = damped(std::stod(ratio));
            lacuna::simulation<plane_locally_damped> run(packing, p);
            for (std::size_t k = 0; k < run.size(); ++k) run.fix(k);
            // If all discs are fixed, no step is too long: this is a share of eq. 9.
            double const duration = 10 * run.resolve_time_step();
            for (std::size_t k = 0; k < run.size(); ++k) {
                auto const& x = packing.position[k];
                if (kind == "stretch")
                    run.set_velocity(k, {strain * x[0] / duration, 0});
                else
                    run.set_velocity(k, {strain * x[1] / 2 / duration, strain * x[0] / 2 / duration});
            }
            for (int s = 0; s < 11; ++s) {
                if (s == 10)
                    for (std::size_t k = 0; k < run.size(); ++k) run.set_velocity(k, {});
                run.step();
            }
            lacuna::vec<double, 4> sum{};
            for (auto const& b : packing.bonds) {
                if (std::size_t(b[0]) != middle && std::size_t(b[1]) != middle) continue;
                auto const branch = packing.position[std::size_t(b[1])] - packing.position[std::size_t(b[0])];
                auto const force = pair_force(run, b[0], b[1]);
                for (int r = 0; r < 2; ++r)
                    for (int c = 0; c < 2; ++c)
                        sum[2 * r + c] += 0.5 * branch[r] * force[c] / std::sqrt(0.75) / strain;
            }
            if (kind == "stretch")
                found["C11"] = sum[0], found["C12"] = sum[3];
            else
                found["C66"] = sum[1];
        }
        INFO("k_s / k_n = " << ratio);
        for (std::string const name : {"C11", "C12", "C66"})
            REQUIRE_THAT(found[name], WithinAbs(reference(id, name), 1e-6));
    }
}
