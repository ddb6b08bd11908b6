// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/frictional_spring.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// The linear springs with Coulomb friction of frictional_spring, and a moment against rolling: an elastic spring
/// that slips at its limit (Iwashita and Oda 1998, J. Eng. Mech. 124, 285; model C of Ai, Chen, Rotter and Ooi 2011,
/// Powder Technol. 206, 269).
///
///   R = r_i r_j / (r_i + r_j)                 rolling radius; at a wall r_i
///   M <- clip(M + c k_s R^2 * bend, mu_r R |F_n|)
///
/// bend is the rotation of j minus that of i. With c = 1 the stiffness against rolling is Iwashita and Oda's, k_s R^2.
/// Limits: model C's rolling dashpot is left out, since the law does not see the inertia. A particle that stops rolling
/// therefore oscillates on the spring until another damping stops it. Nothing resists a twist about the normal.
struct rolling_spring {
    static constexpr bool carries_moment = true;

    /// The input values of one material.
    struct material {
        double normal_stiffness = 1e6; ///< k_n, N/m
        double shear_stiffness = 1e6;  ///< k_s, N/m
        double friction = 0.0;         ///< friction coefficient mu, 1
        double rolling_friction = 0.0; ///< mu_r, tangent of the steepest slope on which a particle does not roll, 1
        double rolling_factor = 1.0;   ///< c, stiffness against rolling over k_s R^2; a pair has the mean

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            springs().validate(name);
            require_not_negative(name + ".rolling_friction", rolling_friction);
            require_not_negative(name + ".rolling_factor", rolling_factor);
        }
        frictional_spring::material springs() const { return {normal_stiffness, shear_stiffness, friction}; }
    };

    template <class T>
    struct parameters {
        frictional_spring::parameters<T> springs;
        T rolling_friction, rolling_stiffness; // 1; c k_s, N/m
    };

    template <class T, int Dim>
    struct history {
        T touching_distance;
        vec<T, shear_dim<Dim>> shear_force;
        vec<T, rotation_dim<Dim>> bending_moment;
    };

    /// Combines the springs as frictional_spring::combine(). A pair has the smaller rolling friction.
    static parameters<double> combine(material const& a, material const& b, double thickness) {
        auto const springs = frictional_spring::combine(a.springs(), b.springs(), thickness);
        return {springs, min(a.rolling_friction, b.rolling_friction),
                0.5 * (a.rolling_factor + b.rolling_factor) * springs.shear_stiffness};
    }

    /// \copydoc frictional_spring::initial
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T /*touching_distance*/) {
        return {distance, {}, {}};
    }

    /// \copydoc frictional_spring::hand_over
    template <class T, int Dim>
    static history<T, Dim> hand_over(parameters<T> const& p, pair_motion<T, Dim> const& m, T normal_force,
                                     vec<T, shear_dim<Dim>> const& shear_force) {
        auto const springs = frictional_spring::hand_over(p.springs, m, normal_force, shear_force);
        return {springs.touching_distance, springs.shear_force, {}};
    }

    /// Stiffness against rolling, N m/rad.
    template <int Dim, class T>
    static moment_stiffness<T> rotational_stiffness(parameters<T> const& p, T radius_i, T radius_j,
                                                    T /*distance*/ = T(0)) {
        T r = rolling_radius(radius_i, radius_j);
        return {p.rolling_stiffness * r * r, T(0)};
    }

    template <class T, int Dim>
    static moment_pair_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                                  pair_rotation<T, Dim> const& rotation,
                                                                  history<T, Dim> const& h) {
        auto springs = frictional_spring::evaluate(p.springs, m, {h.touching_distance, h.shear_force});
        T r = rolling_radius(m.radius_i, m.radius_j);
        T k = p.rolling_stiffness * r * r;
        auto resists = k > T(0);
        T compliance = select(resists, T(1) / select(resists, k, T(1)), T(0));
        auto moment = clip_norm(h.bending_moment + rotation.bend * k, -(p.rolling_friction * r * springs.normal_force));
        auto rolled = rotation.bend - (moment - h.bending_moment) * compliance;
        return {{springs.normal_force,
                 springs.shear_force,
                 {springs.history.touching_distance, springs.history.shear_force, moment},
                 springs.stored_energy + T(0.5) * squared_norm(moment) * compliance,
                 springs.dissipated_energy + T(0.5) * dot(moment + h.bending_moment, rolled)},
                moment,
                T(0)};
    }
    template <class T, int Dim>
    static moment_pair_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                                  history<T, Dim> const& h) {
        return evaluate(p, m, pair_rotation<T, Dim>{{}, T(0)}, h);
    }

    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.springs.normal_stiffness;
    }

private:
    template <class T>
    static T rolling_radius(T const& radius_i, T const& radius_j) {
        T product = radius_i * radius_j, sum = radius_i + radius_j;
        return select(product > T(0), product / sum, sum);
    }
};

} // namespace lacuna
