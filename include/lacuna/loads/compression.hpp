// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/loads/wall_drive.hpp>
#include <lacuna/particles/packing.hpp>

/// \file
/// Compression tests: two walls compress a specimen; walls on its sides, if there are any, hold a constant stress.
/// Uniaxial: two platens. Biaxial in the plane, triaxial in space: a box.

namespace lacuna {

/// Lowest and highest coordinate of a packing along an axis, radii included, m.
/// \throws std::invalid_argument for a packing without particles
template <class Real, int Dim>
std::array<double, 2> extent(packing<Real, Dim> const& p, int axis) {
    if (p.size() == 0) refuse("packing.size()", 0.0, "at least 1");
    std::array<double, 2> e{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t k = 0; k < p.size(); ++k) {
        e[0] = std::min(e[0], double(p.position[k][axis]) - double(p.radius[k]));
        e[1] = std::max(e[1], double(p.position[k][axis]) + double(p.radius[k]));
    }
    return e;
}

/// Returns two walls that just touch a packing along an axis: first the lower, then the upper wall.
/// \tparam Wall the simulation's type of wall
/// \throws std::invalid_argument for an axis that does not exist, and for a packing without particles
template <class Wall, class Real, int Dim, class Material>
std::vector<Wall> platens(packing<Real, Dim> const& p, int axis, Material const& material) {
    require_in("axis", axis, 0, Dim - 1);
    std::vector<Wall> walls;
    auto const ends = extent(p, axis);
    for (int side = 0; side < 2; ++side) {
        Wall wall{};
        wall.point[axis] = ends[std::size_t(side)];
        wall.normal[axis] = side == 0 ? 1 : -1;
        wall.material = material;
        walls.push_back(wall);
    }
    return walls;
}

/// Returns walls that just touch a packing on all sides. Walls 2 axis and 2 axis + 1 are perpendicular to an axis.
/// \throws std::invalid_argument for a packing without particles
template <class Wall, class Real, int Dim, class Material>
std::vector<Wall> box_walls(packing<Real, Dim> const& p, Material const& material) {
    std::vector<Wall> walls;
    for (int axis = 0; axis < Dim; ++axis)
        for (auto const& wall : platens<Wall>(p, axis, material)) walls.push_back(wall);
    return walls;
}

/// Input of a compression test.
struct compression_parameters {
    int axis = 1;            ///< axis of compression
    double strain_rate = 0;  ///< relative to the initial length, 1/s, > 0; each platen does half of it
    double ramp_time = 0;    ///< time in which the platens reach their speed, s
    double confinement = 0;  ///< stress on the sides, Pa, >= 0; used with a box
    double servo_speed = 0;  ///< largest speed of the walls on the sides, m/s, > 0; used with a box
    double relaxation = 0.5; ///< of the servos; see wall_servo

    /// \throws std::invalid_argument naming field, value and rule.
    void validate(std::string const& name, int dim, bool box) const {
        require_in(name + ".axis", axis, 0, dim - 1);
        require_positive(name + ".strain_rate", strain_rate);
        require_not_negative(name + ".ramp_time", ramp_time);
        require_not_negative(name + ".confinement", confinement);
        if (box) require_positive(name + ".servo_speed", servo_speed);
        if (!(relaxation > 0 && relaxation <= 1)) refuse(name + ".relaxation", relaxation, "> 0 and <= 1");
    }
};

/// Strains and stresses of a specimen, measured at its walls; compression is positive.
template <int Dim>
struct compression_state {
    vec<double, Dim> strain{}; ///< shortening over the initial length, 1; 0 along an axis without walls
    vec<double, Dim> stress{}; ///< mean of the forces on two opposite walls over the specimen's section, Pa
};

/// Drives a compression test and measures strain and stress. The simulation's walls 0 and 1 must be those of platens(),
/// or all its walls those of box_walls().
template <int Dim>
class compression_test {
public:
    /// \param packing the specimen: its extent is the initial length, and the section of a uniaxial test
    /// \param box true: walls on all sides; false: two platens
    /// \param thickness of the specimen, m; used in the plane
    /// \throws std::invalid_argument naming field, value and rule.
    template <class Real>
    compression_test(compression_parameters const& p, packing<Real, Dim> const& packing, bool box, double thickness = 1)
        : p_(p), box_(box), thickness_(Dim == 2 ? thickness : 1) {
        p.validate("compression", Dim, box);
        require_positive("thickness", thickness);
        for (int axis = 0; axis < Dim; ++axis) {
            auto const ends = extent(packing, axis);
            length_[axis] = ends[1] - ends[0];
        }
    }

    /// With a box: all walls hold the confinement. Strains are measured from the state in which load() is called.
    template <class Simulation>
    void confine(Simulation& sim) const {
        for (int axis = 0; box_ && axis < Dim; ++axis) hold(sim, axis);
    }
    /// Starts the platens; the walls on the sides hold the confinement.
    template <class Simulation>
    void load(Simulation& sim) {
        if (box_)
            for (int axis = 0; axis < Dim; ++axis) {
                length_[axis] = distance(sim, axis);
                if (axis != p_.axis) hold(sim, axis);
            }
        auto const w = walls_of(p_.axis);
        vec<double, Dim> v{};
        v[p_.axis] = 0.5 * p_.strain_rate * length_[p_.axis];
        sim.move_wall(w[0], v, p_.ramp_time);
        sim.move_wall(w[1], -v, p_.ramp_time);
    }

    /// Strains and stresses at the last evaluation of forces.
    template <class Simulation>
    compression_state<Dim> state(Simulation const& sim) const {
        compression_state<Dim> s;
        for (int axis = 0; axis < Dim; ++axis) {
            if (!box_ && axis != p_.axis) continue;
            auto const w = walls_of(axis);
            s.strain[axis] = 1 - distance(sim, axis) / length_[axis];
            double area = thickness_;
            for (int other = 0; other < Dim; ++other)
                if (other != axis) area *= box_ ? distance(sim, other) : length_[other];
            s.stress[axis] = 0.5 * (sim.walls().force(w[1])[axis] - sim.walls().force(w[0])[axis]) / area;
        }
        return s;
    }
    /// Initial length along an axis, m.
    double length(int axis) const noexcept { return length_[axis]; }

private:
    std::array<std::size_t, 2> walls_of(int axis) const noexcept {
        std::size_t const first = box_ ? 2 * std::size_t(axis) : 0;
        return {first, first + 1};
    }
    template <class Simulation>
    double distance(Simulation const& sim, int axis) const {
        auto const w = walls_of(axis);
        return sim.walls().point(w[1])[axis] - sim.walls().point(w[0])[axis];
    }
    template <class Simulation>
    void hold(Simulation& sim, int axis) const {
        wall_servo<Dim> servo;
        servo.stress = p_.confinement;
        servo.max_speed = p_.servo_speed;
        servo.relaxation = p_.relaxation;
        std::size_t next = 0;
        for (int other = 0; other < Dim; ++other)
            if (other != axis) servo.between[next++] = {2 * other, 2 * other + 1};
        for (std::size_t const w : walls_of(axis)) sim.servo_wall(w, servo);
    }

    compression_parameters p_;
    bool box_;
    double thickness_;
    vec<double, Dim> length_{};
};

} // namespace lacuna
