// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <concepts>

#include <lacuna/core/records.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

/// Summary of the motion of one chunk of particles in one step.
template <class Real>
struct motion_report {
    record<Real> fastest{Real(0)}; ///< largest |velocity| by component, m/s; in 2D the third is the surface speed
    record<Real> turning{Real(0)}; ///< 3D: largest surface speed by component, m/s
    record<Real> poison{Real(0)};  ///< zero, or not-a-number if a velocity is not finite
    double kinetic = 0;            ///< kinetic energy at the time of the forces, J
    double rotation = 0;           ///< part of it due to spins, J
    double load_before = 0;        ///< power of loads and prescribed motion with the old velocity, W
    double load_after = 0;         ///< the same with the new velocity, W
    double held_before = 0;        ///< part of load_before due to prescribed motion, W
    double held_after = 0;         ///< part of load_after due to prescribed motion, W
    double damping_before = 0;     ///< power of the particles' damping force with the old velocity, W
    double damping_after = 0;      ///< the same with the new velocity, W
};

/// The semi-implicit (symplectic) Euler step of the paper's eq. 3 to 8: the new velocity follows from the old force,
/// the new position from the new velocity. Velocities belong to the time half a step before the positions: this is the
/// leapfrog scheme, of second order.
struct symplectic_euler {
    /// Advances `count` particles of one block (particle_store::load_block) by one step, from particle `first` on.
    /// \param pair_force callable: pair_force(k) is the sum of the pair forces on particle first + k, torques over
    ///        radius, N; a record in 2D, {force, torque over radius} in 3D
    /// \param extra other forces of this step, N, or nullptr; per particle one record {F_x, F_y, torque over radius, 0}
    ///        in 2D, two records (force, torque over radius) in 3D
    template <bool WithEnergy, class Damping, class Real, int Dim, class PairForce>
    [[gnu::noinline, gnu::flatten]] static void
    advance(particle_store<Real, Dim>& store, std::size_t first, int count, Real time_step, PairForce const& pair_force,
            typename Damping::parameters const& damping, record_column<Real> const* extra,
            motion_report<Real>& report) {
        using rec = record<Real>;
        rec dt(time_step);
        rec path(time_step); // the fourth lane holds the radius
        path.v[3] = 0;
        rec fastest(Real(0)), poison(Real(0));
        [[maybe_unused]] rec spinning(Real(0));
        Real const* loads = store.loads_of(first);
        [[maybe_unused]] bool const torqued = store.torques().size() > 0;
        for (int k = 0; k < count; ++k) {
            std::size_t const p = first + std::size_t(k);
            rec position = store.particle_records().of(p, 0), velocity = store.particle_records().of(p, 1);
            rec load(Real(0));
            if (loads) load = rec::load(loads + 4 * k);
            if constexpr (Dim == 2) {
                rec force = pair_force(k) + load;
                if (extra) force += (*extra)[p];
                rec drag = damping_force<Damping>(damping, force, velocity, [&] { return store.inverse_mass(p); });
                if constexpr (Damping::acts_on_particles) force += drag;
                rec next = velocity + force * store.inverse_mass(p) * dt;
                store.particle_records().set(p, next, 1);
                store.particle_records().set(p, position + next * path, 0);
                fastest = max(abs(next), fastest);
                poison += next * rec(Real(0));
                if constexpr (WithEnergy) add_energy(store, p, velocity, next, load, force, drag, report);
            } else {
                auto [force, torque] = pair_force(k);
                force += load;
                rec torque_load(Real(0));
                if (torqued) torque += torque_load = store.torques()[p];
                if (extra) {
                    force += (*extra)[2 * p];
                    torque += (*extra)[2 * p + 1];
                }
                rec drag = damping_force<Damping>(damping, force, velocity, [&] { return store.inverse_mass(p); });
                if constexpr (Damping::acts_on_particles) force += drag;
                rec next = velocity + force * store.inverse_mass(p) * dt;
                store.particle_records().set(p, next, 1);
                store.particle_records().set(p, position + next * path, 0);
                rec spin = store.surface_speeds()[p];
                rec brake = damping_force<Damping>(damping, torque, spin, [&] { return store.inverse_rotary(p); });
                if constexpr (Damping::acts_on_particles) torque += brake;
                rec next_spin = spin + torque * store.inverse_rotary(p) * dt;
                store.surface_speeds().set(p, next_spin);
                store.quaternions().set(p, rotate(store.quaternions()[p], next_spin, time_step / store.radius(p)));
                fastest = max(abs(next), fastest);
                spinning = max(abs(next_spin), spinning);
                poison += (next + next_spin) * rec(Real(0));
                if constexpr (WithEnergy) {
                    add_energy(store, p, velocity, next, load, force, drag, report);
                    for (int axis = 0; axis < 3; ++axis)
                        add_freedom(surface_inertia(store, p), store.mobility(p, 3) == Real(0), spin[axis],
                                    next_spin[axis], double(torque_load[axis]), torque[axis], brake[axis], true,
                                    report);
                }
            }
        }
        report.fastest = fastest;
        if constexpr (Dim == 3) report.turning = spinning;
        report.poison = poison;
    }

private:
    /// \param inverse_inertia callable () -> record; 0 where held
    template <class Damping, class Real, class Inverse>
    static record<Real> damping_force(typename Damping::parameters const& damping, record<Real> const& force,
                                      record<Real> const& velocity, [[maybe_unused]] Inverse const& inverse_inertia) {
        if constexpr (requires { requires Damping::needs_inertia; }) {
            record<Real> inverse = inverse_inertia(), zero(Real(0)), one(Real(1));
            auto free = inverse > zero;
            return Damping::particle_force(damping, force, velocity,
                                           select(free, one / select(free, inverse, one), zero));
        } else {
            return Damping::particle_force(damping, force, velocity);
        }
    }

    /// The paper's eq. 8 in space: the unit quaternion q rotated by spin * dt, renormalised.
    template <class Real>
    static record<Real> rotate(record<Real> const& q, record<Real> const& w, Real time_step) {
        Real const h = Real(0.5) * time_step;
        record<Real> r;
        r.v[0] = q[0] - h * (w[0] * q[1] + w[1] * q[2] + w[2] * q[3]);
        r.v[1] = q[1] + h * (w[0] * q[0] + w[1] * q[3] - w[2] * q[2]);
        r.v[2] = q[2] + h * (w[1] * q[0] + w[2] * q[1] - w[0] * q[3]);
        r.v[3] = q[3] + h * (w[2] * q[0] + w[0] * q[2] - w[1] * q[1]);
        return r * record<Real>(Real(1) / std::sqrt(sum(r * r)));
    }

    /// Inertia for the surface speed, I / r^2, kg.
    template <class Real, int Dim>
    static double surface_inertia(particle_store<Real, Dim> const& store, std::size_t p) {
        return double(store.moment_of_inertia(p)) / (double(store.radius(p)) * double(store.radius(p)));
    }

    /// The kinetic energy at the time of the positions is 1/2 m times the product of the velocities half a step before
    /// and after. With it, and with work as mean force times displacement, the energy balance of a linear system closes
    /// up to rounding in this scheme. A prescribed motion does the work of its reaction, which is minus the force.
    template <class Real, int Dim>
    static void add_energy(particle_store<Real, Dim> const& store, std::size_t p, record<Real> const& before,
                           record<Real> const& after, record<Real> const& load, record<Real> const& force,
                           record<Real> const& drag, motion_report<Real>& report) {
        for (int axis = 0; axis < 3; ++axis) {
            bool const rotation = Dim == 2 && axis == 2;
            add_freedom(rotation ? surface_inertia(store, p) : double(store.mass(p)),
                        store.mobility(p, axis) == Real(0), before[axis], after[axis], load[axis], force[axis],
                        drag[axis], rotation, report);
        }
    }

    template <class Real>
    static void add_freedom(double inertia, bool held, double before, double after, double load, double force,
                            double drag, bool rotation, motion_report<Real>& report) {
        double const reaction = held ? -force : 0, outside = load + reaction;
        double const kinetic = 0.5 * inertia * before * after;
        report.kinetic += kinetic;
        if (rotation) report.rotation += kinetic;
        report.held_before += reaction * before;
        report.held_after += reaction * after;
        report.load_before += outside * before;
        report.load_after += outside * after;
        report.damping_before += drag * before;
        report.damping_after += drag * after;
    }
};

namespace detail {
template <int Dim>
struct any_pair_force {
    record<double> operator()(int) const { return {}; }
};
template <>
struct any_pair_force<3> {
    struct force_and_torque {
        record<double> force, torque;
    };
    force_and_torque operator()(int) const { return {}; }
};
struct any_damping {
    struct parameters {};
    static constexpr bool acts_on_pairs = false;
    static constexpr bool acts_on_particles = false;
    template <class T>
    static T particle_force(parameters const&, T const&, T const&) {
        return T(0);
    }
};
template <class I, int Dim, bool WithEnergy>
concept integrator_advance = requires(particle_store<double, Dim>& store, record_column<double> const* extra,
                                      motion_report<double>& report, any_damping::parameters const& damping,
                                      any_pair_force<Dim> const& pair_force) {
    I::template advance<WithEnergy, any_damping>(store, std::size_t(0), 1, 1.0, pair_force, damping, extra, report);
};
} // namespace detail

/// Requirements on an integrator, such as symplectic_euler and velocity_verlet. It advances the particles of a chunk by
/// one step and fills a report; see symplectic_euler::advance() and motion_report.
template <class I, int Dim = 2>
concept integrator = detail::integrator_advance<I, Dim, false> && detail::integrator_advance<I, Dim, true>;

} // namespace lacuna
