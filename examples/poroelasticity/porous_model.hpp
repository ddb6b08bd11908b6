// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/laws/no_contact.hpp>
#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/simulation.hpp>

#include "medium.hpp"

/// \file
/// The common model of the cases, made of the library's parts, and the balance of its fluid.

namespace poroelasticity {

using point = lacuna::vec<double, 2>;
using discs = lacuna::packing<double, 2>;
using network = lacuna::pore_network<double, 2>;

/// The paper's bond with the stiffness of the stiffer of its two materials. So the materials of particles on an outline
/// or on a line of symmetry set the stiffness of the springs there.
struct outline_bond : lacuna::brittle_spring_bond {
    static parameters<double> combine(material const& a, material const& b, double thickness) {
        auto const& stiffer = a.normal_stiffness < b.normal_stiffness ? b : a;
        return lacuna::brittle_spring_bond::combine(stiffer, stiffer, thickness);
    }
};

/// Bonded discs, throats of constant aperture, and local damping.
struct porous_model : lacuna::default_model<2> {
    using contact_law = lacuna::no_contact;
    using bond_law = outline_bond;
    using damping = lacuna::local_damping;
    using flow = lacuna::explicit_flow_with<lacuna::constant_aperture>;
};
using simulator = lacuna::simulation<porous_model>;

/// Materials of the particles: inside, on the outline (half a disc), on a line of symmetry (half a disc, whole
/// springs), on both (a quarter of a disc), and the marks that hold cut springs (see column).
enum material : int { inner, outline, symmetry, corner, mark };

constexpr double mark_share = 1e-3; ///< radius of a mark divided by that of a disc

/// Parameters of the model for a medium. \param initial_pressure Pa
inline simulator::parameters porous_parameters(lattice_medium const& m, double initial_pressure) {
    simulator::parameters p;
    double const disc = std::numbers::pi * m.radius * m.radius;
    double const kn = m.normal_stiffness, ks = m.shear_stiffness;
    auto const add = [&](double mass, double area, double stiffness) {
        simulator::parameters::material one;
        one.density = mass / area;
        one.bond.normal_stiffness = stiffness * kn;
        one.bond.shear_stiffness = stiffness * ks;
        p.materials.push_back(one);
    };
    p.materials.clear();
    add(m.disc_mass, disc, 1);
    add(m.disc_mass / 2, disc, 0.5);
    add(m.disc_mass / 2, disc, 1);
    add(m.disc_mass / 4, disc, 0.5);
    add(m.disc_mass / 2, disc * mark_share * mark_share, 2);
    p.damping.factor = 0.5;
    p.safety = 0.8;
    p.follow_critical_step = false; // fluid_account and rigid_plate use one step for the whole run
    p.flow.bulk_modulus = m.bulk_modulus;
    p.flow.initial_pressure = initial_pressure;
    p.flow.skip_ratio = std::numeric_limits<double>::infinity();
    // C = k a^3 / l: only the product matters.
    p.flow.aperture.aperture = 0.01 * m.radius;
    p.flow.conductivity = m.conductance * 2 * m.radius / std::pow(p.flow.aperture.aperture, 3);
    return p;
}

/// Halves the length of throats through the surface. They lead only to the line of the outermost centres, where the
/// packing ends, half as far as to the next pore.
inline void halve_surface_throats(network& net) {
    for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t) net.length[t] *= 0.5;
}

/// Balance of the fluid in a run, from volumes, pressures and flows of the network alone.
class fluid_account {
public:
    explicit fluid_account(network const& net, double bulk_modulus) : bulk_modulus_(bulk_modulus) { remember(net); }

    /// Call after every step. \param dt s
    void add_step(network const& net, double dt) {
        add(net, dt, [](double strain) { return strain; });
    }
    /// Call after every step in slow time, in which the fluid's bulk modulus acts without linearisation.
    void add_slow_step(network const& net, double dt) {
        add(net, dt, [](double strain) { return std::expm1(strain); });
    }
    double inflow() const { return in_; }   ///< from reservoirs, m^3
    double outflow() const { return out_; } ///< to reservoirs, m^3
    double gained() const { return gained_; } ///< by the pores: sum of V dp / K_f + dV, m^3
    /// The imbalance divided by the total flow through the surface.
    double error() const { return std::fabs(gained_ - (in_ - out_)) / (in_ + out_); }

private:
    template <class Stored>
    void add(network const& net, double dt, Stored const& stored) {
        for (std::size_t k = 0; k < net.pores(); ++k)
            gained_ += net.volume[k] * stored((net.pressure[k] - pressure_[k]) / bulk_modulus_) +
                       (net.volume[k] - volume_[k]);
        for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t) {
            double const moved = net.flow[t] * dt;
            (moved > 0 ? in_ : out_) += std::fabs(moved);
        }
        remember(net);
    }
    void remember(network const& net) {
        pressure_.assign(net.pressure.begin(), net.pressure.end());
        volume_.assign(net.volume.begin(), net.volume.end());
    }

    double bulk_modulus_;
    double gained_ = 0, in_ = 0, out_ = 0;
    std::vector<double> pressure_, volume_;
};

} // namespace poroelasticity
