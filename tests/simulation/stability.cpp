// SPDX-License-Identifier: BSD-3-Clause

#include <Eigen/Dense>

#include "catch.hpp"
#include "reference.hpp"
#include "simulation/setups.hpp"

using namespace setups;

namespace {

struct bonds_only : plane {
    using contact_law = lacuna::no_contact;
};
struct bonds_only_in_space : space {
    using contact_law = lacuna::no_contact;
};

template <class Model>
lacuna::simulation_parameters<Model> unit_bonds(double ks) {
    lacuna::simulation_parameters<Model> p;
    p.materials[0].density = unit_density(Model::dim);
    p.materials[0].bond.normal_stiffness = 1;
    p.materials[0].bond.shear_stiffness = ks;
    return p;
}

/// 2 / omega_max of free equal discs (m = 1, R = 0.5, I = 1/8, k_n = 1), from the stiffness matrix written out:
/// bond length change (u_j - u_i).n, slip (u_j - u_i).s - R (theta_i + theta_j).
double exact_limit(lacuna::packing<double, 2> const& p, double ks, bool rotation) {
    int const n = int(p.size()), freedoms = 3 * n;
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(freedoms, freedoms);
    for (auto const& b : p.bonds) {
        Eigen::VectorXd stretch = Eigen::VectorXd::Zero(freedoms), slip = stretch;
        auto const i = std::size_t(b[0]), j = std::size_t(b[1]);
        double const nx = p.position[j][0] - p.position[i][0], ny = p.position[j][1] - p.position[i][1];
        for (auto const& [who, sign] : {std::pair{3 * b[0], -1.0}, std::pair{3 * b[1], 1.0}}) {
            stretch[who] = sign * nx;
            stretch[who + 1] = sign * ny;
            slip[who] = -sign * ny;
            slip[who + 1] = sign * nx;
            slip[who + 2] = rotation ? -0.5 * std::sqrt(8.0) : 0; // scaled by 1 / sqrt(I)
        }
        k += stretch * stretch.transpose() + ks * slip * slip.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, Eigen::EigenvaluesOnly);
    return 2 / std::sqrt(solver.eigenvalues().maxCoeff());
}

/// Whether an assembly stays in place after a small push.
template <class Model>
bool stays(lacuna::packing<double, Model::dim> const& packing, lacuna::simulation_parameters<Model> p, double dt,
           bool rotation, int steps, bool only_along_x = false, bool ends_fixed = false) {
    p.time_step = dt;
    p.allow_unstable_step = true;
    lacuna::simulation<Model> run(packing, p);
    for (std::size_t k = 0; k < run.size(); ++k) {
        bool const end = ends_fixed && (k == 0 || k + 1 == run.size());
        run.fix(k, {.x = end, .y = only_along_x || end, .z = only_along_x || end, .rotation = !rotation});
        lacuna::vec<double, Model::dim> v{};
        for (int axis = 0; axis < (only_along_x ? 1 : Model::dim); ++axis)
            v[axis] = 1e-7 * std::sin(1.0 + 7.3 * double(k) + 2.1 * axis);
        if (!end) run.set_velocity(k, v);
        if (rotation) {
            lacuna::vec<double, lacuna::rotation_dim<Model::dim>> w{};
            w[0] = 1e-7 * (1 + 0.3 * std::sin(3.7 * double(k)));
            run.set_spin(k, w);
        }
    }
    double const before = run.kinetic_energy();
    try {
        for (int n = 0; n < steps; ++n) {
            run.step();
            if (n % 100 == 0 && run.kinetic_energy() > 1e6 * before) return false;
        }
    } catch (lacuna::unstable_run const&) {
        return false;
    }
    return true;
}

} // namespace

TEST_CASE("modes of a chain between fixed ends", "[stability][reference]") {
    auto const expected = reference_list("2a.modes_fixed_fixed_N10");
    for (int mode = 1; mode <= 10; ++mode) {
        auto p = springs<plane>(1, 1, 0, unit_density(2));
        p.time_step = 0.1;
        lacuna::simulation<plane> run(chain<2>(12), p);
        run.fix(0);
        run.fix(11);
        std::vector<double> shape(12, 0.0);
        for (int k = 1; k <= 10; ++k) {
            shape[std::size_t(k)] = std::sin(k * mode * pi / 11);
            run.set_velocity(std::size_t(k), {1e-3 * shape[std::size_t(k)], 0});
        }
        auto const amplitude = [&] {
            double sum = 0;
            for (std::size_t k = 1; k <= 10; ++k) sum += shape[k] * (run.position(k)[0] - double(k));
            return sum;
        };
        // Identity of the scheme: q(t + dt) - 2 q(t) + q(t - dt) = -(omega dt)^2 q(t), for any dt.
        double above = 0, below = 0, old = 0, now = 0;
        for (int n = 0; n < 500; ++n) {
            run.step();
            double const next = amplitude();
            above -= (next - 2 * now + old) * now;
            below += now * now;
            old = now;
            now = next;
        }
        INFO("mode " << mode);
        REQUIRE_THAT(std::sqrt(above / below) / 0.1, WithinRel(expected[std::size_t(mode - 1)], 1e-6));
    }
}

TEST_CASE("the stable step of a chain lies between 0.999 and 1.001 of 2 / omega_max", "[stability][reference]") {
    for (bool const fixed : {true, false}) {
        double const limit =
            reference(fixed ? "2a.dt_crit_fixed_fixed_N10" : "2a.dt_crit_free_free_N10");
        auto const packing = chain<2>(fixed ? 12 : 10);
        REQUIRE(stays(packing, unit_bonds<bonds_only>(1), 0.999 * limit, false, 100000, true, fixed));
        REQUIRE_FALSE(stays(packing, unit_bonds<bonds_only>(1), 1.001 * limit, false, 100000, true, fixed));
    }
}

TEST_CASE("the stable step of lattices, with rotation and without", "[stability][reference]") {
    for (auto const& [name, packing] : {std::pair{"chain2D", chain<2>(24)}, std::pair{"square", lattice(6, 6, false)},
                                        std::pair{"triangular", lattice(6, 6, true)}})
        for (std::string const ks : {"1", "0.5", "0"})
            for (bool const rotation : {true, false}) {
                INFO(name << ", ks/kn = " << ks << ", rotation " << rotation);
                double const infinite = reference("2b.dt_crit_lattices", name + (" ks/kn=" + ks),
                                                  rotation ? "dt_rot" : "dt_norot");
                double const exact = exact_limit(packing, std::stod(ks), rotation);
                REQUIRE(exact >= infinite * (1 - 1e-9)); // a finite piece vibrates more slowly
                auto p = unit_bonds<bonds_only>(std::stod(ks));
                REQUIRE(stays(packing, p, 0.999 * exact, rotation, 5000));
                REQUIRE_FALSE(stays(packing, p, 1.002 * exact, rotation, 5000));

                lacuna::simulation<bonds_only> run(packing, p);
                if (!rotation)
                    for (std::size_t k = 0; k < run.size(); ++k) run.fix(k, {.rotation = true});
                auto const found = run.limits();
                REQUIRE(found.rigorous <= exact);
                CHECK(found.rigorous >= 0.6 * infinite);
                REQUIRE_THAT(found.wave_limit, WithinRel(reference("2a.dt_crit_infinite"), 1e-12));
                REQUIRE(found.critical() == found.rigorous);
            }
}

TEST_CASE("lattices in 3D: the bound stays below the limit of the infinite lattice", "[stability][reference][3d]") {
    for (std::string const name : {"chain3D", "simple_cubic", "fcc"})
        for (std::string const ks : {"1", "0.5", "0"})
            for (bool const rotation : {true, false}) {
                INFO(name << ", ks/kn = " << ks << ", rotation " << rotation);
                lacuna::packing<double, 3> packing;
                int const n = name == "fcc" ? 8 : 5;
                double const cell = name == "fcc" ? std::sqrt(0.5) : 1;
                for (int x = 0; x < n; ++x)
                    for (int y = 0; y < (name == "chain3D" ? 1 : n); ++y)
                        for (int z = 0; z < (name == "chain3D" ? 1 : n); ++z)
                            if (name != "fcc" || (x + y + z) % 2 == 0)
                                packing.add({x * cell, y * cell, z * cell}, 0.5);
                bond_touching(packing);
                double const limit = reference("2b.dt_crit_lattices", name + (" ks/kn=" + ks),
                                               rotation ? "dt_rot" : "dt_norot");
                auto p = unit_bonds<bonds_only_in_space>(std::stod(ks));
                lacuna::simulation<bonds_only_in_space> run(packing, p);
                if (!rotation)
                    for (std::size_t k = 0; k < run.size(); ++k) run.fix(k, {.rotation = true});
                // The middle of the specimen is as stiff as the infinite lattice: the bound has to lie below it.
                if (name != "chain3D") CHECK(run.limits().rigorous <= limit * (1 + 1e-9));
                CHECK(run.limits().rigorous >= 0.6 * limit);
                REQUIRE(stays(packing, p, 0.995 * limit, rotation, 300));
                // A specimen of a few layers lacks the longest waves, or the shortest: its limit is a little higher.
                REQUIRE_FALSE(stays(packing, p, 1.15 * limit, rotation, 300));
            }
}

TEST_CASE("damping shortens the stable step, and the bound includes it", "[stability]") {
    // Two free discs: omega^2 = 2 k / m = 2. Local damping multiplies the force against the motion by 1 + alpha; a
    // dashpot with the velocity of half a step before requires omega dt < 2 (sqrt(1 + zeta^2) - zeta).
    auto const check = [](auto model, auto const& p, double limit) {
        using type = decltype(model);
        REQUIRE(stays<type>(chain<2>(2), p, 0.995 * limit, false, 5000, true));
        REQUIRE_FALSE(stays<type>(chain<2>(2), p, 1.005 * limit, false, 5000, true));
        auto const tri = lattice(5, 5, true);
        for (bool const rotation : {true, false}) {
            for (auto const& packing : {chain<2>(2), chain<2>(12), tri}) {
                lacuna::simulation<type> run(packing, p);
                if (!rotation)
                    for (std::size_t k = 0; k < run.size(); ++k) run.fix(k, {.rotation = true});
                double const bound = run.limits().rigorous;
                REQUIRE(stays<type>(packing, p, 0.999 * bound, rotation, 3000));
                if (packing.size() == 2 && !rotation) REQUIRE_THAT(bound, WithinRel(limit, 1e-9));
            }
        }
    };
    for (double const alpha : {0.3, 0.7}) {
        auto p = springs<plane_locally_damped>(1, 1, 0, unit_density(2));
        p.damping.factor = alpha;
        check(plane_locally_damped{}, p, std::sqrt(2 / (1 + alpha)));
    }
    for (double const ratio : {0.1, 0.5}) {
        auto p = springs<plane_viscous>(1, 1, 0, unit_density(2));
        p.damping.ratio = ratio;
        check(plane_viscous{}, p, std::sqrt(2.0) * (std::sqrt(1 + ratio * ratio) - ratio));
    }
}

TEST_CASE("a step above the bound is refused, and runs with allow_unstable_step", "[stability]") {
    auto p = springs<plane>(1, 1, 0, unit_density(2));
    p.time_step = 0.9;
    {
        lacuna::simulation<plane> run(chain<2>(10), p);
        REQUIRE_THROWS_AS(run.step(), std::invalid_argument);
        REQUIRE_THROWS_WITH(run.run(1), contains_text("time_step = 0.9") && contains_text("must be at most") &&
                                            contains_text("allow_unstable_step") && contains_text("eq. 9"));
        REQUIRE(run.steps() == 0);
    }
    p.allow_unstable_step = true;
    lacuna::simulation<plane> run(chain<2>(10), p);
    REQUIRE_NOTHROW(run.run(10));
    p.allow_unstable_step = false;
    p.time_step = 0.999 * run.limits().rigorous;
    lacuna::simulation<plane> allowed(chain<2>(10), p);
    REQUIRE_NOTHROW(allowed.run(10));
    p.time_step = 0;
    p.safety = 0.25;
    lacuna::simulation<plane> own(chain<2>(10), p);
    REQUIRE_THAT(own.resolve_time_step(), WithinRel(0.25 * own.limits().critical(), 1e-14));
}
