// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <lacuna/core/parallel.hpp>
#include <lacuna/interactions/interactions.hpp>
#include <lacuna/interactions/walls.hpp>
#include <lacuna/loads/load_set.hpp>
#include <lacuna/model.hpp>
#include <lacuna/motion/stable_step.hpp>
#include <lacuna/observe/energy_ledger.hpp>
#include <lacuna/observe/observer.hpp>
#include <lacuna/particles/spatial_order.hpp>

namespace lacuna {

/// Settings of a simulation; they nest those of its parts. SI units.
template <class Model>
struct simulation_parameters {
    static constexpr int dim = Model::dim;
    using material = material_of<typename Model::contact_law, typename Model::bond_law>;

    std::vector<material> materials{material{}};    ///< a particle's material number counts these
    double thickness = 1;                           ///< out of plane, m; 2D only
    mass_model mass = dim == 2 ? mass_model::disc : mass_model::sphere;
    vec<double, dim> gravity{};                     ///< m/s^2
    interaction_parameters interactions{};
    typename Model::damping::parameters damping{};
    std::vector<wall<typename Model::contact_law, dim>> walls{};
    typename Model::flow::parameters flow{};
    double time_step = 0;                           ///< s; 0: safety times the critical time step
    double safety = 0.2;                            ///< fraction of the critical time step
    bool allow_unstable_step = false;               ///< run even with a time step above the bound
    double start_time = 0;                          ///< s
    int threads = 1;                                ///< takes effect in programs built with OpenMP
    /// Keep the forces of all pairs after a step, for pair_force(). Without, a run on one thread without walls and
    /// fluid forgets each force once it has acted, which saves a third of the memory traffic of large models.
    bool keep_pair_forces = true;

    /// \throws std::invalid_argument naming the part, the field, the value and the rule.
    void validate() const {
        if (materials.empty()) refuse("materials.size()", 0.0, "at least 1");
        for (std::size_t m = 0; m < materials.size(); ++m) materials[m].validate("materials[" + std::to_string(m) + "]");
        require_positive("thickness", thickness);
        for (int axis = 0; axis < dim; ++axis) require_finite("gravity", gravity[axis]);
        interactions.validate("interactions");
        damping.validate("damping");
        for (std::size_t w = 0; w < walls.size(); ++w) walls[w].validate("walls[" + std::to_string(w) + "]");
        flow.validate("flow");
        require_not_negative("time_step", time_step);
        require_positive("safety", safety);
        require_finite("start_time", start_time);
        require_in("threads", threads, 1, 1024);
    }
};

/// The time step limits of a simulation in its present state, s.
struct time_step_limits {
    double equation_9 = 0;  ///< as the paper gives it: shortest distance over wave speed, from the stiffest light pair
    double equation_19 = 0; ///< as the paper gives it, for the fluid; infinite without flow
    double flow = 0;        ///< rigorous, for the fluid alone; infinite without flow
    double rigorous = 0;    ///< rigorous, for particles with rotation, damping and the stiffness of the fluid
    /// What a step has to stay below.
    double critical() const noexcept { return rigorous < flow ? rigorous : flow; }
};

/// A simulator, composed at compile time from the parts that Model names (see default_model).
///
/// A step reads: neighbours, interactions, pores, loads, motion. Forces are those of the positions at the
/// beginning of the step; `time()` is the time of the positions.
template <model Model>
class simulation {
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
                                                   typename Model::template search<real, dim>>;
    using event_type = break_event<dim>;

    /// \throws std::invalid_argument for a bad packing or parameter
    explicit simulation(packing<real, dim> const& packing, parameters const& p = {}) : parameters_(p) {
        p.validate();
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
        loads_ = load_set<real, dim>(p.gravity, store_.size());
        loads_.apply_gravity(store_);
        interactions_ = interactions_type(store_, packing.bonds, p.materials, p.thickness, p.interactions, p.damping);
        walls_ = wall_contacts<contact_law_type, damping_type, real, dim>(p.walls, contact_materials, p.thickness);
        smallest_radius_ = store_.size() ? *std::min_element(store_.radii().begin(), store_.radii().end()) : real(1);
        update_walls();
        reports_.resize(std::size_t(interactions_.chunks()));
        extra_.resize(store_.size() * pair_forces<real, dim>::records_per_pair);
    }

    /// \name The particles, by the number they have in the packing
    /// \{
    std::size_t size() const noexcept { return store_.size(); }
    point position(std::size_t id) const { return widen(store_.position(internal(id))); }
    point velocity(std::size_t id) const { return widen(store_.velocity(internal(id))); }
    vec<double, rotation_dim<dim>> spin(std::size_t id) const { return widen(store_.spin(internal(id))); }
    double radius(std::size_t id) const { return double(store_.radius(internal(id))); }
    double mass(std::size_t id) const { return double(store_.mass(internal(id))); }
    double moment_of_inertia(std::size_t id) const { return double(store_.moment_of_inertia(internal(id))); }
    int material(std::size_t id) const { return store_.material(internal(id)); }
    /// Eq. 8's unit vector in 2D, a unit quaternion {w, x, y, z} in 3D.
    auto orientation(std::size_t id) const { return widen(store_.orientation(internal(id))); }

    /// Gives a particle a velocity, m/s; the ledger books the kinetic energy as work from outside.
    void set_velocity(std::size_t id, point const& v) {
        auto const k = internal(id);
        kicked_.push_back({k, store_.velocity(k), store_.spin(k)});
        book_work(0.5 * double(store_.mass(k)) * (squared_norm(v) - squared_norm(widen(store_.velocity(k)))));
        store_.set_velocity(k, narrow(v));
    }
    /// Gives a particle a spin, rad/s; the ledger books the kinetic energy as work from outside.
    void set_spin(std::size_t id, vec<double, rotation_dim<dim>> const& w) {
        auto const k = internal(id);
        kicked_.push_back({k, store_.velocity(k), store_.spin(k)});
        book_work(0.5 * double(store_.moment_of_inertia(k)) * (squared_norm(w) - squared_norm(widen(store_.spin(k)))));
        store_.set_spin(k, narrow(w));
    }
    /// Prescribes the motion along the given axes: there the particle keeps the velocity it has or is given.
    void fix(std::size_t id, fixed_axes const& axes = fixed_axes::all()) { store_.fix(internal(id), axes); }
    /// Applies a force, and in 2D a torque, on top of gravity; replaces the one applied before. N, N m.
    /// \param ramp_time within which it rises linearly from zero, from now on, s; 0: at once
    void apply(std::size_t id, point const& force, double torque = 0, double ramp_time = 0) {
        loads_.set(store_, internal(id), force, torque, ramp_time, ramp_time > 0 ? time() : parameters_.start_time);
    }
    /// \}

    /// Fills the pores with fluid (models with flow; before the first step).
    /// \param make callable (points_view positions, Real const* radii) -> pore_network, in the simulation's own
    ///        numbering of particles; see triangulate_body() and make_pore_network()
    /// \throws std::invalid_argument for flow parameters out of range
    template <class Make>
    void fill_pores(Make const& make)
        requires(has_fluid<Model>)
    {
        auto flow = parameters_.flow;
        flow.thickness = parameters_.thickness;
        flow_.emplace(flow, make(store_.positions(), store_.radii().data()), store_.positions(), store_.radii().data());
        time_step_.reset();
    }

    /// Advances by one step.
    /// \throws unstable_run when the state is no longer meaningful; std::invalid_argument when the time step is
    ///         above the bound
    void step() { take_step<false>(); }

    /// Advances by `steps` steps, or until an observer's on_step asks to stop.
    /// \return the number of steps taken
    /// \throws as step()
    template <observer... Observers>
    long long run(long long steps, Observers&&... observers) {
        (detail::check_observer<simulation, event_type, Observers>(), ...);
        constexpr bool energy = (detail::needs_energy<Observers> || ...);
        planned_steps_ = steps;
        if (step_ == 0) time_step_.reset();
        settle_time_step();
        (start(observers), ...);
        long long taken = 0;
        for (bool go_on = true; go_on && taken < steps; ++taken) {
            take_step<energy>();
            for (auto const& event : events_) (report(observers, event), ...);
            (void)std::initializer_list<int>{((go_on = observe(observers) && go_on), 0)...};
        }
        (finish(observers), ...);
        return taken;
    }

    long long steps() const noexcept { return step_; }
    double time_step() const {
        settle_time_step();
        return *time_step_;
    }
    double time() const { return parameters_.start_time + double(step_) * time_step(); }
    /// Failures of the last step.
    std::span<event_type const> events() const noexcept { return events_; }
    /// Kept while an observer with needs_energy is there, or step_with_energy() is used.
    energy_ledger const& energy() const noexcept { return ledger_; }
    /// As step(), and keeps the energy ledger.
    void step_with_energy() { take_step<true>(); }

    /// Kinetic energy of all particles with their present velocities, J.
    double kinetic_energy() const {
        double total = 0;
        for (std::size_t k = 0; k < store_.size(); ++k)
            total += 0.5 * double(store_.mass(k)) * double(squared_norm(store_.velocity(k))) +
                     0.5 * double(store_.moment_of_inertia(k)) * double(squared_norm(store_.spin(k)));
        return total;
    }

    /// Limits of the time step in the present state (MODEL.md section 6).
    time_step_limits limits() const {
        time_step_limits result;
        frequency_bound<dim> bound(store_.size()), dashpots(damping_type::acts_on_pairs ? store_.size() : 0);
        for (std::size_t k = 0; k < store_.size(); ++k)
            for (int axis = 0; axis < frequency_bound<dim>::freedoms; ++axis) {
                bound.set_mobility(k, axis, double(store_.mobility(k, axis)));
                if constexpr (damping_type::acts_on_pairs)
                    dashpots.set_mobility(k, axis, double(store_.mobility(k, axis)));
            }
        double wave = std::numeric_limits<double>::infinity();
        interactions_.for_each_stiffness(store_, [&](std::size_t i, std::size_t j, point const& normal, double kn,
                                                     double ks, double prestress, double li, double lj) {
            bound.add_pair(i, j, normal, kn, ks, prestress, li, lj);
            if constexpr (damping_type::acts_on_pairs)
                dashpots.add_pair(i, j, normal, dashpot(kn, double(store_.mass(i)), double(store_.mass(j))), 0, 0, li, lj);
            wave = std::min(wave, std::sqrt(double(std::min(store_.mass(i), store_.mass(j))) / kn));
        });
        walls_.for_each_stiffness(store_, [&](std::size_t k, point const& normal, double kn, double ks, double lever) {
            bound.add_support(k, normal, kn, ks, lever);
            if constexpr (damping_type::acts_on_pairs)
                dashpots.add_support(k, normal, dashpot(kn, 2 * double(store_.mass(k)), 2 * double(store_.mass(k))), 0,
                                     lever);
        });
        result.equation_9 = wave;
        result.equation_19 = result.flow = std::numeric_limits<double>::infinity();
        if constexpr (has_fluid<Model>)
            if (flow_) {
                add_fluid_stiffness(bound);
                result.equation_19 = double(flow_->equation_19_time_step());
                result.flow = double(flow_->critical_time_step());
            }
        double const against_motion = 1 + std::fabs(damping_type::particle_force(parameters_.damping, 1.0, -1.0));
        result.rigorous = bound.time_step(dashpots, against_motion);
        return result;
    }

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

    store_type const& particles() const noexcept { return store_; }
    interactions_type const& pairs() const noexcept { return interactions_; }
    auto const& walls() const noexcept { return walls_; }
    parameters const& settings() const noexcept { return parameters_; }
    /// The pore network and its flow (models with flow).
    auto const& flow() const
        requires(has_fluid<Model>)
    {
        return *flow_;
    }
    bool filled() const noexcept { return flow_.has_value(); }

private:
    template <bool WithEnergy>
    void take_step() {
        settle_time_step();
        auto const dt = real(*time_step_);
        if (interactions_.update(store_, moved_)) {
            update_walls();
            skip_idle_throats();
        }
        loads_.advance(store_, time());
        for (auto& r : reports_) r = {};

        int const chunks = interactions_.chunks();
        bool const further_forces = flow_.has_value() || !walls_.empty();
        bool const at_once = !further_forces && parameters_.threads == 1 && kicked_.empty();
        interactions_.set_streaming(store_, at_once && !parameters_.keep_pair_forces);
        if (at_once) {
            // A particle's pairs belong to it and to lower-numbered ones: once the pairs of a chunk are evaluated,
            // nothing reads its particles again, and they can move while they are in the cache.
            for (int c = 0; c < chunks; ++c) {
                interactions_.template evaluate<WithEnergy>(store_, c, dt);
                move<WithEnergy>(c, dt, nullptr);
            }
        } else {
            // The slip of a step is that of the motion before it, which was not at velocities given since.
            std::for_each(kicked_.rbegin(), kicked_.rend(), [&](kick& k) { exchange(k); });
            for_each_chunk(chunks, parameters_.threads,
                           [&](int c) { interactions_.template evaluate<WithEnergy>(store_, c, dt); });
            if (further_forces) add_further_forces(dt);
            for (auto& k : kicked_) exchange(k);
            kicked_.clear();
            for_each_chunk(chunks, parameters_.threads,
                           [&](int c) { move<WithEnergy>(c, dt, further_forces ? &extra_ : nullptr); });
        }
        collect_events();
        check_motion(dt);
        if constexpr (WithEnergy)
            keep_ledger(double(dt));
        else
            ledger_open_ = false;
        ++step_;
    }

    /// What a particle's velocities were before they were given new ones between two steps.
    struct kick {
        std::size_t particle;
        vec<real, dim> velocity;
        vec<real, rotation_dim<dim>> spin;
    };
    void exchange(kick& k) {
        auto const now = kick{k.particle, store_.velocity(k.particle), store_.spin(k.particle)};
        store_.set_velocity(k.particle, k.velocity);
        store_.set_spin(k.particle, k.spin);
        k = now;
    }

    template <bool WithEnergy>
    void move(int chunk, real dt, record_column<real> const* extra) {
        std::size_t const first = std::size_t(chunk) * interactions_type::chunk_particles;
        int const count = int(std::min(store_.size() - first, std::size_t(interactions_type::chunk_particles)));
        interactions_.with_forces_on(chunk, [&](auto const& pair_force) {
            Model::integrator::template advance<WithEnergy, damping_type>(
                store_, first, count, dt, pair_force, parameters_.damping, extra, reports_[std::size_t(chunk)]);
        });
    }

    void add_further_forces(real dt) {
        std::fill(extra_.data(), extra_.data() + 4 * extra_.size(), real(0));
        if (!walls_.empty()) {
            auto const beyond = walls_.evaluate(store_, dt, parameters_.damping, extra_, wall_energy_);
            if (beyond >= 0) throw_unstable(beyond, "its centre is beyond a wall", "the load or speed is too high for the stiffness of the wall");
        }
        if constexpr (has_fluid<Model>)
            if (flow_) {
                auto const points = store_.positions();
                auto const* radii = store_.radii().data();
                flow_->refresh_geometry(points, radii);
                flow_->refresh_apertures([this](std::int32_t i, std::int32_t j) { return throat_at(i, j); });
                flow_->advance(dt);
                flow_->add_tractions(points, radii, extra_.data(), 4);
            }
    }

    /// What the pair at a throat does, from its force in this step.
    throat_state<real> throat_at(std::int32_t i, std::int32_t j) const {
        auto const offset = interactions_.find_force(i, j);
        real const distance = norm(store_.position(std::size_t(j)) - store_.position(std::size_t(i)));
        return {offset < 0 ? real(0) : interactions_.force_column()[offset + 3],
                distance - store_.radius(std::size_t(i)) - store_.radius(std::size_t(j))};
    }

    /// Throats are left out for the run that was announced; ones that open within it are taken up again here.
    void skip_idle_throats() const {
        if constexpr (has_fluid<Model>) {
            if (!flow_ || planned_steps_ <= 0 || !time_step_) return;
            flow_->refresh_apertures([this](std::int32_t i, std::int32_t j) { return throat_at(i, j); }, true);
            flow_->skip_idle_throats(real(double(planned_steps_) * *time_step_));
        }
    }

    void add_fluid_stiffness(frequency_bound<dim>& bound) const {
        auto const& net = flow_->network();
        double const modulus = flow_->settings().bulk_modulus;
        for (std::size_t p = 0; p < net.pores(); ++p) {
            auto const tractions = flow_->pore_tractions(p, store_.positions(), store_.radii().data());
            std::array<std::size_t, std::size_t(dim) + 1> who{};
            std::array<typename frequency_bound<dim>::gradient, std::size_t(dim) + 1> g{};
            for (std::size_t c = 0; c < who.size(); ++c) {
                who[c] = std::size_t(net.corner[c][p]);
                for (int axis = 0; axis < dim; ++axis) g[c][axis] = double(tractions[c][axis]);
            }
            bound.add(who, g, modulus / double(net.volume[p]));
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

    void check_motion(real dt) {
        record<real> fastest(real(0)), poison(real(0));
        for (auto const& r : reports_) {
            fastest = max(r.fastest, fastest);
            poison += r.poison;
        }
        real squared = 0;
        for (int axis = 0; axis < dim; ++axis) squared += fastest[axis] * fastest[axis];
        moved_ = std::sqrt(squared) * dt;
        if (!(poison[0] + poison[1] + poison[2] == real(0))) report_poison();
        if (moved_ > smallest_radius_ / 10) report_fast(dt);
        if (auto const k = interactions_.deep_overlap(); k >= 0)
            throw_unstable(k, "it overlaps another particle by more than a radius",
                           "the load is too high for the contact stiffness, or the time step too long");
    }

    void report_poison() const {
        for (std::size_t k = 0; k < store_.size(); ++k) {
            auto const v = store_.velocity(k);
            for (int axis = 0; axis < dim; ++axis)
                if (!std::isfinite(v[axis]))
                    throw_unstable(std::int32_t(k), "its velocity is not a number",
                                   "a load that is not a number, coinciding particles, or an unstable time step");
        }
        throw_unstable(-1, "a velocity is not a number", "an unstable time step");
    }
    void report_fast(real dt) const {
        for (std::size_t k = 0; k < store_.size(); ++k) {
            real const path = norm(store_.velocity(k)) * dt;
            if (path > store_.radius(k) / 10)
                throw_unstable(std::int32_t(k),
                               "it moved " + to_text(double(path / store_.radius(k))) +
                                   " of its radius in one step (limit 0.1)",
                               "the time step is above the stable one, or a load is very large");
        }
    }
    [[noreturn]] void throw_unstable(std::int32_t k, std::string const& what, std::string const& cause) const {
        long long const id = k < 0 ? -1 : store_.id(std::size_t(k));
        std::string text = "unstable run at step " + std::to_string(step_) + ", time " + to_text(time()) + " s: ";
        if (k >= 0) {
            text += "particle " + std::to_string(id) + " at (";
            for (int axis = 0; axis < dim; ++axis)
                text += (axis ? ", " : "") + to_text(double(store_.position(std::size_t(k))[axis]));
            text += ") m: ";
        }
        throw unstable_run(text + what + "; likely cause: " + cause, step_, id);
    }

    void book_work(double work) {
        if (!ledger_open_) return;
        ledger_.external += work;
        work_ahead_ += work;
    }

    void keep_ledger(double dt) {
        auto const pairs = interactions_.energy();
        motion_report<real> total;
        for (auto const& r : reports_) {
            total.kinetic += r.kinetic;
            total.load_before += r.load_before;
            total.load_after += r.load_after;
            total.damping_before += r.damping_before;
            total.damping_after += r.damping_after;
        }
        bool const first = !ledger_open_;
        if (first) {
            ledger_ = {};
            work_ahead_ = damping_ahead_ = 0;
            ledger_open_ = true;
        }
        ledger_.kinetic = total.kinetic;
        ledger_.strain = pairs.stored + wall_energy_.stored;
        if constexpr (has_fluid<Model>)
            if (flow_) keep_fluid_ledger(first);
        if (first) {
            ledger_.initial = ledger_.kinetic + ledger_.strain + ledger_.fluid_storage;
        } else {
            ledger_.friction += pairs.dissipated + wall_energy_.dissipated;
            ledger_.damping += pairs.damped + wall_energy_.damped;
            ledger_.fracture += interactions_.fracture_energy();
            ledger_.external = work_ahead_ + 0.5 * dt * total.load_before;
            ledger_.damping += damping_ahead_ - 0.5 * dt * total.damping_before;
        }
        work_ahead_ = ledger_.external + 0.5 * dt * total.load_after;
        damping_ahead_ = -0.5 * dt * total.damping_after;
    }

    void keep_fluid_ledger(bool first) {
        auto const& now = flow_->ledger();
        if (first) fluid_start_ = now;
        ledger_.fluid_storage = double(flow_->storage_energy());
        ledger_.fluid_viscous = double(now.dissipation - fluid_start_.dissipation);
        ledger_.fluid_outflow = -double(now.reservoir_work - fluid_start_.reservoir_work) -
                                double(now.vapour_work - fluid_start_.vapour_work) -
                                double(now.prefactor_work - fluid_start_.prefactor_work);
    }

    void update_walls() {
        if (walls_.empty()) return;
        double mean = 0;
        for (real const r : store_.radii()) mean += double(r) / double(store_.size());
        walls_.update(store_, real(parameters_.interactions.skin * mean));
    }

    /// Fixes the time step on first use: the one asked for, if it is stable, or a share of the critical one.
    /// Coefficient of the damping of one pair, N s/m.
    double dashpot(double stiffness, double mass_i, double mass_j) const {
        return damping_type::pair_force(parameters_.damping, stiffness, mass_i, mass_j, 1.0);
    }

    void settle_time_step() const {
        if (time_step_) return;
        if constexpr (has_fluid<Model>)
            if (!flow_) throw std::logic_error("simulation: the model has a fluid but fill_pores() was not called");
        time_step_limits found = limits();
        bool const given = parameters_.time_step > 0;
        if (planned_steps_ > 0 && std::isfinite(found.rigorous)) {
            // Which throats matter depends on the length of the run, and that on the step of the particles.
            time_step_ = given ? parameters_.time_step : parameters_.safety * found.rigorous;
            skip_idle_throats();
            time_step_.reset();
            found = limits();
        }
        double const critical = found.critical();
        if (given && !parameters_.allow_unstable_step && !(parameters_.time_step <= critical))
            refuse("time_step", parameters_.time_step,
                   "at most the stable limit " + to_text(critical) + " s (of " +
                       (found.rigorous <= found.flow ? "the particles, with rotation and fluid stiffness"
                                                     : "the flow between pores") +
                       "; eq. 9 gives " + to_text(found.equation_9) + " s), or allow_unstable_step");
        if (!given && !std::isfinite(critical))
            refuse("time_step", 0.0, "given: without any stiffness there is no critical time step");
        time_step_ = given ? parameters_.time_step : parameters_.safety * critical;
    }

    template <class Observer>
    void start(Observer& o) const {
        if constexpr (has(Observer::stages, stage::start)) o.on_start(*this);
    }
    template <class Observer>
    void report(Observer& o, event_type const& event) const {
        if constexpr (has(Observer::stages, stage::breakage)) o.on_break(event, *this);
    }
    template <class Observer>
    bool observe(Observer& o) const {
        if constexpr (has(Observer::stages, stage::step)) {
            if constexpr (std::is_void_v<decltype(o.on_step(*this))>)
                o.on_step(*this);
            else
                return o.on_step(*this) != run_control::stop;
        }
        return true;
    }
    template <class Observer>
    void finish(Observer& o) const {
        if constexpr (has(Observer::stages, stage::end)) o.on_end(*this);
    }

    std::size_t internal(std::size_t id) const {
        if (id >= store_.size()) refuse("particle", double(id), "below the number of particles, " + std::to_string(store_.size()));
        return std::size_t(store_.internal(id));
    }
    template <int N>
    static vec<double, N> widen(vec<real, N> const& a) {
        vec<double, N> r{};
        for (int k = 0; k < N; ++k) r[k] = double(a[k]);
        return r;
    }
    template <int N>
    static vec<real, N> narrow(vec<double, N> const& a) {
        vec<real, N> r{};
        for (int k = 0; k < N; ++k) r[k] = real(a[k]);
        return r;
    }

    parameters parameters_;
    store_type store_;
    interactions_type interactions_;
    wall_contacts<contact_law_type, damping_type, real, dim> walls_;
    load_set<real, dim> loads_;
    mutable std::optional<flow_type> flow_; // mutable: which throats are left out is settled with the time step
    flow_ledger<real> fluid_start_;
    pair_energy wall_energy_;
    record_column<real> extra_;
    std::vector<motion_report<real>> reports_;
    std::vector<event_type> events_;
    std::vector<kick> kicked_;
    energy_ledger ledger_;
    double work_ahead_ = 0, damping_ahead_ = 0;
    bool ledger_open_ = false;
    mutable std::optional<double> time_step_;
    real moved_ = 0, smallest_radius_ = 1;
    long long step_ = 0, planned_steps_ = 0;
};

} // namespace lacuna
