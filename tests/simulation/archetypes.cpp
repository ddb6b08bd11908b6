// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"
#include "setups.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/pores/mesh/triangulation.hpp>

/// \file
/// Parts that satisfy the concepts of their slots and have nothing else: the engine must not use more.

using namespace lacuna;

namespace {

struct spring_contact {
    struct material {
        double stiffness = 100; // N/m
        void validate(std::string const&) const {}
    };
    template <class T>
    struct parameters {
        T stiffness;
    };
    template <class T, int Dim>
    struct history {
        T rest;
    };
    static parameters<double> combine(material const& a, material const&, double) { return {a.stiffness}; }
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T) {
        return {distance};
    }
    template <class T, int Dim>
    static history<T, Dim> hand_over(parameters<T> const&, pair_motion<T, Dim> const& m, T,
                                     vec<T, shear_dim<Dim>> const&) {
        return {m.distance};
    }
    template <class T, int Dim>
    static pair_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                           history<T, Dim> const& h) {
        T overlap = max(h.rest - m.distance, T(0));
        return {-(p.stiffness * overlap), {}, h, T(0.5) * p.stiffness * overlap * overlap, T(0)};
    }
    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.stiffness;
    }
};
struct spring_bond {
    using material = spring_contact::material;
    template <class T>
    using parameters = spring_contact::parameters<T>;
    template <class T, int Dim>
    using history = spring_contact::history<T, Dim>;
    static parameters<double> combine(material const& a, material const&, double) { return {a.stiffness}; }
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T) {
        return {distance};
    }
    template <class T, int Dim>
    static bond_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                           history<T, Dim> const& h) {
        T stretch = m.distance - h.rest;
        auto const never = m.distance < T(0);
        return {{p.stiffness * stretch, {}, h, T(0.5) * p.stiffness * stretch * stretch, T(0)}, never, never};
    }
    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.stiffness;
    }
};
struct idle_damping {
    struct parameters {
        void validate(std::string const&) const {}
    };
    static constexpr bool acts_on_pairs = false, acts_on_particles = false;
    template <class T>
    static T particle_force(parameters const&, T const&, T const&) {
        return T(0);
    }
};
struct plain_integrator {
    template <bool WithEnergy, class Damping, class Real, int Dim, class PairForce>
    static void advance(particle_store<Real, Dim>& store, std::size_t first, int count, Real dt,
                        PairForce const& pair_force, typename Damping::parameters const& damping,
                        record_column<Real> const* extra, motion_report<Real>& report) {
        symplectic_euler::advance<WithEnergy, Damping>(store, first, count, dt, pair_force, damping, extra, report);
    }
};
struct endless_domain {
    static constexpr bool periodic = false;
    template <int Dim>
    struct parameters {
        void validate(std::string const&) const {}
    };
};
template <class Real, int Dim>
class all_pairs {
public:
    using real_type = Real;
    static constexpr int dim = Dim;
    void build(points_view<Real, Dim> const& points, Real cutoff) {
        touching_pairs(points, std::vector<Real>(points.size(), Real(0)), cutoff, found_);
    }
    void pairs(std::vector<neighbor_pair>& out) const { out = found_; }
    void touching_pairs(points_view<Real, Dim> const& points, std::span<Real const> radii, Real margin,
                        std::vector<neighbor_pair>& out) {
        out.clear();
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = i + 1; j < points.size(); ++j)
                if (norm(points[j] - points[i]) <= radii[i] + radii[j] + margin)
                    out.push_back({std::int32_t(i), std::int32_t(j)});
    }

private:
    std::vector<neighbor_pair> found_;
};
/// A wind: the same force on each particle, independent of the pores.
struct wind {
    struct parameters {
        double force = 0.25; // N
        int interval = 1;
        double bulk_modulus = 1, minimum_pressure = -std::numeric_limits<double>::infinity(),
               minimum_volume_fraction = 1e-3;
        void validate(std::string const&) const {}
    };
    template <class Real, int Dim>
    class solver {
    public:
        solver(parameters const& p, pore_network<Real, Dim> network, Real, points_view<Real, Dim>, Real const*)
            : parameters_(p), network_(std::move(network)) {
            network_.volume.assign(network_.pores(), Real(1));
        }
        parameters const& settings() const { return parameters_; }
        pore_network<Real, Dim> const& network() const { return network_; }
        template <class Lookup>
        void map_throats(Lookup const&) {}
        void refresh_apertures(particle_column<Real> const&, Real const*) {}
        void deactivate_slow_throats() {}
        template <bool WithLedger>
        void step(particle_column<Real> const&, Real const*, Real, int, record_column<Real>* out) {
            constexpr std::size_t records = Dim == 2 ? 1 : 2;
            for (std::size_t k = 0; k < out->size(); ++k) {
                record<Real> force(Real(0));
                if (k % records == 0) force.v[0] = Real(parameters_.force);
                out->set(k, force);
            }
        }
        Real critical_time_step() const { return std::numeric_limits<Real>::infinity(); }
        std::array<vec<Real, Dim>, std::size_t(Dim) + 1> pore_tractions(std::size_t, points_view<Real, Dim>,
                                                                        Real const*) const {
            return {};
        }
        Real storage_energy() const { return Real(0); }
        flow_ledger<Real> const& ledger() const { return ledger_; }
        void restore(pore_network<Real, Dim> network, flow_ledger<Real> const& ledger) {
            network_ = std::move(network);
            ledger_ = ledger;
        }
        template <class Archive>
        void serialize(Archive& ar) {
            ar(network_, ledger_);
        }

    private:
        parameters parameters_;
        pore_network<Real, Dim> network_;
        flow_ledger<Real> ledger_;
    };
};
struct end_watch {
    static constexpr stage stages = stage::end;
    double time = 0;
    template <class Simulation>
    void on_end(Simulation const& sim) {
        time = sim.time();
    }
};

template <int Dim>
struct archetypes : default_model<Dim> {
    using contact_law = spring_contact;
    using bond_law = spring_bond;
    using damping = idle_damping;
    using flow = wind;
    using integrator = plain_integrator;
    using domain = endless_domain;
    template <class Real, int D>
    using search = all_pairs<Real, D>;
};

} // namespace

TEMPLATE_TEST_CASE("parts that only satisfy the concepts of their slots make a simulator", "[model]", archetypes<2>,
                   archetypes<3>) {
    constexpr int dim = TestType::dim;
    constexpr double dt = 1e-3, k = 100, pull = 0.02, meet = 0.05, force = 0.25;
    auto const at = [](double x, double y, double z) {
        vec<double, dim> p{};
        double const all[] = {x, y, z};
        for (int axis = 0; axis < dim; ++axis) p[axis] = all[axis];
        return p;
    };
    packing<double, dim> particles;
    for (auto const& x : {at(0, 0, 0), at(1, 0, 0), at(0.5, 0.95, 0), at(1.52, 0.95, 0)}) particles.add(x, 0.5);
    if (dim == 3) particles.add(at(0.75, 0.45, 0.95), 0.5);
    particles.bonds.push_back({0, 1});
    simulation_parameters<TestType> p;
    p.materials[0].density = setups::unit_density(dim);
    p.time_step = dt;
    simulation<TestType> sim(particles, p);
    sim.fill_pores([](auto points, double const* radii) {
        return make_pore_network(triangulate_body(points, radii), points, radii);
    });
    sim.set_velocity(1, at(pull, 0, 0));
    sim.set_velocity(2, at(meet, 0, 0));
    sim.set_velocity(3, at(-meet, 0, 0));
    end_watch watch;

    // Two masses of 1 kg on a spring: their distance oscillates with sqrt(2 k).
    sim.run(100, watch);
    REQUIRE_THAT(watch.time, WithinRel(0.1, 1e-12));
    double const w = std::sqrt(2 * k);
    REQUIRE_THAT(sim.position(1)[0] - sim.position(0)[0], WithinAbs(1 + pull / w * std::sin(w * 0.1), 2e-5));
    // An elastic collision exchanges velocities.
    sim.run(500, watch);
    REQUIRE_THAT(sim.velocity(3)[0] - sim.velocity(2)[0], WithinRel(2 * meet, 1e-2));
    // The wind accelerates all particles alike: each gains F t over its initial momentum.
    double momentum = 0;
    for (std::size_t i = 0; i < sim.size(); ++i) momentum += sim.velocity(i)[0];
    REQUIRE_THAT(momentum, WithinRel(double(sim.size()) * force * 0.6 + pull, 1e-9));
    REQUIRE(sim.limits().flow == std::numeric_limits<double>::infinity());
}
