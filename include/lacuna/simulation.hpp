// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// First, so that compiler errors about a model or a formula have the shortest include path.
#include <lacuna/core/pack.hpp>
#include <lacuna/simulation/model_check.hpp>

#include <lacuna/model.hpp>
#include <lacuna/observe/observer.hpp>
#include <lacuna/simulation/explicit_stepper.hpp>
#include <lacuna/simulation/forward.hpp>
#include <lacuna/simulation/limits.hpp>
#include <lacuna/simulation/parameters.hpp>
#include <lacuna/simulation/particle_access.hpp>
#include <lacuna/simulation/particle_forces.hpp>
#include <lacuna/simulation/set_up_record.hpp>
#include <lacuna/simulation/simulation_state.hpp>
#include <lacuna/simulation/slot_names.hpp>
#include <lacuna/simulation/step_clock.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// A simulator, composed at compile time from the parts that Model names (see default_model). A Model with a bad part
/// fails to compile with one message, which names the slot.
///
/// A step updates the neighbours, evaluates the forces at the present positions, then moves the particles: see
/// explicit_stepper. `time()` is the time of the positions.
template <class Model>
class simulation : public particle_access<simulation<Model>, typename Model::real, Model::dim> {
public:
    using model_type = Model;
    using real = typename Model::real;
    static constexpr int dim = Model::dim;
    using point = vec<double, dim>;
    using parameters = simulation_parameters<Model>;
    using contact_law_type = typename Model::contact_law;
    using bond_law_type = typename Model::bond_law;
    using damping_type = typename Model::damping;
    using flow_type = typename Model::flow::template solver<typename Model::real, Model::dim>;
    using network_type = pore_network<typename Model::real, Model::dim>;
    using state_type = simulation_state<Model>;
    using store_type = typename state_type::store_type;
    using interactions_type = typename state_type::interactions_type;
    using event_type = break_event<dim>;
    static_assert(detail::refuse_misspelt_slots<Model>());
    static_assert(detail::instantiates_formula<contact_law_type, dim> &&
                  detail::instantiates_formula<bond_law_type, dim>);

    /// \throws std::invalid_argument for a bad packing or parameter; for two particles at the same position; for an
    ///         overlap above guards.overlap_limit; for a particle too far from the origin for the precision
    explicit simulation(packing<real, dim> const& packing, parameters const& p = {})
        : state_(packing, p), clock_(p.start_time) {
        set_up_hash positions;
        for (auto const& x : packing.position) positions.add(x);
        set_up_.positions = positions.value();
    }

    /// \name Actions on particles, by their number in the packing
    /// \{
    /// Gives a particle a velocity, m/s. The ledger counts the change of kinetic energy as external work.
    void set_velocity(std::size_t id, point const& v) {
        note(set_up::velocities);
        state_.motions.forget(internal(id));
        state_.apply_velocity_change(internal(id), v);
    }
    /// Prescribes a particle's velocity and fixes it along the axes. The velocity changes linearly from its present
    /// value to `v` within `ramp_time` from now. The ledger counts the energy that this takes as external work.
    /// \param v m/s
    /// \param ramp_time s; 0: at once
    /// \param axes along which no force accelerates the particle
    /// \throws std::invalid_argument for a velocity that is not finite, and for a negative ramp_time
    void prescribe_velocity(std::size_t id, point const& v, double ramp_time = 0,
                            fixed_axes const& axes = {true, true, true, false}) {
        for (int axis = 0; axis < dim; ++axis) require_finite("velocity of particle " + std::to_string(id), v[axis]);
        require_not_negative("ramp_time of particle " + std::to_string(id), ramp_time);
        fix(id, axes);
        if (!(ramp_time > 0)) return set_velocity(id, v);
        note(set_up::velocities);
        auto const k = internal(id);
        state_.motions.add(k, convert<double>(state_.store.velocity(k)), v, ramp_time, time());
    }
    /// Ends a motion of prescribe_velocity(). The particle keeps its present velocity; only `axes` stay fixed.
    void release(std::size_t id, fixed_axes const& axes = {}) {
        state_.motions.forget(internal(id));
        fix(id, axes);
    }
    /// Gives a particle a spin, rad/s. The ledger counts the change of kinetic energy as external work.
    void set_spin(std::size_t id, vec<double, rotation_dim<dim>> const& w) {
        auto const k = internal(id);
        note(set_up::velocities);
        state_.apply_spin_change(k, w);
    }
    /// Fixes a particle along the given axes: forces do not change its velocity there; set_velocity() still does.
    void fix(std::size_t id, fixed_axes const& axes = fixed_axes::all()) {
        state_.store.fix(internal(id), axes);
        note(set_up::fixed_axes);
        clock_.supports_changed();
    }
    /// Attaches particles to a rigid, smooth plate, see rigid_plates: from now on they move as one along the axis. Do
    /// not give these particles single velocities afterwards.
    void attach_to_rigid_plate(std::span<std::size_t const> ids, int axis) {
        std::vector<std::size_t> particles;
        for (std::size_t const id : ids) particles.push_back(internal(id));
        state_.plates.add(state_.store, std::move(particles), axis);
        note(set_up::plates);
    }
    /// Applies a force and a torque in addition to gravity. They replace those applied before. N, N m.
    /// \param ramp_time the load changes linearly from its present value (zero at first) to the new one in this time,
    ///        s; 0: at once
    void apply(std::size_t id, point const& force, vec<double, rotation_dim<dim>> const& torque, double ramp_time = 0) {
        state_.loads.set(state_.store, internal(id), force, torque, ramp_time, time());
        note(set_up::loads);
    }
    void apply(std::size_t id, point const& force, double torque = 0, double ramp_time = 0)
        requires(dim == 2)
    {
        apply(id, force, vec<double, 1>{torque}, ramp_time);
    }
    void apply(std::size_t id, point const& force)
        requires(dim == 3)
    {
        apply(id, force, point{});
    }
    /// \}

    /// \name Actions on walls, by their number in simulation_parameters::walls; walls() has positions and forces
    /// \{
    /// Moves a wall. Its velocity changes linearly from its present value to `v` within `ramp_time` from now. The
    /// ledger counts the work of the wall as work of prescribed motion.
    /// \param v m/s
    /// \param ramp_time s; 0: at once
    void move_wall(std::size_t w, point const& v, double ramp_time = 0) {
        state_.wall_motions.move(state_.walls, w, v, ramp_time, time());
        note(set_up::walls);
    }
    /// Makes a servo hold the stress on a wall from now on, until move_wall().
    void servo_wall(std::size_t w, wall_servo<dim> const& servo) {
        state_.wall_motions.hold(w, servo);
        note(set_up::walls);
    }
    /// \}

    /// Fills the pores with fluid (models with flow; before the first step).
    /// \param make callable (points_view positions, Real const* radii) -> pore_network, in the simulation's own
    ///        numbering of particles; see triangulate_body() and make_pore_network(). With remeshing the simulation
    ///        stores a copy and calls it for every new mesh: objects to which it refers must stay alive.
    /// \throws std::invalid_argument for flow parameters out of range, and for two particles at the same position
    template <class Make>
    void fill_pores(Make const& make)
        requires(has_fluid<Model>)
    {
        auto const& p = state_.settings;
        auto const require_distinct = [&] {
            require_apart(state_.store.positions(), [&](std::size_t k) { return state_.store.id(k); });
        };
        state_.pairs.keep_normal_forces();
        try {
            state_.fluid.fill(state_.store, state_.pairs, p.flow, p.remeshing, dim == 2 ? p.thickness : 1.0, make);
        } catch (std::exception const&) {
            require_distinct(); // a better message if coinciding particles are the reason
            throw;
        }
        if (!flow().network().bare()) require_distinct();
        clock_.reset();
        set_up_.pores = hash_of_shape(flow().network());
        set_up_.fluid = hash_of_fluid(flow().network());
    }

    /// \name Steps
    /// \{
    /// Advances by one step.
    /// \throws unstable_run when the state is no longer meaningful
    /// \throws std::invalid_argument, std::logic_error before the first step, as resolve_time_step()
    void step() {
        begin();
        take_step<false>();
    }
    /// As step(), and updates the energy ledger.
    void step_with_energy() {
        begin();
        take_step<true>();
    }

    /// Advances by `steps` steps, or until an observer's on_step asks to stop. The results do not depend on
    /// interruptions: a run that is stopped, or resumed from a checkpoint, gives the same bits as an uninterrupted one.
    /// \return the number of steps taken
    /// \throws as step()
    template <observer... Observers>
    long long run(long long steps, Observers&&... observers) {
        (detail::check_observer<simulation, event_type, Observers>(), ...);
        constexpr bool always = (detail::needs_energy<Observers> || ...);
        constexpr bool sometimes = !always && (detail::samples_energy<Observers> || ...);
        begin();
        (detail::notify_start(observers, *this), ...);
        long long taken = 0;
        for (bool go_on = true; go_on && taken < steps; ++taken) {
            if (sometimes && (detail::wants_energy(observers, this->steps()) || ...))
                take_step<always || sometimes>();
            else
                take_step<always>();
            for (auto const& event : state_.events) (detail::notify_break(observers, event, *this), ...);
            (void)std::initializer_list<int>{((go_on = detail::notify_step(observers, *this) && go_on), 0)...};
        }
        (detail::notify_end(observers, *this), ...);
        return taken;
    }

    /// Determines the length of the first step now; otherwise the first step does it. Settings that change before the
    /// first step still have an effect: the first step determines its length again.
    /// \return the length, s
    /// \throws std::invalid_argument for a given time step above the stable limit; and if none is given and nothing has
    ///         a stiffness
    /// \throws std::logic_error for a model with fluid whose pores are not filled
    double resolve_time_step() {
        clock_.resolve(state_);
        return time_step();
    }
    /// Length of the next step, s, unless that step adapts it to the critical one. NaN before resolve_time_step() or
    /// the first step.
    double time_step() const noexcept { return clock_.time_step(); }
    double time() const noexcept { return clock_.time(); }
    long long steps() const noexcept { return clock_.step(); }
    /// \}

    /// Limits of the time step in the present state. They count bonds, the fluid, the model's own forces, and all
    /// contacts of particles and walls that touch or may touch before the limits are computed again. For laws that
    /// stiffen, contacts count with the largest overlap that they may reach until then. See assumed_contacts() and
    /// step_control.
    time_step_limits limits() const { return clock_.limits(state_); }
    /// Assumptions of limits() about contacts.
    contact_assumption assumed_contacts() const { return clock_.assumed_contacts(state_); }
    /// Number of times that the limits of the time step were computed, the first time included.
    long long limit_updates() const noexcept { return clock_.control().updates(); }

    /// Failures of the last step.
    std::span<event_type const> events() const noexcept { return state_.events; }
    /// The energy ledger. It is updated while an observer asks for it (see observe/observer.hpp) and by
    /// step_with_energy().
    energy_ledger const& energy() const noexcept { return state_.ledger.ledger(); }

    /// Force of particle b on particle a by their bond or contact in the last step, N; zero if they have none.
    /// \throws std::logic_error without simulation_parameters::keep_pair_forces
    point pair_force(std::size_t a, std::size_t b) const {
        if (!settings().keep_pair_forces) throw std::logic_error("simulation: pair_force() needs keep_pair_forces");
        auto const i = std::int32_t(internal(a)), j = std::int32_t(internal(b));
        auto const offset = pairs().find_force(i, j);
        point force{};
        for (int axis = 0; offset >= 0 && axis < dim; ++axis)
            force[axis] = (i < j ? 1 : -1) * double(pairs().force_column()[offset + axis]);
        return force;
    }

    /// Total force on a particle at the last evaluation, N: from pairs, fluid, walls, loads, gravity, the model's own
    /// forces and the plate to which it is attached. It excludes damping policies that act on particles.
    /// \throws std::logic_error without simulation_parameters::keep_pair_forces
    point force(std::size_t id) const { return convert<double>(stored_force(id).force); }
    /// Total torque on a particle, N m, as force().
    vec<double, rotation_dim<dim>> torque(std::size_t id) const {
        return convert<double>(stored_force(id).turning) * this->radius(id);
    }

    /// The particles in the library's own order.
    store_type const& particles() const noexcept { return state_.store; }
    interactions_type const& pairs() const noexcept { return state_.pairs; }
    auto const& walls() const noexcept { return state_.walls; }
    parameters const& settings() const noexcept { return state_.settings; }
    /// The pore network and its flow (models with flow).
    auto const& flow() const
        requires(has_fluid<Model>)
    {
        return *state_.fluid.get();
    }
    /// The same, for calls of its set_pressure() and set_source(). Do not step it: the simulation does.
    auto& flow()
        requires(has_fluid<Model>)
    {
        return *state_.fluid.get();
    }
    bool filled() const noexcept { return state_.filled(); }

    /// Record of the calls before the first step; see simulation/checkpoint.hpp.
    set_up_record set_up_so_far() const {
        if (steps() > 0) return set_up_;
        set_up_record found = set_up_;
        if (filled()) {
            auto const now = hash_of_fluid(state_.fluid.get()->network());
            if (now != found.fluid || pressures_were_set(*state_.fluid.get())) found.call(set_up::fluid);
            if (found.was_called(set_up::fluid)) found.result[std::size_t(set_up::fluid)] = now;
        }
        sum_up_particles(found);
        auto const id = [&](std::size_t k) { return state_.store.id(k); };
        auto const hash = [](auto const&... value) { return set_up_hash::of(value...); };
        if (found.was_called(set_up::loads))
            found.result[std::size_t(set_up::loads)] = state_.loads.sum_of_loads(
                [&](std::size_t k, auto const&... value) { return hash(id(k), value...); });
        if (found.was_called(set_up::plates))
            found.result[std::size_t(set_up::plates)] =
                state_.plates.sum_of_plates([&](std::size_t k) { return hash(id(k)); }, hash);
        if (found.was_called(set_up::walls))
            found.result[std::size_t(set_up::walls)] = state_.wall_motions.sum_of_motions(state_.walls, hash);
        return found;
    }
    /// Replaces the record of calls by that of a checkpoint whose state was read.
    void take_set_up(set_up_record const& record) noexcept { set_up_ = record; }

    /// Writes or reads all state that steps and calls change; see simulation/checkpoint.hpp.
    template <class Archive>
    void serialize(Archive& ar) {
        ar(state_, clock_);
        if constexpr (Archive::is_loading::value) state_.pairs.watch_overlaps(clock_.control().assumed().overlap);
    }

private:
    friend class lacuna::equilibrium<Model>; // moves the same state
    using particle_access<simulation, real, dim>::internal;

    /// Up to the first step the length of the step is determined again, so that late settings have an effect.
    void begin() {
        if (steps() == 0) clock_.reset();
        resolve_time_step();
    }
    template <bool WithEnergy>
    void take_step() {
        if (steps() == 0) set_up_ = set_up_so_far();
        explicit_stepper<Model>(state_, clock_).template step<WithEnergy>();
    }

    particle_force<real, dim> stored_force(std::size_t id) const {
        if (!settings().keep_pair_forces) throw std::logic_error("simulation: force() needs keep_pair_forces");
        return total_force(state_.store, state_.pairs, state_.other_forces, internal(id));
    }

    void note(set_up kind) noexcept {
        if (steps() == 0) set_up_.call(kind);
    }
    /// Adds hashes of fixed axes and velocities to a record; the order of the particles does not matter.
    void sum_up_particles(set_up_record& to) const {
        if (!to.was_called(set_up::fixed_axes) && !to.was_called(set_up::velocities)) return;
        auto const& store = state_.store;
        std::uint64_t axes = 0, speeds = 0;
        for (std::size_t k = 0; k < store.size(); ++k) {
            int held = 0;
            for (int axis = 0; axis <= dim; ++axis) held |= (store.mobility(k, axis) == real(0)) << axis;
            if (held) axes += set_up_hash::of(store.id(k), held);
            auto const v = store.velocity(k);
            auto const w = store.spin(k);
            if (squared_norm(v) + squared_norm(w) > real(0)) speeds += set_up_hash::of(store.id(k), v, w);
        }
        speeds += state_.motions.sum_of_motions(
            [&](std::size_t k, auto const&... value) { return set_up_hash::of(-1, store.id(k), value...); });
        if (to.was_called(set_up::fixed_axes)) to.result[std::size_t(set_up::fixed_axes)] = axes;
        if (to.was_called(set_up::velocities)) to.result[std::size_t(set_up::velocities)] = speeds;
    }
    template <class Flow>
    static bool pressures_were_set(Flow const& flow) noexcept {
        if constexpr (requires { flow.values_were_set(); })
            return flow.values_were_set();
        else
            return false;
    }

    state_type state_;
    step_clock<Model> clock_;
    set_up_record set_up_; // of calls before the first step
};

/// \cond
// For a Model that is no model: it derives from a valid simulation, so that the message below is the only one.
template <class Model>
    requires(!model<Model>)
class simulation<Model> : public simulation<default_model<detail::with_slots<Model>::dim>> {
    using slots = detail::with_slots<Model>;
    static constexpr int space = slots::dim;
    static_assert(detail::explain_slots<Model>() && detail::refuse_misspelt_slots<Model>());
    static_assert(detail::explain_law<typename slots::contact_law, space, detail::contact_law_slot>());
    static_assert(detail::explain_law<typename slots::bond_law, space, detail::bond_law_slot>());
    static_assert(detail::explain_damping<typename slots::damping>());
    static_assert(detail::explain_flow<typename slots::flow, space, typename slots::real>());
    static_assert(detail::explain_forces<typename slots::forces, space, typename slots::real>());
    static_assert(detail::explain_integrator<typename slots::integrator, space>());
    static_assert(detail::explain_domain<typename slots::domain, space>());
    static_assert(detail::explain_search<typename slots::template search<typename slots::real, space>>());

public:
    template <class... Arguments>
    explicit simulation(Arguments const&...) : simulation<default_model<space>>({}) {}
};
/// \endcond

LACUNA_END_PACKS

} // namespace lacuna
