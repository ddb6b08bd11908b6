// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <variant>

#include <lacuna/laws/aperture.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/flow/flow.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>

namespace lacuna_run {

/// One of two aperture laws, chosen at the start of a run.
struct chosen_aperture {
    struct parameters {
        bool is_constant = false;
        lacuna::constant_aperture::parameters constant{};
        lacuna::contact_force_aperture::parameters contact_force{};
        void validate(std::string const& name) const {
            constant.validate(name);
            contact_force.validate(name);
        }
    };
    template <class T>
    static T aperture(parameters const& p, T normal_force, T gap) {
        if (p.is_constant) return lacuna::constant_aperture::aperture(p.constant, normal_force, gap);
        return lacuna::contact_force_aperture::aperture(p.contact_force, normal_force, gap);
    }
};

enum class flow_kind { none, explicit_steps, implicit_steps };

/// Flow policy of the plane: no fluid, explicit flow or implicit flow, chosen at the start of a run. One branch per
/// step avoids a separate simulator for each. The solvers are compiled once, in chosen_flow.cpp.
struct chosen_flow {
    struct parameters : lacuna::implicit_flow_parameters<chosen_aperture> {
        flow_kind kind = flow_kind::none;
        /// Its members, by name; see core/aggregate.hpp.
        template <class Visit>
        void for_each_named(Visit const& visit) {
            lacuna::implicit_flow_parameters<chosen_aperture>::for_each_named(visit);
            visit("kind", kind);
        }
        /// Whether the run has no fluid: then its network has no pores.
        bool dry() const noexcept { return kind == flow_kind::none; }
        void validate(std::string const& name) const {
            if (kind == flow_kind::implicit_steps)
                lacuna::implicit_flow_parameters<chosen_aperture>::validate(name);
            else if (kind == flow_kind::explicit_steps)
                lacuna::flow_parameters<chosen_aperture>::validate(name);
        }
    };

    template <class Real, int Dim>
    class solver {
        static_assert(Dim == 2);
        using points_type = lacuna::points_view<Real, 2>;
        using records = lacuna::record_column<Real>;
        using particles_type = lacuna::particle_column<Real>;
        using explicit_type = lacuna::explicit_flow_solver<Real, 2, chosen_aperture>;
        using implicit_type = lacuna::implicit_flow_solver<Real, 2, chosen_aperture>;

    public:
        using network_type = lacuna::pore_network<Real, 2>;
        using lookup_type = std::function<std::int64_t(std::int32_t, std::int32_t)>;

        /// Pores between particles.
        solver(parameters const& p, network_type network, Real thickness, points_type points, Real const* radii);
        /// A bare network.
        solver(parameters const& p, network_type network);

        template <class Lookup>
        void map_throats(Lookup const& lookup) {
            map(lookup_type(lookup));
        }
        void refresh_apertures(particles_type const& positions, Real const* normal_forces, int threads = 1);
        template <bool WithLedger>
        void step(particles_type const& positions, Real const* normal_forces, Real dt, int threads = 1,
                  records* tractions = nullptr) {
            take_step(WithLedger, positions, normal_forces, dt, threads, tractions);
        }
        /// One step of flow alone.
        void advance(Real dt, int threads);
        std::array<lacuna::vec<Real, 2>, 3> pore_tractions(std::size_t pore, points_type points,
                                                           Real const* radii) const;
        Real critical_time_step() const;
        /// As of the explicit and implicit solver, s; infinite without fluid.
        Real mean_throat_limit() const;
        Real storage_energy() const;
        lacuna::flow_ledger<Real> const& ledger() const;
        network_type const& network() const;
        parameters const& settings() const { return parameters_; }
        std::size_t deactivate_slow_throats();
        /// Continues with another network of the same packing, as the solvers do.
        void restore(network_type network, lacuna::flow_ledger<Real> const& ledger);
        template <class Archive>
        void serialize(Archive& ar) {
            std::visit([&](auto& one) { ar(one); }, chosen_);
        }

    private:
        void map(lookup_type const& lookup);
        void take_step(bool with_ledger, particles_type const& positions, Real const* normal_forces, Real dt,
                       int threads, records* tractions);

        parameters parameters_;
        std::variant<typename lacuna::no_flow::solver<Real, 2>, explicit_type, implicit_type> chosen_;
    };
};

} // namespace lacuna_run
