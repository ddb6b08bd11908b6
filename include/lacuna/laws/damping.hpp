// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/scalar.hpp>

/// \file
/// Damping policies. Each has `parameters` and two formulas over a scalar type:
///   pair_force(p, stiffness, mass_i, mass_j, normal_rate): force along the normal, positive in tension, N;
///   particle_force(p, force, velocity): what is added to one component of a particle's force (or torque).

namespace lacuna {

/// No damping: the paper's choice.
struct no_damping {
    struct parameters {
        void validate(std::string const&) const {}
    };
    static constexpr bool acts_on_pairs = false;
    static constexpr bool acts_on_particles = false;
    template <class T>
    static T pair_force(parameters const&, T const&, T const&, T const&, T const&) {
        return T(0);
    }
    template <class T>
    static T particle_force(parameters const&, T const&, T const&) {
        return T(0);
    }
};

/// Local non-viscous damping (Cundall 1987): a force against the motion, proportional to the unbalanced force,
/// -alpha |F| sign(v), on each component. Bodies in steady motion are not slowed.
struct local_damping {
    struct parameters {
        double factor = 0.7; ///< alpha, 0 to 1
        void validate(std::string const& name) const { require_in(name + ".factor", factor, 0, 1); }
    };
    static constexpr bool acts_on_pairs = false;
    static constexpr bool acts_on_particles = true;
    template <class T>
    static T pair_force(parameters const&, T const&, T const&, T const&, T const&) {
        return T(0);
    }
    template <class T>
    static T particle_force(parameters const& p, T const& force, T const& velocity) {
        T drag = T(value_t<T>(p.factor)) * abs(force);
        return select(velocity > T(0), -drag, select(velocity < T(0), drag, T(0)));
    }
};

/// Dashpot along the normal of each contact and bond, c = 2 ratio sqrt(k_n m_eff), m_eff = m_i m_j / (m_i + m_j).
/// A contact's total normal force stays compressive: a rebounding pair separates when spring and dashpot
/// together vanish, not when the overlap does (restitution of reference case 1b "zero force").
struct viscous_damping {
    struct parameters {
        double ratio = 0.1; ///< fraction of critical damping, >= 0
        void validate(std::string const& name) const { require_not_negative(name + ".ratio", ratio); }
    };
    static constexpr bool acts_on_pairs = true;
    static constexpr bool acts_on_particles = false;
    template <class T>
    static T pair_force(parameters const& p, T const& stiffness, T const& mass_i, T const& mass_j,
                        T const& normal_rate) {
        return T(value_t<T>(2 * p.ratio)) * sqrt(stiffness * (mass_i * mass_j) / (mass_i + mass_j)) * normal_rate;
    }
    template <class T>
    static T particle_force(parameters const&, T const&, T const&) {
        return T(0);
    }
};

template <class Policy>
concept damping_policy = requires(typename Policy::parameters const& p) {
    p.validate("damping");
    { Policy::acts_on_pairs } -> std::convertible_to<bool>;
    { Policy::acts_on_particles } -> std::convertible_to<bool>;
    { Policy::pair_force(p, 1.0, 1.0, 1.0, 1.0) } -> std::convertible_to<double>;
    { Policy::particle_force(p, 1.0, 1.0) } -> std::convertible_to<double>;
};

} // namespace lacuna
