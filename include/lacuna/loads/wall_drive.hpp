// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/state.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/loads/prescribed_motion.hpp>

namespace lacuna {

/// Holds a wall at a constant compressive stress by moving it along its normal (the servo-mechanism of Itasca's PFC, as
/// in Potyondy and Cundall 2004, Int. J. Rock Mech. Min. Sci. 41, 1329, appendix A):
///
///   v = clamp(G (stress * area - F), +- max_speed),   G = relaxation / (dt sum of k_n)
///
/// F is the particles' force on the wall against its normal. The sum runs over the wall's contacts. If its particles
/// did not move, one step would supply the share `relaxation` of the missing force. A wall without contacts advances at
/// max_speed. Limits: the servo controls the force at the wall, not inside the specimen. If the wall must move at v to
/// hold the force, the force is off by v / G.
template <int Dim>
struct wall_servo {
    double stress = 0;       ///< Pa, >= 0
    double area = 0;         ///< area on which the stress acts, m^2; 0: from the distances of the walls `between`
    double max_speed = 0;    ///< m/s, > 0
    double relaxation = 0.5; ///< share of the missing force that one step supplies, 1; > 0, at most 1
    /// Pairs of opposite walls, by their numbers: the area is the product of their distances, in the plane times the
    /// thickness. Used if area is 0.
    std::array<std::array<std::int32_t, 2>, std::size_t(Dim - 1)> between{};

    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name, std::size_t walls) const {
        require_not_negative(name + ".stress", stress);
        require_not_negative(name + ".area", area);
        require_positive(name + ".max_speed", max_speed);
        if (!(relaxation > 0 && relaxation <= 1)) refuse(name + ".relaxation", relaxation, "> 0 and <= 1");
        if (area > 0) return;
        for (auto const& pair : between) {
            for (auto const w : pair) require_in(name + ".between", w, 0, double(walls) - 1);
            if (pair[0] == pair[1]) refuse(name + ".between", double(pair[0]), "two different walls, or an area given");
        }
    }
};

/// Moves walls at prescribed velocities or by servos. `Walls` is wall_contacts, of a room that this one does not
/// include.
template <int Dim>
class wall_drive {
public:
    using point = vec<double, Dim>;

    wall_drive() = default;
    wall_drive(std::size_t walls, double thickness) : servo_(walls), thickness_(thickness) {}

    /// Changes a wall's velocity linearly from the current one to `v`, m/s, in ramp_time after `now`, s; 0: at once.
    /// \throws std::invalid_argument naming wall, value and rule.
    template <class Walls>
    void move(Walls& walls, std::size_t w, point const& v, double ramp_time, double now) {
        std::string const name = checked(w);
        for (int axis = 0; axis < Dim; ++axis) require_finite(name + ".velocity", v[axis]);
        require_not_negative(name + ".ramp_time", ramp_time);
        servo_[w].on = 0;
        motions_.forget(w);
        if (ramp_time > 0)
            motions_.add(w, walls.next_velocity(w), v, ramp_time, now);
        else
            walls.set_velocity(w, v);
    }
    /// From now on a servo moves the wall.
    /// \throws std::invalid_argument naming wall, field, value and rule.
    void hold(std::size_t w, wall_servo<Dim> const& servo) {
        servo.validate(checked(w) + ".servo", servo_.size());
        motions_.forget(w);
        servo_[w] = {servo, 1};
    }

    /// Sets the velocities of the walls for the step from `time` to `time + time_step`, s. Servos use the forces at
    /// `time`.
    template <class Walls>
    void advance(Walls& walls, double time, double time_step) {
        motions_.advance(time, time_step, [&](std::size_t w, point const& v) { walls.set_velocity(w, v); });
        for (std::size_t w = 0; w < servo_.size(); ++w)
            if (servo_[w].on) walls.set_velocity(w, walls.normal(w) * speed(walls, w, time_step));
    }
    /// Whether a servo moves a wall.
    bool has_servo(std::size_t w) const noexcept { return servo_[w].on != 0; }
    /// Force that a servo holds, stress times area, N.
    template <class Walls>
    double servo_force(Walls const& walls, std::size_t w) const {
        return servo_[w].law.stress * area(walls, w);
    }
    /// Area on which a servo's stress acts, m^2.
    template <class Walls>
    double area(Walls const& walls, std::size_t w) const {
        auto const& servo = servo_[w].law;
        if (servo.area > 0) return servo.area;
        double product = Dim == 2 ? thickness_ : 1;
        for (auto const& pair : servo.between)
            product *= std::fabs(dot(walls.normal(std::size_t(pair[0])),
                                     walls.point(std::size_t(pair[1])) - walls.point(std::size_t(pair[0]))));
        return product;
    }

    /// Sum of the hashes of all prescribed motions, velocities and servos of walls.
    template <class Walls, class Hash>
    std::uint64_t sum_of_motions(Walls const& walls, Hash const& hash) const {
        std::uint64_t sum = motions_.sum_of_motions([&](auto const&... value) { return hash(0, value...); });
        for (std::size_t w = 0; w < servo_.size(); ++w) {
            if (auto const v = walls.next_velocity(w); squared_norm(v) > 0) sum += hash(1, w, v);
            auto const& law = servo_[w].law;
            if (!servo_[w].on) continue;
            sum += hash(2, w, law.stress, law.area, law.max_speed, law.relaxation);
            for (std::size_t k = 0; !(law.area > 0) && k < law.between.size(); ++k)
                sum += hash(3, w, k, law.between[k][0], law.between[k][1]);
        }
        return sum;
    }

    template <class Archive>
    void serialize(Archive& ar) {
        ar(motions_, fixed_length{servo_});
        require_state(motions_.fits(servo_.size()), "a prescribed motion of a wall that does not exist");
        for (auto const& s : servo_) {
            require_state(s.on == 0 || s.on == 1, "whether a wall has a servo");
            if (s.on && !(s.law.area > 0))
                for (auto const& pair : s.law.between)
                    for (auto const w : pair)
                        require_state(w >= 0 && std::size_t(w) < servo_.size(), "a servo's walls");
        }
    }

private:
    struct one {
        wall_servo<Dim> law{};
        std::int32_t on = 0;
    };

    std::string checked(std::size_t w) const {
        if (w >= servo_.size())
            refuse("wall", double(w), "below the number of walls, " + std::to_string(servo_.size()));
        return "wall " + std::to_string(w);
    }
    template <class Walls>
    double speed(Walls const& walls, std::size_t w, double time_step) const {
        auto const& servo = servo_[w].law;
        double const missing = servo.stress * area(walls, w) + dot(walls.force(w), walls.normal(w));
        double const stiffness = walls.stiffness(w);
        if (!(stiffness > 0)) return missing > 0 ? servo.max_speed : 0.0;
        return std::clamp(servo.relaxation * missing / (stiffness * time_step), -servo.max_speed, servo.max_speed);
    }

    std::vector<one> servo_;
    prescribed_motion<Dim> motions_;
    double thickness_ = 1;
};

} // namespace lacuna
