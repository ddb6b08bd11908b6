// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "facts.hpp"
#include "particle_runner.hpp"

/// \file
/// Runs of lacuna-run that the target run_deck can observe. Each kind of model has a file in this folder, which defines
/// make_particle_runner() in place of the program's definition.

namespace fuzz {

template <class Model>
class watched_runner final : public lacuna_run::particle_runner<Model>, public watched {
    static constexpr int dim = Model::dim;
    using simulation = lacuna::simulation<Model>;
    using vector = lacuna::vec<double, dim>;

public:
    explicit watched_runner(lacuna_run::scenario const& s) : lacuna_run::particle_runner<Model>(s), scenario_(s) {}

    run_facts facts(bool with_hash) const override {
        auto const& sim = this->simulated();
        run_facts f;
        if (with_hash) f.hash = lacuna::state_hash(sim);
        for (std::size_t k = 0; k < sim.size(); ++k) {
            auto const x = sim.position(k), v = sim.velocity(k);
            auto const w = sim.spin(k);
            auto& row = f.state.emplace_back();
            for (int axis = 0; axis < dim; ++axis) {
                row[std::size_t(axis)] = x[axis];
                row[std::size_t(3 + axis)] = v[axis];
            }
            for (int axis = 0; axis < lacuna::rotation_dim<dim>; ++axis) row[std::size_t(6 + axis)] = w[axis];
        }
        return f;
    }

    step_facts rehearse(long long steps) const override {
        simulation copy = this->simulated();
        // More than 1000 fluid steps per particle step take too long here.
        if constexpr (lacuna::has_fluid<Model>)
            if (scenario_.fluid && !scenario_.fluid->implicit &&
                copy.resolve_time_step() > 1000 * copy.flow().mean_throat_limit())
                throw other_kind();
        step_facts f;
        try {
            copy.run(steps, watcher{scenario_, momentum_of(copy), f});
        } catch (lacuna::unstable_run const& bad) {
            f.message = bad.what();
        }
        // The state of an unstable run may not be writable.
        if (f.message.empty()) f.hash = lacuna::state_hash(copy);
        return f;
    }

private:
    static vector momentum_of(simulation const& sim) {
        vector sum{};
        for (std::size_t k = 0; k < sim.size(); ++k) sum += sim.velocity(k) * sim.mass(k);
        return sum;
    }

    struct watcher {
        static constexpr lacuna::stage stages = lacuna::stage::step;
        static constexpr bool needs_energy = true;
        lacuna_run::scenario const& scenario;
        vector first;
        step_facts& f;

        void on_step(simulation const& sim) {
            auto const& e = sim.energy();
            vector const change = momentum_of(sim) - first;
            for (int axis = 0; axis < dim; ++axis)
                f.momentum_change = std::max(f.momentum_change, std::fabs(change[axis]));
            f.residual = std::max(f.residual, std::fabs(e.residual()));
            f.spent = std::max({f.spent, e.friction + e.damping, -e.damping});
            f.energy = std::max({f.energy, e.largest(), sim.kinetic_energy()});
            double sum = e.residual();
            for (std::size_t k = 0; k < sim.size(); ++k)
                sum += squared_norm(sim.position(k)) + squared_norm(sim.velocity(k)) + squared_norm(sim.spin(k));
            f.finite = f.finite && std::isfinite(sum);
            add_rounding(sim);
        }

        /// Largest stiffness in the scenario. The bound of the step ignores the springs of fixed particles.
        double stated_stiffness() const {
            double most = 0;
            for (auto const& m : scenario.materials) most = std::max({most, m.normal_stiffness, m.shear_stiffness});
            for (auto const& w : scenario.walls) most = std::max({most, w.normal_stiffness, w.shear_stiffness});
            for (auto const& b : scenario.bonds.values)
                most = std::max({most, b.normal_stiffness.value_or(0.0), b.shear_stiffness.value_or(0.0)});
            return most;
        }
        /// Estimates the rounding errors of forces, velocities and positions from energies and steps. A force is at
        /// most sqrt(2 k E), a momentum sqrt(2 m E), and stiffnesses are about those of the bound, 4 m / critical^2.
        void add_rounding(simulation const& sim) {
            double const epsilon = double(std::numeric_limits<typename Model::real>::epsilon());
            double heaviest = 0, momenta = 0, reach = 0;
            for (std::size_t k = 0; k < sim.size(); ++k) {
                heaviest = std::max(heaviest, sim.mass(k));
                momenta += std::sqrt(2 * sim.mass(k) * f.energy);
                for (int axis = 0; axis < dim; ++axis)
                    reach = std::max(reach, std::fabs(sim.position(k)[axis]) + sim.radius(k));
            }
            double const critical = sim.limits().critical(), step = sim.time_step();
            f.share = std::max(f.share, step / critical);
            double const stiffness = std::max(4 * heaviest / (critical * critical), stated_stiffness());
            double const pairs = double(sim.size()) * (dim == 2 ? 4 : 8) + double(scenario.bonds.pairs.size());
            double momentum = momenta + step * pairs * std::sqrt(2 * stiffness * f.energy);
            // The error of a position, and of a spring's length, is epsilon times the distance from the origin.
            double const blur = epsilon * reach;
            double energy =
                epsilon * f.energy + pairs * (std::sqrt(stiffness * f.energy) * blur + stiffness * blur * blur);
            if constexpr (lacuna::has_fluid<Model>)
                if (scenario.fluid) {
                    auto const& net = sim.flow().network();
                    double pressure = 0;
                    for (std::size_t p = 0; p < net.pores(); ++p)
                        pressure = std::max(pressure, std::fabs(double(net.pressure[p])));
                    double const thrust = double(net.pores()) * pressure * scenario.simulation.thickness * reach;
                    momentum += step * thrust;
                    energy += thrust * blur;
                }
            f.momentum_rounding = std::max(f.momentum_rounding, epsilon * momentum);
            f.energy_rounding = std::max(f.energy_rounding, energy);
        }
    };

    lacuna_run::scenario const& scenario_;
};

} // namespace fuzz
