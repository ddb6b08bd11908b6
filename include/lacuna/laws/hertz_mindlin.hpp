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
/// While the contact gets smaller the stored shear force shrinks with it (with its old force on a smaller contact it
/// would give back more energy than it took); what it loses counts as dissipated. Particles are spheres to this law
/// in the plane, too.
///
/// With a dashpot (laws/damping.hpp) of the ratio z of critical damping a collision has the restitution
/// exp(-pi z / sqrt(1 - z^2)) at any speed, as with a linear spring (Tsuji, Tanaka and Ishida 1992, in the closed form of
/// Antypov and Elliott 2011), if the contact lasts until the overlap has gone: see restitution_damping.
struct hertz_mindlin {
    /// What one material contributes.
    struct material {
        double young_modulus = 1e9;  ///< E, Pa
        double poisson_ratio = 0.25; ///< nu, above -1 and at most 0.5
        double friction = 0.0;       ///< friction coefficient mu, 1
        double shear_factor = 1.0;   ///< tangential stiffness over Mindlin's; of a pair the mean

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

    /// A time step that is chosen for a run is made for contacts with this overlap at least, as a share of the smaller
    /// radius; see contact_assumption.
    static constexpr double expected_overlap = 0.01;

    static parameters<double> combine(material const& a, material const& b, double /*thickness*/) {
        auto const across = [](material const& m) { return (1 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus; };
        auto const along = [](material const& m) {
            return 2 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio) / m.young_modulus;
        };
        return {4.0 / 3 / (across(a) + across(b)), 4 * (a.shear_factor + b.shear_factor) / (along(a) + along(b)),
                min(a.friction, b.friction)};
    }

    /// A pair at zero force that touches at `distance`; see frictional_spring::initial().
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T /*touching_distance*/) {
        return {distance, T(0), {}};
    }

    /// A pair whose bond has just failed in shear: keeps a compressive normal force, and the shear force, which
    /// evaluate() clips.
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
        // A rounding more than the limit: a pair that starts with a gap at its own L must not lose it by standing still.
        auto apart = m.distance > max(h.touching_distance, m.touching_distance()) * T(1 + slack<value_t<T>>);
        return {normal,
                shear,
                {select(apart, m.touching_distance(), h.touching_distance), radius, shear},
                T(value_t<T>(0.4)) * overlap * (-normal) + shear_energy,
                T(value_t<T>(0.5)) * dot(shear + h.shear_force, m.slip) +
                    energy(h.shear_force, p.shear_modulus * h.contact_radius) - shear_energy};
    }

    /// 5/6 of the normal tangent stiffness: with it a dashpot's ratio of critical damping gives a Hertzian contact the
    /// restitution that it gives a linear one.
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
        auto there = stiffness > T(0);
        return select(there, T(value_t<T>(0.5)) * squared_norm(force) / select(there, stiffness, T(1)), T(0));
    }
};

} // namespace lacuna
