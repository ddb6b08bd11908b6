// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <lacuna/core/parallel.hpp>
#include <lacuna/simulation/force_terms.hpp>
#include <lacuna/simulation/particle_forces.hpp>
#include <lacuna/simulation/paths.hpp>
#include <lacuna/simulation/simulation_state.hpp>
#include <lacuna/simulation/step_clock.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// One explicit step of a model's state: forces from the positions, velocities from the forces, positions from the
/// velocities.
/// \code
/// explicit_stepper<Model>(state, clock).template step<WithEnergy>();
/// \endcode
///
/// Most of a model's code is in step() and in resolve() and limits() of step_clock. A program of several files can
/// compile these three once, with `extern template`; see examples/cartilage/run/cartilage_model.hpp.
template <class Model>
class explicit_stepper {
public:
    using state_type = simulation_state<Model>;
    using real = typename Model::real;
    static constexpr int dim = Model::dim;

    /// \param clock its time step must be resolved
    explicit_stepper(state_type& state, step_clock<Model>& clock) : s_(state), clock_(clock) {}

    /// Makes one step.
    /// \tparam WithEnergy whether the energy ledger is updated
    /// \throws unstable_run when the state is no longer meaningful
    template <bool WithEnergy>
    void step();

private:
    bool update_neighbours() {
        bool const changed = s_.pairs.update(s_.store);
        if (changed || s_.walls.outdated(s_.store)) s_.update_walls();
        return changed;
    }

    void apply_prescribed_motion() {
        s_.loads.advance(s_.store, clock_.time());
        s_.motions.advance(clock_.time(), clock_.time_step(),
                           [&](std::size_t k, vec<double, dim> const& v) { s_.apply_velocity_change(k, v); });
    }

    void prepare_forces() {
        for (auto& r : s_.reports) r = {};
        other_forces_act_ = force_terms::any_active(s_);
        velocities_on_time_ = s_.settings.velocities_on_time && (clock_.step() == 0 || !s_.changes.empty());
        s_.pairs.set_force_retention(s_.store, !s_.settings.keep_pair_forces, s_.settings.threads);
    }

    bool nothing_else_reads_forces() const noexcept {
        return !other_forces_act_ && s_.changes.empty() && !velocities_on_time_ && dt_ == previous_ &&
               s_.pairs.spans().count() == s_.settings.threads;
    }

    /// Calls finish(chunk) for each chunk once its forces are known. A pair belongs to its lower-numbered particle.
    /// Hence no later chunk reads the particles of a chunk whose pairs are evaluated, and `finish` can move them while
    /// they and their forces are in the cache.
    template <bool WithEnergy, class Finish>
    void evaluate_spans(Finish const& finish) {
        auto const& spans = s_.pairs.spans();
        for_each_chunk(spans.count(), s_.settings.threads, [&](int span) {
            for (int c = spans.begin(span); c < spans.end(span); ++c) {
                s_.pairs.template evaluate<WithEnergy>(s_.store, c, previous_);
                if (!spans.waits(c)) finish(c);
            }
        });
        for_each_chunk(spans.count(), s_.settings.threads, [&](int span) {
            for (int c = spans.begin(span); c < spans.end(span); ++c)
                if (spans.waits(c)) finish(c);
        });
    }

    template <bool WithEnergy>
    void compute_pair_forces_and_move() {
        evaluate_spans<WithEnergy>([&](int c) {
            s_.pairs.for_fresh_force_sums(c, [&](auto const& force) { move_chunk<WithEnergy>(c, force, nullptr); });
        });
    }

    /// Slip increments use the previous time step.
    template <bool WithEnergy>
    void compute_pair_forces() {
        if (s_.pairs.forces_are_transient()) {
            s_.pairs.prepare_force_sums(s_.store);
            evaluate_spans<WithEnergy>([&](int c) { s_.pairs.keep_force_sums(s_.store, c); });
        } else {
            for_each_chunk(s_.pairs.chunks(), s_.settings.threads,
                           [&](int c) { s_.pairs.template evaluate<WithEnergy>(s_.store, c, previous_); });
        }
    }

    template <bool WithEnergy>
    void compute_other_forces(force_step<real>& step) {
        if (other_forces_act_) force_terms::template add_forces<WithEnergy>(s_, step);
    }

    void move_walls() {
        if (s_.walls.empty()) return;
        double const dt = double(dt_);
        s_.wall_motions.advance(s_.walls, clock_.time(), dt);
        s_.wall_power = s_.walls.advance(dt);
        double const share = s_.walls.fastest() * dt / double(s_.guards.smallest_radius());
        if (double const limit = s_.settings.guards.largest_motion(); share > limit)
            throw_unstable(s_.store, clock_.now(), -1,
                           "a wall moved " + to_text(share) + " of the smallest radius in one step (limit " +
                               to_text(limit) + ")",
                           "its velocity is too high");
    }

    /// Shifts velocities that were given since the last step to the times of the integrator, and accounts for a step
    /// whose length differs from the last.
    template <bool WithEnergy>
    void correct_for_velocity_changes() {
        s_.changes.swap_in_new(s_.store, [&]([[maybe_unused]] auto const& change) {
            if constexpr (WithEnergy) s_.ledger.book_work(work_of(change));
        });
        if (velocities_on_time_) shift_to_half_step((previous_ + dt_) / 4);
        if (dt_ != previous_) shorten_half_kick((dt_ - previous_) / 2);
        fastest_given_ = s_.changes.fastest(s_.store);
        s_.guards.follow(s_.store, fastest_given_);
        s_.changes.clear();
    }
    /// Work that the ledger misses for a changed velocity, because its terms of this step use the new velocity alone,
    /// J.
    double work_of(velocity_change<real, dim> const& c) const {
        auto const whole = force_on(c.particle);
        auto const change = s_.store.velocity(c.particle) - c.velocity;
        auto applied = s_.store.applied_force(c.particle);
        if constexpr (requires { s_.own_forces.force(c.particle); }) applied += s_.own_forces.force(c.particle);
        double work = double(dot(whole.force - applied, change));
        auto const spin_change = (s_.store.spin(c.particle) - c.spin) * s_.store.radius(c.particle);
        for (int axis = 0; axis < rotation_dim<dim>; ++axis) {
            real const torque = dim == 2 ? s_.store.load(c.particle)[2]
                                : s_.store.torques().size() > 0 ? s_.store.torques().at(c.particle, axis) : real(0);
            work += double((whole.turning[axis] - torque) * spin_change[axis]);
        }
        return 0.5 * double(previous_) * work;
    }
    /// Shifts velocities that were given at the time of the positions back by half a step.
    void shift_to_half_step(real half_step) {
        std::vector<char> done(2 * s_.store.size(), 0); // velocities, spins
        auto const once = [&](std::size_t k, bool spin) {
            if (std::exchange(done[2 * k + spin], char(1))) return;
            spin ? set_spin_back(s_.store, force_on(k), k, half_step)
                 : set_velocity_back(s_.store, force_on(k), k, half_step);
        };
        for (auto const& c : s_.changes) once(c.particle, c.of_spin);
        for (std::size_t k = 0; clock_.step() == 0 && k < s_.store.size(); ++k)
            for (bool const spin : {false, true}) once(k, spin);
    }
    /// Corrects velocities for a change of the step length. From the middle of one step to the middle of the next it is
    /// half of each length, but the integrator accelerates for the whole new step. Takes back the surplus.
    /// \param too_long surplus time, s; negative: the acceleration is too short
    void shorten_half_kick(real too_long) {
        for (std::size_t k = 0; k < s_.store.size(); ++k) {
            auto const force = force_on(k);
            set_velocity_back(s_.store, force, k, too_long);
            set_spin_back(s_.store, force, k, too_long);
        }
    }
    particle_force<real, dim> force_on(std::size_t k) const {
        return total_force(s_.store, s_.pairs, s_.other_forces, k);
    }

    template <bool WithEnergy>
    void move_particles() {
        if constexpr (WithEnergy) s_.own_power[0] = own_power();
        record_column<real> const* other = other_forces_act_ ? &s_.other_forces : nullptr;
        for_each_chunk(s_.pairs.chunks(), s_.settings.threads, [&](int c) {
            s_.pairs.for_force_sums(c, [&](auto const& force) { move_chunk<WithEnergy>(c, force, other); });
        });
        if constexpr (WithEnergy) s_.own_power[1] = own_power();
    }
    double own_power() const {
        if constexpr (requires { s_.own_forces.power(s_.store); })
            return s_.own_forces.active() ? s_.own_forces.power(s_.store) : 0;
        else
            return 0;
    }
    template <bool WithEnergy, class PairForce>
    void move_chunk(int chunk, PairForce const& pair_force, record_column<real> const* other) {
        constexpr std::size_t chunk_particles = state_type::interactions_type::chunk_particles;
        std::size_t const first = std::size_t(chunk) * chunk_particles;
        int const count = int(std::min(s_.store.size() - first, chunk_particles));
        Model::integrator::template advance<WithEnergy, typename Model::damping>(
            s_.store, first, count, dt_, pair_force, s_.settings.damping, other, s_.reports[std::size_t(chunk)]);
    }

    void collect_failures() {
        auto const found = s_.pairs.collect_events();
        s_.events.assign(found.begin(), found.end());
        for (auto& e : s_.events) {
            e.step = clock_.step();
            e.time = clock_.time();
        }
    }

    /// \return upper bound of the path of every particle, m
    real check_motion() {
        real const path = s_.guards.check_motion(s_.store, s_.pairs, s_.reports, dt_, fastest_given_, clock_.now());
        count_paths(s_, dt_);
        return path;
    }

    static constexpr bool laws_state_energies =
        (is_absent<typename Model::contact_law> || states_energies<typename Model::contact_law, dim>) &&
        (is_absent<typename Model::bond_law> || states_energies<typename Model::bond_law, dim>);
    template <bool WithEnergy>
    void book_energy() {
        if constexpr (WithEnergy) {
            auto energy = s_.pairs.energy();
            energy += s_.wall_energy;
            s_.ledger.keep(energy, s_.pairs.fracture_energy(), s_.reports, double(previous_), double(dt_),
                           s_.fluid.get(), s_.wall_power, s_.own_power, laws_state_energies);
            s_.guards.check_energy(s_.store, s_.ledger.ledger(), double(dt_), clock_.now());
        } else {
            s_.ledger.close();
        }
    }

    void check_fluid([[maybe_unused]] bool pairs_changed) const {
        if constexpr (has_fluid<Model>)
            if (s_.settings.guards.pores && s_.settings.remeshing.rule == remesh_rule::never &&
                (pairs_changed || clock_.step() % 64 == 63))
                check_pores(s_.store, s_.fluid.get()->network(), clock_.now(), s_.guards.crushed(s_.store, s_.pairs));
    }

    state_type& s_;
    step_clock<Model>& clock_;
    real previous_ = 0, dt_ = 0; // lengths of the last step and of this one, s
    bool other_forces_act_ = false, velocities_on_time_ = false;
    std::int32_t fastest_given_ = -1; // fastest particle that was given a velocity since the last step; -1: none
};
// Outside the class, because each file would compile an inline member in spite of `extern template`.
template <class Model>
template <bool WithEnergy>
void explicit_stepper<Model>::step() {
    bool const pairs_changed = update_neighbours();
    previous_ = real(clock_.previous_step());
    dt_ = real(clock_.begin_step(s_)); // follows or keeps the time step
    apply_prescribed_motion();
    prepare_forces();
    force_step<real> forces{clock_.now(), previous_, pairs_changed};
    if (nothing_else_reads_forces()) {
        compute_pair_forces_and_move<WithEnergy>(); // fused: forces are used while in cache
    } else {
        s_.changes.swap_in_old(s_.store);
        compute_pair_forces<WithEnergy>();
        compute_other_forces<WithEnergy>(forces); // fluid, moments, walls, the model's own, plates
        move_walls();
        correct_for_velocity_changes<WithEnergy>();
        move_particles<WithEnergy>();
    }
    collect_failures();
    real const max_displacement = check_motion();
    book_energy<WithEnergy>();
    check_fluid(pairs_changed);
    clock_.end_step(s_, max_displacement, forces.remeshed);
}
LACUNA_END_PACKS

} // namespace lacuna
