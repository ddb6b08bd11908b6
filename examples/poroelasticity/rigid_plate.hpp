// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "column.hpp"

namespace poroelasticity {

/// A rigid, smooth plate: particles that move together along an axis, under their total force and a load.
///
/// Inertia plays no role in the problem, so the mass is free. It is large enough to use the force of the last step for
/// the next one, and small enough to follow the load at once: against the adjacent discs it oscillates once in thirty
/// steps.
class rigid_plate {
public:
    /// \param held the particles of the plate, fixed along `axis`; the plate sets their velocity
    /// \param stiffness of the adjacent discs against the plate, N/m
    /// \param damping divided by critical damping
    rigid_plate(simulator& sim, discs const& packing, std::vector<std::size_t> const& held, int axis,
                double stiffness, double damping)
        : axis_(axis), on_plate_(sim.size(), 0), particles_(held) {
        double const frequency = 0.2 / sim.resolve_time_step();
        mass_ = stiffness / (frequency * frequency);
        drag_ = 2 * damping * mass_ * frequency;
        std::vector<char> on(sim.size(), 0);
        for (std::size_t i : held) on[i] = on_plate_[std::size_t(sim.particles().internal(i))] = 1;
        for (auto const& [a, b] : packing.bonds)
            if (on[std::size_t(a)] != on[std::size_t(b)])
                bonds_.push_back(on[std::size_t(a)] ? std::array{a, b} : std::array{b, a});
        auto const& net = sim.flow().network();
        for (std::size_t k = 0; k < net.pores(); ++k)
            if (touches(net, k)) pores_.push_back(k);
    }

    /// Force of the packing on the plate in the last step, N.
    double force(simulator const& sim) const {
        double sum = 0;
        for (auto const& [a, b] : bonds_) sum += sim.pair_force(std::size_t(a), std::size_t(b))[axis_];
        auto const& net = sim.flow().network();
        for (std::size_t k : pores_) {
            auto const unit = sim.flow().pore_tractions(k, sim.particles().positions(), sim.particles().radii().data());
            for (std::size_t c = 0; c < 3; ++c)
                if (on_plate_[std::size_t(net.corner[c][k])]) sum += net.pressure[k] * unit[c][axis_];
        }
        return sum;
    }
    /// Sets the velocity of the plate for the next step. \param load towards the packing, N
    void move(simulator& sim, double load) {
        velocity_ += (force(sim) - load - drag_ * velocity_) / mass_ * sim.time_step();
        drive(sim, velocity_);
    }
    /// Sets the velocity of the plate, m/s, whatever the force.
    void drive(simulator& sim, double velocity) {
        velocity_ = velocity;
        for (std::size_t i : particles_) {
            auto v = sim.velocity(i);
            v[axis_] = velocity;
            sim.set_velocity(i, v);
        }
    }

private:
    bool touches(network const& net, std::size_t k) const {
        for (auto const& corner : net.corner)
            if (on_plate_[std::size_t(corner[k])]) return true;
        return false;
    }

    int axis_;
    std::vector<char> on_plate_; ///< by internal index
    double mass_ = 0, drag_ = 0, velocity_ = 0;
    std::vector<std::size_t> particles_, pores_;
    std::vector<std::array<std::int32_t, 2>> bonds_;
};

} // namespace poroelasticity
