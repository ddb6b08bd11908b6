// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/laws/bond_values.hpp>
#include <lacuna/laws/brittle_spring_bond.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// The paper's bond that also resists bending, and in space twisting. Its stiffness against these is the share b of a
/// parallel bond's (Potyondy and Cundall 2004, see parallel_bond). b = 0 gives brittle_spring_bond with its compression
/// failure. Below, R is min(r_i, r_j).
///
///   M_b <- M_b + b k_n R^2 / 3 * bend         in the plane; R^2 / 4 in space
///   M_t <- M_t + b k_s R^2 / 2 * twist        in space
///   F_n + 3 |M_b| / R > sigma_n A_c           breaks in tension; 4 |M_b| / R in space
///   |F_s| + 2 |M_t| / R > sigma_s A_c         breaks in shear
///
/// As in parallel_bond, the moment terms are the stress at the rim of the beam times its area.
struct brittle_beam_bond {
    static constexpr bool carries_moment = true;

    /// The input values of one material (the paper's Table 1).
    struct material {
        double normal_stiffness = 1e6;                                     ///< k_n, N/m
        double shear_stiffness = 1e6;                                      ///< k_s, N/m
        double tensile_strength = std::numeric_limits<double>::infinity(); ///< sigma_n, Pa; infinite: never breaks
        double shear_strength = std::numeric_limits<double>::infinity();   ///< sigma_s, Pa
        double bending_ratio = 1; ///< b, share of a parallel bond's rotational stiffness, 1; a pair has the smaller one

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            spring().validate(name);
            require_not_negative(name + ".bending_ratio", bending_ratio);
        }
        brittle_spring_bond::material spring() const {
            return {normal_stiffness, shear_stiffness, tensile_strength, shear_strength};
        }
    };

    template <class T>
    struct parameters {
        brittle_spring_bond::parameters<T> spring;
        T bending_ratio;
    };

    template <class T, int Dim>
    struct history {
        T rest_distance;
        vec<T, shear_dim<Dim>> shear_force;
        vec<T, rotation_dim<Dim>> bending_moment;
        T twisting_moment;
    };

    static parameters<double> combine(material const& a, material const& b, double thickness) {
        return {brittle_spring_bond::combine(a.spring(), b.spring(), thickness), min(a.bending_ratio, b.bending_ratio)};
    }

    /// Returns the parameters of a bond whose values `own` replace those of its materials.
    template <int Dim>
    static parameters<double> with_values(parameters<double> p, bond_values const& own, double radius_i,
                                          double radius_j) {
        bond_values springs = own;
        springs.bending_stiffness.reset();
        p.spring = brittle_spring_bond::with_values<Dim>(p.spring, springs, radius_i, radius_j);
        if (own.bending_stiffness) {
            p.bending_ratio = 1;
            p.bending_ratio = *own.bending_stiffness / rotational_stiffness<Dim>(p, radius_i, radius_j).bending;
        }
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
        T r = min(radius_i, radius_j);
        T r2 = r * r * p.bending_ratio;
        if constexpr (Dim == 2)
            return {p.spring.normal_stiffness * r2 * T(value_t<T>(1.0 / 3)), T(0)};
        else
            return {p.spring.normal_stiffness * r2 * T(value_t<T>(0.25)),
                    p.spring.shear_stiffness * r2 * T(value_t<T>(0.5))};
    }

    template <class T, int Dim>
    static moment_response<T, Dim, history<T, Dim>> evaluate(parameters<T> const& p, pair_motion<T, Dim> const& m,
                                                             pair_rotation<T, Dim> const& rotation,
                                                             history<T, Dim> const& h) {
        auto spring = brittle_spring_bond::evaluate<T, Dim>(p.spring, m, {h.rest_distance, h.shear_force});
        T r = min(m.radius_i, m.radius_j);
        T area = smaller_particle_area::area<Dim>(m.radius_i, m.radius_j, p.spring.thickness);
        auto k = rotational_stiffness<Dim>(p, m.radius_i, m.radius_j);
        auto bending = h.bending_moment + rotation.bend * k.bending;
        T twisting = h.twisting_moment + rotation.twist * k.twisting;
        T at_rim = spring.normal_force + norm(bending) * T(value_t<T>(Dim == 2 ? 3.0 : 4.0)) / r;
        T along_rim = norm(spring.shear_force) + abs(twisting) * T(value_t<T>(2.0)) / r;
        auto failure = box_envelope::check_strength(at_rim, along_rim, p.spring.tensile_strength * area,
                                                    p.spring.shear_strength * area);
        T stored = spring.stored_energy + T(value_t<T>(0.5)) * (per(squared_norm(bending), k.bending) +
                                                                per(twisting * twisting, k.twisting));
        return {{{spring.normal_force,
                  spring.shear_force,
                  {spring.history.rest_distance, spring.shear_force, bending, twisting},
                  stored,
                  spring.dissipated_energy},
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
        return p.spring.normal_stiffness;
    }

    /// The compressive force at which the bond yields, N. It carries no more than this.
    template <int Dim, class T>
    static T compressive_limit(parameters<T> const& p, T radius_i, T radius_j) {
        return brittle_spring_bond::compressive_limit<Dim>(p.spring, radius_i, radius_j);
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
