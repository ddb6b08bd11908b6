// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <random>
#include <string>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/pore_network.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation.hpp>

#include "block.hpp"
#include "machine.hpp"
#include "sheet.hpp"

/// \file
/// Workloads as simulations, and checks of their physics after each timing.

namespace bench {

/// Model with bonds and friction, also for workloads that use only one of them.
template <class Real, int Dim = 2>
struct dry_model : lacuna::default_model<Dim, Real> {};
/// Model with bonds, friction and pores, whose flow is solved in every step.
template <class Real>
struct wet_model : lacuna::default_model<2, Real> {
    using flow = lacuna::explicit_flow;
};

/// Constants of the fluid. It is soft enough for the time step of the workloads, and throats are wide enough for
/// pressures to spread over several pores in a run.
struct fluid_constants {
    double bulk_modulus = 0.1, initial_pressure = 0.02;
    double conductivity = 0.1, residual_aperture = 0.3, half_force = 10;
    /// Squeezed discs leave little space between them: most pores have this minimum share of their triangle.
    double minimum_volume_fraction = 0.05;
};

/// Thickness of the discs. A disc of mean radius then has the mass of a sphere, the particle of LAMMPS.
inline constexpr double sheet_thickness = 4.0 / 3 * 1.75;

/// Share of the load in a workload. Bonds start without force, so the full load would act on a fully bonded sheet like
/// an impact.
inline double load_share(work w) { return w == work::full || w == work::full3 ? 0.05 : 1; }

template <class Model>
lacuna::simulation_parameters<Model> work_parameters(int threads = 1) {
    sheet_constants const c;
    lacuna::simulation_parameters<Model> p;
    p.materials.resize(1);
    p.materials[0].density = 1;
    p.materials[0].contact = {c.normal_stiffness, c.shear_stiffness, c.friction};
    // Failure is tested in every step, but the strength is far above all stresses.
    p.materials[0].bond = {c.normal_stiffness, c.shear_stiffness, 1e3, 1e3};
    if (Model::dim == 2) p.thickness = sheet_thickness;
    p.keep_pair_forces = false; // no workload reads the force of a single pair
    p.time_step = c.time_step;
    p.interactions.skin = c.skin / (0.5 * (c.smallest_radius + c.largest_radius));
    p.threads = threads;
    if constexpr (lacuna::has_fluid<Model>) {
        fluid_constants const f;
        p.flow.bulk_modulus = f.bulk_modulus;
        p.flow.initial_pressure = f.initial_pressure;
        p.flow.conductivity = f.conductivity;
        p.flow.minimum_volume_fraction = f.minimum_volume_fraction;
        p.flow.aperture = {f.residual_aperture, f.half_force, 1.0};
        // Discs of the squeezed sheet pass each other.
        p.remeshing = {lacuna::remesh_rule::when_needed, 1000};
    }
    return p;
}

/// Makes the simulation of a workload.
/// \param s sheet or block
/// \param free no particle is held or loaded, so that momentum is conserved
template <class Model, class Body>
lacuna::simulation<Model> make_simulation(Body const& s, work w, int threads = 1, bool free = false) {
    using real = typename Model::real;
    lacuna::simulation<Model> sim(to_packing<real>(s, w), work_parameters<Model>(threads));
    for (std::size_t k = 0; k < s.size() && !free; ++k) {
        if (s.held(k)) sim.fix(k);
        lacuna::vec<double, Model::dim> down{};
        down[1] = -load_share(w) * s.load;
        if (s.loaded(k)) sim.apply(k, down);
    }
    if constexpr (lacuna::has_fluid<Model>)
        sim.fill_pores([&](auto points, real const* radii) {
            auto const drained_top = [](lacuna::boundary_throat<real, 2> const& throat) {
                bool const top = throat.side == lacuna::body_side::top;
                return lacuna::throat_boundary<real>{
                    top ? lacuna::boundary_kind::drained : lacuna::boundary_kind::sealed, real(0)};
            };
            return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii, drained_top);
        });
    return sim;
}

/// Energies of a simulation, with the potential of the load.
struct energy_state {
    double total = 0;  ///< kinetic + strain + fluid + potential of the load
    double stored = 0; ///< kinetic + strain + fluid
};
/// Takes one step and returns its energies.
template <class Model, class Body>
energy_state energy_of(lacuna::simulation<Model>& sim, Body const& s, work w) {
    // The ledger belongs to the positions before the step, where the forces were computed.
    double raised = 0;
    for (std::size_t k = 0; k < s.size(); ++k)
        if (s.loaded(k)) raised += sim.position(k)[1] - s.y[k];
    sim.step_with_energy();
    auto const& e = sim.energy();
    energy_state now;
    now.stored = e.kinetic + e.strain + e.fluid_storage;
    now.total = now.stored + load_share(w) * s.load * raised;
    return now;
}

/// Outcome of the checks.
struct verdict {
    bool good = true;
    std::string why; ///< the failed checks, or empty
    /// Records a failed check. \param what name of the quantity
    void demand(bool condition, std::string const& what, double value, double limit) {
        if (condition) return;
        good = false;
        why +=
            (why.empty() ? "" : "; ") + what + " " + std::to_string(value) + " (limit " + std::to_string(limit) + ")";
    }
};

/// One timed run of a workload after a warm-up, and the results of its checks.
struct timing {
    double seconds = 0;
    double cpu_seconds = 0; ///< of all threads; other programs on the machine disturb it less than `seconds`
    long long steps = 0;
    double resident_mb = 0; ///< memory in use after the last run, with sheet and program, MiB; see resident_mb()
    std::size_t particles = 0, pairs = 0, bonds = 0, contacts = 0, open_throats = 0, active_throats = 0;
    long long rebuilds = 0;
    double energy_drift = 0;   ///< change of the total energy divided by the stored energy
    double ledger_residual = 0; ///< of the energy ledger, divided by its largest term
    double momentum_drift = 0; ///< of a free sheet, divided by the sum of its particles' momenta
    verdict found;
    double rate() const { return double(particles) * double(steps) / seconds; }
    double nanoseconds_per_pair() const { return seconds * 1e9 / (double(pairs) * double(steps)); }
};

/// Linear and angular momentum of all particles, and the sums of their magnitudes.
template <int Dim>
struct momenta {
    lacuna::vec<double, Dim> momentum{};
    lacuna::vec<double, lacuna::rotation_dim<Dim>> spin{};
    double linear = 0, angular = 0;
};
template <class Model>
momenta<Model::dim> momenta_of(lacuna::simulation<Model> const& sim) {
    momenta<Model::dim> sum;
    for (std::size_t k = 0; k < sim.size(); ++k) {
        auto const x = sim.position(k), v = sim.velocity(k);
        double const m = sim.mass(k);
        auto const own = sim.spin(k) * sim.moment_of_inertia(k);
        sum.momentum += v * m;
        sum.spin += own;
        if constexpr (Model::dim == 2)
            sum.spin[0] += m * cross(x, v);
        else
            sum.spin += cross(x, v) * m;
        sum.linear += m * norm(v);
        sum.angular += m * norm(x) * norm(v) + norm(own);
    }
    return sum;
}

/// Relative change of momentum of a small, free sheet or block in random motion: zero but for rounding.
template <class Model>
double momentum_drift(work w) {
    auto sim = [&] {
        if constexpr (Model::dim == 2)
            return make_simulation<Model>(make_sheet(600), w, 1, true);
        else
            return make_simulation<Model>(make_block(500), w, 1, true);
    }();
    std::mt19937_64 generator(7);
    auto const random = [&](auto& v) {
        for (int axis = 0; axis < v.size(); ++axis) v[axis] = (double(generator() >> 11) * 0x1p-53 - 0.5) * 0.1;
    };
    for (std::size_t k = 0; k < sim.size(); ++k) {
        lacuna::vec<double, Model::dim> v{};
        lacuna::vec<double, lacuna::rotation_dim<Model::dim>> spin{};
        random(v);
        random(spin);
        sim.set_velocity(k, v);
        sim.set_spin(k, spin);
    }
    auto const before = momenta_of(sim);
    sim.run(300);
    auto const after = momenta_of(sim);
    double const linear = std::max(before.linear, after.linear), angular = std::max(before.angular, after.angular);
    return std::max(norm(after.momentum - before.momentum) / linear, norm(after.spin - before.spin) / angular);
}

/// Number of pairs in a table without padding.
template <class Law, class Real, int Dim>
std::size_t count_pairs(lacuna::pair_table<Law, Real, Dim> const& table, std::size_t particles) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < table.slots(); ++k) count += table.is_padding(k, particles) ? 0 : 1;
    return count;
}

/// A workload after set-up and warm-up, ready to be timed in parts.
/// \tparam Body sheet or block
template <class Model, class Body = sheet>
class work_run {
public:
    /// \param s must outlive this object
    work_run(Body const& s, work w, int threads = 1)
        : sheet_(s), work_(w), sim_(make_simulation<Model>(s, w, threads)) {
        auto const limits = sim_.limits();
        result_.found.demand(sim_.settings().time_step <= limits.critical(), "time step above the stable limit",
                             sim_.settings().time_step, limits.critical());
        begin_ = energy_of(sim_, sheet_, work_);
        // Warm-up.
        sim_.run(few(200));
        rebuilds_ = sim_.pairs().neighbors().build_count();
    }

    void run(long long steps) {
        auto const start = std::chrono::steady_clock::now();
        auto const used = std::clock();
        sim_.run(steps);
        result_.cpu_seconds += double(std::clock() - used) / CLOCKS_PER_SEC;
        result_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        result_.steps += steps;
        result_.resident_mb = resident_mb();
    }

    lacuna::simulation<Model> const& simulation() const { return sim_; }

    /// Checks the physics after the timed runs. \return timing and results
    timing finish() {
        bool const single = sizeof(typename Model::real) == 4;
        auto& r = result_;
        r.particles = sheet_.size();
        r.rebuilds = sim_.pairs().neighbors().build_count() - rebuilds_;
        r.bonds = count_pairs(sim_.pairs().bonds(), r.particles);
        r.contacts = count_pairs(sim_.pairs().contacts(), r.particles);
        r.pairs = r.bonds + r.contacts;

        auto const end = energy_of(sim_, sheet_, work_);
        double const scale = std::max(begin_.stored, end.stored);
        r.energy_drift = (end.total - begin_.total) / scale;
        r.found.demand(std::isfinite(end.total), "energy", end.total, 0);
        // Friction and outflow remove energy; nothing may add any.
        double const tolerance = single ? 0.01 : 0.005;
        r.found.demand(r.energy_drift <= tolerance, "energy gained", r.energy_drift, tolerance);
        if (work_ == work::full || work_ == work::full3)
            r.found.demand(r.energy_drift >= -tolerance, "energy lost without friction", r.energy_drift, -tolerance);
        for (long long k = 0; k < few(50); ++k) sim_.step_with_energy();
        r.ledger_residual = sim_.energy().residual() / sim_.energy().largest();
        r.found.demand(std::fabs(r.ledger_residual) <= 0.01, "residual of the energy ledger", r.ledger_residual, 0.01);

        std::size_t broken = 0;
        for (auto const& bond : sim_.pairs().bond_records())
            broken += bond.state == lacuna::bond_state::intact ? 0 : 1;
        r.found.demand(broken == 0, "broken bonds", double(broken), 0);
        if constexpr (lacuna::has_fluid<Model>) {
            auto const& net = sim_.flow().network();
            r.open_throats = net.open_throats();
            double flow = 0;
            for (std::size_t t = 0; t < r.open_throats; ++t) {
                r.active_throats += net.inactive[t] ? 0 : 1;
                flow = std::max(flow, std::fabs(double(net.flow[t])));
            }
            r.found.demand(r.active_throats == r.open_throats, "throats in use", double(r.active_throats),
                           double(r.open_throats));
            r.found.demand(flow > 0, "largest flow", flow, 0);
        }
        r.momentum_drift = momentum_drift<Model>(work_);
        double const rounding = single ? 1e-4 : 1e-11;
        r.found.demand(r.momentum_drift <= rounding, "momentum of a free sheet", r.momentum_drift, rounding);
        return r;
    }

private:
    /// Number of untimed steps: `most`, less for large sheets.
    long long few(long long most) const { return std::clamp(most * 3200 / (long long)sheet_.size(), 5LL, most); }

    Body const& sheet_;
    work work_;
    lacuna::simulation<Model> sim_;
    energy_state begin_;
    long long rebuilds_ = 0;
    timing result_;
};

} // namespace bench
