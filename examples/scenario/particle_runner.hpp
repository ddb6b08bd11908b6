// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lacuna/loads/surface_traction.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "checkpoints.hpp"
#include "frames.hpp"
#include "model_parameters.hpp"
#include "pore_view.hpp"
#include "runner.hpp"
#include "statement.hpp"
#include "summary.hpp"
#include "touching.hpp"

namespace lacuna_run {

/// The model of a scenario with these laws.
template <int Dim, class Real, class Contact, class Bond>
struct run_model : lacuna::default_model<Dim, Real> {
    using contact_law = Contact;
    using bond_law = Bond;
    using damping = lacuna::combined_damping;
    using flow = std::conditional_t<Dim == 2, chosen_flow, lacuna::no_flow>;
};

/// A run of particles, with or without fluid.
template <class Model>
class particle_runner : public runner {
    static constexpr int dim = Model::dim;
    using vector = lacuna::vec<double, dim>;

public:
    using simulation = lacuna::simulation<Model>;

    explicit particle_runner(scenario const& s) : scenario_(s), statement_(statement_of(s)) {
        journal_.heading = heading_of(s);
        build(model_parameters<Model>(s));
        if constexpr (lacuna::has_fluid<Model>) {
            auto p = model_parameters<Model>(s);
            if (s.fluid && !std::isfinite(p.flow.duration)) {
                // The length of the run in s follows from the particles' time step, which is known only now.
                p.flow.duration = std::max(1.0, double(*s.simulation.steps)) * resolved_step();
                build(p);
            }
            if (s.fluid && s.fluid->time_step > 0) {
                // The number of flow steps per particle step, or of particle steps per flow step, likewise.
                double const ratio = resolved_step() / s.fluid->time_step;
                if (!(ratio <= 1e6 && ratio >= 1e-6))
                    refuse("fluid.time_step", lacuna::to_text(s.fluid->time_step),
                           "from 1e-6 to 1e6 times the particles' step of " + lacuna::to_text(resolved_step()) + " s");
                p.flow.substeps = std::max(1, int(std::ceil(ratio * (1 - 1e-9))));
                p.flow.interval = std::max(1, int(std::floor(1 / ratio * (1 + 1e-9))));
                build(p);
            }
        }
        check_flow_step(resolved_step());
        for (probe const& p : s.probes)
            if constexpr (lacuna::has_fluid<Model>) check_location(p, sim_->flow().network());
    }

    void restore(std::string const& path) override;
    bool run(results& out) override;
    journal const& log() const override { return journal_; }
    long long steps() const override { return sim_->steps(); }
    std::string summary(std::string const& ended, std::string const& message) const override;
    /// The simulation, for inspection.
    simulation const& simulated() const noexcept { return *sim_; }

private:
    /// The observer that writes rows, frames and checkpoints.
    class recorder;

    /// The sum of all loads on one particle, N and N m, and its prescribed velocity, m/s.
    struct drive {
        vector force{};
        lacuna::vec<double, lacuna::rotation_dim<dim>> torque{};
        double load_ramp = 0, velocity_ramp = 0;
        bool loaded = false;
        std::optional<vector> velocity; ///< if prescribed
    };
    static std::vector<drive> drives_of(scenario const& s);
    static std::vector<lacuna::fixed_axes> held_axes(scenario const& s);
    static lacuna::fixed_axes driven_axes(lacuna::fixed_axes const& held) {
        return {true, true, dim == 3, held.rotation};
    }

    lacuna::packing<typename Model::real, dim> packing_of() const;
    void build(lacuna::simulation_parameters<Model> const& p);
    void set_up();
    void fill();
    void resume_drives(scenario const& before);
    double resolved_step();
    void check_flow_step(double step) const;
    void write_row(results& out);
    void save(results& out, bool regular);
    double read(probe const& p) const;
    double read_of_particle(probe const& p) const;
    double read_of_bond(probe const& p) const;
    double read_of_contact(probe const& p) const;
    bool is_over() const {
        auto const& set = scenario_.simulation;
        return set.steps ? sim_->steps() >= *set.steps : sim_->time() >= *set.end_time * (1 - 1e-12);
    }
    frame_data frame() const;

    scenario const& scenario_;
    std::string const statement_; ///< of the scenario, for checkpoints
    std::optional<simulation> sim_;
    journal journal_;
};

template <class Model>
lacuna::packing<typename Model::real, particle_runner<Model>::dim> particle_runner<Model>::packing_of() const {
    lacuna::packing<typename Model::real, dim> packing;
    for (std::size_t k = 0; k < scenario_.particles.size(); ++k)
        packing.add(lacuna::convert<typename Model::real>(to_vec<dim>(scenario_.particles.position[k])),
                    typename Model::real(scenario_.particles.radius[k]), scenario_.particles.material[k]);
    packing.density = scenario_.particles.density;
    packing.bonds.assign(scenario_.bonds.pairs.begin(), scenario_.bonds.pairs.end());
    return packing;
}

template <class Model>
void particle_runner<Model>::build(lacuna::simulation_parameters<Model> const& given) {
    sim_.emplace(packing_of(), given);
    set_up();
}

template <class Model>
void particle_runner<Model>::set_up() {
    auto const& s = scenario_;
    auto const held = held_axes(s);
    for (std::size_t k = 0; k < s.particles.size(); ++k) {
        if (s.particles.velocity[k] != point{}) sim_->set_velocity(k, to_vec<dim>(s.particles.velocity[k]));
        if (s.particles.spin[k] != point{}) sim_->set_spin(k, to_vec<lacuna::rotation_dim<dim>>(s.particles.spin[k]));
        sim_->fix(k, held[k]);
    }
    auto const drives = drives_of(s);
    for (std::size_t k = 0; k < drives.size(); ++k) {
        drive const& d = drives[k];
        if (d.velocity) sim_->prescribe_velocity(k, *d.velocity, d.velocity_ramp, driven_axes(held[k]));
        if (d.loaded) sim_->apply(k, d.force, d.torque, d.load_ramp);
    }
    fill();
}

template <class Model>
void particle_runner<Model>::fill() {
    if constexpr (lacuna::has_fluid<Model>)
        sim_->fill_pores([&](auto points, auto const* radii) {
            return scenario_.fluid ? make_network(*scenario_.fluid, points, radii)
                                   : lacuna::pore_network<typename Model::real, 2>{};
        });
}

template <class Model>
std::vector<lacuna::fixed_axes> particle_runner<Model>::held_axes(scenario const& s) {
    std::vector<lacuna::fixed_axes> held(s.particles.size());
    for (fixed const& f : s.particles.fix)
        for (auto const id : f.particles) {
            auto& h = held[std::size_t(id)];
            h = {h.x || f.x, h.y || f.y, h.z || f.z, h.rotation || f.rotation};
        }
    return held;
}

template <class Model>
auto particle_runner<Model>::drives_of(scenario const& s) -> std::vector<drive> {
    std::vector<drive> all(s.particles.size());
    auto const add = [&](std::int32_t id, point const& force, point const& torque, load const& l, std::size_t number) {
        drive& d = all[std::size_t(id)];
        if (d.loaded && d.load_ramp != l.ramp_time)
            refuse("loads[" + std::to_string(number) + "].ramp_time", lacuna::to_text(l.ramp_time),
                   "equal to that of the other loads on particle " + std::to_string(id) + ", " +
                       lacuna::to_text(d.load_ramp));
        d.force += to_vec<dim>(force);
        d.torque += to_vec<lacuna::rotation_dim<dim>>(torque);
        d.load_ramp = l.ramp_time;
        d.loaded = true;
    };
    for (std::size_t n = 0; n < s.loads.size(); ++n) {
        load const& l = s.loads[n];
        if (l.what == load::kind::velocity) {
            for (auto const id : l.particles) {
                all[std::size_t(id)].velocity = to_vec<dim>(l.velocity);
                all[std::size_t(id)].velocity_ramp = l.ramp_time;
            }
        } else if (l.what == load::kind::force) {
            for (auto const id : l.particles) add(id, l.force, l.torque, l, n);
        } else {
            auto const row = row_on_side(s.particles, l.where, l.margin_diameters * 2 * mean_radius(s.particles));
            if (row.empty())
                refuse("loads[" + std::to_string(n) + "].margin_diameters", lacuna::to_text(l.margin_diameters),
                       "small enough to leave particles to load");
            constexpr double inward[4][2] = {{0, -1}, {0, 1}, {1, 0}, {-1, 0}};
            auto const& direction = inward[int(l.where)];
            for (auto const id : row) {
                double const force =
                    lacuna::traction_force(l.pressure, s.particles.radius[std::size_t(id)], s.simulation.thickness,
                                           l.disc_area ? lacuna::traction_area::disc : lacuna::traction_area::strip);
                add(id, {force * direction[0], force * direction[1]}, {}, l, n);
            }
        }
    }
    return all;
}

/// Applies the loads of a resumed run. An unchanged load keeps its ramp; a changed load starts from the present one.
template <class Model>
void particle_runner<Model>::resume_drives(scenario const& before) {
    auto const held = held_axes(scenario_);
    auto const old = drives_of(before), now = drives_of(scenario_);
    for (std::size_t k = 0; k < now.size(); ++k) {
        drive const &a = old[k], &b = now[k];
        bool const as_before = a.velocity.has_value() == b.velocity.has_value() &&
                               (!b.velocity || (a.velocity_ramp == b.velocity_ramp && *a.velocity == *b.velocity));
        if (!as_before && b.velocity)
            sim_->prescribe_velocity(k, *b.velocity, b.velocity_ramp, driven_axes(held[k]));
        else if (!as_before)
            sim_->release(k, held[k]);
        if (a.force == b.force && a.torque == b.torque && a.load_ramp == b.load_ramp) continue;
        sim_->apply(k, b.force, b.torque, b.load_ramp);
    }
}

template <class Model>
double particle_runner<Model>::resolved_step() {
    try {
        return sim_->resolve_time_step();
    } catch (std::invalid_argument const& bad) {
        if (!(scenario_.simulation.time_step > 0) &&
            std::string_view(bad.what()).find("without any stiffness") != std::string_view::npos)
            refuse("simulation.time_step", "\"auto\"", "a number of seconds: nothing here has a stiffness");
        throw refusal("simulation." + std::string(bad.what()));
    }
}

/// \throws refusal if a particle step needs more explicit flow steps than the solver allows
template <class Model>
void particle_runner<Model>::check_flow_step([[maybe_unused]] double step) const {
    if constexpr (lacuna::has_fluid<Model>) {
        auto const& fluid = scenario_.fluid;
        // The limit of merged pores is known only after the first step of the flow solver.
        if (!fluid || fluid->implicit || fluid->time_step > 0 || fluid->merge_conductance) return;
        constexpr int most = lacuna::explicit_flow_solver<typename Model::real, 2, chosen_aperture>::most_substeps;
        double const limit = double(lacuna::flow_critical_time_step(sim_->flow().network(), fluid->bulk_modulus));
        if (step <= most / 1.01 * limit) return;
        refuse("fluid.solver", "\"explicit\"",
               "\"implicit\": the stable limit of the explicit flow is " + lacuna::to_text(limit) +
                   " s, and the particles' step of " + lacuna::to_text(step) + " s would take more than " +
                   std::to_string(most) + " flow steps");
    }
}

template <class Model>
class particle_runner<Model>::recorder {
public:
    static constexpr lacuna::stage stages = lacuna::stage::step | lacuna::stage::breakage;
    static constexpr bool needs_energy = true;

    recorder(particle_runner& run, results& out) : run_(run), out_(out) {}

    void on_break(lacuna::break_event<dim> const& e, simulation const& sim) {
        break_line line;
        line.step = e.step;
        line.time = e.time;
        line.bond = e.bond;
        line.particles = {e.particles[0], e.particles[1]};
        line.shear = e.mode == lacuna::bond_state::broken_in_shear;
        auto const direction = sim.position(std::size_t(e.particles[1])) - sim.position(std::size_t(e.particles[0]));
        for (int axis = 0; axis < dim; ++axis) {
            line.position[std::size_t(axis)] = e.position[axis];
            line.direction[std::size_t(axis)] = direction[axis];
        }
        line.normal_force = e.normal_force;
        line.shear_force = e.shear_force;
        line.energy = e.energy;
        run_.journal_.cracks.push_back({line.bond, line.shear, line.position, line.direction});
        out_.add_break(line);
    }
    lacuna::run_control on_step(simulation const& sim) {
        run_.write_row(out_);
        out_.progress().passed(sim.steps());
        auto const& o = run_.scenario_.output;
        auto const due = [&](long long every) { return every > 0 && sim.steps() % every == 0; };
        if (due(o.vtk_every)) write_vtk(out_, run_.frame(), run_.scenario_, run_.journal_);
        if (due(o.picture_every)) write_picture(out_, run_.frame(), run_.scenario_, run_.journal_);
#ifdef LACUNA_RUN_CHECKPOINTS
        if (due(o.checkpoint_every)) run_.save(out_, true);
#endif
        return run_.is_over() || lacuna::stop_signal() != 0 ? lacuna::run_control::stop : lacuna::run_control::go_on;
    }

private:
    particle_runner& run_;
    results& out_;
};

template <class Model>
bool particle_runner<Model>::run(results& out) {
    auto const& o = scenario_.output;
    // A run that was stopped before its first step has already written its first row and frames.
    if (sim_->steps() == 0 && journal_.events.bytes == 0) {
        write_row(out);
        if (o.vtk_every > 0) write_vtk(out, frame(), scenario_, journal_);
        if (o.picture_every > 0) write_picture(out, frame(), scenario_, journal_);
    }
    recorder watch(*this, out);
    auto const& set = scenario_.simulation;
    auto const left = [&] {
        return set.steps ? double(*set.steps - sim_->steps())
                         : std::ceil((*set.end_time - sim_->time()) / sim_->time_step());
    };
    out.progress().begin(left(), sim_->size(), sim_->steps());
    while (!is_over() && lacuna::stop_signal() == 0) {
        try {
            sim_->run(std::max(1LL, (long long)(std::min(left(), 1e15))), watch);
        } catch (lacuna::unstable_run const&) {
            // The unfinished step may have broken bonds that no observer has seen.
            for (auto const& e : sim_->events())
                if (e.step == sim_->steps()) watch.on_break(e, *sim_);
            throw;
        }
    }
    out.progress().finish();
#ifdef LACUNA_RUN_CHECKPOINTS
    if (!is_over()) save(out, false);
#endif
    return is_over();
}

#ifdef LACUNA_RUN_CHECKPOINTS
template <class Model>
void particle_runner<Model>::save(results& out, bool regular) {
    out.mark(journal_);
    if (!regular) out.set_regular_checkpoint_aside();
    auto content = lacuna::checkpoint_of(*sim_, journal_);
    content.program_input = statement_;
    lacuna::write_checkpoint(out.file("checkpoint.bin"), content);
    if (regular) out.regular_checkpoint_written();
}
#endif

template <class Model>
void particle_runner<Model>::restore([[maybe_unused]] std::string const& path) {
#ifdef LACUNA_RUN_CHECKPOINTS
    std::string const heading = journal_.heading;
    try {
        auto const content = lacuna::read_checkpoint(path);
        scenario const before = earlier_scenario(path, content.program_input, scenario_);
        // A simulation without loads takes all loads from the checkpoint.
        auto const p = sim_->settings();
        sim_.emplace(packing_of(), p);
        fill();
        lacuna::resume_from(content, path, *sim_, journal_);
        resume_drives(before);
    } catch (lacuna::checkpoint_error const& bad) {
        throw refusal(bad.what());
    }
    begin_other_probes(journal_, heading);
#else
    throw refusal("--restart = \"" + path + "\": must be left out: this program was built without checkpoints");
#endif
}

template <class Model>
void particle_runner<Model>::write_row(results& out) {
    bool due = false;
    for (probe const& p : scenario_.probes) due = due || sim_->steps() % p.every == 0;
    if (!due) return;
    std::string row = std::to_string(sim_->steps()) + "," + lacuna::to_text(sim_->time());
    for (probe const& p : scenario_.probes) {
        row += ",";
        if (sim_->steps() % p.every == 0) row += lacuna::to_text(read(p));
    }
    out.add_row(row + "\n");
}

template <class Model>
double particle_runner<Model>::read(probe const& p) const {
    auto const& e = sim_->energy();
    bool const begun = sim_->steps() > 0;
    switch (p.what) {
    case quantity::position:
    case quantity::velocity:
    case quantity::spin:
    case quantity::rotation:
    case quantity::force:
    case quantity::torque: return read_of_particle(p);
    case quantity::bond_normal_force:
    case quantity::bond_shear_force:
    case quantity::bond_broken: return read_of_bond(p);
    case quantity::contact_normal_force:
    case quantity::contact_shear_force: return read_of_contact(p);
    case quantity::wall_force: return sim_->walls().force(std::size_t(p.index))[p.axis];
    case quantity::kinetic: return begun ? e.kinetic : sim_->kinetic_energy();
    case quantity::strain: return e.strain;
    case quantity::friction: return e.friction;
    case quantity::damping: return e.damping;
    case quantity::fracture: return e.fracture;
    case quantity::fluid_energy: return e.fluid_storage + e.fluid_viscous + e.fluid_outflow;
    case quantity::external: return e.external;
    case quantity::residual: return e.residual();
    case quantity::broken_tension: return double(journal_.broken(false));
    case quantity::broken_shear: return double(journal_.broken(true));
    case quantity::contacts: {
        auto const& pairs = sim_->pairs();
        double count = 0;
        for (std::size_t slot = 0; begun && slot < pairs.contacts().slots(); ++slot) {
            if (pairs.contacts().is_padding(slot, sim_->size())) continue;
            auto const at = pairs.find_force(pairs.contacts().i(slot), pairs.contacts().j(slot));
            count += pairs.force_column()[at + 3] != 0;
        }
        return count;
    }
    default:
        if constexpr (lacuna::has_fluid<Model>)
            return read_of_pores(p, sim_->flow().network(), sim_->particles().positions());
        else
            return 0;
    }
}

template <class Model>
double particle_runner<Model>::read_of_particle(probe const& p) const {
    auto const id = std::size_t(p.index);
    auto const part = [&](auto const& v) {
        if constexpr (requires { v[2]; } && std::remove_cvref_t<decltype(v)>::size() == 3)
            return p.axis < 0 ? norm(v) : v[p.axis];
        else
            return p.axis < 0 ? v[0] : v[p.axis];
    };
    // The stored velocity is half a step behind the position; with velocity Verlet both belong to the same time.
    double const half = scenario_.simulation.velocity_verlet && sim_->steps() > 0 ? 0.5 * sim_->time_step() : 0;
    auto const& store = sim_->particles();
    auto const k = std::size_t(store.internal(id));
    switch (p.what) {
    case quantity::position: return part(sim_->position(id));
    case quantity::velocity: {
        auto v = sim_->velocity(id);
        if (half > 0) {
            auto const force = sim_->force(id);
            for (int axis = 0; axis < dim; ++axis) v[axis] += half * force[axis] * double(store.mobility(k, axis));
        }
        return part(v);
    }
    case quantity::spin: {
        auto w = sim_->spin(id);
        if (half > 0) w += sim_->torque(id) * (half * double(store.mobility(k, dim)));
        return part(w);
    }
    case quantity::rotation:
        if constexpr (dim == 2) {
            return double(store.particle_records().at(k, 2)) / sim_->radius(id);
        } else {
            // Convert the unit quaternion to a rotation vector.
            auto const q = sim_->orientation(id);
            vector const axis{q[1], q[2], q[3]};
            double const sine = norm(axis);
            double const angle = 2 * std::atan2(sine, q[0]);
            return part(sine > 0 ? axis * (angle / sine) : axis);
        }
    case quantity::force: return part(sim_->force(id));
    default: return part(sim_->torque(id));
    }
}

template <class Model>
double particle_runner<Model>::read_of_bond(probe const& p) const {
    auto const& record = sim_->pairs().bond_records()[std::size_t(p.index)];
    bool const broken = record.state != lacuna::bond_state::intact;
    if (p.what == quantity::bond_broken) return broken ? 1 : 0;
    if (broken || sim_->steps() == 0) return 0;
    if (p.what == quantity::bond_shear_force) {
        auto const& shear = sim_->pairs().bonds().get(std::size_t(record.slot)).state.shear_force;
        return dim == 2 ? double(shear[0]) : double(norm(shear));
    }
    auto const& store = sim_->particles();
    auto const at = sim_->pairs().find_force(store.internal(std::size_t(record.particles[0])),
                                             store.internal(std::size_t(record.particles[1])));
    return double(sim_->pairs().force_column()[at + 3]);
}

template <class Model>
double particle_runner<Model>::read_of_contact(probe const& p) const {
    auto const& store = sim_->particles();
    auto const& pairs = sim_->pairs();
    auto i = store.internal(std::size_t(p.particles[0])), j = store.internal(std::size_t(p.particles[1]));
    if (i > j) std::swap(i, j);
    auto const slot = pairs.contacts().find(i, j);
    if (slot < 0 || sim_->steps() == 0) return 0;
    if (p.what == quantity::contact_normal_force) return double(pairs.force_column()[pairs.find_force(i, j) + 3]);
    auto const& shear = pairs.contacts().get(std::size_t(slot)).state.shear_force;
    return dim == 2 ? double(shear[0]) : double(norm(shear));
}

template <class Model>
frame_data particle_runner<Model>::frame() const {
    frame_data f;
    f.step = sim_->steps();
    f.time = sim_->time();
    for (std::size_t k = 0; k < sim_->size(); ++k) {
        auto const to_point = [](auto const& v) {
            point p{};
            for (int axis = 0; axis < dim; ++axis) p[std::size_t(axis)] = v[axis];
            return p;
        };
        f.position.push_back(to_point(sim_->position(k)));
        f.velocity.push_back(to_point(sim_->velocity(k)));
    }
    for (auto const& record : sim_->pairs().bond_records())
        f.intact.push_back(record.state == lacuna::bond_state::intact);
    if constexpr (lacuna::has_fluid<Model>)
        add_pores(f, sim_->flow().network(), [&](std::size_t corner) { return sim_->particles().id(corner); });
    return f;
}

template <class Model>
std::string particle_runner<Model>::summary(std::string const& ended, std::string const& message) const {
    run_numbers n;
    n.ended = ended;
    n.message = message;
    n.steps = sim_->steps();
    n.time = sim_->time();
    n.time_step = sim_->time_step();
    n.critical = sim_->limits().critical();
    n.energy = &sim_->energy();
    n.kinetic = sim_->steps() > 0 ? sim_->energy().kinetic : sim_->kinetic_energy();
    if constexpr (lacuna::has_fluid<Model>) add_pores(n, sim_->flow().network(), sim_->particles().positions());
    return summary_text(scenario_, journal_, n);
}

} // namespace lacuna_run
