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
/// The works as simulations, and the checks of their physics that follow each timing.

namespace bench {

/// Bonds and friction, both as types in the simulator whatever the work uses of them.
template <class Real, int Dim = 2>
struct dry_model : lacuna::default_model<Dim, Real> {};
/// The same with pores, whose flow is solved in every step.
template <class Real>
struct wet_model : lacuna::default_model<2, Real> {
    using flow = lacuna::explicit_flow;
};

/// Constants of the fluid: soft enough for the time step of the works, and open enough that pressures move by several
/// pores within a run.
struct fluid_constants {
    double bulk_modulus = 0.1, initial_pressure = 0.02;
    double conductivity = 0.1, residual_aperture = 0.3, half_force = 10;
    /// The squeezed discs leave little room between them: most pores rest at this share of their triangle.
    double minimum_volume_fraction = 0.05;
};

/// Thickness of the discs, with which a disc of mean radius weighs as much as a sphere, the particle of LAMMPS.
inline constexpr double sheet_thickness = 4.0 / 3 * 1.75;

/// Part of the sheet's load that a work carries. Bonds start without force, so that a fully bonded sheet would be struck
/// by all of it.
inline double load_share(work w) { return w == work::full || w == work::full3 ? 0.05 : 1; }

template <class Model>
lacuna::simulation_parameters<Model> work_parameters(int threads = 1) {
    sheet_constants const c;
    lacuna::simulation_parameters<Model> p;
    p.materials.resize(1);
    p.materials[0].density = 1;
    p.materials[0].contact = {c.normal_stiffness, c.shear_stiffness, c.friction};
    // Failure is tested for in every step; the strength is far beyond what the load brings.
    p.materials[0].bond = {c.normal_stiffness, c.shear_stiffness, 1e3, 1e3};
    if (Model::dim == 2) p.thickness = sheet_thickness;
    p.keep_pair_forces = false; // no work reads the force of a single pair
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

/// \param s sheet or block
/// \param free no disc held and none loaded: momentum is then conserved
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
                return lacuna::throat_boundary<real>{top ? lacuna::boundary_kind::drained : lacuna::boundary_kind::sealed,
                                                     real(0)};
            };
            return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii, drained_top);
        });
    return sim;
}

/// Energy of a simulation, load included; takes one step.
struct energy_state {
    double total = 0;  ///< kinetic + strain + fluid + potential of the load
    double stored = 0; ///< kinetic + strain + fluid
};
template <class Model, class Body>
energy_state energy_of(lacuna::simulation<Model>& sim, Body const& s, work w) {
    // The ledger is that of the positions at which the forces were found: those before the step.
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
    std::string why; ///< empty, or what failed
    void demand(bool condition, std::string const& what, double value, double limit) {
        if (condition) return;
        good = false;
        why += (why.empty() ? "" : "; ") + what + " " + std::to_string(value) + " (limit " + std::to_string(limit) + ")";
    }
};

/// One timed run of a work, after a few steps to warm up, and what its checks found.
struct timing {
    double seconds = 0;
    double cpu_seconds = 0; ///< of all threads; less disturbed than seconds by what else runs on the machine
    long long steps = 0;
    double resident_mb = 0; ///< memory in use after the last run, with the sheet and what the program itself takes; see machine.hpp
    std::size_t particles = 0, pairs = 0, bonds = 0, contacts = 0, open_throats = 0, active_throats = 0;
    long long rebuilds = 0;
    double energy_drift = 0;   ///< change of the total energy over the energy stored
    double ledger_residual = 0; ///< of the energy ledger over its largest term
    double momentum_drift = 0; ///< of a free sheet, over the sum of its particles' momenta
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
        auto const turn = sim.spin(k) * sim.moment_of_inertia(k);
        sum.momentum += v * m;
        sum.spin += turn;
        if constexpr (Model::dim == 2)
            sum.spin[0] += m * cross(x, v);
        else
            sum.spin += cross(x, v) * m;
        sum.linear += m * norm(v);
        sum.angular += m * norm(x) * norm(v) + norm(turn);
    }
    return sum;
}

/// Change of the momentum of a small sheet or block in random motion that nothing holds: zero but for rounding.
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
        lacuna::vec<double, lacuna::rotation_dim<Model::dim>> turn{};
        random(v);
        random(turn);
        sim.set_velocity(k, v);
        sim.set_spin(k, turn);
    }
    auto const before = momenta_of(sim);
    sim.run(300);
    auto const after = momenta_of(sim);
    double const linear = std::max(before.linear, after.linear), angular = std::max(before.angular, after.angular);
    return std::max(norm(after.momentum - before.momentum) / linear, norm(after.spin - before.spin) / angular);
}

/// Pairs that the step works on, padding of the packs left out.
template <class Table>
std::size_t count_pairs(Table const& table, std::size_t particles) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < table.slots(); ++k) count += table.is_padding(k, particles) ? 0 : 1;
    return count;
}

/// A work that has been set up and warmed up, and can be timed in parts.
/// \tparam Body sheet or block
template <class Model, class Body = sheet>
class work_run {
public:
    /// \param s is referred to
    work_run(Body const& s, work w, int threads = 1)
        : sheet_(s), work_(w), sim_(make_simulation<Model>(s, w, threads)) {
        auto const limits = sim_.limits();
        result_.found.demand(sim_.settings().time_step <= limits.critical(), "time step above the stable limit",
                             sim_.settings().time_step, limits.critical());
        begin_ = energy_of(sim_, sheet_, work_);
        // Throats that a short run would leave idle are in use: the announced run is long.
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

    /// Checks what the timed run has left behind.
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
        // Friction and outflow take energy out; nothing may bring it in.
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
    /// A number of steps besides the timed ones, less for large sheets.
    long long few(long long most) const { return std::clamp(most * 3200 / (long long)sheet_.size(), 5LL, most); }

    Body const& sheet_;
    work work_;
    lacuna::simulation<Model> sim_;
    energy_state begin_;
    long long rebuilds_ = 0;
    timing result_;
};

} // namespace bench
