// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <lacuna/core/eigen_dense.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/interactions/kinematics.hpp>

namespace lacuna {

/// Small dense matrices of the pairs of an equilibrium.
template <int Dim>
struct pair_matrices {
    static constexpr int rotations = rotation_dim<Dim>;
    static constexpr int per_particle = Dim + rotations;
    static constexpr int freedoms = 2 * per_particle;
    using point = Eigen::Matrix<double, Dim, 1>;
    using tensor = Eigen::Matrix<double, Dim, Dim>;              ///< change of a force per displacement
    using operators = Eigen::Matrix<double, Dim, freedoms>;      ///< relative displacement per freedom
    using rotation_operators = Eigen::Matrix<double, rotations, freedoms>;
    using element = Eigen::Matrix<double, freedoms, freedoms>;

    static point to_eigen(vec<double, Dim> const& v) {
        point p;
        for (int axis = 0; axis < Dim; ++axis) p[axis] = v[axis];
        return p;
    }
    static vec<double, Dim> to_vec(point const& p) {
        vec<double, Dim> v{};
        for (int axis = 0; axis < Dim; ++axis) v[axis] = p[axis];
        return v;
    }

    /// Displacement of the contact point on j relative to that on i, per freedom of the two particles: displacements
    /// and surface rotations of i, then of j. The transpose gives minus the forces on the particles for a force on i.
    static operators relative_displacement(pair_frame<double, Dim> const& frame) {
        operators b = operators::Zero();
        for (int axis = 0; axis < Dim; ++axis) {
            b(axis, axis) = -1;
            b(axis, per_particle + axis) = 1;
        }
        for (int r = 0; r < rotations; ++r) {
            auto const along = swept(frame.normal, r);
            for (int axis = 0; axis < Dim; ++axis)
                b(axis, Dim + r) = b(axis, per_particle + Dim + r) = -frame.lever * along[axis];
        }
        return b;
    }
    /// The same without the rotations: displacement of one centre relative to the other.
    static operators relative_centres() {
        operators b = operators::Zero();
        for (int axis = 0; axis < Dim; ++axis) {
            b(axis, axis) = -1;
            b(axis, per_particle + axis) = 1;
        }
        return b;
    }
    /// Rotation of j relative to i, per freedom.
    static rotation_operators relative_rotation(double radius_i, double radius_j) {
        rotation_operators b = rotation_operators::Zero();
        for (int r = 0; r < rotations; ++r) {
            b(r, Dim + r) = -1 / radius_i;
            b(r, per_particle + Dim + r) = 1 / radius_j;
        }
        return b;
    }
    /// Force on i from a normal force, positive in tension, and a shear force in the frame.
    static point force(pair_frame<double, Dim> const& frame, double normal, vec<double, shear_dim<Dim>> const& shear) {
        return to_eigen(frame.force(normal, shear));
    }
    /// Slip in the frame's own form from a displacement.
    static vec<double, shear_dim<Dim>> slip(pair_frame<double, Dim> const& frame, point const& displacement) {
        if constexpr (Dim == 2) {
            auto const t = perpendicular(frame.normal);
            return {t[0] * displacement[0] + t[1] * displacement[1]};
        } else {
            auto const d = to_vec(displacement);
            return d - frame.normal * dot(frame.normal, d);
        }
    }
    /// Unit vectors of the frame: the normal, then tangents.
    static tensor axes(pair_frame<double, Dim> const& frame) {
        tensor e;
        e.col(0) = to_eigen(frame.normal);
        if constexpr (Dim == 2) {
            e.col(1) = to_eigen(perpendicular(frame.normal));
        } else {
            int least = 0;
            for (int axis = 1; axis < 3; ++axis)
                if (std::fabs(frame.normal[axis]) < std::fabs(frame.normal[least])) least = axis;
            vec<double, 3> unit{};
            unit[least] = 1;
            auto const across = cross(frame.normal, unit);
            auto const first = across / norm(across);
            e.col(1) = to_eigen(first);
            e.col(2) = to_eigen(cross(frame.normal, first));
        }
        return e;
    }

private:
    /// Displacement at the end of the normal by a unit rotation about axis r.
    static vec<double, Dim> swept(vec<double, Dim> const& normal, [[maybe_unused]] int r) {
        if constexpr (Dim == 2) {
            return perpendicular(normal);
        } else {
            vec<double, 3> axis{};
            axis[r] = 1;
            return cross(axis, normal);
        }
    }
};

} // namespace lacuna
