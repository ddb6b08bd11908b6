// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <lacuna/model.hpp>
#include <lacuna/particles/store.hpp>

namespace lacuna {

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

    /// \param make callable (positions, radii) -> pore_network in the store's numbering
    template <class Make>
    void fill(store_type const& store, typename Model::flow::parameters parameters, double thickness, Make const& make) {
        parameters.thickness = thickness;
        auto const* radii = store.radii().data();
        flow_.emplace(parameters, make(store.positions(), radii), store.positions(), radii);
    }

    /// Geometry, apertures, flow, pressures; then their forces, added to `out`, a record per particle.
    template <class Pairs>
    void step(store_type const& store, Pairs const& pairs, real dt, record_column<real>& out) {
        if constexpr (has_fluid<Model>)
            if (flow_) {
                auto const points = store.positions();
                auto const* radii = store.radii().data();
                flow_->refresh_geometry(points, radii);
                flow_->refresh_apertures([&](std::int32_t i, std::int32_t j) { return throat(store, pairs, i, j); });
                flow_->advance(dt);
                flow_->add_tractions(points, radii, out.data(), 4);
            }
    }

    /// Decides which throats are left out of a run of `duration` s, and takes up again those that have opened.
    template <class Pairs>
    void skip_idle_throats(store_type const& store, Pairs const& pairs, double duration) {
        if constexpr (has_fluid<Model>)
            if (flow_) {
                flow_->refresh_apertures([&](std::int32_t i, std::int32_t j) { return throat(store, pairs, i, j); }, true);
                flow_->skip_idle_throats(real(duration));
            }
    }

private:
    /// What the pair at a throat does, from its force in this step.
    template <class Pairs>
    static throat_state<real> throat(store_type const& store, Pairs const& pairs, std::int32_t i, std::int32_t j) {
        auto const offset = pairs.find_force(i, j);
        real const distance = norm(store.position(std::size_t(j)) - store.position(std::size_t(i)));
        return {offset < 0 ? real(0) : pairs.force_column()[offset + 3],
                distance - store.radius(std::size_t(i)) - store.radius(std::size_t(j))};
    }

    std::optional<flow_type> flow_;
};

} // namespace lacuna
