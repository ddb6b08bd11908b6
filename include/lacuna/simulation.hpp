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

// First, so that a compiler that refuses a model or a formula has the shortest way to say where.
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
/// A simulator, composed at compile time from the parts that Model names (see default_model). A Model with a bad part is refused
/// with one message, which names the slot.
///
/// A step updates neighbours, evaluates forces at the positions at its beginning, then moves the particles: see explicit_stepper.
/// `time()` is the time of the positions.
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
    static_assert(detail::instantiates_formula<contact_law_type, dim> && detail::instantiates_formula<bond_law_type, dim>);

    /// \throws std::invalid_argument for a bad packing or parameter; for particles that are at the same place, overlap by
    ///         more than guards.overlap_limit, or are too far from the origin for the precision
    explicit simulation(packing<real, dim> const& packing, parameters const& p = {}) : state_(packing, p), clock_(p.start_time) {
        set_up_hash positions;
        for (auto const& x : packing.position) positions.add(x);
        set_up_.places = positions.value();
    }

    /// \name Acting on particles, by the number they have in the packing
    /// \{
    /// Gives a particle a velocity, m/s; the ledger books the kinetic energy as work from outside.
    void set_velocity(std::size_t id, point const& v) {
        note(set_up::velocities);
        state_.motions.forget(internal(id));
        state_.apply_velocity_change(internal(id), v);
    }
    /// Prescribes a particle's velocity, and fixes it along the axes: from the one it has it changes linearly to v
    /// within ramp_time, from now on; 0: at once. m/s, s. The ledger books what it takes as work from outside.
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
    /// Ends what prescribe_velocity() began: the particle keeps the velocity it has, and `axes` alone stay fixed.
    void release(std::size_t id, fixed_axes const& axes = {}) {
        state_.motions.forget(internal(id));
        fix(id, axes);
    }
    /// Gives a particle a spin, rad/s; the ledger books the kinetic energy as work from outside.
    void set_spin(std::size_t id, vec<double, rotation_dim<dim>> const& w) {
        auto const k = internal(id);
        note(set_up::velocities);
        state_.apply_spin_change(k, w);
    }
    /// Prescribes the motion along the given axes: there the particle keeps the velocity it has or is given.
    void fix(std::size_t id, fixed_axes const& axes = fixed_axes::all()) {
        state_.store.fix(internal(id), axes);
        note(set_up::fixed_axes);
        clock_.supports_changed();
    }
    /// Attaches particles to a rigid, smooth plate, see rigid_plates: from now on they move as one along the axis. They
    /// are not to be given velocities of their own afterwards.
    void attach_to_rigid_plate(std::span<std::size_t const> ids, int axis) {
        std::vector<std::size_t> particles;
        for (std::size_t const id : ids) particles.push_back(internal(id));
        state_.plates.add(state_.store, std::move(particles), axis);
        note(set_up::plates);
    }
    /// Applies a force and a torque on top of gravity; replaces the ones applied before. N, N m.
    /// \param ramp_time within which the load changes linearly from its present value, at first zero, to this, s; 0: at once
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

    /// \name Acting on walls, by their number in simulation_parameters::walls; see walls() for their positions and forces
    /// \{
    /// Moves a wall: from the velocity it has to v, linearly within ramp_time from now on; 0: at once. m/s, s. The ledger
    /// books its work as that of prescribed motion.
    void move_wall(std::size_t w, point const& v, double ramp_time = 0) {
        state_.wall_motions.move(state_.walls, w, v, ramp_time, time());
        note(set_up::walls);
    }
    /// Lets a servo hold the stress on a wall from now on, until move_wall().
    void servo_wall(std::size_t w, wall_servo<dim> const& servo) {
        state_.wall_motions.hold(w, servo);
        note(set_up::walls);
    }
    /// \}

    /// Fills the pores with fluid (models with flow; before the first step).
    /// \param make callable (points_view positions, Real const* radii) -> pore_network, in the simulation's own
    ///        numbering of particles; see triangulate_body() and make_pore_network(). With remeshing a copy is kept,
    ///        and called again whenever the mesh is made anew: what it refers to has to stay.
    /// \throws std::invalid_argument for flow parameters out of range, and for two particles at the same place
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
            require_distinct(); // names them, where they are what no mesh can be made of
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
    /// \throws unstable_run when the state is no longer meaningful; std::invalid_argument as resolve_time_step()
    void step() {
        begin();
        take_step<false>();
    }
    /// As step(), and keeps the energy ledger.
    void step_with_energy() {
        begin();
        take_step<true>();
    }

    /// Advances by `steps` steps, or until an observer's on_step asks to stop. A run that was stopped, or resumed from a
    /// checkpoint, and goes on to the same last step counts as the same run: it has the same bits.
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

    /// Sets the length of the first step now; else that step does. What is set later, before that step, still counts.
    /// \return the length, s
    /// \throws std::invalid_argument for a given time step above the stable limit, and for none given where nothing has a
    ///         stiffness; std::logic_error for a model with fluid whose pores are not filled
    double resolve_time_step() {
        clock_.resolve(state_);
        return time_step();
    }
    /// Length of the next step, unless it has to follow the critical one, s; not a number before it is resolved.
    double time_step() const noexcept { return clock_.time_step(); }
    double time() const noexcept { return clock_.time(); }
    long long steps() const noexcept { return clock_.step(); }
    /// \}

    /// Limits of the time step in the present state, as the clock counts them: bonds, contacts of particles and walls
    /// that touch or may before the next look, the fluid, and the model's own forces; with laws that stiffen, contacts are
    /// taken to be as deep as they may get until then. See assumed_contacts() and step_control.
    time_step_limits limits() const { return clock_.limits(state_); }
    /// What limits() assumes of contacts.
    contact_assumption assumed_contacts() const { return clock_.assumed_contacts(state_); }
    /// How often the limits of the time step were looked for, the first time included.
    long long looks() const noexcept { return clock_.control().looks(); }

    /// Failures of the last step.
    std::span<event_type const> events() const noexcept { return state_.events; }
    /// Kept while an observer asks for it (see observe/observer.hpp), or step_with_energy() is used.
    energy_ledger const& energy() const noexcept { return state_.ledger.ledger(); }

    /// Force of particle b on particle a by their bond or contact in the last step, N; zero without one.
    /// \throws std::logic_error when forces are not kept: see simulation_parameters::keep_pair_forces
    point pair_force(std::size_t a, std::size_t b) const {
        if (!settings().keep_pair_forces) throw std::logic_error("simulation: pair_force() needs keep_pair_forces");
        auto const i = std::int32_t(internal(a)), j = std::int32_t(internal(b));
        auto const offset = pairs().find_force(i, j);
        point force{};
        for (int axis = 0; offset >= 0 && axis < dim; ++axis)
            force[axis] = (i < j ? 1 : -1) * double(pairs().force_column()[offset + axis]);
        return force;
    }

    /// Total force on a particle, and torque, at the last evaluation, N, N m: of pairs, fluid, walls, loads, gravity, the
    /// model's own forces and the plate that it is attached to; not of damping policies that act on particles.
    /// \throws std::logic_error when forces are not kept: see simulation_parameters::keep_pair_forces
    point force(std::size_t id) const { return convert<double>(kept_force(id).force); }
    vec<double, rotation_dim<dim>> torque(std::size_t id) const { return convert<double>(kept_force(id).turning) * this->radius(id); }

    /// The particles as the step sees them, in the library's own order.
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
    /// The same, for its set_pressure() and set_source(); steps are the simulation's.
    auto& flow()
        requires(has_fluid<Model>)
    {
        return *state_.fluid.get();
    }
    bool filled() const noexcept { return state_.filled(); }

    /// What it was given before its first step; see simulation/checkpoint.hpp.
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
    /// After the state of a checkpoint was read: its record is this one's from now on.
    void take_set_up(set_up_record const& record) noexcept { set_up_ = record; }

    /// Writes or reads all that steps and calls change; see simulation/checkpoint.hpp.
    template <class Archive>
    void serialize(Archive& ar) {
        ar(state_, clock_);
        if constexpr (Archive::is_loading::value) state_.pairs.watch_overlaps(clock_.control().assumed().overlap);
    }

private:
    using particle_access<simulation, real, dim>::internal;

    /// What was set since the time step was first asked for counts, up to the first step.
    void begin() {
        if (steps() == 0) clock_.reset();
        resolve_time_step();
    }
    template <bool WithEnergy>
    void take_step() {
        if (steps() == 0) set_up_ = set_up_so_far();
        explicit_stepper<Model>(state_, clock_).template step<WithEnergy>();
    }

    particle_force<real, dim> kept_force(std::size_t id) const {
        if (!settings().keep_pair_forces) throw std::logic_error("simulation: force() needs keep_pair_forces");
        return total_force(state_.store, state_.pairs, state_.other_forces, internal(id));
    }

    void note(set_up kind) noexcept {
        if (steps() == 0) set_up_.call(kind);
    }
    /// Held axes and velocities, of the particles in any order.
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
    set_up_record set_up_; ///< up to the first step
};

/// \cond
// What is no model: the first message is the only one, as what the program goes on to do is checked against another.
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
