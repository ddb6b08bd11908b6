// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/bond_values.hpp>
#include <lacuna/laws/brittle_spring_bond.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// The parallel bond of Potyondy and Cundall (2004): an elastic beam of cement between two particles. It also resists
/// bending, and in space twisting. It breaks when the stress at its rim exceeds the strength.
///
///   R = radius_factor * min(r_i, r_j)         half-width (2D) or radius (3D) of the beam
///   A = 2 R t, I = 2/3 R^3 t                  in the plane; pi R^2, pi R^4 / 4, J = 2 I in space
///   F_n = k_n (d - L)                         k_n = kbar_n A of the paper
///   F_s <- F_s + k_s * slip                   k_s = kbar_s A
///   M_b <- M_b + k_n I/A * bend               kbar_n I: k_n R^2 / 3 in the plane, k_n R^2 / 4 in space
///   M_t <- M_t + k_s J/A * twist              kbar_s J: k_s R^2 / 2
///   F_n / A + |M_b| R / I > sigma_n           breaks in tension
///   |F_s| / A + |M_t| R / J > sigma_s         breaks in shear
///
/// As in their paper, there is no failure in compression. Stiffnesses here belong to the whole bond, in N/m, as in the
/// other laws; those of the paper are per unit area of the bond.
struct parallel_bond {
    static constexpr bool carries_moment = true;

    /// The input values of one material.
    struct material {
        double normal_stiffness = 1e6;                                     ///< k_n, N/m
        double shear_stiffness = 1e6;                                      ///< k_s, N/m
        double tensile_strength = std::numeric_limits<double>::infinity(); ///< sigma_n, Pa; infinite: never breaks
        double shear_strength = std::numeric_limits<double>::infinity();   ///< sigma_s, Pa
        double radius_factor = 1; ///< R over the radius of the smaller particle, 1; a pair has the smaller factor

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_positive(name + ".normal_stiffness", normal_stiffness);
            require_not_negative(name + ".shear_stiffness", shear_stiffness);
            require_limit(name + ".tensile_strength", tensile_strength);
            require_limit(name + ".shear_strength", shear_strength);
            require_positive(name + ".radius_factor", radius_factor);
        }
    };

    template <class T>
    struct parameters {
        T normal_stiffness, shear_stiffness;
        T tensile_strength, shear_strength; // Pa
        T radius_factor;
        T moment_factor; // multiplies the stiffnesses against bending and twisting; 1 for the beam
        T thickness;     // m
    };

    template <class T, int Dim>
    struct history {
        T rest_distance;
        vec<T, shear_dim<Dim>> shear_force;
        vec<T, rotation_dim<Dim>> bending_moment;
        T twisting_moment;
    };

    /// Stiffnesses combine in series (harmonic mean); a pair has the smaller strength and radius factor.
    static parameters<double> combine(material const& a, material const& b, double thickness) {
        auto const series = [](double x, double y) { return x > 0 && y > 0 ? 2 / (1 / x + 1 / y) : 0.0; };
        // 1e30 means "never" and is finite in single precision, too: infinity would give infinity times zero.
        auto const weaker = [](double x, double y) { return min(min(x, y), 1e30); };
        return {series(a.normal_stiffness, b.normal_stiffness),
                series(a.shear_stiffness, b.shear_stiffness),
                weaker(a.tensile_strength, b.tensile_strength),
                weaker(a.shear_strength, b.shear_strength),
                min(a.radius_factor, b.radius_factor),
                1,
                thickness};
    }

    /// Returns the parameters of a bond whose values `own` replace those of its materials.
    template <int Dim>
    static parameters<double> with_values(parameters<double> p, bond_values const& own, double radius_i,
                                          double radius_j) {
        double const r = p.radius_factor * min(radius_i, radius_j);
        double const area = smaller_particle_area::area<Dim>(r, r, p.thickness);
        p.normal_stiffness = own.normal_stiffness.value_or(p.normal_stiffness);
        p.shear_stiffness = own.shear_stiffness.value_or(p.shear_stiffness);
        if (own.bending_stiffness) {
            p.moment_factor = 1;
            p.moment_factor = *own.bending_stiffness / rotational_stiffness<Dim>(p, radius_i, radius_j).bending;
        }
        own.set_strengths(area, p.tensile_strength, p.shear_strength);
        return p;
    }

    /// History of a bond made at `distance`, without force and moment.
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T /*touching_distance*/) {
        return {distance, {}, {}, T(0)};
    }

    template <int Dim, class T>
    static moment_stiffness<T> rotational_stiffness(parameters<T> const& p, T radius_i, T radius_j,
                                                    T /*distance*/ = T(0)) {
        T r = p.radius_factor * min(radius_i, radius_j);
        T r2 = r * r * p.moment_factor;
        if constexpr (Dim == 2)
            return {p.normal_stiffness * r2 * T(value_t<T>(1.0 / 3)), T(0)};
        else
            return {p.normal_stiffness * r2 * T(value_t<T>(0.25)), p.shear_stiffness * r2 * T(value_t<T>(0.5))};
    }

    template <class T, int Dim>
    static moment_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                             pair_rotation<T, Dim> const& rotation,
                                                             history<T, Dim> const& h) {
        T r = p.radius_factor * min(m.radius_i, m.radius_j);
        T area = smaller_particle_area::area<Dim>(r, r, p.thickness);
        auto k = rotational_stiffness<Dim>(p, m.radius_i, m.radius_j);
        T normal = p.normal_stiffness * (m.distance - h.rest_distance);
        auto shear = h.shear_force + m.slip * p.shear_stiffness;
        auto bending = h.bending_moment + rotation.bend * k.bending;
        T twisting = h.twisting_moment + rotation.twist * k.twisting;
        // The stress at the rim times A: A R / I is 3 / R in the plane and 4 / R in space, A R / J is 2 / R.
        T at_rim = normal + norm(bending) * T(value_t<T>(Dim == 2 ? 3.0 : 4.0)) / r;
        T along_rim = norm(shear) + abs(twisting) * T(value_t<T>(2.0)) / r;
        auto failure =
            box_envelope::check_strength(at_rim, along_rim, p.tensile_strength * area, p.shear_strength * area);
        T stored = T(value_t<T>(0.5)) *
                   (per(normal * normal, p.normal_stiffness) + per(squared_norm(shear), p.shear_stiffness) +
                    per(squared_norm(bending), k.bending) + per(twisting * twisting, k.twisting));
        return {{{normal, shear, {h.rest_distance, shear, bending, twisting}, stored, T(0)},
                 failure.broken,
                 failure.in_tension},
                bending,
                twisting};
    }
    template <class T, int Dim>
    static moment_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                             history<T, Dim> const& h) {
        return evaluate(p, m, pair_rotation<T, Dim>{{}, T(0)}, h);
    }

    template <class T>
    static T stiffness(parameters<T> const& p) {
        return p.normal_stiffness;
    }

private:
    /// a / k, and 0 for a spring without stiffness.
    template <class T>
    static T per(T const& a, T const& k) {
        auto resists = k > T(0);
        return select(resists, a / select(resists, k, T(1)), T(0));
    }
};

} // namespace lacuna
