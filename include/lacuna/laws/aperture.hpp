// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/scalar.hpp>

/// \file
/// Aperture laws: how wide the throat between two particles is, from what the particles do to each other.
/// Each has `parameters` and one formula over a scalar type, aperture(p, normal_force, gap) in m;
/// normal_force in N, positive in tension; gap = distance - r_i - r_j in m, negative where particles overlap.

namespace lacuna {

/// The same aperture for every throat, whatever its particles do.
struct constant_aperture {
    struct parameters {
        double aperture = 1e-8; ///< a, m; >= 0
        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const { require_not_negative(name + ".aperture", aperture); }
    };
    template <class T>
    static T aperture(parameters const& p, T /*normal_force*/, T /*gap*/) {
        return T(value_t<T>(p.aperture));
    }
};

/// Aperture from the contact force (MODEL.md section 5.3, after the flow scheme that the paper follows):
///
///   under compression        a = a_0 F_0 / (|F_n| + F_0)
///   open or in tension       a = a_0 + m * gap      (gap counted from 0)
///
/// Continuous, and never 0 at a finite force.
struct contact_force_aperture {
    struct parameters {
        /// a_0, aperture at zero force, m; > 0. The width of cartilage's own pores, some 10 nm: no flow in a run of
        /// nanoseconds.
        double residual_aperture = 1e-8;
        double half_force = 1e-4;  ///< F_0, compression that halves the aperture, N; > 0
        double gap_factor = 1.0;   ///< m, share of the gap that adds to the aperture; 0 to 1

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_positive(name + ".residual_aperture", residual_aperture);
            require_positive(name + ".half_force", half_force);
            require_in(name + ".gap_factor", gap_factor, 0, 1);
        }
    };
    template <class T>
    static T aperture(parameters const& p, T normal_force, T gap) {
        T residual(value_t<T>(p.residual_aperture));
        T half(value_t<T>(p.half_force));
        T factor(value_t<T>(p.gap_factor));
        T squeezed = residual * half / (half - min(normal_force, T(0)));
        return select(normal_force < T(0), squeezed, residual + factor * max(gap, T(0)));
    }
};

/// What the flow policies ask of an aperture law.
template <class Law>
concept aperture_law = requires(typename Law::parameters const& p) {
    p.validate("aperture");
    { Law::aperture(p, 1.0, 1.0) } -> std::convertible_to<double>;
};

} // namespace lacuna
