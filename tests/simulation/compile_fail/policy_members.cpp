// SPDX-License-Identifier: BSD-3-Clause
// refused with NO_STEP: the flow's solver needs: template <bool WithLedger> void step(
// refused with OTHER_NETWORK: the flow's solver needs: pore_network<Real, Dim> const& network() const
// refused with NO_RESTORE: the flow's solver needs: void restore(
// refused with NO_PARTICLE_FORCE: the damping needs, for every T: static T particle_force(
// refused with NUMBERS_ONLY: the damping needs, for every T: static T particle_force(
// refused with NO_PAIR_FORCE: a damping that acts_on_pairs needs, for every T: static T pair_force(
// refused with NO_PERIOD: a periodic domain needs: vec<double, Dim> period
// refused with NO_TOUCHING_PAIRS: the search needs: void touching_pairs(

#include <concepts>
#include <limits>
#include <string>
#include <utility>

#include <lacuna/simulation.hpp>

struct my_flow {
    struct parameters {
        int interval = 1;
        double bulk_modulus = 1, minimum_pressure = -std::numeric_limits<double>::infinity(),
               minimum_volume_fraction = 1e-3;
        void validate(std::string const&) const {}
    };
    template <class Real, int Dim>
    struct solver {
        using network_type = lacuna::pore_network<Real, Dim>;
        parameters own;
        network_type net;
        lacuna::flow_ledger<Real> sums{};
        solver(parameters const& p, network_type network, Real, lacuna::points_view<Real, Dim>, Real const*)
            : own(p), net(std::move(network)) {}
        parameters const& settings() const { return own; }
#ifdef OTHER_NETWORK
        network_type network() const { return net; }
#else
        network_type const& network() const { return net; }
#endif
        template <class Lookup>
        void map_throats(Lookup const&) {}
        void refresh_apertures(lacuna::particle_column<Real> const&, Real const*) {}
        void deactivate_slow_throats() {}
#ifndef NO_STEP
        template <bool WithLedger>
        void step(lacuna::particle_column<Real> const&, Real const*, Real, int, lacuna::record_column<Real>*) {}
#endif
        Real critical_time_step() const { return std::numeric_limits<Real>::infinity(); }
        std::array<lacuna::vec<Real, Dim>, std::size_t(Dim) + 1>
        pore_tractions(std::size_t, lacuna::points_view<Real, Dim>, Real const*) const {
            return {};
        }
        Real storage_energy() const { return Real(0); }
        lacuna::flow_ledger<Real> const& ledger() const { return sums; }
#ifndef NO_RESTORE
        void restore(network_type, lacuna::flow_ledger<Real> const&) {}
#endif
        template <class Archive>
        void serialize(Archive&) {}
    };
};

struct my_damping {
    struct parameters {
        void validate(std::string const&) const {}
    };
    static constexpr bool acts_on_particles = true;
#ifdef NO_PAIR_FORCE
    static constexpr bool acts_on_pairs = true;
#else
    static constexpr bool acts_on_pairs = false;
#endif
#ifndef NO_PARTICLE_FORCE
    template <class T>
#ifdef NUMBERS_ONLY
        requires std::floating_point<T>
#endif
    static T particle_force(parameters const&, T const&, T const& velocity) {
        return -velocity;
    }
#endif
};

struct my_domain {
    template <int Dim>
    struct parameters {
        void validate(std::string const&) const {}
    };
#ifdef NO_PERIOD
    static constexpr bool periodic = true;
#else
    static constexpr bool periodic = false;
#endif
};

template <class Real, int Dim>
struct my_search : lacuna::cell_grid<Real, Dim> {
#ifdef NO_TOUCHING_PAIRS
    void touching_pairs() {}
#endif
};

struct my_model : lacuna::default_model<2> {
    using flow = my_flow;
    using damping = my_damping;
    using domain = my_domain;
    template <class Real, int Dim>
    using search = my_search<Real, Dim>;
};

void use(lacuna::packing<double, 2> const& discs) {
    lacuna::simulation_parameters<my_model> p;
    lacuna::simulation<my_model> run(discs, p);
    run.fix(0);
    run.run(1);
}
