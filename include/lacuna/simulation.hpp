// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// First, so that a compiler that refuses a model or a formula has the shortest way to say where.
#include <lacuna/core/pack.hpp>
#include <lacuna/simulation/model_check.hpp>

#include <lacuna/core/parallel.hpp>
#include <lacuna/interactions/interactions.hpp>
#include <lacuna/interactions/interactions_archive.hpp>
#include <lacuna/interactions/walls.hpp>
#include <lacuna/loads/load_set.hpp>
#include <lacuna/loads/prescribed_motion.hpp>
#include <lacuna/loads/rigid_plates.hpp>
#include <lacuna/loads/wall_drive.hpp>
#include <lacuna/model.hpp>
#include <lacuna/observe/observer.hpp>
#include <lacuna/particles/spatial_order.hpp>
#include <lacuna/simulation/fluid_coupling.hpp>
#include <lacuna/simulation/forward.hpp>
#include <lacuna/simulation/ledger_keeper.hpp>
#include <lacuna/simulation/limits.hpp>
#include <lacuna/simulation/parameters.hpp>
#include <lacuna/simulation/particle_access.hpp>
#include <lacuna/simulation/particle_forces.hpp>
#include <lacuna/simulation/paths.hpp>
#include <lacuna/simulation/run_guards.hpp>
#include <lacuna/simulation/set_up_record.hpp>
#include <lacuna/simulation/slot_names.hpp>
#include <lacuna/simulation/step_control.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// A simulator, composed at compile time from the parts that Model names (see default_model). What is no `model` is refused
/// with one message, which names the slot.
///
/// A step reads: neighbours, interactions, pores, loads, motion. Forces are those of the positions at the
/// beginning of the step; `time()` is the time of the positions.
template <class Model>
class simulation : public particle_access<typename Model::real, Model::dim> {
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
    using store_type = particle_store<real, dim>;
    using interactions_type = lacuna::interactions<real, dim, contact_law_type, bond_law_type, damping_type,
                                                   typename Model::template search<real, dim>, typename Model::domain>;
    using event_type = break_event<dim>;
    static_assert(detail::refuse_misspelt_slots<Model>());
    static_assert(detail::instantiates_formula<contact_law_type, dim> && detail::instantiates_formula<bond_law_type, dim>);

    /// \throws std::invalid_argument for a bad packing or parameter; for particles that are at the same place, overlap by
    ///         more than guards.overlap_limit, or are too far from the origin for the precision
    explicit simulation(packing<real, dim> const& packing, parameters const& p = {}) : parameters_(p) {
        p.validate();
        packing.require_bond_kinds(p.bonds.size());
        packing.require_period([&] {
            if constexpr (Model::domain::periodic)
                return p.domain.period;
            else
                return point{};
        }());
        std::vector<double> density;
        std::vector<typename contact_law_type::material> contact_materials;
        for (auto const& m : p.materials) {
            density.push_back(m.density);
            contact_materials.push_back(m.contact);
        }
        auto const order = [&] {
            if constexpr (dim == 2)
                return strip_order(view_points(packing.position));
            else
                return spatial_order(view_points(packing.position));
        }();
        store_ = store_type(packing, order, density, p.mass, p.thickness);
        if constexpr (Model::domain::periodic) {
            static_assert(!has_fluid<Model>, "pores have no images: a model with fluid has an open domain");
            store_.set_period(p.domain.period);
        }
        bool const own = !packing.density.empty();
        if (own) density.clear();
        for (std::size_t k = 0; own && k < store_.size(); ++k) density.push_back(packing.density[std::size_t(order[k])]);
        loads_ = load_set<real, dim>(p.gravity, p.weight_shares(density), own);
        loads_.apply_weight(store_);
        interactions_ = interactions_type(store_, packing.bonds, p.materials, p.thickness, p.interactions, p.damping,
                                          p.bonds);
        walls_ = wall_contacts<contact_law_type, damping_type, real, dim>(p.walls, contact_materials, p.thickness);
        wall_drive_ = wall_drive<dim>(p.walls.size(), p.thickness);
        guards_ = run_guards<Model>(store_, interactions_, p.guards, p.damping, p.allow_unstable_step);
        interactions_.set_deepest_overlap(p.guards.largest_overlap());
        update_walls();
        reports_.resize(std::size_t(interactions_.chunks()));
        other_forces_.resize(store_.size() * pair_forces<real, dim>::records_per_pair);
        set_up_hash places;
        for (auto const& x : packing.position) places.add(x);
        set_up_.places = places.value();
    }

    /// \name Acting on particles, by the number they have in the packing
    /// \{
    /// Gives a particle a velocity, m/s; the ledger books the kinetic energy as work from outside.
    void set_velocity(std::size_t id, point const& v) {
        note(set_up::velocities);
        motions_.forget(internal(id));
        apply_velocity_change(internal(id), v);
    }
    /// Prescribes a particle's velocity, and fixes it along the axes: from the one it has it changes linearly to v
    /// within ramp_time, from now on; 0: at once. m/s, s. The ledger books what it takes as work from outside.
    void prescribe_velocity(std::size_t id, point const& v, double ramp_time = 0, fixed_axes const& axes = {true, true, true, false}) {
        for (int axis = 0; axis < dim; ++axis) require_finite("velocity of particle " + std::to_string(id), v[axis]);
        require_not_negative("ramp_time of particle " + std::to_string(id), ramp_time);
        fix(id, axes);
        if (!(ramp_time > 0)) return set_velocity(id, v);
        note(set_up::velocities);
        motions_.add(internal(id), convert<double>(store_.velocity(internal(id))), v, ramp_time, now().time);
    }
    /// Lets a particle go that move() drives: it keeps the velocity it has, and `axes` alone stay fixed.
    void release(std::size_t id, fixed_axes const& axes = {}) {
        motions_.forget(internal(id));
        fix(id, axes);
    }
    /// Gives a particle a spin, rad/s; the ledger books the kinetic energy as work from outside.
    void set_spin(std::size_t id, vec<double, rotation_dim<dim>> const& w) {
        auto const k = internal(id);
        note(set_up::velocities);
        velocity_changes_.push_back({k, store_.velocity(k), store_.spin(k), true});
        ledger_.book_work(0.5 * double(store_.moment_of_inertia(k)) * (squared_norm(w) - squared_norm(convert<double>(store_.spin(k)))));
        store_.set_spin(k, convert<real>(w));
    }
    /// Prescribes the motion along the given axes: there the particle keeps the velocity it has or is given.
    void fix(std::size_t id, fixed_axes const& axes = fixed_axes::all()) {
        store_.fix(internal(id), axes);
        note(set_up::fixed_axes);
        control_.forget_forecast();
    }
    /// Joins particles to a rigid, smooth plate, see rigid_plates: from now on they move as one along the axis. Not to
    /// be given velocities of their own afterwards.
    void attach_to_rigid_plate(std::span<std::size_t const> ids, int axis) {
        std::vector<std::size_t> particles;
        for (std::size_t const id : ids) particles.push_back(internal(id));
        plates_.add(store_, std::move(particles), axis);
        note(set_up::plates);
    }
    /// Applies a force and a torque on top of gravity; replaces the ones applied before. N, N m.
    /// \param ramp_time within which the load changes linearly from what it is now, at first zero, to this, s; 0: at once
    void apply(std::size_t id, point const& force, vec<double, rotation_dim<dim>> const& torque, double ramp_time = 0) {
        loads_.set(store_, internal(id), force, torque, ramp_time, now().time);
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

    /// \name Acting on walls, by their number in simulation_parameters::walls; see walls() for their places and forces
    /// \{
    /// Moves a wall: from the velocity it has to v, linearly within ramp_time from now on; 0: at once. m/s, s. The ledger
    /// books its work as that of prescribed motion.
    void move_wall(std::size_t w, point const& v, double ramp_time = 0) {
        wall_drive_.move(walls_, w, v, ramp_time, now().time);
        note(set_up::walls);
    }
    /// Lets a servo hold the stress on a wall from now on, until move_wall().
    void servo_wall(std::size_t w, wall_servo<dim> const& servo) {
        wall_drive_.hold(w, servo);
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
        auto const apart = [&] { require_apart(store_.positions(), [&](std::size_t k) { return store_.id(k); }); };
        interactions_.keep_normal_forces();
        try {
            fluid_.fill(store_, interactions_, parameters_.flow, parameters_.remeshing, dim == 2 ? parameters_.thickness : 1.0, make);
        } catch (std::exception const&) {
            apart(); // names them, where they are what no mesh can be made of
            throw;
        }
        if (!fluid_.get()->network().bare()) apart();
        time_step_.reset();
        set_up_.pores = hash_of_shape(fluid_.get()->network());
        set_up_.fluid = hash_of_fluid(fluid_.get()->network());
    }

    /// Advances by one step.
    /// \throws unstable_run when the state is no longer meaningful; std::invalid_argument when the time step is
    ///         above the bound
    void step() {
        settle_anew();
        take_step<false>();
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
        settle_anew();
        time_step();
        (detail::notify_start(observers, *this), ...);
        long long taken = 0;
        for (bool go_on = true; go_on && taken < steps; ++taken) {
            if (sometimes && (detail::wants_energy(observers, step_) || ...))
                advance<always || sometimes>();
            else
                advance<always>();
            for (auto const& event : events_) (detail::notify_break(observers, event, *this), ...);
            (void)std::initializer_list<int>{((go_on = detail::notify_step(observers, *this) && go_on), 0)...};
        }
        (detail::notify_end(observers, *this), ...);
        return taken;
    }

    long long steps() const noexcept { return step_; }
    double time_step() const;
    double time() const { return clock_.time + double(step_ - clock_.step) * time_step(); }
    /// Failures of the last step.
    std::span<event_type const> events() const noexcept { return events_; }
    /// Kept while an observer asks for it (see observe/observer.hpp), or step_with_energy() is used.
    energy_ledger const& energy() const noexcept { return ledger_.ledger(); }
    /// As step(), and keeps the energy ledger.
    void step_with_energy() {
        settle_anew();
        take_step<true>();
    }
    /// One step of run(), without observers, WithEnergy: with the energy ledger. Unlike step() it keeps the time step that
    /// was first asked for, whatever was set since. Most of a model's code is in it, in time_step() and in limits(): a
    /// program of several files compiles them once where it declares these three `extern template`, as
    /// examples/cartilage/run/cartilage_model.hpp does. \throws as step()
    template <bool WithEnergy>
    void advance();

    /// Limits of the time step in the present state, by what the control of the step counts: bonds,
    /// contacts of particles and walls that touch or may before the next look, and the fluid; with laws that stiffen
    /// contacts are taken to be as deep as then they may be. See assumed_contacts() and step_control.
    time_step_limits limits() const;
    /// What limits() assumes of contacts.
    contact_assumption assumed_contacts() const { return time_step_ ? control_.assumed() : next_assumption(); }
    /// How often the limits of the time step were looked for, the first time included.
    long long looks() const noexcept { return control_.looks(); }

    /// Force of particle b on particle a by their bond or contact in the last step, N; zero without one.
    /// \throws std::logic_error when forces are not kept: see simulation_parameters::keep_pair_forces
    point pair_force(std::size_t a, std::size_t b) const {
        if (!parameters_.keep_pair_forces) throw std::logic_error("simulation: pair_force() needs keep_pair_forces");
        auto const i = std::int32_t(internal(a)), j = std::int32_t(internal(b));
        auto const offset = interactions_.find_force(i, j);
        point force{};
        for (int axis = 0; offset >= 0 && axis < dim; ++axis)
            force[axis] = (i < j ? 1 : -1) * double(interactions_.force_column()[offset + axis]);
        return force;
    }

    /// Total force on a particle, and torque, at the last evaluation, N, N m: of pairs, fluid, walls, loads, gravity and
    /// the plate that it is joined to; not of damping policies that act on particles.
    /// \throws std::logic_error when forces are not kept: see simulation_parameters::keep_pair_forces
    point force(std::size_t id) const { return convert<double>(kept_force(id).force); }
    vec<double, rotation_dim<dim>> torque(std::size_t id) const { return convert<double>(kept_force(id).turning) * this->radius(id); }

    interactions_type const& pairs() const noexcept { return interactions_; }
    auto const& walls() const noexcept { return walls_; }
    parameters const& settings() const noexcept { return parameters_; }
    /// The pore network and its flow (models with flow).
    auto const& flow() const
        requires(has_fluid<Model>)
    {
        return *fluid_.get();
    }
    /// The same, for its set_pressure() and set_source(); steps are the simulation's.
    auto& flow()
        requires(has_fluid<Model>)
    {
        return *fluid_.get();
    }
    bool filled() const noexcept { return fluid_.get() != nullptr; }

    /// What it was given before its first step; see simulation/checkpoint.hpp.
    set_up_record set_up_so_far() const {
        if (step_ > 0) return set_up_;
        set_up_record found = set_up_;
        if (filled()) {
            auto const now = hash_of_fluid(fluid_.get()->network());
            if (now != found.fluid || fluid_values_were_set(*fluid_.get())) found.call(set_up::fluid);
            if (found.was_called(set_up::fluid)) found.result[std::size_t(set_up::fluid)] = now;
        }
        sum_up_particles(found);
        auto const id = [&](std::size_t k) { return store_.id(k); };
        auto const hash = [](auto const&... value) { return set_up_hash::of(value...); };
        if (found.was_called(set_up::loads))
            found.result[std::size_t(set_up::loads)] = loads_.sum_of_loads(
                [&](std::size_t k, auto const&... value) { return hash(id(k), value...); });
        if (found.was_called(set_up::plates)) found.result[std::size_t(set_up::plates)] =
                plates_.sum_of_plates([&](std::size_t k) { return hash(id(k)); }, hash);
        if (found.was_called(set_up::walls)) found.result[std::size_t(set_up::walls)] = wall_drive_.sum_of_motions(walls_, hash);
        return found;
    }
    /// After the state of a checkpoint was read: its record is this one's from now on.
    void take_set_up(set_up_record const& record) noexcept { set_up_ = record; }

    /// Writes or reads all that steps and calls change; see simulation/checkpoint.hpp.
    template <class Archive>
    void serialize(Archive& ar) {
        ar(store_);
        loads_.archive(ar, store_.size());
        interactions_archive::apply(ar, interactions_, store_);
        walls_.archive(ar, store_);
        ar(wall_drive_);
        fluid_.archive(ar, store_);
        ar(events_, velocity_changes_, motions_, plates_, ledger_, guards_, time_step_, control_, max_displacement_, step_);
        ar(clock_.time, clock_.step, clock_.last);
        require_state(motions_.fits(store_.size()), "a motion prescribed to no particle");
        require_state(plates_.fit(store_.size()), "a rigid plate of no particle");
        require_state(guards_.fit(store_.size()), "guards that follow no particle");
        for (auto const& k : velocity_changes_) require_state(k.particle < store_.size(), "a velocity given to no particle");
        require_state(!time_step_ || (*time_step_ > 0 && std::isfinite(*time_step_)), "its time step");
        require_state(step_ >= 0 && step_ < (1LL << 62), "its number of steps");
        if constexpr (Archive::is_loading::value) {
            reports_.resize(std::size_t(interactions_.chunks()));
            fluid_.map_throats(interactions_);
            interactions_.watch_overlaps(control_.assumed().overlap);
        }
    }

private:
    using particle_access<real, dim>::store_;
    using particle_access<real, dim>::internal;

    void note(set_up kind) noexcept {
        if (step_ == 0) set_up_.call(kind);
    }
    /// Held axes and velocities, of the particles in any order.
    void sum_up_particles(set_up_record& to) const {
        if (!to.was_called(set_up::fixed_axes) && !to.was_called(set_up::velocities)) return;
        std::uint64_t axes = 0, speeds = 0;
        for (std::size_t k = 0; k < store_.size(); ++k) {
            int held = 0;
            for (int axis = 0; axis <= dim; ++axis) held |= (store_.mobility(k, axis) == real(0)) << axis;
            if (held) axes += set_up_hash::of(store_.id(k), held);
            auto const v = store_.velocity(k);
            auto const w = store_.spin(k);
            if (squared_norm(v) + squared_norm(w) > real(0)) speeds += set_up_hash::of(store_.id(k), v, w);
        }
        speeds += motions_.sum_of_motions(
            [&](std::size_t k, auto const&... value) { return set_up_hash::of(-1, store_.id(k), value...); });
        if (to.was_called(set_up::fixed_axes)) to.result[std::size_t(set_up::fixed_axes)] = axes;
        if (to.was_called(set_up::velocities)) to.result[std::size_t(set_up::velocities)] = speeds;
    }
    template <class Flow>
    static bool fluid_values_were_set(Flow const& flow) noexcept {
        if constexpr (requires { flow.values_were_set(); })
            return flow.values_were_set();
        else
            return false;
    }

    template <bool WithEnergy>
    void take_step() {
        resolve_time_step();
        if (step_ == 0) set_up_ = set_up_so_far();
        bool const changed = interactions_.update(store_);
        if (changed || walls_.outdated(store_)) update_walls();
        // Slips are those of the motion that led here, with the step of then.
        auto const before = real(step_ > 0 ? clock_.last : *time_step_);
        if (control_.looks_now()) mind_step();
        auto const dt = real(*time_step_);
        clock_.last = *time_step_;
        loads_.advance(store_, time());
        motions_.advance(time(), *time_step_, [&](std::size_t k, point const& v) { apply_velocity_change(k, v); });
        for (auto& r : reports_) r = {};

        int const chunks = interactions_.chunks();
        bool const has_other_forces = filled() || !walls_.empty() || !plates_.empty() || carries_moment<bond_law_type> ||
                                    carries_moment<contact_law_type>;
        bool const on_time = parameters_.velocities_on_time && (step_ == 0 || !velocity_changes_.empty());
        bool remeshed = false;
        std::int32_t given = -1;
        interactions_.set_force_retention(store_, !parameters_.keep_pair_forces, parameters_.threads);
        auto const& spans = interactions_.spans();
        // A particle's pairs belong to it and to lower-numbered ones: once the pairs of a chunk are evaluated, nothing
        // reads its particles again, and `finish` can treat them while they and their forces are in the cache.
        auto const evaluate_spans = [&](auto const& finish) {
            for_each_chunk(spans.count(), parameters_.threads, [&](int s) {
                for (int c = spans.begin(s); c < spans.end(s); ++c) {
                    interactions_.template evaluate<WithEnergy>(store_, c, before);
                    if (!spans.waits(c)) finish(c);
                }
            });
            for_each_chunk(spans.count(), parameters_.threads, [&](int s) {
                for (int c = spans.begin(s); c < spans.end(s); ++c)
                    if (spans.waits(c)) finish(c);
            });
        };
        bool const changes_step = dt != before;
        if (!has_other_forces && velocity_changes_.empty() && !on_time && !changes_step && spans.count() == parameters_.threads) {
            evaluate_spans([&](int c) {
                interactions_.for_fresh_force_sums(c, [&](auto const& force) { move<WithEnergy>(c, dt, force, nullptr); });
            });
        } else {
            // The slip of a step is that of the motion before it, which was not at velocities given since.
            std::for_each(velocity_changes_.rbegin(), velocity_changes_.rend(), [&](velocity_change& k) { swap_velocities(k); });
            if (interactions_.forces_are_transient()) {
                interactions_.prepare_force_sums(store_);
                evaluate_spans([&](int c) { interactions_.keep_force_sums(store_, c); });
            } else {
                for_each_chunk(chunks, parameters_.threads,
                               [&](int c) { interactions_.template evaluate<WithEnergy>(store_, c, before); });
            }
            if (has_other_forces) remeshed = compute_other_forces<WithEnergy>(before, changed);
            drive_walls(double(dt));
            for (auto& k : velocity_changes_) {
                swap_velocities(k);
                if constexpr (WithEnergy) ledger_.book_work(work_of_velocity_change(k, before));
            }
            if (on_time) shift_to_half_step((before + dt) / 4);
            if (changes_step) shorten_half_kick((dt - before) / 2);
            given = fastest_given();
            guards_.follow(store_, given);
            velocity_changes_.clear();
            for_each_chunk(chunks, parameters_.threads, [&](int c) {
                interactions_.for_force_sums(
                    c, [&](auto const& force) { move<WithEnergy>(c, dt, force, has_other_forces ? &other_forces_ : nullptr); });
            });
        }
        collect_events();
        max_displacement_ = guards_.check_motion(store_, interactions_, reports_, dt, given, now());
        count_paths<dim>(std::span<motion_report<real> const>(reports_), dt, interactions_, walls_);
        if constexpr (WithEnergy) {
            auto pairs = interactions_.energy();
            pairs += wall_energy_;
            ledger_.template keep<flow_type>(pairs, interactions_.fracture_energy(), reports_, double(before), double(dt),
                                             fluid_.get(), wall_power_);
            guards_.check_energy(store_, ledger_.ledger(), double(dt), now());
        } else {
            ledger_.close();
        }
        if constexpr (has_fluid<Model>)
            if (parameters_.guards.pores && parameters_.remeshing.rule == remesh_rule::never &&
                (changed || step_ % 64 == 63))
                check_pores(store_, fluid_.get()->network(), now(), guards_.crushed(store_, interactions_));
        if (minds_step())
            control_.moved(std::max(double(max_displacement_), walls_.fastest() * double(dt)),
                           std::max(interactions_.take_deepest(), walls_.take_deepest()), !events_.empty());
        ++step_;
        if (remeshed || step_ % 64 == 0) enforce_flow_limit();
    }

    /// What a particle's velocities were before they were given new ones between two steps.
    struct velocity_change {
        std::size_t particle;
        vec<real, dim> velocity;
        vec<real, rotation_dim<dim>> spin;
        bool spun; ///< the spin was given, not the velocity
    };
    /// Of the particles that have been given a velocity since the last step the fastest, -1: none.
    std::int32_t fastest_given() const noexcept {
        std::int32_t found = -1;
        real speed = -1;
        for (velocity_change const& k : velocity_changes_)
            if (real const own = squared_norm(store_.velocity(k.particle)); !k.spun && own > speed)
                speed = own, found = std::int32_t(k.particle);
        return found;
    }
    void swap_velocities(velocity_change& k) {
        auto const now = velocity_change{k.particle, store_.velocity(k.particle), store_.spin(k.particle), k.spun};
        store_.set_velocity(k.particle, k.velocity);
        store_.set_spin(k.particle, k.spin);
        k = now;
    }

    particle_force<real, dim> kept_force(std::size_t id) const {
        if (!parameters_.keep_pair_forces) throw std::logic_error("simulation: force() needs keep_pair_forces");
        return total_force(store_, interactions_, other_forces_, internal(id));
    }

    void apply_velocity_change(std::size_t k, point const& v) {
        velocity_changes_.push_back({k, store_.velocity(k), store_.spin(k), false});
        ledger_.book_work(0.5 * double(store_.mass(k)) * (squared_norm(v) - squared_norm(convert<double>(store_.velocity(k)))));
        store_.set_velocity(k, convert<real>(v));
    }

    /// What the ledger's work and kinetic energy of this step, made with the new velocity alone, leave out of a velocity_change.
    double work_of_velocity_change(velocity_change const& k, real before) const {
        auto const whole = total_force(store_, interactions_, other_forces_, k.particle);
        auto const change = store_.velocity(k.particle) - k.velocity;
        double work = double(dot(whole.force - store_.applied_force(k.particle), change));
        auto const turn = (store_.spin(k.particle) - k.spin) * store_.radius(k.particle);
        for (int axis = 0; axis < rotation_dim<dim>; ++axis) {
            real const applied = dim == 2 ? store_.load(k.particle)[2]
                                 : store_.torques().size() > 0 ? store_.torques().at(k.particle, axis) : real(0);
            work += double((whole.turning[axis] - applied) * turn[axis]);
        }
        return 0.5 * double(before) * work;
    }

    /// Velocities that were given at the time of the positions become those of half a step before.
    void shift_to_half_step(real half_a_step) {
        std::vector<char> done(2 * store_.size(), 0); // velocities, spins
        auto const once = [&](std::size_t k, bool spin) {
            if (std::exchange(done[2 * k + spin], char(1))) return;
            auto const force = total_force(store_, interactions_, other_forces_, k);
            spin ? set_spin_back(store_, force, k, half_a_step) : set_velocity_back(store_, force, k, half_a_step);
        };
        for (velocity_change const& k : velocity_changes_) once(k.particle, k.spun);
        for (std::size_t k = 0; step_ == 0 && k < store_.size(); ++k)
            for (bool const spin : {false, true}) once(k, spin);
    }

    /// From the middle of one step to that of the next, of another length, it takes half of each: velocities give what a
    /// velocity_change of the whole next step has too much.
    void shorten_half_kick(real too_long) {
        for (std::size_t k = 0; k < store_.size(); ++k) {
            auto const force = total_force(store_, interactions_, other_forces_, k);
            set_velocity_back(store_, force, k, too_long);
            set_spin_back(store_, force, k, too_long);
        }
    }

    template <bool WithEnergy, class PairForce>
    void move(int chunk, real dt, PairForce const& pair_force, record_column<real> const* extra) {
        std::size_t const first = std::size_t(chunk) * interactions_type::chunk_particles;
        int const count = int(std::min(store_.size() - first, std::size_t(interactions_type::chunk_particles)));
        Model::integrator::template advance<WithEnergy, damping_type>(
            store_, first, count, dt, pair_force, parameters_.damping, extra, reports_[std::size_t(chunk)]);
    }

    /// \return whether the pores were made anew
    template <bool WithEnergy>
    bool compute_other_forces(real dt, bool pairs_changed) {
        bool remeshed = false;
        if (pairs_changed) {
            fluid_.map_throats(interactions_);
            fluid_.deactivate_slow_throats(store_, interactions_);
        }
        if (filled()) {
            fluid_.template step<WithEnergy>(store_, interactions_, dt, step_, parameters_.threads, other_forces_);
            remeshed = fluid_.remesh(store_, interactions_, step_);
        } else
            std::fill(other_forces_.data(), other_forces_.data() + 4 * other_forces_.size(), real(0));
        interactions_.add_moments(store_, other_forces_);
        if (!walls_.empty()) {
            auto const beyond = walls_.evaluate(store_, dt, parameters_.damping, other_forces_, wall_energy_);
            if (beyond >= 0 && parameters_.guards.walls)
                throw_unstable(store_, now(), beyond, "its centre is beyond a wall",
                               step_ == 0 ? "it is there from the start: a wall's point or normal, or the particle's position"
                                          : "the load or speed is too high for the stiffness of the wall");
        }
        if (!plates_.empty())
            plates_.share(store_, [&](std::size_t k) { return total_force(store_, interactions_, other_forces_, k).force; },
                          other_forces_);
        return remeshed;
    }

    void drive_walls(double dt) {
        if (walls_.empty()) return;
        wall_drive_.advance(walls_, time(), dt);
        wall_power_ = walls_.advance(dt);
        if (double const share = walls_.fastest() * dt / double(guards_.smallest_radius()), limit = parameters_.guards.largest_motion(); share > limit)
            throw_unstable(store_, now(), -1,
                           "a wall moved " + to_text(share) + " of the smallest radius in one step (limit " + to_text(limit) + ")",
                           "its velocity is too high");
    }

    /// Before the first step, whose length may not be known yet, the time is that of the start.
    moment now() const { return {step_, step_ == clock_.step ? clock_.time : time()}; }

    bool chooses_step() const noexcept { return !(parameters_.time_step > 0); }
    /// Whether the bound is looked at during the run.
    bool minds_step() const noexcept { return chooses_step() || !parameters_.allow_unstable_step; }

    time_step_limits find_limits_of(contact_assumption const& assumed) const {
        limit_scratch<dim> scratch;
        return find_limits<Model>(store_, interactions_, walls_, fluid_.get(), parameters_.damping, assumed, scratch);
    }
    contact_assumption next_assumption(bool wide = false, double reach = 0) const {
        return control_.next_assumption(store_, interactions_, walls_, chooses_step(), wide, reach,
                                        double(guards_.smallest_radius()), filled());
    }
    /// What contacts may become, for control_.
    void look_ahead(double speed, double overlap) const {
        control_.look_ahead(store_, interactions_, walls_, parameters_.damping, speed, overlap, chooses_step());
    }
    /// The step for a critical one: where nothing counted has a stiffness, that of a contact which may form, s. At the
    /// present speeds nothing moves further than half of what checked_motion() allows.
    double chosen_step(double critical) const {
        double step = parameters_.safety * (std::isfinite(critical) ? critical : control_.forecast().first_contact());
        if (!std::isfinite(step)) return step;
        for (std::size_t k = 0; k < store_.size(); ++k) {
            double const path = double(norm(store_.velocity(k))) * step, most = 0.05 * double(store_.radius(k));
            if (path > most) step *= most / path;
        }
        return std::min(step, 0.05 * double(guards_.smallest_radius()) / walls_.fastest_next());
    }
    void looked(contact_assumption const& assumed, double rigorous) const {
        double const accurate = chooses_step() ? 1.3 * parameters_.safety * control_.forecast().first_contact()
                                               : std::numeric_limits<double>::infinity();
        control_.looked(assumed, *time_step_, rigorous, accurate, chooses_step(), filled());
        interactions_.watch_overlaps(control_.assumed().overlap);
    }
    /// Whether numbers can be divided by a step.
    static bool is_step(double step) noexcept { return real(step) > real(0) && std::isfinite(1 / real(step)); }
    void change_step(double step) {
        if (!is_step(step))
            throw_unstable(store_, now(), -1, "no time step is short enough any more",
                           "a stiffness, a mass, a damping or a speed has left the range of " + precision_text<real>());
        clock_ = {time(), step_, clock_.last};
        time_step_ = step;
    }

    /// Looks for the bound again, as contacts have formed or got deeper: a step of our choice follows it, one that was
    /// asked for and is not safe any more ends the run.
    void mind_step() {
        auto const look = [&](contact_assumption const& at) {
            return find_limits<Model>(store_, interactions_, walls_, fluid_.get(), parameters_.damping, at, scratch_);
        };
        double const speed = std::max(double(max_displacement_) / clock_.last, walls_.fastest());
        auto assumed = next_assumption(control_.cannot_wait(), chooses_step() ? 2 * speed * *time_step_ : 0);
        auto found = look(assumed);
        if (!chooses_step() && control_.cannot_wait() && !(*time_step_ <= found.rigorous)) {
            // What is near may pass: only what is about to touch ends a run.
            assumed = next_assumption();
            found = look(assumed);
        }
        look_ahead(speed, assumed.overlap);
        if (chooses_step())
            if (double const longer = chosen_step(found.rigorous); longer > 1.05 * *time_step_ && 2 * speed * longer > assumed.gap) {
                // In a longer step bodies come together from further away.
                assumed = next_assumption(true, 2 * speed * longer);
                found = look(assumed);
            }
        double const critical = found.rigorous; // that of the fluid alone: enforce_flow_limit()
        if (chooses_step()) {
            double const now = *time_step_, most = parameters_.safety * found.flow;
            double const wanted = speed > 0 ? std::min(chosen_step(critical), std::max(now, assumed.gap / (2 * speed))) : chosen_step(critical);
            // A step that could be a little longer is not worth a change.
            bool const shrinks = parameters_.follow_critical_step ? wanted < 0.99 * now || now > critical : now > critical;
            bool const grows = parameters_.follow_critical_step && std::min(wanted, most) > 1.05 * now;
            if ((shrinks || grows) && std::isfinite(wanted)) change_step(std::min(wanted, most));
        } else if (!(*time_step_ <= critical) && !parameters_.allow_unstable_step) {
            throw_unstable(store_, now(), -1,
                           "the time step of " + to_text(*time_step_) + " s is above the stable limit, which is " +
                               to_text(critical) + " s by now",
                           "contacts have formed or become stiffer, bonds have failed, or supports were freed: a step that is not given follows "
                           "the limit; allow_unstable_step goes on without");
        }
        looked(assumed, found.rigorous);
    }

    /// Where throats have opened, or pores were made anew, the step may be too long for an explicit flow: one of our
    /// choice is chosen again, one that was asked for ends the run.
    void enforce_flow_limit() {
        if constexpr (has_fluid<Model>) {
            double const limit = flow_limit(*fluid_.get());
            if (*time_step_ <= limit || parameters_.allow_unstable_step) return;
            if (parameters_.time_step > 0)
                throw_unstable(store_, now(), -1,
                               "the flow between pores allows a time step of at most " + to_text(limit) +
                                   " s by now, less than " + to_text(*time_step_) + " s",
                               "throats have opened or pores become small; flow.substeps = 0 takes as many flow steps as "
                               "are safe, implicit flow has no limit");
            change_step(parameters_.safety * limits().critical());
        }
    }

    void collect_events() {
        auto const found = interactions_.collect_events();
        events_.assign(found.begin(), found.end());
        for (auto& e : events_) {
            e.step = step_;
            e.time = time();
        }
    }

    void update_walls() {
        if (walls_.empty()) return;
        walls_.update(store_, interactions_.neighbors().settings().skin,
                      real(parameters_.interactions.initial_contact_tolerance));
    }

    /// What was set since the time step was first asked for counts: whether the first step is one of run() or of step().
    void settle_anew() noexcept {
        if (step_ == 0) time_step_.reset();
    }
    /// Fixes the time step on first use: the one asked for, if it is stable, or a share of the critical one.
    void resolve_time_step() const {
        if (time_step_) return;
        if constexpr (has_fluid<Model>)
            if (!filled()) throw std::logic_error("simulation: the model has a fluid but fill_pores() was not called");
        control_.reset(filled());
        auto assumed = next_assumption();
        time_step_limits found = find_limits_of(assumed);
        bool const given = parameters_.time_step > 0;
        double speed = walls_.fastest_next();
        for (std::size_t k = 0; k < store_.size(); ++k) speed = std::max(speed, double(norm(store_.velocity(k))));
        look_ahead(speed, assumed.overlap);
        if (double const reach = given ? 0 : 2 * speed * chosen_step(found.critical()); reach > assumed.gap && std::isfinite(reach)) {
            assumed = next_assumption(false, reach); // what may touch within the first step
            found = find_limits_of(assumed);
        }
        double const critical = found.critical();
        if (given && !parameters_.allow_unstable_step && !(parameters_.time_step <= critical))
            refuse("time_step", parameters_.time_step,
                   "at most the stable limit " + to_text(critical) + " s (of " +
                       (found.rigorous <= found.flow ? "the particles, with rotation and fluid stiffness"
                                                     : "the flow between pores") +
                       "; eq. 9 gives " + to_text(found.wave_limit) + " s), or allow_unstable_step");
        // Where all particles are held no step is too long, and eq. 9 gives one that is of use.
        bool const free = std::isfinite(critical) || std::isfinite(control_.forecast().first_contact());
        double const step = given ? parameters_.time_step : chosen_step(free ? critical : found.wave_limit);
        if (std::isinf(step))
            refuse("time_step", 0.0, "given: without any stiffness there is no critical time step");
        if (!is_step(step))
            refuse("time_step", step,
                   "longer, to be a step at all: a stiffness, a mass, a damping or a speed leaves the range of " +
                       precision_text<real>());
        time_step_ = step;
        looked(assumed, found.rigorous);
    }

    parameters parameters_;
    mutable interactions_type interactions_; // mutable: how deep overlaps are watched is settled with the time step
    wall_contacts<contact_law_type, damping_type, real, dim> walls_;
    load_set<real, dim> loads_;
    fluid_coupling<Model> fluid_;
    wall_drive<dim> wall_drive_;
    std::array<double, 2> wall_power_{};
    pair_energy wall_energy_;
    record_column<real> other_forces_;
    std::vector<motion_report<real>> reports_;
    std::vector<event_type> events_;
    std::vector<velocity_change> velocity_changes_;
    ledger_keeper<real> ledger_;
    run_guards<Model> guards_;
    prescribed_motion<dim> motions_;
    rigid_plates<real, dim> plates_;
    mutable std::optional<double> time_step_;
    mutable step_control<Model> control_;
    limit_scratch<dim> scratch_;
    /// When the present time step began to apply, and how long the last step was.
    struct step_clock {
        double time;
        long long step;
        double last;
    };
    step_clock clock_{parameters_.start_time, 0, 0};
    set_up_record set_up_; ///< up to the first step
    real max_displacement_ = 0; ///< upper bound of the path of every particle in the last step, m
    long long step_ = 0;
};

// Outside the class: else each file that includes this compiles them, `extern template` or not.
template <class Model>
template <bool WithEnergy>
void simulation<Model>::advance() {
    take_step<WithEnergy>();
}

template <class Model>
double simulation<Model>::time_step() const {
    resolve_time_step();
    return *time_step_;
}

template <class Model>
time_step_limits simulation<Model>::limits() const {
    return find_limits_of(assumed_contacts());
}

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
