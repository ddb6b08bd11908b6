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
/// The fluid of a simulation and its exchange with particles and pairs; does nothing in a model without fluid and
/// until the pores are filled.
template <class Model>
class fluid_coupling {
public:
    using real = typename Model::real;
    using store_type = particle_store<real, Model::dim>;
    using flow_type = typename Model::flow::template solver<real, Model::dim>;

    /// The flow solver, nullptr without fluid.
    flow_type const* get() const noexcept { return flow_ ? &*flow_ : nullptr; }
    flow_type* get() noexcept { return flow_ ? &*flow_ : nullptr; }

    /// \param make callable (positions, radii) -> pore_network in the store's numbering
    /// \throws std::invalid_argument for a network without pores, unless the flow's parameters say that they are dry()
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
            // So that step limits are those of the gaps that there are.
            deactivate_slow_throats(store, pairs);
        }
    }

    /// To be called when the pairs' normal forces have moved in memory.
    template <class Pairs>
    void map_throats(Pairs const& pairs) {
        if constexpr (has_fluid<Model>)
            if (flow_) flow_->map_throats([&](std::int32_t i, std::int32_t j) { return pairs.find_normal_force(i, j); });
    }

    /// Geometry, apertures, flow, pressures; then their forces, written to `out`, a record per particle. With an
    /// interval n the last of every n steps lets fluid flow, for the time of all n.
    /// \param number of the step, from 0
    /// \throws unstable_run when throats have opened so far that the step takes more flow steps than can be made;
    ///         std::invalid_argument in step 0
    template <bool WithLedger, class Pairs>
    void step(store_type const& store, Pairs const& pairs, real dt, long long number, int threads,
              record_column<real>& out) {
        if constexpr (has_fluid<Model>)
            if (flow_) {
                int const interval = flow_->settings().interval;
                real const flow_time = (number + 1) % interval == 0 ? dt * real(interval) : real(0);
                try {
                    flow_->template step<WithLedger>(store.bodies(), pairs.normal_forces(), flow_time, threads, &out);
                } catch (std::invalid_argument const& why) {
                    if (number == 0) throw;
                    // It is the run that has led there, not the input.
                    throw unstable_run("unstable run at step " + std::to_string(number) + ": " + why.what(), number, -1);
                }
            }
    }

    /// Gives the fluid a new mesh where remesh_parameters ask for one.
    /// \param number of the step that has been made
    /// \return whether the mesh is another
    /// \throws unstable_run when the particles are where no network can be made
    template <class Pairs>
    bool remesh(store_type const& store, Pairs const& pairs, long long number) {
        if constexpr (has_fluid<Model>)
            if (flow_ && make_anew(store, pairs, number)) {
                map_throats(pairs);
                deactivate_slow_throats(store, pairs);
                return true;
            }
        return false;
    }

    /// New apertures; leaves out the throats that do not matter, and takes up again those that have opened.
    template <class Pairs>
    void deactivate_slow_throats(store_type const& store, Pairs const& pairs) {
        if constexpr (has_fluid<Model>)
            if (flow_) {
                flow_->refresh_apertures(store.bodies(), pairs.normal_forces());
                flow_->deactivate_slow_throats();
            }
    }
    /// Writes to, or reads from, an archive what a run changes.
    template <class Archive>
    void archive(Archive& ar, store_type const& store) {
        bool filled = flow_.has_value();
        ar(filled);
        require_state(filled == flow_.has_value(), "its pores are filled and these are not, or the other way round");
        if constexpr (has_fluid<Model>) {
            if (remesher_.on()) remesher_.archive(ar, *flow_, store.radii().data());
            if (filled) ar(*flow_);
        }
    }

private:
    /// Calls it; a refusal that names particles by their places in the store names them by their ids.
    template <class Call>
    static auto by_id(store_type const& store, Call const& call) {
        try {
            return call();
        } catch (particle_refusal const& bad) {
            throw bad.named([&](std::size_t i) { return store.id(i); });
        }
    }
    template <class Pairs>
    bool make_anew(store_type const& store, Pairs const& pairs, long long number) {
        try {
            return by_id(store, [&] { return remesher_.remesh(*flow_, store.positions(), store.radii().data(), pairs, number); });
        } catch (std::invalid_argument const& why) {
            // It is the run that has led there, not the input.
            throw unstable_run("pores made anew after step " + std::to_string(number) + ": " + why.what(), number, -1);
        }
    }

    std::optional<flow_type> flow_;
    remesher<flow_type, real, Model::dim> remesher_;
};
LACUNA_END_PACKS

} // namespace lacuna
