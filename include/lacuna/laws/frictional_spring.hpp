// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// Linear springs in compression and shear with Coulomb friction: the paper's contact, eq. 11 to 13.
///
///   F_n = -k_n * max(0, L - d)          d distance, L touching distance
///   F_s <- clip(F_s + k_s * slip, mu * |F_n|)
///
/// The normal force is the total form of eq. 12's sum of increments: the two are equal up to rounding.
/// L is r_i + r_j, except for pairs that carry on from the initial packing or from a bond, whose L makes them
/// start without a jump of force; once such a pair has come apart, L is r_i + r_j again.
struct frictional_spring {
    /// What one material contributes (Table 1).
    struct material {
        double normal_stiffness = 1e6; ///< k_jn, N/m
        double shear_stiffness = 1e6;  ///< k_js, N/m
        double friction = 0.0;         ///< friction coefficient mu, 1

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_positive(name + ".normal_stiffness", normal_stiffness);
            require_not_negative(name + ".shear_stiffness", shear_stiffness);
            require_not_negative(name + ".friction", friction);
        }
    };

    template <class T>
    struct parameters {
        T normal_stiffness, shear_stiffness, shear_compliance, friction;
    };

    template <class T, int Dim>
    struct history {
        T touching_distance;
        vec<T, shear_dim<Dim>> shear_force;
    };

    template <class Value>
    static constexpr Value slack = 8 * std::numeric_limits<Value>::epsilon();

    /// Stiffness of two materials in series, each contributing twice its own so that equal materials keep theirs
    /// (harmonic mean); the smaller friction.
    static parameters<double> combine(material const& a, material const& b, double /*thickness*/) {
        auto const series = [](double x, double y) { return x > 0 && y > 0 ? 2 / (1 / x + 1 / y) : 0.0; };
        double const shear = series(a.shear_stiffness, b.shear_stiffness);
        return {series(a.normal_stiffness, b.normal_stiffness), shear, shear > 0 ? 1 / shear : 0.0,
                min(a.friction, b.friction)};
    }

    /// A pair at zero force that touches at `distance`: the pairs of the initial packing that count as touching,
    /// and pairs whose bond broke in tension. For all other pairs distance is touching_distance.
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T /*touching_distance*/) {
        return {distance, {}};
    }

    /// A pair whose bond has just failed in shear: keeps a compressive normal force, and the shear force, which
    /// evaluate() clips.
    template <class T, int Dim>
    static history<T, Dim> hand_over(parameters<T> const& p, pair_motion<T, Dim> const& m, T normal_force,
                                     vec<T, shear_dim<Dim>> const& shear_force) {
        T carried = m.distance - normal_force / p.normal_stiffness;
        T open = min(m.distance, m.touching_distance());
        return {select(normal_force < T(0), carried, open), shear_force};
    }

    template <class T, int Dim>
    static pair_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                           history<T, Dim> const& h) {
        T overlap = max(h.touching_distance - m.distance, T(0));
        T normal = -(p.normal_stiffness * overlap);
        auto shear = clip_norm(h.shear_force + m.slip * p.shear_stiffness, -(p.friction * normal));
        auto slid = m.slip - (shear - h.shear_force) * p.shear_compliance;
        // A rounding more than the limit: a pair that starts with a gap at its own L must not lose it by standing still.
        auto apart = m.distance > max(h.touching_distance, m.touching_distance()) * T(1 + slack<value_t<T>>);
        return {normal,
                shear,
                {select(apart, m.touching_distance(), h.touching_distance), shear},
                T(0.5) * (overlap * (-normal) + squared_norm(shear) * p.shear_compliance),
                T(0.5) * dot(shear + h.shear_force, slid)};
    }

    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.normal_stiffness;
    }
};

} // namespace lacuna
