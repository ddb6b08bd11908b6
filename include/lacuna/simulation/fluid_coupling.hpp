// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <lacuna/core/error.hpp>
#include <lacuna/core/particle_refusal.hpp>
#include <lacuna/model.hpp>
#include <lacuna/particles/store.hpp>
#include <lacuna/pores/mesh/no_pores.hpp>
#include <lacuna/simulation/remesher.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// The fluid of a simulation and its coupling to particles and pairs. It does nothing in a model without fluid, and
/// nothing before the pores are filled.
template <class Model>
class fluid_coupling {
public:
    using real = typename Model::real;
    using store_type = particle_store<real, Model::dim>;
    using flow_type = typename Model::flow::template solver<real, Model::dim>;

    /// The flow solver; nullptr without fluid.
    flow_type const* get() const noexcept { return flow_ ? &*flow_ : nullptr; }
    flow_type* get() noexcept { return flow_ ? &*flow_ : nullptr; }

    /// Makes the pores and fills them.
    /// \param thickness of a 2D packing, m
    /// \param make callable (positions, radii) -> pore_network in the store's numbering
    /// \throws std::invalid_argument for a network without pores, unless the flow's parameters are dry()
    template <class Make, class Pairs>
    void fill(store_type const& store, Pairs const& pairs, typename Model::flow::parameters const& parameters,
              remesh_parameters const& remeshing, double thickness, Make const& make) {
        auto const* radii = store.radii().data();
        by_id(store, [&] {
            auto network = make(store.positions(), radii);
            bool dry = false;
            if constexpr (requires { parameters.dry(); }) dry = parameters.dry();
            if (network.pores() == 0 && !dry) refuse_no_pores(store.positions(), radii);
            flow_.emplace(parameters, std::move(network), real(thickness), store.positions(), radii);
        });
        if constexpr (has_fluid<Model>) {
            remesher_.start(remeshing, make, real(thickness), *flow_, store.positions(), radii, pairs);
            map_throats(pairs);
            // Sets the apertures, so that limits of the time step use the present gaps.
            deactivate_slow_throats(store, pairs);
        }
    }

    /// Finds the normal force of each throat's pair. Call it when the normal forces have moved in memory.
    template <class Pairs>
    void map_throats(Pairs const& pairs) {
        if constexpr (has_fluid<Model>)
            if (flow_)
                flow_->map_throats([&](std::int32_t i, std::int32_t j) { return pairs.find_normal_force(i, j); });
    }

    /// Makes one step of the fluid: geometry, apertures, flow, pressures. Writes the forces of the pressures to `out`.
    /// With an interval n fluid flows only in the last of every n steps, for the time of all n.
    /// \param dt length of the step, s
    /// \param number number of the step, from 0
    /// \param out one record per particle; overwritten
    /// \throws unstable_run if throats have opened so far that the step needs too many flow steps; in step 0
    ///         std::invalid_argument
    template <bool WithLedger, class Pairs>
    void step(store_type const& store, Pairs const& pairs, real dt, long long number, int threads,
              record_column<real>& out) {
        if constexpr (has_fluid<Model>)
            if (flow_) {
                int const interval = flow_->settings().interval;
                real const flow_time = (number + 1) % interval == 0 ? dt * real(interval) : real(0);
                try {
                    flow_->template step<WithLedger>(store.particle_records(), pairs.normal_forces(), flow_time,
                                                     threads, &out);
                } catch (std::invalid_argument const& why) {
                    if (number == 0) throw;
                    // After step 0 the cause is the run, not the input.
                    throw unstable_run("unstable run at step " + std::to_string(number) + ": " + why.what(), number,
                                       -1);
                }
            }
    }

    /// Gives the fluid a new mesh if remesh_parameters require it.
    /// \param number number of the step
    /// \return whether the mesh has changed
    /// \throws unstable_run if no network can be made from the positions of the particles
    template <class Pairs>
    bool remesh(store_type const& store, Pairs const& pairs, long long number) {
        if constexpr (has_fluid<Model>)
            if (flow_ && remesh_if_needed(store, pairs, number)) {
                map_throats(pairs);
                deactivate_slow_throats(store, pairs);
                return true;
            }
        return false;
    }

    /// Updates the apertures. Then deactivates throats whose flow does not matter, and reactivates those that have
    /// opened.
    template <class Pairs>
    void deactivate_slow_throats(store_type const& store, Pairs const& pairs) {
        if constexpr (has_fluid<Model>)
            if (flow_) {
                flow_->refresh_apertures(store.particle_records(), pairs.normal_forces());
                flow_->deactivate_slow_throats();
            }
    }
    /// Writes the state that a run changes to an archive, or reads it from one.
    template <class Archive>
    void archive(Archive& ar, store_type const& store) {
        bool filled = flow_.has_value();
        ar(filled);
        require_state(filled == flow_.has_value(),
                      "its pores are filled and those of this simulation are not, or vice versa");
        if constexpr (has_fluid<Model>) {
            if (remesher_.on()) remesher_.archive(ar, *flow_, store.radii().data());
            if (filled) ar(*flow_);
        }
    }

private:
    /// Calls `call`. If it refuses particles by their internal indices, the new exception names their ids instead.
    template <class Call>
    static auto by_id(store_type const& store, Call const& call) {
        try {
            return call();
        } catch (particle_refusal const& bad) {
            throw bad.named([&](std::size_t i) { return store.id(i); });
        }
    }
    template <class Pairs>
    bool remesh_if_needed(store_type const& store, Pairs const& pairs, long long number) {
        try {
            return by_id(store, [&] {
                return remesher_.remesh(*flow_, store.positions(), store.radii().data(), pairs, number);
            });
        } catch (std::invalid_argument const& why) {
            // The cause is the run, not the input.
            throw unstable_run("new mesh of the pores after step " + std::to_string(number) + ": " + why.what(), number,
                               -1);
        }
    }

    std::optional<flow_type> flow_;
    remesher<flow_type, real, Model::dim> remesher_;
};
LACUNA_END_PACKS

} // namespace lacuna
