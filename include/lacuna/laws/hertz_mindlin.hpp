// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// Elastic spheres in contact: Hertz's normal force, Mindlin's tangential stiffness without slip, Coulomb friction.
///
///   a = sqrt(R overlap)                       radius of the contact, 1/R = 1/r_i + 1/r_j (a wall: R = r_i)
///   F_n = -4/3 E* a overlap                   1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j
///   F_s <- clip(F_s + 8 G* a * slip, mu |F_n|)
///                                             1/G* = 2 (2 - nu_i)(1 + nu_i)/E_i + 2 (2 - nu_j)(1 + nu_j)/E_j
///
/// While the contact shrinks, the stored shear force shrinks with it: the old force on a smaller contact would return
/// more energy than the contact has stored. The energy lost in this way counts as dissipated. The law treats particles
/// as spheres in the plane, too.
///
/// A dashpot (laws/damping.hpp) at the ratio z of critical damping gives a collision the coefficient of restitution
/// exp(-pi z / sqrt(1 - z^2)) at any speed, as with a linear spring. This holds if the contact lasts until the overlap
/// is zero: see restitution_damping. The result is due to Tsuji, Tanaka and Ishida (1992), its closed form to Antypov
/// and Elliott (2011).
struct hertz_mindlin {
    /// The input values of one material.
    struct material {
        double young_modulus = 1e9;  ///< E, Pa
        double poisson_ratio = 0.25; ///< nu, above -1 and at most 0.5
        double friction = 0.0;       ///< friction coefficient mu, 1
        double shear_factor = 1.0;   ///< tangential stiffness over Mindlin's, 1; a pair has the mean

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_positive(name + ".young_modulus", young_modulus);
            if (!(poisson_ratio > -1 && poisson_ratio <= 0.5))
                refuse(name + ".poisson_ratio", poisson_ratio, "> -1 and <= 0.5");
            require_not_negative(name + ".friction", friction);
            require_not_negative(name + ".shear_factor", shear_factor);
        }
    };

    template <class T>
    struct parameters {
        T normal_modulus, shear_modulus; // 4/3 E* and 8 G*, Pa
        T friction;
    };

    template <class T, int Dim>
    struct history {
        T touching_distance;
        T contact_radius; ///< a of the last step, m
        vec<T, shear_dim<Dim>> shear_force;
    };

    template <class Value>
    static constexpr Value slack = 8 * std::numeric_limits<Value>::epsilon();

    /// An automatically chosen time step assumes that contacts overlap by at least this share of the smaller radius;
    /// see contact_assumption.
    static constexpr double expected_overlap = 0.01;

    static parameters<double> combine(material const& a, material const& b, double /*thickness*/) {
        auto const across = [](material const& m) { return (1 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus; };
        auto const along = [](material const& m) {
            return 2 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio) / m.young_modulus;
        };
        return {4.0 / 3 / (across(a) + across(b)), 4 * (a.shear_factor + b.shear_factor) / (along(a) + along(b)),
                min(a.friction, b.friction)};
    }

    /// History at zero force of a pair that touches at `distance`; see frictional_spring::initial().
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T /*touching_distance*/) {
        return {distance, T(0), {}};
    }

    /// \copydoc frictional_spring::hand_over
    template <class T, int Dim>
    static history<T, Dim> hand_over(parameters<T> const& p, pair_motion<T, Dim> const& m, T normal_force,
                                     vec<T, shear_dim<Dim>> const& shear_force) {
        if (!(normal_force < T(0))) return {min(m.distance, m.touching_distance()), T(0), shear_force};
        T const root = std::cbrt(-normal_force / (p.normal_modulus * sqrt(effective_radius(m))));
        return {m.distance + root * root, sqrt(effective_radius(m)) * root, shear_force};
    }

    template <class T, int Dim>
    static pair_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                           history<T, Dim> const& h) {
        T overlap = max(h.touching_distance - m.distance, T(0));
        T radius = sqrt(effective_radius(m) * overlap);
        T normal = -(p.normal_modulus * radius * overlap);
        T stiffness = p.shear_modulus * radius;
        auto before = h.contact_radius > T(0);
        auto stored = h.shear_force * min(select(before, radius / select(before, h.contact_radius, T(1)), T(0)), T(1));
        auto shear = clip_norm(stored + m.slip * stiffness, -(p.friction * normal));
        T shear_energy = energy(shear, stiffness);
        // The slack absorbs rounding: a pair that rests at an L beyond r_i + r_j must not lose this L.
        auto apart = m.distance > max(h.touching_distance, m.touching_distance()) * T(1 + slack<value_t<T>>);
        return {normal,
                shear,
                {select(apart, m.touching_distance(), h.touching_distance), radius, shear},
                T(value_t<T>(0.4)) * overlap * (-normal) + shear_energy,
                T(value_t<T>(0.5)) * dot(shear + h.shear_force, m.slip) +
                    energy(h.shear_force, p.shear_modulus * h.contact_radius) - shear_energy};
    }

    /// 5/6 of the normal tangent stiffness, N/m. With this value, a ratio of critical damping gives a Hertzian contact
    /// the same restitution as a linear one.
    template <class T, int Dim>
    static T stiffness(parameters<T> const& p, pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        T overlap = max(h.touching_distance - m.distance, T(0));
        return T(value_t<T>(1.25)) * p.normal_modulus * sqrt(effective_radius(m) * overlap);
    }

private:
    template <class T, int Dim>
    static T effective_radius(pair_motion<T, Dim> const& m) {
        T product = m.radius_i * m.radius_j, sum = m.radius_i + m.radius_j;
        return select(product > T(0), product / sum, sum);
    }
    template <class T, int N>
    static T energy(vec<T, N> const& force, T const& stiffness) {
        auto resists = stiffness > T(0);
        return select(resists, T(value_t<T>(0.5)) * squared_norm(force) / select(resists, stiffness, T(1)), T(0));
    }
};

} // namespace lacuna
