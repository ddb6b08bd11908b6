// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/dual.hpp>
#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/core/fields.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/equilibrium/pair_operator.hpp>
#include <lacuna/interactions/kinematics.hpp>
#include <lacuna/laws/law_concepts.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// Forces of one bond in an increment, and their tangent, from the law's formula with dual numbers. As long as the
/// solver looks for an equilibrium, bonds are elastic beyond their strength.
template <class Law, int Dim>
struct bond_forces {
    using matrices = pair_matrices<Dim>;
    static constexpr bool bends = carries_moment<Law>;
    static constexpr int rotations = rotation_dim<Dim>;
    static constexpr int strains = Dim + (bends ? rotations : 0);
    using tangent_matrix = Eigen::Matrix<double, strains, strains>;

    typename matrices::point force = matrices::point::Zero(); ///< on i, N
    Eigen::Matrix<double, rotations, 1> moment = Eigen::Matrix<double, rotations, 1>::Zero(); ///< on i, N m
    double normal_force = 0; ///< positive in tension, N
    bool broken = false;     ///< whether the law says that the bond fails
};

/// A symmetric matrix whose negative eigenvalues are replaced by zero: a stiffness with which Newton's matrix stays
/// positive definite.
template <class Matrix>
Matrix without_negative_directions(Matrix const& k) {
    if (k.llt().info() == Eigen::Success) return k;
    Eigen::SelfAdjointEigenSolver<Matrix> modes(k);
    return modes.eigenvectors() * modes.eigenvalues().cwiseMax(0.0).asDiagonal() * modes.eigenvectors().transpose();
}

namespace detail {

template <class Law, class P, class M, class R, class H>
auto evaluate_bond(P const& parameters, M const& motion, [[maybe_unused]] R const& rotation, H const& history) {
    if constexpr (carries_moment<Law>)
        return Law::evaluate(parameters, motion, rotation, history);
    else
        return Law::evaluate(parameters, motion, history);
}

/// The history with its vectors turned with the pair.
template <class Law, int Dim, class H>
H turned(H state, [[maybe_unused]] pair_frame<double, Dim> const& frame) {
    if constexpr (Dim == 3) rotate_history<Law>(state, frame);
    return state;
}

} // namespace detail

/// Evaluates a bond.
/// \param state history at the last committed state, turned with the pair
template <class Law, int Dim, class P, class H>
bond_forces<Law, Dim> evaluate_bond(P const& parameters, pair_frame<double, Dim> const& frame,
                                    pair_rotation<double, Dim> const& rotation, H const& state) {
    auto const answer = detail::evaluate_bond<Law>(parameters, frame.motion, rotation, state);
    bond_forces<Law, Dim> f;
    f.normal_force = answer.normal_force;
    f.force = pair_matrices<Dim>::force(frame, answer.normal_force, answer.shear_force);
    f.broken = answer.broken;
    if constexpr (carries_moment<Law>) {
        auto const moment = frame.moment(answer);
        for (int r = 0; r < rotation_dim<Dim>; ++r) f.moment[r] = moment[r];
    }
    return f;
}

/// Change of a bond's force and moment per relative displacement and rotation, made symmetric and without negative
/// directions.
template <class Law, int Dim, class P, class H>
typename bond_forces<Law, Dim>::tangent_matrix bond_tangent(P const& parameters, pair_frame<double, Dim> const& frame,
                                                            pair_rotation<double, Dim> const& rotation,
                                                            H const& state) {
    using forces = bond_forces<Law, Dim>;
    constexpr int strains = forces::strains, rotations = rotation_dim<Dim>;
    using number = dual<double, strains>;
    auto const constant = [](double x) { return number(x); };
    auto const axes = pair_matrices<Dim>::axes(frame);
    auto const seeded = [](double value, double const* derivative, int first, int count, int stride) {
        number x(value);
        for (int v = 0; v < count; ++v) x.derivative[first + v] = derivative[v * stride];
        return x;
    };
    pair_motion<number, Dim> motion{number::variable(frame.motion.distance, 0), number(frame.motion.radius_i),
                                    number(frame.motion.radius_j), {}, number(0.0)};
    pair_rotation<number, Dim> turn{{}, number(rotation.twist), {}};
    for (int axis = 0; axis < Dim; ++axis) turn.normal[axis] = number(frame.normal[axis]);
    if constexpr (Dim == 2) {
        motion.slip[0] = number::variable(frame.motion.slip[0], 1);
        if constexpr (forces::bends) turn.bend[0] = number::variable(rotation.bend[0], 2);
    } else {
        for (int axis = 0; axis < 3; ++axis) {
            double const tangents[2] = {axes(axis, 1), axes(axis, 2)};
            motion.slip[axis] = seeded(frame.motion.slip[axis], tangents, 1, 2, 1);
            if constexpr (forces::bends) turn.bend[axis] = seeded(rotation.bend[axis], tangents, 3, 2, 1);
        }
        if constexpr (forces::bends) turn.twist = number::variable(rotation.twist, 5);
    }
    auto const answer = detail::evaluate_bond<Law>(
        convert_fields<number, double, typename Law::template parameters<number>>(parameters, constant), motion, turn,
        convert_fields<number, double, typename Law::template history<number, Dim>>(state, constant));

    // Rows: force, then moment; columns: the variables, each along one axis.
    Eigen::Matrix<double, strains, strains> change, along = Eigen::Matrix<double, strains, strains>::Zero();
    along.template topLeftCorner<Dim, Dim>() = axes;
    for (int v = 0; v < strains; ++v) {
        vec<double, shear_dim<Dim>> shear{};
        for (int s = 0; s < shear_dim<Dim>; ++s) shear[s] = answer.shear_force[s].derivative[v];
        change.template block<Dim, 1>(0, v) =
            pair_matrices<Dim>::force(frame, answer.normal_force.derivative[v], shear);
        if constexpr (forces::bends)
            for (int r = 0; r < rotations; ++r)
                change(Dim + r, v) = answer.bending_moment[r].derivative[v] +
                                     (Dim == 3 ? frame.normal[r] * answer.twisting_moment.derivative[v] : 0.0);
    }
    if constexpr (forces::bends) {
        if constexpr (Dim == 2) {
            along(2, 2) = 1;
        } else {
            along.template block<3, 1>(3, 3) = axes.col(1);
            along.template block<3, 1>(3, 4) = axes.col(2);
            along.template block<3, 1>(3, 5) = axes.col(0);
        }
    }
    typename forces::tangent_matrix const k = change * along.transpose();
    return without_negative_directions((0.5 * (k + k.transpose())).eval());
}

} // namespace lacuna
