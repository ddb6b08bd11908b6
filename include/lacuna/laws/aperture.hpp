// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/scalar.hpp>

/// \file
/// Aperture laws give the width of the throat between two particles from their normal force and gap. Each has
/// `parameters` and one formula over a scalar type, aperture(p, normal_force, gap) in m. normal_force is in N, positive
/// in tension; gap = distance - r_i - r_j is in m, negative where particles overlap.

namespace lacuna {

/// The same aperture for every throat at all times.
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

/// Aperture from the contact force (the flow scheme that the paper follows):
///
///   under compression        a = a_0 F_0 / (|F_n| + F_0)
///   open or in tension       a = a_0 + m * gap      (gap counted from 0)
///
/// Continuous, and never 0 at a finite force.
struct contact_force_aperture {
    struct parameters {
        /// a_0, aperture at zero force, m; > 0. The default is the width of the natural pores of cartilage, about 10
        /// nm, through which nothing flows within nanoseconds.
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

/// Aperture of a crack between parallel plates:
///
///   a = h (a_r + w),   w = max(gap, 0)
///
/// w is the crack's opening displacement, counted from the position where the discs touch. a_r is the mechanical width
/// that remains when the crack is shut, whatever the compression. h is the ratio of hydraulic to mechanical aperture.
/// It is f^(-1/3) for the roughness factor f of Witherspoon, Wang, Iwai and Gale (1980, "Validity of cubic law for
/// fluid flow in a deformable rock fracture", Water Resour. Res. 16, 1016): 1 for smooth plates, f = 1.04 to 1.65 in
/// their tests. With the conductivity k = depth / (12 mu), the paper's eq. 14 is their cubic law, q = depth (a_r + w)^3
/// / (12 mu f) dp / l.
struct cubic_crack_aperture {
    struct parameters {
        double residual_aperture = 1e-8; ///< a_r, m; > 0
        double hydraulic_factor = 1;     ///< h, 1; > 0, <= 1

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_positive(name + ".residual_aperture", residual_aperture);
            if (!(hydraulic_factor > 0 && hydraulic_factor <= 1))
                refuse(name + ".hydraulic_factor", hydraulic_factor, "> 0 and <= 1");
        }
    };
    template <class T>
    static T aperture(parameters const& p, T /*normal_force*/, T gap) {
        return T(value_t<T>(p.hydraulic_factor)) * (T(value_t<T>(p.residual_aperture)) + max(gap, T(0)));
    }
};

/// Aperture that compression reduces exponentially to a residual one:
///
///   under compression        a = a_inf + (a_0 - a_inf) exp(-|F_n| / F_d)
///   open or in tension       a = a_0 + m * gap      (gap counted from 0)
///
/// The law of fractures under normal stress, b = b_r + b_max exp(-alpha sigma) (Rutqvist, Wu, Tsang and Bodvarsson
/// 2002, Int. J. Rock Mech. Min. Sci. 39, 429), written in the force: F_d = A / alpha for a contact of area A.
/// Continuous, and never below a_inf.
struct exponential_aperture {
    struct parameters {
        double zero_force_aperture = 1e-8; ///< a_0, m; > 0
        double residual_aperture = 1e-9;   ///< a_inf under great compression, m; > 0, <= a_0
        double decay_force = 1e-4;         ///< F_d, compression that takes 1 - 1/e off a_0 - a_inf, N; > 0
        double gap_factor = 1.0;           ///< m, share of the gap that adds to the aperture; 0 to 1

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const {
            require_positive(name + ".zero_force_aperture", zero_force_aperture);
            require_positive(name + ".residual_aperture", residual_aperture);
            if (!(residual_aperture <= zero_force_aperture))
                refuse(name + ".residual_aperture", residual_aperture, "at most zero_force_aperture");
            require_positive(name + ".decay_force", decay_force);
            require_in(name + ".gap_factor", gap_factor, 0, 1);
        }
    };
    template <class T>
    static T aperture(parameters const& p, T normal_force, T gap) {
        T most(value_t<T>(p.zero_force_aperture));
        T least(value_t<T>(p.residual_aperture));
        T squeezed = least + (most - least) * exp(min(normal_force, T(0)) * T(value_t<T>(1 / p.decay_force)));
        return select(normal_force < T(0), squeezed, most + T(value_t<T>(p.gap_factor)) * max(gap, T(0)));
    }
};

/// Conductance C of a throat in space, the facet between three spheres, as that of a tube with its hydraulic radius:
///
///   C = k s A R_h^2 / l,   k = 1 / (2 mu)
///
/// A is the area of the facet outside the spheres, 0 where they close it. R_h is that area over the length of the arcs
/// that bound it. A round tube has s = 1 (Hagen, Poiseuille). After B. Chareyre, A. Cortis, E. Catalano and E.
/// Barthelemy (2012, "Pore-scale modeling of viscous flow and induced forces in dense sphere packings", Transp. Porous
/// Media 94, 595), who take R_h from the walls of the two pores instead, and l from the distance between the pores.
struct hydraulic_section {
    struct parameters {
        double shape_factor = 1; ///< s; > 0

        /// \throws std::invalid_argument naming field, value and rule.
        void validate(std::string const& name) const { require_positive(name + ".shape_factor", shape_factor); }
    };
    /// s A R_h^2, m^4.
    template <class T>
    static T opening(parameters const& p, T area, T hydraulic_radius) {
        return T(value_t<T>(p.shape_factor)) * max(area, T(0)) * hydraulic_radius * hydraulic_radius;
    }
};

/// A law for the section of a throat in space; it does not depend on the forces and gaps of particle pairs.
template <class Law>
concept throat_section_law = requires(typename Law::parameters const& p) {
    p.validate("aperture");
    { Law::opening(p, 1.0, 1.0) } -> std::convertible_to<double>;
};

/// Requirements of the flow policies on an aperture law.
template <class Law>
concept aperture_law = throat_section_law<Law> || requires(typename Law::parameters const& p) {
    p.validate("aperture");
    { Law::aperture(p, 1.0, 1.0) } -> std::convertible_to<double>;
};

} // namespace lacuna
