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
/// The normal force follows from the total overlap, not from eq. 12's sum of increments: the two are equal up to
/// rounding. L is r_i + r_j. Pairs that touch in the initial packing, and pairs whose bond has broken, have another L,
/// with which their force starts without a jump. Once such a pair has separated, L is r_i + r_j again.
struct frictional_spring {
    /// The input values of one material (the paper's Table 1).
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

    /// Stiffness: two springs in series, each of twice the material's stiffness (harmonic mean), so that two equal
    /// materials give their own value. Friction: the smaller one.
    static parameters<double> combine(material const& a, material const& b, double /*thickness*/) {
        auto const series = [](double x, double y) { return x > 0 && y > 0 ? 2 / (1 / x + 1 / y) : 0.0; };
        double const shear = series(a.shear_stiffness, b.shear_stiffness);
        return {series(a.normal_stiffness, b.normal_stiffness), shear, shear > 0 ? 1 / shear : 0.0,
                min(a.friction, b.friction)};
    }

    /// History at zero force of a pair that touches at `distance`. This is the current distance for pairs of the
    /// initial packing that count as touching, and for pairs whose bond broke in tension. For all other pairs it is the
    /// touching distance.
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T /*touching_distance*/) {
        return {distance, {}};
    }

    /// History of a pair whose bond has just failed in shear. A compressive normal force stays, and so does the shear
    /// force, which evaluate() clips.
    template <class T, int Dim>
    static history<T, Dim> hand_over(parameters<T> const& p, pair_motion<T, Dim> const& m, T normal_force,
                                     vec<T, shear_dim<Dim>> const& shear_force) {
        T carried = m.distance - normal_force / p.normal_stiffness;
        T unloaded = min(m.distance, m.touching_distance());
        return {select(normal_force < T(0), carried, unloaded), shear_force};
    }

    template <class T, int Dim>
    static pair_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                           history<T, Dim> const& h) {
        T overlap = max(h.touching_distance - m.distance, T(0));
        T normal = -(p.normal_stiffness * overlap);
        auto shear = clip_norm(h.shear_force + m.slip * p.shear_stiffness, -(p.friction * normal));
        auto slid = m.slip - (shear - h.shear_force) * p.shear_compliance;
        // The slack absorbs rounding: a pair that rests at an L beyond r_i + r_j must not lose this L.
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
