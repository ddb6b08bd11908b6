// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/equilibrium/energy.hpp>
#include <lacuna/equilibrium/system.hpp>
#include <lacuna/simulation/simulation_state.hpp>

namespace lacuna {

/// Keeps the energy balance of the increments of an equilibrium.
template <class Model>
class energy_account {
public:
    static constexpr int dim = Model::dim;

    energy_account(simulation_state<Model>& state, equilibrium_system<Model>& system) : s_(state), system_(system) {}

    /// Reads the committed state, in which the next increments begin. Loads that changed since the last increment rise
    /// in proportion within the next one; if the simulation has made steps meanwhile, they are those of now.
    /// \param step number of the simulation's step
    void begin(long long step) {
        auto const load = before_.load;
        read();
        if (step == step_ && load.size() == before_.load.size()) before_.load = load;
        step_ = step;
        stored_ = stored();
    }
    /// The loads at which the system found forces last are those in which the next increment begins.
    void note_loads() { before_.load = system_.forces_now().load; }
    /// Books the work of an increment: forces before and after it, before bonds fail, times its displacements. Called
    /// with the system at the end of the increment, by exact_forces().
    void book_work() {
        auto const& now = system_.forces_now();
        auto const& motion = system_.motion();
        constexpr int per_particle = unknowns<dim>::per_particle;
        for (std::size_t k = 0; k < s_.store.size(); ++k)
            for (int f = 0; f < per_particle; ++f) {
                auto const at = Eigen::Index(k) * per_particle + f;
                double const half = 0.5 * motion[std::size_t(at)];
                if (system_.numbers().of(k, f) >= 0) {
                    sum_.work += half * (before_.load[at] + now.load[at]);
                    sum_.released += half * (before_.sum(k, f) + now.sum(k, f));
                } else {
                    sum_.work -= half * (before_.inner[at] + now.inner[at]);
                }
            }
        book_walls(now);
    }
    /// Books what the laws stored and dissipated, and what failing bonds lost.
    void book_laws() {
        double const now = stored();
        sum_.strain += now - stored_;
        sum_.friction += s_.pairs.energy().dissipated + s_.wall_energy.dissipated;
        sum_.fracture += s_.pairs.energy_of_failures();
        stored_ = now;
    }
    /// Called before the fluid goes to its new state.
    void remember_fluid() {
        if constexpr (has_fluid<Model>) {
            auto const& net = s_.fluid.get()->network();
            pressure_.assign(net.pressure.begin(), net.pressure.end());
            volume_.assign(net.old_volume.begin(), net.old_volume.end());
        }
    }
    void book_fluid() {
        if constexpr (has_fluid<Model>) {
            auto const& net = s_.fluid.get()->network();
            for (std::size_t p = 0; p < net.pores() && p < volume_.size(); ++p)
                sum_.fluid += 0.5 * (pressure_[p] + net.pressure[p]) * (volume_[p] - net.old_volume[p]);
        }
    }
    /// Reads the forces in which the next increment begins.
    void read() {
        system_.exact_forces(Eigen::VectorXd::Zero(system_.count()));
        before_ = system_.forces_now();
    }
    /// \return the balance since the last call
    equilibrium_energy take() noexcept { return std::exchange(sum_, {}); }

private:
    double stored() const { return s_.pairs.energy().stored + s_.wall_energy.stored; }
    void book_walls(exact_force_record<dim> const& now) {
        for (std::size_t w = 0; w < s_.walls.size(); ++w) {
            auto const& motion = system_.wall_motion()[w];
            double const inner = 0.5 * dot(before_.on_wall[w] + now.on_wall[w], motion);
            if (system_.numbers().of_wall(w) >= 0) {
                double const servo = s_.wall_motions.servo_force(s_.walls, w) * dot(s_.walls.normal(w), motion);
                sum_.work += servo;
                sum_.released += servo + inner;
            } else {
                sum_.work -= inner;
            }
        }
    }

    simulation_state<Model>& s_;
    equilibrium_system<Model>& system_;
    exact_force_record<dim> before_;
    std::vector<double> pressure_, volume_;
    double stored_ = 0;
    long long step_ = -1;
    equilibrium_energy sum_;
};

} // namespace lacuna
