// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include <lacuna/core/points.hpp>
#include <lacuna/laws/no_contact.hpp>
#include <lacuna/simulation/guard_parameters.hpp>
#include <lacuna/simulation/guards.hpp>
#include <lacuna/simulation/resolution_watch.hpp>
#include <lacuna/simulation/start_checks.hpp>

namespace lacuna {

/// The guards of a run: their settings and their state.
template <class Model>
class run_guards {
public:
    using real = typename Model::real;
    static constexpr int dim = Model::dim;
    using store_type = particle_store<real, dim>;
    using damping_type = typename Model::damping;

    run_guards() = default;
    /// \throws std::invalid_argument for a packing that cannot be simulated; see start_checks.hpp
    template <class Pairs>
    run_guards(store_type const& store, Pairs const& pairs, guard_parameters const& guards,
               typename damping_type::parameters const& damping, bool allow_unstable_step)
        : guards_(guards), extent_(extent_of(store)), unstable_step_(allow_unstable_step), damped_(damps(damping)) {
        if (guards.resolution) require_resolved(store, extent_);
        start_ = check_start(store, pairs, guards.largest_overlap());
    }

    real smallest_radius() const noexcept { return extent_.smallest_radius; }
    /// Lets the resolution guard follow a particle that was given a velocity; -1: none.
    void follow(store_type const& store, std::int32_t given) noexcept {
        if (given >= 0 && guards_.resolution) resolution_.follow(store, given, real(0.5));
    }

    /// Checks the motion of a step, and overlaps.
    /// \param given fastest of the particles that were given a velocity before this step; -1: none
    /// \return upper bound of the path of every particle in the step, m
    /// \throws unstable_run as the guards require
    template <class Pairs>
    real check_motion(store_type const& store, Pairs const& pairs, std::span<motion_report<real> const> reports,
                      real dt, std::int32_t given, moment const& now) {
        auto const cause = [&](std::int32_t k) { return cause_of_motion(store, pairs, k, double(dt), given, now); };
        auto const moved =
            checked_motion<real, dim>(store, reports, dt, smallest_radius(), guards_.largest_motion(), now, cause);
        growth_.look(store, now.step, moved, 4 * extent_.spacing());
        if (guards_.growth && !unstable_step_) check_growth(store, growth_, moved, smallest_radius(), now);
        if (auto const pair = pairs.deep_overlap(); pair[0] >= 0)
            throw_overlap(store, pairs, pair[0], pair[1], now, cause);
        if constexpr (!is_absent<typename Model::bond_law>) {
            if (now.step % 64 == 63 && guards_.overlap) {
                auto const& bonds = pairs.bonds();
                if (auto const slot = find_deep_bond(store, bonds, guards_.overlap_limit, start_.deep_bonds); slot >= 0)
                    throw_overlap(store, pairs, bonds.i(std::size_t(slot)), bonds.j(std::size_t(slot)), now, cause);
            }
        }
        if (guards_.resolution) check_resolution(store, dt, moved.path, now);
        return moved.path;
    }
    /// \throws unstable_run if an energy is not a number, or energy has no source
    void check_energy(store_type const& store, energy_ledger const& ledger, double dt, moment const& now) const {
        if (!ledger.complete && std::isfinite(ledger.kinetic + ledger.external)) return;
        if (!std::isfinite(ledger.residual()))
            throw_unstable(
                store, now, -1, "an energy is not a number",
                "a stiffness, a mass, a load or a pressure is so large or so small that it leaves the range of " +
                    precision_text<real>());
        if (!guards_.energy || unstable_step_ || !(ledger.residual() > 0.5 * ledger.largest())) return;
        // In each step rounding may add the energy of particles that move by one spacing of numbers per step.
        double mass = 0;
        for (std::size_t k = 0; k < store.size(); ++k) mass += double(store.mass(k));
        double const speed = double(extent_.spacing()) / dt;
        lacuna::check_energy(store, ledger, 0.5 * mass * speed * speed * double(16 + now.step), now);
    }
    /// Callable () -> result of crushed_bond().
    template <class Pairs>
    static auto crushed(store_type const& store, Pairs const& pairs) {
        return [&store, &pairs] { return crushed_bond<typename Model::bond_law>(store, pairs); };
    }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(growth_, resolution_);
    }
    bool fit(std::size_t count) const noexcept { return growth_.fits(count) && resolution_.fits(count); }

private:
    template <class Pairs, class Cause>
    [[noreturn]] void throw_overlap(store_type const& store, Pairs const& pairs, std::int32_t i, std::int32_t j,
                                    moment const& now, Cause const& cause) const {
        double const limit = guards_.overlap_limit;
        std::string why = bond_between<typename Model::bond_law>(store, pairs, i, j);
        if (why.empty()) why = "the load or the speed is too high for the contact stiffness; or " + cause(i);
        throw_unstable(store, now, i,
                       "it overlaps another particle by more than " +
                           (limit == 1 ? "a radius" : to_text(limit) + " of a radius") + ": particle " +
                           std::to_string(store.id(std::size_t(j))) + " at " + to_text(store.position(std::size_t(j))) +
                           " m, by " + to_text(double(overlap_of(store, i, j))) + " of the smaller radius",
                       why);
    }
    void check_resolution(store_type const& store, real dt, real path, moment const& now) {
        if (now.step % 64 == 0 && !resolution_.follows()) {
            auto k = resolution_.find_held(store, dt);
            real change = 0;
            if (k < 0 && !damped_ && path > 0 && path < extent_.spacing()) {
                k = fastest_particle(store);
                change = 4 * std::numeric_limits<real>::epsilon();
            }
            if (k >= 0) resolution_.follow(store, k, change);
            return; // the watch begins with the next step
        }
        auto const lost = resolution_.look(store, double(dt));
        if (lost.particle < 0) return;
        auto const velocity = store.velocity(std::size_t(lost.particle));
        throw_unstable(store, now, lost.particle,
                       "its motion is lost to rounding: at a velocity of " + to_text(velocity) + " m/s it moved " +
                           to_text(lost.actual) + " m instead of " + to_text(lost.expected) + " m, by steps of " +
                           to_text(double(norm(velocity)) * double(dt)) + " m where numbers of " +
                           precision_text<real>() + " are " + to_text(lost.spacing) + " m apart",
                       std::string("it is too far from the origin: shift the body to the origin, ") +
                           (sizeof(real) < 8 ? "use double precision, " : "") + "or take a longer time step");
    }
    /// Whether there is damping. Damping can keep small velocities of a packing at rest alive that are no real motion.
    static bool damps(typename damping_type::parameters const& p) {
        bool any = damping_type::particle_force(p, 1.0, -1.0) != 0;
        if constexpr (damping_type::acts_on_pairs) any = any || damping_type::pair_force(p, 1.0, 1.0, 1.0, 1.0) != 0;
        if constexpr (requires { damping_type::drag_rate(p); }) any = any || damping_type::drag_rate(p) != 0;
        return any;
    }
    /// Text with the likely reasons why particle k, or any particle for -1, is so fast.
    template <class Pairs>
    std::string cause_of_motion(store_type const& store, Pairs const& pairs, std::int32_t k, double dt,
                                std::int32_t given, moment const& now) const {
        std::string found;
        auto const add = [&](std::string const& text) { found += (found.empty() ? "" : "; ") + text; };
        if (k >= 0) {
            auto const at = std::size_t(k);
            auto const force = store.applied_force(at);
            bool held = false;
            for (int axis = 0; axis < dim; ++axis)
                held = held || (store.held(at, axis) && store.velocity(at)[axis] != 0);
            if (held) add("the velocity that is prescribed to it");
            if (k == given) add("the velocity that it was given");
            if (double(norm(force)) / double(store.mass(at)) * dt * dt > 0.05 * double(store.radius(at)))
                add("the load on it, " + to_text(force) + " N, is large for its mass");
        }
        if (growth_.runs_away()) add(growth_text() + ": the time step is above the stable one");
        if (std::string const bond = crushed(store, pairs)(); !bond.empty()) add(bond);
        if (start_.deepest > 0.01 && now.step < 1000)
            add("particles that overlap at the start push each other apart, most of all " +
                std::to_string(start_.particles[0]) + " and " + std::to_string(start_.particles[1]) + ", by " +
                to_text(start_.deepest) + " of the smaller radius");
        return found.empty()
                   ? "the time step is above the stable one, or a load, a velocity or a stiffness is very large"
                   : found;
    }

    guard_parameters guards_;
    body_extent<real> extent_;
    start_pairs start_;
    growth_watch<real, dim> growth_;
    resolution_watch<real, dim> resolution_;
    bool unstable_step_ = false, damped_ = false;
};

} // namespace lacuna
