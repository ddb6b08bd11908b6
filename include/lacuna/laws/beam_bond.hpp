// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/bond_values.hpp>
#include <lacuna/laws/brittle_spring_bond.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// An elastic beam between the centres of two particles, clamped to both, without mass: Euler and Bernoulli's (the
/// cohesive beam of Andre, Iordanoff, Charles and Neauport 2012, Comput. Methods Appl. Mech. Eng. 213, 113), or, with
/// shear, Timoshenko's (Obermayr, Dressler, Vrettos and Eberhard 2013, Comput. Geotech. 49, 299).
///
///   R = radius_factor * min(r_i, r_j)         half-depth (2D) or radius (3D) of the section
///   A = 2 R t, I = 2/3 R^3 t                  in the plane; pi R^2, pi R^4 / 4, J = 2 I in space
///   F_n = E A / L (d - L)                     L: distance at which the bond was made
///   V <- V + 12 E I / (L^3 (1 + phi)) * s     phi = 12 E I / (kappa G A L^2), G = E / (2 (1 + nu))
///   M <- M + E I / L * bend                   in the middle of the beam
///   M_t <- M_t + G J / L * twist
///   F_n / A + max |M +- V L / 2| R / I > sigma_n    breaks in tension: at the rim of an end, where |M| is largest
///   |V| / A + |M_t| R / J > sigma_s                 breaks in shear
///
/// s is the slip in the middle of the beam, where shear and bending are uncoupled. The engine works at the contact
/// point, at the distance e = d/2 - (lever arm of i) from the middle. There they couple: s = slip + e bend, and the
/// moment is M + e V. A cantilever of such bonds has the deflection of one beam, F L^3 / (3 E I) + F L / (kappa G A),
/// for any number of bonds. Limits: small bending between two neighbours; no failure in compression and no buckling
/// within a bond.
struct beam_bond {
    static constexpr bool carries_moment = true;
    /// In the bound of the time step, shear has the lever arm d/2 on both sides, whatever the radii.
    static constexpr bool shears_in_the_middle = true;

    /// The input values of one material.
    struct material {
        double young_modulus = 1e9;                                        ///< E, Pa
        double poisson_ratio = 0.25;                                       ///< nu, above -1 and at most 0.5
        double tensile_strength = std::numeric_limits<double>::infinity(); ///< sigma_n, Pa; infinite: never breaks
        double shear_strength = std::numeric_limits<double>::infinity();   ///< sigma_s, Pa
        double radius_factor = 1; ///< R over the radius of the smaller particle, 1; a pair has the smaller factor
        /// kappa, share of the section that carries shear, 1: 5/6 for a rectangle, 0.9 for a circle. Infinite gives
        /// Euler and Bernoulli's beam without shear deformation. A pair has the smaller one.
        double shear_correction = std::numeric_limits<double>::infinity();

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_positive(name + ".young_modulus", young_modulus);
            if (!(poisson_ratio > -1 && poisson_ratio <= 0.5))
                refuse(name + ".poisson_ratio", poisson_ratio, "> -1 and <= 0.5");
            require_limit(name + ".tensile_strength", tensile_strength);
            require_limit(name + ".shear_strength", shear_strength);
            require_positive(name + ".radius_factor", radius_factor);
            if (!(shear_correction > 0)) refuse(name + ".shear_correction", shear_correction, "> 0, or infinite");
        }
    };

    template <class T>
    struct parameters {
        T young_modulus, shear_modulus; // Pa
        T shear_compliance;             // E / (kappa G)
        T tensile_strength, shear_strength; // Pa
        T radius_factor;
        T thickness; // m
    };

    template <class T, int Dim>
    struct history {
        T rest_distance;
        vec<T, shear_dim<Dim>> shear_force;
        vec<T, rotation_dim<Dim>> bending_moment; // in the middle
        T twisting_moment;
    };

    /// Each material makes up half of the beam: moduli combine in series (harmonic mean). A pair has the smaller
    /// strength and radius factor.
    static parameters<double> combine(material const& a, material const& b, double thickness) {
        auto const series = [](double x, double y) { return 2 / (1 / x + 1 / y); };
        // 1e30 means "never" and is finite in single precision, too: infinity would give infinity times zero.
        auto const weaker = [](double x, double y) { return min(min(x, y), 1e30); };
        auto const shear = [](material const& m) { return m.young_modulus / (2 * (1 + m.poisson_ratio)); };
        double const young = series(a.young_modulus, b.young_modulus), g = series(shear(a), shear(b));
        return {young,
                g,
                young / (min(a.shear_correction, b.shear_correction) * g),
                weaker(a.tensile_strength, b.tensile_strength),
                weaker(a.shear_strength, b.shear_strength),
                min(a.radius_factor, b.radius_factor),
                thickness};
    }

    /// Returns the parameters of a bond whose values `own` replace those of its materials.
    /// \throws std::invalid_argument for a stiffness in `own`: a beam's stiffness follows from its section and length
    template <int Dim>
    static parameters<double> with_values(parameters<double> p, bond_values const& own, double radius_i,
                                          double radius_j) {
        char const* const rule = "left out: a beam's stiffness follows from its section";
        if (own.normal_stiffness) refuse("normal_stiffness", *own.normal_stiffness, rule);
        if (own.shear_stiffness) refuse("shear_stiffness", *own.shear_stiffness, rule);
        if (own.bending_stiffness) refuse("bending_stiffness", *own.bending_stiffness, rule);
        double const r = p.radius_factor * min(radius_i, radius_j);
        own.set_strengths(smaller_particle_area::area<Dim>(r, r, p.thickness), p.tensile_strength, p.shear_strength);
        return p;
    }

    /// History of a bond made at `distance`, without force and moment.
    template <class T, int Dim>
    static history<T, Dim> initial(T distance, T /*touching_distance*/) {
        return {distance, {}, {}, T(0)};
    }

    /// E I / L and G J / L, N m/rad.
    /// \param length L, m
    template <int Dim, class T>
    static moment_stiffness<T> rotational_stiffness(parameters<T> const& p, T radius_i, T radius_j, T length) {
        T r = p.radius_factor * min(radius_i, radius_j);
        T inertia = gyration<Dim, T>() * r * r * smaller_particle_area::area<Dim>(r, r, p.thickness) / length;
        return {p.young_modulus * inertia, Dim == 2 ? T(0) : p.shear_modulus * inertia * T(value_t<T>(2.0))};
    }

    template <class T, int Dim>
    static moment_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                             pair_rotation<T, Dim> const& rotation,
                                                             history<T, Dim> const& h) {
        T r = p.radius_factor * min(m.radius_i, m.radius_j);
        T area = smaller_particle_area::area<Dim>(r, r, p.thickness);
        T length = h.rest_distance;
        T axial = p.young_modulus * area / length;
        auto rotational = rotational_stiffness<Dim>(p, m.radius_i, m.radius_j, length);
        T slender = gyration<Dim, T>() * r * r / (length * length); // I / (A L^2)
        T across = T(value_t<T>(12.0)) * axial * slender / (T(1) + T(value_t<T>(12.0)) * p.shear_compliance * slender);
        T off = T(value_t<T>(0.5)) * m.distance * (m.radius_j - m.radius_i) / (m.radius_i + m.radius_j);

        T normal = axial * (m.distance - h.rest_distance);
        auto shear = h.shear_force + (m.slip + swing(rotation.bend, rotation.normal) * off) * across;
        auto bending = h.bending_moment + rotation.bend * rotational.bending;
        T twisting = h.twisting_moment + rotation.twist * rotational.twisting;
        auto arm = moment_of(shear, rotation.normal);
        auto half = arm * (T(value_t<T>(0.5)) * m.distance);
        // The stress at the rim times A: A R / I is 3 / R in the plane and 4 / R in space, A R / J is 2 / R.
        T at_rim = normal + max(norm(bending + half), norm(bending - half)) * T(value_t<T>(Dim == 2 ? 3.0 : 4.0)) / r;
        T along_rim = norm(shear) + abs(twisting) * T(value_t<T>(2.0)) / r;
        auto failure =
            box_envelope::check_strength(at_rim, along_rim, p.tensile_strength * area, p.shear_strength * area);
        T stored = T(value_t<T>(0.5)) * (normal * normal / axial + squared_norm(shear) / across +
                                         squared_norm(bending) / rotational.bending);
        if constexpr (Dim == 3) stored = stored + T(value_t<T>(0.5)) * twisting * twisting / rotational.twisting;
        return {{{normal, shear, {h.rest_distance, shear, bending, twisting}, stored, T(0)},
                 failure.broken,
                 failure.in_tension},
                bending + arm * off,
                twisting};
    }
    template <class T, int Dim>
    static moment_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                             history<T, Dim> const& h) {
        return evaluate(p, m, pair_rotation<T, Dim>{{}, T(0)}, h);
    }

    /// E A / L, N/m.
    template <class T, int Dim>
    static T stiffness(parameters<T> const& p, pair_motion<T, Dim> const& m, history<T, Dim> const& h) {
        T r = p.radius_factor * min(m.radius_i, m.radius_j);
        return p.young_modulus * smaller_particle_area::area<Dim>(r, r, p.thickness) / h.rest_distance;
    }

private:
    /// I / (A R^2).
    template <int Dim, class T>
    static T gyration() {
        return T(value_t<T>(Dim == 2 ? 1.0 / 3 : 0.25));
    }
    /// Displacement across the normal due to a rotation, per metre along the normal.
    template <class T>
    static vec<T, 1> swing(vec<T, 1> const& bend, vec<T, 2> const&) {
        return bend;
    }
    template <class T>
    static vec<T, 3> swing(vec<T, 3> const& bend, vec<T, 3> const& normal) {
        return cross(bend, normal);
    }
    /// Moment of a shear force per metre of lever arm along the normal, N.
    template <class T>
    static vec<T, 1> moment_of(vec<T, 1> const& shear, vec<T, 2> const&) {
        return shear;
    }
    template <class T>
    static vec<T, 3> moment_of(vec<T, 3> const& shear, vec<T, 3> const& normal) {
        return cross(normal, shear);
    }
};

} // namespace lacuna
