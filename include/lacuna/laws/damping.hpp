// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <concepts>
#include <numbers>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/core/scalar.hpp>

/// \file
/// Damping policies. Each has `parameters` and two formulas over a scalar type:
///   - pair_force(p, stiffness, mass_i, mass_j, normal_rate): force along the normal, positive in tension, N (where
///     acts_on_pairs is true);
///   - particle_force(p, force, velocity): the term that damping adds to one component of a particle's force, N, or
///     torque, N m. A policy with `needs_inertia` also has particle_force(p, force, velocity, inertia), and
///     drag_rate(p), the drag over the momentum, 1/s.

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

/// Local non-viscous damping (Cundall 1987): each component gets a force against the motion, proportional to the
/// unbalanced force, -alpha |F| sign(v). It does not slow particles in steady motion.
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
/// A contact's total normal force stays compressive. A rebounding pair separates when the sum of spring and dashpot
/// force vanishes, not when the overlap does (restitution of reference case 1b "zero force").
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

/// Dashpot along the normal that gives every collision the same coefficient of restitution e. It is the dashpot of
/// viscous_damping with ratio -ln e / sqrt(ln^2 e + pi^2). It acts, and may pull, until the overlap is zero
/// (restitution of reference case 1b "zero overlap"; Hertzian contacts: see hertz_mindlin).
struct restitution_damping {
    struct parameters {
        double restitution = 1; ///< e, above 0 and at most 1
        double ratio = 0;       ///< fraction of critical damping that belongs to e: see with_restitution()
        void validate(std::string const& name) const {
            if (!(restitution > 0 && restitution <= 1)) refuse(name + ".restitution", restitution, "> 0 and <= 1");
            if (!(std::fabs(ratio - ratio_of(restitution)) <= 1e-12))
                refuse(name + ".ratio", ratio, "that of the restitution: use with_restitution()");
        }
    };
    static constexpr bool acts_on_pairs = true;
    static constexpr bool acts_on_particles = false;
    static constexpr bool pulls = true;
    static parameters with_restitution(double e) { return {e, ratio_of(e)}; }
    template <class T>
    static T pair_force(parameters const& p, T const& stiffness, T const& mass_i, T const& mass_j,
                        T const& normal_rate) {
        return viscous_damping::pair_force({p.ratio}, stiffness, mass_i, mass_j, normal_rate);
    }
    template <class T>
    static T particle_force(parameters const&, T const&, T const&) {
        return T(0);
    }

private:
    static double ratio_of(double e) {
        double const l = std::log(e);
        return -l / std::sqrt(l * l + std::numbers::pi * std::numbers::pi);
    }
};

/// The sum of local damping, dashpots, and a drag proportional to mass and velocity (and to moment of inertia and
/// spin).
struct combined_damping {
    struct parameters {
        double local = 0;   ///< factor of local_damping, 0 to 1
        double mass = 0;    ///< drag over momentum, 1/s, >= 0
        double viscous = 0; ///< ratio of viscous_damping, >= 0
        void validate(std::string const& name) const {
            require_in(name + ".local", local, 0, 1);
            require_not_negative(name + ".mass", mass);
            require_not_negative(name + ".viscous", viscous);
        }
    };
    static constexpr bool acts_on_pairs = true;
    static constexpr bool acts_on_particles = true;
    static constexpr bool needs_inertia = true;
    /// Rate at which a free particle loses momentum, 1/s.
    static double drag_rate(parameters const& p) { return p.mass; }
    template <class T>
    static T pair_force(parameters const& p, T const& stiffness, T const& mass_i, T const& mass_j,
                        T const& normal_rate) {
        return viscous_damping::pair_force({p.viscous}, stiffness, mass_i, mass_j, normal_rate);
    }
    /// The term that does not depend on the inertia.
    template <class T>
    static T particle_force(parameters const& p, T const& force, T const& velocity) {
        return local_damping::particle_force({p.local}, force, velocity);
    }
    template <class T>
    static T particle_force(parameters const& p, T const& force, T const& velocity, T const& inertia) {
        return particle_force(p, force, velocity) - T(value_t<T>(p.mass)) * inertia * velocity;
    }
};

/// True if a dashpot may pull at a contact that separates.
template <class Policy>
inline constexpr bool dashpot_pulls = requires { requires Policy::pulls; };

namespace detail {
template <class Policy>
concept damping_parameters = std::default_initializable<typename Policy::parameters> &&
    requires(typename Policy::parameters const& p, std::string const& name) { p.validate(name); };
template <class Policy>
concept damping_flags = requires {
    { Policy::acts_on_pairs } -> std::convertible_to<bool>;
    { Policy::acts_on_particles } -> std::convertible_to<bool>;
};
template <class Policy, class T>
concept damping_particle_force = requires(typename Policy::parameters const& p, T const& value) {
    { Policy::particle_force(p, value, value) } -> std::convertible_to<T>;
};
/// Applies to policies with `needs_inertia` only.
template <class Policy, class T>
concept damping_inertial_force = !requires { requires Policy::needs_inertia; } ||
    requires(typename Policy::parameters const& p, T const& value) {
        { Policy::particle_force(p, value, value, value) } -> std::convertible_to<T>;
        { Policy::drag_rate(p) } -> std::convertible_to<double>;
    };
/// Applies to policies with `acts_on_pairs` only.
template <class Policy, class T>
concept damping_pair_force = !requires { requires Policy::acts_on_pairs; } ||
    requires(typename Policy::parameters const& p, T const& value) {
        { Policy::pair_force(p, value, value, value, value) } -> std::convertible_to<T>;
    };
template <class Policy, class T>
concept damping_forces =
    damping_particle_force<Policy, T> && damping_inertial_force<Policy, T> && damping_pair_force<Policy, T>;
} // namespace detail

/// Requirements on a damping policy, such as no_damping and local_damping. It has `parameters` with
/// `validate(std::string const& name)`, the constants acts_on_pairs and acts_on_particles, and the formulas above.
/// These must accept plain numbers and packs. pair_force() is needed only where acts_on_pairs is true.
template <class Policy>
concept damping_policy = detail::damping_parameters<Policy> && detail::damping_flags<Policy> &&
    detail::damping_forces<Policy, double> && detail::damping_forces<Policy, pack<double, 4>>;

} // namespace lacuna
