// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/vec.hpp>

/// \file
/// Input and output of a pair law, and the sign convention of the whole library. The normal n points from particle i to
/// particle j. A normal force is **positive in tension**. A shear force is the force on i along the tangent (in 2D n
/// rotated by +90 degrees), positive for a positive slip of j against i.

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

/// The relative rotation of a pair over one time step. Laws with moments read it.
template <class T, int Dim>
struct pair_rotation {
    vec<T, rotation_dim<Dim>> bend; ///< rotation of j minus rotation of i; in space its part across the normal, rad
    T twist;                        ///< in space the part of that rotation about the normal, in the plane 0, rad
    vec<T, Dim> normal{};           ///< unit vector from i to j
};

/// The result of a law's formula. H is the law's history.
template <class T, int Dim, class H>
struct pair_response {
    T normal_force;                     ///< N, positive in tension
    vec<T, shear_dim<Dim>> shear_force; ///< N, on particle i
    H history;                          ///< input of the next step
    T stored_energy;                    ///< elastic energy in the pair, J
    T dissipated_energy;                ///< energy dissipated in this step (sliding, crushing), J
};

/// What a law answers that states no energies: the ledger then lacks its strain energy and dissipation, and says so.
template <class T, int Dim, class H>
struct force_response {
    T normal_force;                     ///< N, positive in tension
    vec<T, shear_dim<Dim>> shear_force; ///< N, on particle i
    H history;                          ///< what the law remembers for the next step
};

/// The result of a bond law's formula: it also says whether, and in which mode, the bond fails in this step.
template <class T, int Dim, class H>
struct bond_response : pair_response<T, Dim, H> {
    mask_t<T> broken;           ///< the bond fails
    mask_t<T> broken_in_tension; ///< valid where broken: true for tension, false for shear
};

/// The result of a law that also carries moments. Response is pair_response or bond_response.
template <class T, int Dim, class Response>
struct with_moments : Response {
    vec<T, rotation_dim<Dim>> bending_moment; ///< on i; j gets the opposite; in space across the normal, N m
    T twisting_moment;                        ///< in space, on i about the normal, N m
};
template <class T, int Dim, class H>
using moment_response = with_moments<T, Dim, bond_response<T, Dim, H>>; ///< for a bond
template <class T, int Dim, class H>
using moment_pair_response = with_moments<T, Dim, pair_response<T, Dim, H>>; ///< for a contact

/// Stiffness of a bond against bending and twisting, N m/rad.
template <class T>
struct moment_stiffness {
    T bending, twisting;
};

/// True if a law carries moments. Such a law has
///   - `static constexpr bool carries_moment = true`, and in its history `bending_moment`, which rotates with the pair;
///   - `evaluate(parameters, pair_motion, pair_rotation, history) -> with_moments`, and the form without pair_rotation;
///   - `rotational_stiffness<Dim>(parameters, radius_i, radius_j, distance) -> moment_stiffness`.
template <class Law>
inline constexpr bool carries_moment = requires { requires Law::carries_moment; };

/// Whether a law states the energies of its pairs.
template <class Law, int Dim>
inline constexpr bool states_energies = requires(typename Law::template parameters<double> const& parameters,
                                                 pair_motion<double, Dim> const& motion,
                                                 typename Law::template history<double, Dim> const& history) {
    Law::evaluate(parameters, motion, history).stored_energy;
};
/// Elastic energy that a law answers, J; 0 where it states none.
template <class Answer>
double stored_energy_of(Answer const& answer) noexcept {
    if constexpr (requires { answer.stored_energy; })
        return double(answer.stored_energy);
    else
        return 0;
}

/// The normal stiffness from which a dashpot's critical damping follows, N/m: `stiffness(parameters, pair_motion,
/// history)` in the current state if the law has it, else the constant `stiffness(parameters)`.
template <class Law, class P, class M, class H>
auto dashpot_stiffness(P const& parameters, [[maybe_unused]] M const& motion, [[maybe_unused]] H const& history) {
    if constexpr (requires { Law::stiffness(parameters, motion, history); })
        return Law::stiffness(parameters, motion, history);
    else
        return Law::stiffness(parameters);
}

/// True if a law's stiffness changes with the overlap.
template <class Law, int Dim>
inline constexpr bool stiffens = requires(typename Law::template parameters<double> const& parameters,
                                          pair_motion<double, Dim> const& motion,
                                          typename Law::template history<double, Dim> const& history) {
    Law::stiffness(parameters, motion, history);
};

/// Distance at which a pair touches according to its law, m: that in its history if there is one, else r_i + r_j.
template <class T, int Dim, class H>
T touching_distance_of(pair_motion<T, Dim> const& motion, [[maybe_unused]] H const& history) {
    if constexpr (requires { history.touching_distance; })
        return history.touching_distance;
    else
        return motion.touching_distance();
}

} // namespace lacuna
