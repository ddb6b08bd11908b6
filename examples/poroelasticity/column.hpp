// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <lacuna/pores/network/flow_boundaries.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

#include "porous_model.hpp"

/// \file
/// A column of the triangular lattice between two lines of symmetry. It behaves exactly as a layer without end across.

namespace poroelasticity {

/// Rows of discs, one above the other along `axis`. Both sides are mirrors. Even rows begin and end with a disc on the
/// mirror, half of which belongs to the column. In odd rows the mirror cuts a bond, and a mark, a particle of
/// negligible size, holds the cut end. Because a mark has no extent, the half pores at the mirrors have the right
/// volumes and forces.
struct column {
    discs packing;
    std::vector<int> row;        ///< of each particle, from 0
    std::vector<int> side;       ///< of each particle: 0 inside, -1 on the near mirror, +1 on the far mirror
    int rows, cells, axis;
    double radius;

    double length() const { return (rows - 1) * std::sqrt(3.0) * radius; } ///< along the axis, m
    double width() const { return 2 * radius * cells; }                    ///< between the mirrors, m
    bool is_mark(std::size_t i) const { return packing.material[i] == mark; }
    bool is_end(std::size_t i) const { return row[i] == 0 || row[i] == rows - 1; }
    /// Share of a disc that lies in the column.
    double share(std::size_t i) const { return side[i] == 0 ? 1.0 : 0.5; }
};

/// Makes a column.
/// \param rows odd, so that both ends are rows of whole discs
/// \param cells width in disc diameters
/// \param radius of a disc, m
/// \param axis direction from row to row: 0 for x, 1 for y
/// \throws std::invalid_argument for rows or cells out of range
inline column make_column(int rows, int cells, double radius, int axis) {
    lacuna::require_in("column.rows", rows, 3, 1e6);
    lacuna::require_in("column.cells", cells, 1, 1e6);
    if (rows % 2 == 0) lacuna::refuse("column.rows", rows, "odd");
    column c{{}, {}, {}, rows, cells, axis, radius};
    auto& p = c.packing;
    auto const add = [&](double across, int row, int side, material what) {
        point x{};
        x[1 - axis] = across;
        x[axis] = row * std::sqrt(3.0) * radius;
        c.row.push_back(row);
        c.side.push_back(side);
        return p.add(x, what == mark ? mark_share * radius : radius, what);
    };
    std::vector<std::int32_t> below, here;
    for (int row = 0; row < rows; ++row) {
        bool const end = row == 0 || row == rows - 1;
        here.clear();
        if (row % 2 == 0) {
            for (int i = 0; i <= cells; ++i) {
                int const side = i == 0 ? -1 : i == cells ? 1 : 0;
                here.push_back(add(2 * radius * i, row, side,
                                   side != 0 ? (end ? corner : symmetry) : end ? outline : inner));
            }
        } else {
            here.push_back(add(0, row, -1, mark));
            for (int i = 0; i < cells; ++i) here.push_back(add(2 * radius * (i + 0.5), row, 0, inner));
            here.push_back(add(2 * radius * cells, row, 1, mark));
        }
        for (std::size_t i = 1; i < here.size(); ++i) p.bonds.push_back({here[i - 1], here[i]});
        for (auto a : below)
            for (auto b : here)
                if (norm(p.position[std::size_t(b)] - p.position[std::size_t(a)]) <
                    1.01 * (p.radius[std::size_t(a)] + p.radius[std::size_t(b)]))
                    p.bonds.push_back({a, b});
        below = here;
    }
    return c;
}

/// Boundary conditions at the two ends of a column, and the length of the throats there. The far end is always drained.
struct column_ends {
    bool near_drained = false;
    double near_pressure = 0, far_pressure = 0; ///< of the reservoirs "near" and "far", Pa
    bool half_throats = true;                   ///< see halve_surface_throats()
};

/// Makes the pore network of a column, for simulation::fill_pores(). Half of a throat across a mirror belongs to the
/// column. A mark at its end makes its length too short by half; this is corrected here.
inline auto column_pores(column const& c, column_ends const& ends) {
    return [&c, ends](lacuna::points_view<double, 2> points, double const* radii) {
        using lacuna::body_side, lacuna::on_side;
        auto const mesh = lacuna::triangulate_body(points, radii);
        auto const far =
            lacuna::reservoir("far", on_side{c.axis == 1 ? body_side::top : body_side::right}, ends.far_pressure);
        auto const near =
            lacuna::reservoir("near", on_side{c.axis == 1 ? body_side::bottom : body_side::left}, ends.near_pressure);
        auto net = ends.near_drained
                       ? lacuna::make_pore_network(mesh, points, radii, lacuna::flow_boundaries(near, far))
                       : lacuna::make_pore_network(mesh, points, radii, lacuna::flow_boundaries(far));
        for (std::size_t t = 0; t < net.open_throats(); ++t)
            for (auto const& end : net.throat_particle)
                if (radii[std::size_t(end[t])] < c.radius / 2) net.length[t] = 4 * c.radius;
        if (ends.half_throats) halve_surface_throats(net);
        return net;
    };
}

/// Holds particles on the mirrors at their mirror, and fixes their rotation.
inline void hold_mirrors(simulator& sim, column const& c) {
    for (std::size_t i = 0; i < sim.size(); ++i) {
        if (c.side[i] == 0) continue;
        lacuna::fixed_axes held;
        (c.axis == 1 ? held.x : held.y) = true;
        held.rotation = true;
        sim.fix(i, held);
    }
}

/// Mean pressure of the pores between rows `layer` and `layer` + 1, Pa.
inline double layer_pressure(simulator const& sim, column const& c, int layer) {
    auto const& net = sim.flow().network();
    double sum = 0, size = 0;
    double const height = std::sqrt(3.0) * c.radius;
    for (std::size_t k = 0; k < net.pores(); ++k) {
        double const along = pore_middle(net, k, sim.particles().positions())[c.axis];
        if (int(std::floor(along / height)) != layer) continue;
        sum += net.size[k] * net.pressure[k];
        size += net.size[k];
    }
    return sum / size;
}

} // namespace poroelasticity
