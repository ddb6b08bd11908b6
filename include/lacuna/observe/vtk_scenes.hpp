// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <lacuna/observe/vtk.hpp>

/// \file
/// VTK scenes of a simulation: particles, bonds, pores. Points are particles, numbered as in the packing.

namespace lacuna {

namespace detail {

/// Appends the three components of a vector of the plane or of space; a spin in the plane is along z.
template <class Vector>
void put_three(std::vector<double>& to, Vector const& v) {
    if constexpr (Vector::size() == 1)
        to.insert(to.end(), {0.0, 0.0, double(v[0])});
    else
        for (int axis = 0; axis < 3; ++axis) to.push_back(axis < v.size() ? double(v[axis]) : 0.0);
}

/// Appends a unit quaternion {x, y, z, w}, from eq. 8's unit vector in the plane or from a quaternion {w, x, y, z}.
template <class Orientation>
void put_quaternion(std::vector<double>& to, Orientation const& q) {
    if constexpr (Orientation::size() == 2) {
        double const half = 0.5 * std::atan2(double(q[1]), double(q[0]));
        to.insert(to.end(), {0.0, 0.0, std::sin(half), std::cos(half)});
    } else {
        to.insert(to.end(), {double(q[1]), double(q[2]), double(q[3]), double(q[0])});
    }
}

template <class Simulation>
vtk_surface vtk_points(Simulation const& sim, vtk_surface::cells kind) {
    vtk_surface s;
    s.kind = kind;
    for (std::size_t k = 0; k < sim.size(); ++k) put_three(s.coordinates, sim.position(k));
    return s;
}

} // namespace detail

/// Particles as points: radius m, material, mass kg, velocity m/s, spin rad/s, orientation (unit quaternion x, y, z,
/// w).
template <class Simulation>
vtk_surface vtk_particles(Simulation const& sim) {
    auto s = detail::vtk_points(sim, vtk_surface::cells::points);
    s.point_data = {{"radius", 1, {}}, {"material", 1, {}}, {"mass", 1, {}},
                    {"velocity", 3, {}}, {"spin", 3, {}}, {"orientation", 4, {}}};
    for (std::size_t k = 0; k < sim.size(); ++k) {
        s.add_cell({std::int64_t(k)});
        s.point_data[0].values.push_back(sim.radius(k));
        s.point_data[1].values.push_back(sim.material(k));
        s.point_data[2].values.push_back(sim.mass(k));
        detail::put_three(s.point_data[3].values, sim.velocity(k));
        detail::put_three(s.point_data[4].values, sim.spin(k));
        detail::put_quaternion(s.point_data[5].values, sim.orientation(k));
    }
    return s;
}

/// Bonds as lines. Their mode is 0 if intact, 1 if broken in tension, 2 if broken in shear.
/// \param broken_only leaves out intact bonds
template <class Simulation>
vtk_surface vtk_bonds(Simulation const& sim, bool broken_only = false) {
    auto s = detail::vtk_points(sim, vtk_surface::cells::lines);
    s.cell_data = {{"mode", 1, {}}};
    for (auto const& bond : sim.pairs().bond_records()) {
        if (broken_only && int(bond.state) == 0) continue;
        s.add_cell({bond.particles[0], bond.particles[1]});
        s.cell_data[0].values.push_back(double(bond.state));
    }
    return s;
}

/// Pores as triangles, in space as tetrahedra: pressure Pa, volume m^3.
/// \param sim a simulation with a flow whose pores are filled
template <class Simulation>
vtk_surface vtk_pores(Simulation const& sim) {
    constexpr bool solid = Simulation::dim == 3;
    auto s = detail::vtk_points(sim, solid ? vtk_surface::cells::tetrahedra : vtk_surface::cells::polygons);
    auto const& net = sim.flow().network();
    s.cell_data = {{"pressure", 1, {}}, {"volume", 1, {}}};
    for (std::size_t p = 0; p < net.pores() && !net.bare(); ++p) {
        for (auto const& corner : net.corner) s.connectivity.push_back(sim.particles().id(std::size_t(corner[p])));
        s.offsets.push_back(std::int64_t(s.connectivity.size()));
        s.cell_data[0].values.push_back(double(net.pressure[p]));
        s.cell_data[1].values.push_back(double(net.volume[p]));
    }
    return s;
}

} // namespace lacuna
