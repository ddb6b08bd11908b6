// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <lacuna/interactions/interactions.hpp>
#include <lacuna/interactions/interactions_archive.hpp>
#include <lacuna/interactions/walls.hpp>
#include <lacuna/loads/load_set.hpp>
#include <lacuna/loads/prescribed_motion.hpp>
#include <lacuna/loads/rigid_plates.hpp>
#include <lacuna/loads/wall_drive.hpp>
#include <lacuna/model.hpp>
#include <lacuna/particles/spatial_order.hpp>
#include <lacuna/simulation/fluid_coupling.hpp>
#include <lacuna/simulation/ledger_keeper.hpp>
#include <lacuna/simulation/parameters.hpp>
#include <lacuna/simulation/run_guards.hpp>
#include <lacuna/simulation/velocity_changes.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// State of a model at one instant: particles, pairs, walls, loads, fluid, and the forces between them.
/// explicit_stepper advances it in time.
template <class Model>
struct simulation_state {
    using model_type = Model;
    using real = typename Model::real;
    static constexpr int dim = Model::dim;
    using point = vec<double, dim>;
    using contact_law_type = typename Model::contact_law;
    using bond_law_type = typename Model::bond_law;
    using damping_type = typename Model::damping;
    using store_type = particle_store<real, dim>;
    using interactions_type = interactions<real, dim, contact_law_type, bond_law_type, damping_type,
                                           typename Model::template search<real, dim>, typename Model::domain>;
    using walls_type = wall_contacts<contact_law_type, damping_type, real, dim>;
    using event_type = break_event<dim>;

    /// \throws std::invalid_argument for a bad packing or parameter; see simulation
    simulation_state(packing<real, dim> const& packing, simulation_parameters<Model> const& p)
        : settings(checked(p, packing)), store(make_particles(packing)),
          pairs(store, packing.bonds, p.materials, p.thickness, p.interactions, p.damping, p.bonds),
          walls(p.walls, contact_materials(), p.thickness), loads(make_loads(packing)), own_forces(p.forces),
          wall_motions(p.walls.size(), p.thickness),
          guards(store, pairs, p.guards, p.damping, p.allow_unstable_step) {
        loads.apply_weight(store);
        pairs.set_deepest_overlap(p.guards.largest_overlap());
        update_walls();
        reports.resize(std::size_t(pairs.chunks()));
        other_forces.resize(store.size() * pair_forces<real, dim>::records_per_pair);
    }

    bool filled() const noexcept { return fluid.get() != nullptr; }
    /// Updates the list of particles close to each wall.
    void update_walls() {
        if (walls.empty()) return;
        walls.update(store, pairs.neighbors().settings().skin, real(settings.interactions.initial_contact_tolerance));
    }
    /// Gives particle k a velocity, m/s. The ledger counts the change of kinetic energy as external work.
    void apply_velocity_change(std::size_t k, point const& v) {
        changes.add(store, k, false);
        ledger.book_work(0.5 * double(store.mass(k)) *
                         (squared_norm(v) - squared_norm(convert<double>(store.velocity(k)))));
        store.set_velocity(k, convert<real>(v));
    }
    /// Gives particle k a spin, rad/s, in the same way.
    void apply_spin_change(std::size_t k, vec<double, rotation_dim<dim>> const& w) {
        changes.add(store, k, true);
        ledger.book_work(0.5 * double(store.moment_of_inertia(k)) *
                         (squared_norm(w) - squared_norm(convert<double>(store.spin(k)))));
        store.set_spin(k, convert<real>(w));
    }

    /// Writes or reads all state that steps and calls change, except for the clock.
    template <class Archive>
    void serialize(Archive& ar) {
        ar(store);
        loads.archive(ar, store.size());
        interactions_archive::apply(ar, pairs, store);
        walls.archive(ar, store);
        ar(wall_motions);
        fluid.archive(ar, store);
        if constexpr (requires { own_forces.archive(ar, store); }) own_forces.archive(ar, store);
        ar(events, changes, motions, plates, ledger, guards);
        require_state(motions.fits(store.size()), "a motion prescribed to no particle");
        require_state(plates.fit(store.size()), "a rigid plate of no particle");
        require_state(guards.fit(store.size()), "guards that follow no particle");
        require_state(changes.fit(store.size()), "a velocity given to no particle");
        if constexpr (Archive::is_loading::value) {
            reports.resize(std::size_t(pairs.chunks()));
            fluid.map_throats(pairs);
        }
    }

    simulation_parameters<Model> settings;
    store_type store;
    interactions_type pairs;
    walls_type walls;
    load_set<real, dim> loads;
    fluid_coupling<Model> fluid;
    typename Model::forces::template term<real, dim> own_forces;
    wall_drive<dim> wall_motions;
    prescribed_motion<dim> motions;
    rigid_plates<real, dim> plates;
    velocity_changes<real, dim> changes;      ///< since the last step
    record_column<real> other_forces; ///< all forces but those of pairs and loads, in the layout of the integrators
    std::vector<motion_report<real>> reports; ///< of the last step, by chunk
    std::vector<event_type> events;           ///< failures of the last step
    pair_energy wall_energy;
    /// Power of walls and of the model's own forces, with velocities before and after the step, W.
    std::array<double, 2> wall_power{}, own_power{};
    ledger_keeper<real> ledger;
    run_guards<Model> guards;

private:
    static simulation_parameters<Model> const& checked(simulation_parameters<Model> const& p,
                                                       packing<real, dim> const& packing) {
        p.validate();
        packing.require_bond_kinds(p.bonds.size());
        if constexpr (Model::domain::periodic)
            packing.require_period(p.domain.period);
        else
            packing.require_period(point{});
        return p;
    }
    store_type make_particles(packing<real, dim> const& packing) const {
        auto const order = [&] {
            if constexpr (dim == 2)
                return strip_order(view_points(packing.position));
            else
                return spatial_order(view_points(packing.position));
        }();
        store_type particles(packing, order, densities(), settings.mass, settings.thickness);
        if constexpr (Model::domain::periodic) {
            static_assert(!has_fluid<Model>, "pores have no images: a model with fluid has an open domain");
            particles.set_period(settings.domain.period);
        }
        return particles;
    }
    load_set<real, dim> make_loads(packing<real, dim> const& packing) const {
        bool const own = !packing.density.empty();
        std::vector<double> density = densities();
        if (own) density.clear();
        for (std::size_t k = 0; own && k < store.size(); ++k)
            density.push_back(packing.density[std::size_t(store.id(k))]);
        return {settings.gravity, settings.weight_shares(density), own};
    }
    /// Densities of the materials, kg/m^3.
    std::vector<double> densities() const {
        std::vector<double> list;
        for (auto const& m : settings.materials) list.push_back(m.density);
        return list;
    }
    std::vector<typename contact_law_type::material> contact_materials() const {
        std::vector<typename contact_law_type::material> list;
        for (auto const& m : settings.materials) list.push_back(m.contact);
        return list;
    }
};
LACUNA_END_PACKS

} // namespace lacuna
