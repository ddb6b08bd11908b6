// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/vec.hpp>

/// \file
/// What a law of a pair sees and what it answers. The sign convention of the whole library: the normal n points
/// from particle i to particle j; a normal force is **positive in tension**; a shear force is the force on i,
/// along the tangent (in 2D n turned by +90 degrees), positive for a positive slip of j against i.

namespace lacuna {

/// The relative motion of a pair in its own frame, over one time step.
template <class T, int Dim>
struct pair_motion {
    T distance;                  ///< centre to centre, m
    T radius_i, radius_j;        ///< m; a wall has radius 0
    vec<T, shear_dim<Dim>> slip; ///< tangential displacement of j against i at the contact in this step, m
    T normal_rate;               ///< rate of separation, m/s

    T touching_distance() const noexcept { return radius_i + radius_j; }
};

/// How the bodies of a pair turned against each other over one time step: what bonds with moments read.
template <class T, int Dim>
struct pair_rotation {
    vec<T, rotation_dim<Dim>> bend; ///< turn of j less turn of i; in space its part across the normal, rad
    T twist;                        ///< in space its part about the normal, in the plane 0, rad
    vec<T, Dim> normal{};           ///< unit vector from i to j
};

/// What a law answers. H is the law's history.
template <class T, int Dim, class H>
struct pair_response {
    T normal_force;                     ///< N, positive in tension
    vec<T, shear_dim<Dim>> shear_force; ///< N, on particle i
    H history;                          ///< what the law remembers for the next step
    T stored_energy;                    ///< elastic energy in the pair, J
    T dissipated_energy;                ///< turned into heat in this step (sliding, crushing), J
};

/// A bond's answer: in addition whether, and how, it fails in this step.
template <class T, int Dim, class H>
struct bond_response : pair_response<T, Dim, H> {
    mask_t<T> broken;           ///< the bond fails
    mask_t<T> broken_in_tension; ///< meaningful where broken: by tension (else by shear)
};

/// The answer of a law that also carries moments. Response is pair_response or bond_response.
template <class T, int Dim, class Response>
struct with_moments : Response {
    vec<T, rotation_dim<Dim>> bending_moment; ///< on i, and the opposite on j; in space across the normal, N m
    T twisting_moment;                        ///< in space, on i about the normal, N m
};
template <class T, int Dim, class H>
using moment_response = with_moments<T, Dim, bond_response<T, Dim, H>>; ///< of a bond
template <class T, int Dim, class H>
using moment_pair_response = with_moments<T, Dim, pair_response<T, Dim, H>>; ///< of a contact

/// Stiffness of a bond against bending and twisting, N m/rad.
template <class T>
struct moment_stiffness {
    T bending, twisting;
};

/// Whether a law carries moments. It has then
///   - `static constexpr bool carries_moment = true` and in its history `bending_moment`, which turns with the pair;
///   - `evaluate(parameters, pair_motion, pair_rotation, history) -> with_moments` beside the form without a turn;
///   - `rotational_stiffness<Dim>(parameters, radius_i, radius_j, distance) -> moment_stiffness`.
template <class Law>
inline constexpr bool carries_moment = requires { requires Law::carries_moment; };

/// Normal stiffness in N/m by which a dashpot of a given ratio of critical damping is measured: of a law whose
/// stiffness changes with the overlap in the present state, by `stiffness(parameters, pair_motion, history)`, else
/// the law's constant.
template <class Law, class P, class M, class H>
auto dashpot_stiffness(P const& parameters, [[maybe_unused]] M const& motion, [[maybe_unused]] H const& history) {
    if constexpr (requires { Law::stiffness(parameters, motion, history); })
        return Law::stiffness(parameters, motion, history);
    else
        return Law::stiffness(parameters);
}

/// Whether a law's stiffness changes with the overlap.
template <class Law, int Dim>
inline constexpr bool stiffens = requires(typename Law::template parameters<double> const& parameters,
                                          pair_motion<double, Dim> const& motion,
                                          typename Law::template history<double, Dim> const& history) {
    Law::stiffness(parameters, motion, history);
};

/// Distance at which a pair touches to its law: the one in its history, or r_i + r_j, m.
template <class T, int Dim, class H>
T touching_distance_of(pair_motion<T, Dim> const& motion, [[maybe_unused]] H const& history) {
    if constexpr (requires { history.touching_distance; })
        return history.touching_distance;
    else
        return motion.touching_distance();
}

} // namespace lacuna
