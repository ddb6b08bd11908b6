// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/vec.hpp>
#include <lacuna/laws/pair_motion.hpp>

namespace lacuna {

/// Position and motion of one partner of a pair: input of the kinematics.
template <class T, int Dim>
struct body {
    vec<T, Dim> position;           ///< m
    vec<T, Dim> velocity;           ///< m/s
    vec<T, rotation_dim<Dim>> spin; ///< rad/s
    T radius;                       ///< m
    T mass;                         ///< kg
};

/// Relative position and motion of the two bodies of a pair.
template <class T, int Dim>
struct relative_state {
    vec<T, Dim> arm;                   ///< from i to j, m
    vec<T, Dim> velocity;              ///< of j relative to i, m/s
    vec<T, rotation_dim<Dim>> rolling; ///< r_i w_i + r_j w_j, m/s
    T radii;                           ///< r_i + r_j, m
    T radius_i, radius_j;              ///< m
};

/// Frame of a pair, relative motion in that frame, and the conversion of forces in it to forces on the two bodies.
template <class T, int Dim>
struct pair_frame {
    using shear = vec<T, shear_dim<Dim>>;
    vec<T, Dim> normal;         ///< unit vector from i to j
    pair_motion<T, Dim> motion; ///< input of the laws
    T lever;                    ///< lever arm over radius: distance / (r_i + r_j), the same for both bodies
    vec<T, 3> previous_normal;  ///< 3D only: normal one step ago
    T twist;                    ///< 3D only: radius-weighted mean spin about the normal, times the time step, rad

    /// Force on body i (body j gets the opposite), N.
    vec<T, Dim> force(T normal_force, shear const& shear_force) const {
        if constexpr (Dim == 2)
            return normal * normal_force + perpendicular(normal) * shear_force[0];
        else
            return normal * normal_force + shear_force;
    }
    /// Torque on a body per metre of its radius, the same for i and j, N.
    vec<T, rotation_dim<Dim>> torque_per_radius(shear const& shear_force) const {
        if constexpr (Dim == 2)
            return {shear_force[0] * lever};
        else
            return cross(normal, shear_force) * lever;
    }
    /// Moment on body i (body j gets the opposite), N m.
    template <class Response>
    vec<T, rotation_dim<Dim>> moment(Response const& answer) const {
        if constexpr (Dim == 2)
            return answer.bending_moment;
        else
            return answer.bending_moment + normal * answer.twisting_moment;
    }
    /// Rotation of body j relative to body i in the step, from their spins, rad/s.
    pair_rotation<T, Dim> relative_rotation(vec<T, rotation_dim<Dim>> const& spin_i,
                                            vec<T, rotation_dim<Dim>> const& spin_j, T const& time_step) const {
        auto rotation = (spin_j - spin_i) * time_step;
        if constexpr (Dim == 2) {
            return {rotation, T(0), normal};
        } else {
            T about = dot(normal, rotation);
            return {rotation - normal * about, about, normal};
        }
    }
    /// Rotates a stored shear force with the pair: by the change of the normal and by the mean spin about the normal.
    shear rotate_with_pair(shear const& stored) const {
        if constexpr (Dim == 2) {
            return stored;
        } else {
            auto bisector = normal + previous_normal;
            auto swung = stored - bisector * (dot(normal, stored) / (T(1) + dot(normal, previous_normal)));
            // Cayley's form of the rotation by `twist`: exact length for any angle, without trigonometry.
            T h = T(0.5) * twist;
            T scale = T(1) / (T(1) + h * h);
            return swung * ((T(1) - h * h) * scale) + cross(normal, swung) * (T(2) * h * scale);
        }
    }
};

/// Rotates the vectors of a history with the pair: the shear force and, for laws with moments, the bending moment.
template <class Law, class History, class T>
void rotate_history(History& history, pair_frame<T, 3> const& frame) {
    if constexpr (requires { history.shear_force; })
        history.shear_force = frame.rotate_with_pair(history.shear_force);
    if constexpr (carries_moment<Law>) history.bending_moment = frame.rotate_with_pair(history.bending_moment);
}

/// Relative motion of two bodies over the last step.
///
/// The lever arms are d r_i/(r_i + r_j) and d r_j/(r_i + r_j). They add up to the distance d at any stretch. Hence a
/// rigid motion gives no slip, and forces conserve angular momentum, exactly. The slip is the distance times the angle
/// by which the pair rotated relative to its bodies. The angle is measured between the present normal and the normal
/// one step ago. Tangential velocity over distance would have an error of third order that adds up over many rotations.
/// \param time_step length of the last step, s
template <class T, int Dim>
pair_frame<T, Dim> relative_motion(relative_state<T, Dim> const& state, T const& time_step) {
    // No local variable of this path is const: g++ 12 keeps const ones in memory once they are packs.
    auto arm = state.arm;
    auto step = state.velocity * time_step;
    // The slip divides by the squared distance and so need not wait for the root. One division gives both inverses,
    // because a division takes a processor as long as ten products.
    T squared = squared_norm(arm);
    T inverse = T(1) / (squared * state.radii);
    T inverse_squared = inverse * state.radii;
    T inverse_radii = inverse * squared;
    T distance = sqrt(squared);
    T inverse_distance = distance * inverse_squared;

    pair_frame<T, Dim> frame;
    frame.normal = arm * inverse_distance;
    frame.lever = distance * inverse_radii;
    frame.motion.distance = distance;
    frame.motion.radius_i = state.radius_i;
    frame.motion.radius_j = state.radius_j;
    frame.motion.normal_rate = dot(frame.normal, state.velocity);
    auto rolling = state.rolling * (time_step * inverse_radii);
    if constexpr (Dim == 2) {
        // tan(angle) = (arm x step) / (arm . (arm - step)). The quotient uses the geometric series, the arc tangent its
        // power series: the relative error is below 1e-12 up to 1/100 rad per step.
        T e = dot(arm, step) * inverse_squared;
        T t = cross(arm, step) * inverse_squared * ((T(1) + e) * (T(1) + e * e));
        T t2 = t * t;
        T angle = t - t * t2 * (T(value_t<T>(1.0 / 3)) - t2 * T(value_t<T>(0.2)));
        frame.motion.slip = {distance * (angle - rolling[0])};
    } else {
        auto before = arm - step;
        frame.previous_normal = before / sqrt(squared_norm(before));
        auto middle = (frame.normal + frame.previous_normal) * T(0.5);
        T chord = T(1) + squared_norm(rolling) * T(value_t<T>(1.0 / 12));
        auto slip = (frame.normal - frame.previous_normal - cross(rolling, middle) * chord) * distance;
        frame.motion.slip = slip - frame.normal * dot(frame.normal, slip);
        frame.twist = dot(rolling, frame.normal);
    }
    return frame;
}

/// Relative motion of two bodies over the last step, from their single states.
template <class T, int Dim>
pair_frame<T, Dim> relative_motion(body<T, Dim> const& i, body<T, Dim> const& j, T time_step) {
    return relative_motion(relative_state<T, Dim>{j.position - i.position, j.velocity - i.velocity,
                                                  i.spin * i.radius + j.spin * j.radius, i.radius + j.radius, i.radius,
                                                  j.radius},
                           time_step);
}

} // namespace lacuna
