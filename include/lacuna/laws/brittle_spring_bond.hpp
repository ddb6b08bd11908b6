// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/bond_values.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// Cross-section of a bond: A_c = 2 min(r_i, r_j) t in the plane (t: thickness), pi min(r_i, r_j)^2 in space.
struct smaller_particle_area {
    template <int Dim, class T>
    static T area(T radius_i, T radius_j, T thickness) {
        T r = min(radius_i, radius_j);
        if constexpr (Dim == 2)
            return T(2) * r * thickness;
        else
            return T(value_t<T>(3.14159265358979323846)) * r * r;
    }
};

/// Base of an envelope that has no parameters: everything but check_strength().
struct plain_envelope {
    static constexpr bool yields_in_compression = true; ///< a compressive force is capped at the tensile limit
    struct material {
        void validate(std::string const&) const {}
    };
    template <class T>
    struct parameters {};
    static parameters<double> combine(material const&, material const&) { return {}; }

    template <class T>
    struct failure {
        mask_t<T> broken, in_tension;
    };
};

/// The safety zone of the paper's Fig. 4: a rectangle. The bond breaks beyond the tensile limit or the shear limit. If
/// one step exceeds both, the mode with the larger ratio of force to limit counts. A compressive force is capped at the
/// tensile limit.
struct box_envelope : plain_envelope {
    template <class T>
    static failure<T> check_strength(parameters<T> const&, T normal, T shear, T tensile_limit, T shear_limit) {
        return check_strength(normal, shear, tensile_limit, shear_limit);
    }
    template <class T>
    static failure<T> check_strength(T normal, T shear, T tensile_limit, T shear_limit) {
        auto tension = normal > tensile_limit;
        auto sheared = shear > shear_limit;
        auto tension_leads = normal * shear_limit >= shear * tensile_limit;
        return {tension || sheared, tension && (!sheared || tension_leads)};
    }
};

/// Mohr and Coulomb's line with a tension cut-off (Coulomb 1776, Mohr 1900; the cut-off after Paul 1961, J. Appl. Mech.
/// 28, 259): the shear strength is the cohesion, and compression adds to it.
///
///   F_n > min(sigma_n, c / tan phi) A_c       breaks in tension
///   |F_s| > c A_c - F_n tan phi               breaks in shear
///
/// If one step exceeds both, the mode with the larger ratio of force to limit counts. Pure compression breaks no bond.
struct mohr_coulomb_envelope {
    static constexpr bool yields_in_compression = false;
    struct material {
        double internal_friction = 0.5; ///< tan phi, 1; a pair has the smaller one

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_not_negative(name + ".internal_friction", internal_friction);
        }
    };
    template <class T>
    struct parameters {
        T internal_friction, apex; // tan phi; largest tensile strength over the cohesion
    };
    static parameters<double> combine(material const& a, material const& b) {
        double const slope = min(a.internal_friction, b.internal_friction);
        return {slope, slope > 0 ? min(1 / slope, 1e30) : 1e30};
    }
    template <class T>
    static box_envelope::failure<T> check_strength(parameters<T> const& p, T normal, T shear, T tensile_limit,
                                                   T cohesion) {
        return box_envelope::check_strength(normal, shear, min(tensile_limit, cohesion * p.apex),
                                   max(cohesion - normal * p.internal_friction, T(0)));
    }
};

/// Linear springs in tension, compression and shear, which break when an envelope is exceeded. With box_envelope this
/// is the paper's bond (eq. 10, Fig. 4).
///
///   F_n = k_n * (d - L)                       L: distance at which the bond was made
///   F_s <- F_s + k_s * slip
///   F_n >  sigma_n A_c   breaks in tension
///   |F_s| > sigma_s A_c  breaks in shear
///   F_n < -sigma_n A_c   compression failure, if the envelope yields in compression: the force stays at the limit, the
///                        bond remains, L shortens
///
/// The normal force follows from the total elongation, not from eq. 10's sum of increments. The two are equal up to
/// rounding, also after compression failure, because L contains the plastic shortening.
template <class Envelope = box_envelope, class Area = smaller_particle_area>
struct brittle_spring_bond_with {
    /// The input values of one material (the paper's Table 1).
    struct material {
        double normal_stiffness = 1e6;                                    ///< k_n, N/m
        double shear_stiffness = 1e6;                                     ///< k_s, N/m
        double tensile_strength = std::numeric_limits<double>::infinity(); ///< sigma_n, Pa; infinite: never breaks
        double shear_strength = std::numeric_limits<double>::infinity();   ///< sigma_s, Pa; Mohr-Coulomb: cohesion
        [[no_unique_address]] typename Envelope::material envelope{};      ///< further values that the envelope needs

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_positive(name + ".normal_stiffness", normal_stiffness);
            require_not_negative(name + ".shear_stiffness", shear_stiffness);
            require_limit(name + ".tensile_strength", tensile_strength);
            require_limit(name + ".shear_strength", shear_strength);
            envelope.validate(name + ".envelope");
        }
    };

    template <class T>
    struct parameters {
        T normal_stiffness, normal_compliance, shear_stiffness, shear_compliance;
        T tensile_strength, shear_strength; // Pa
        T thickness;                        // m
        [[no_unique_address]] typename Envelope::template parameters<T> envelope{};
    };

    template <class T, int Dim>
    struct history {
        T rest_distance;
        vec<T, shear_dim<Dim>> shear_force;
    };

    /// Stiffnesses combine in series (harmonic mean); a pair has the smaller strength.
    static parameters<double> combine(material const& a, material const& b, double thickness) {
        auto const series = [](double x, double y) { return x > 0 && y > 0 ? 2 / (1 / x + 1 / y) : 0.0; };
        // 1e30 means "never" and is finite in single precision, too: infinity would give zero times infinity.
        auto const weaker = [](double x, double y) { return min(min(x, y), 1e30); };
        double const normal = series(a.normal_stiffness, b.normal_stiffness);
        double const shear = series(a.shear_stiffness, b.shear_stiffness);
        return {normal,
                1 / normal,
                shear,
                shear > 0 ? 1 / shear : 0.0,
                weaker(a.tensile_strength, b.tensile_strength),
                weaker(a.shear_strength, b.shear_strength),
                thickness,
                Envelope::combine(a.envelope, b.envelope)};
    }

    /// Returns the parameters of a bond whose values `own` replace those of its materials.
    /// \throws std::invalid_argument for a stiffness against bending, which these springs do not have
    template <int Dim>
    static parameters<double> with_values(parameters<double> p, bond_values const& own, double radius_i,
                                          double radius_j) {
        if (own.bending_stiffness)
            refuse("bending_stiffness", *own.bending_stiffness, "left out: the bond law has none");
        double const area = Area::template area<Dim>(radius_i, radius_j, p.thickness);
        p.normal_stiffness = own.normal_stiffness.value_or(p.normal_stiffness);
        p.normal_compliance = 1 / p.normal_stiffness;
        p.shear_stiffness = own.shear_stiffness.value_or(p.shear_stiffness);
        p.shear_compliance = p.shear_stiffness > 0 ? 1 / p.shear_stiffness : 0.0;
        own.set_strengths(area, p.tensile_strength, p.shear_strength);
        return p;
    }

    /// History of a bond made at `distance`, without force.
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T /*touching_distance*/) {
        return {distance, {}};
    }

    template <class T, int Dim>
    static bond_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                           history<T, Dim> const& h) {
        T area = Area::template area<Dim>(m.radius_i, m.radius_j, p.thickness);
        T limit = p.tensile_strength * area;
        T trial = p.normal_stiffness * (m.distance - h.rest_distance);
        T normal = trial, rest = h.rest_distance;
        if constexpr (Envelope::yields_in_compression) {
            normal = max(trial, -limit);
            rest = select(trial < -limit, m.distance + limit * p.normal_compliance, h.rest_distance);
        }
        auto shear = h.shear_force + m.slip * p.shear_stiffness;
        auto failure = Envelope::check_strength(p.envelope, normal, norm(shear), limit, p.shear_strength * area);
        return {{normal,
                 shear,
                 {rest, shear},
                 T(0.5) * (normal * normal * p.normal_compliance + squared_norm(shear) * p.shear_compliance),
                 limit * (h.rest_distance - rest)},
                failure.broken,
                failure.in_tension};
    }

    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.normal_stiffness;
    }

    /// The compressive force at which the bond yields, N. Only for envelopes that yield in compression.
    template <int Dim, class T>
    static T compressive_limit(parameters<T> const& p, T radius_i, T radius_j)
        requires(Envelope::yields_in_compression)
    {
        return p.tensile_strength * Area::template area<Dim>(radius_i, radius_j, p.thickness);
    }
};

/// The paper's bond.
using brittle_spring_bond = brittle_spring_bond_with<>;
/// The same springs, which break at Mohr and Coulomb's line with a tension cut-off.
using mohr_coulomb_bond = brittle_spring_bond_with<mohr_coulomb_envelope>;

} // namespace lacuna
