// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <lacuna/core/records.hpp>
#include <lacuna/pores/network/pore_network.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

/// \file
/// Packings whose pores the tests of flow solvers use.

namespace bodies {

using point = lacuna::vec<double, 2>;
using space_point = lacuna::vec<double, 3>;

inline double uniform(std::mt19937_64& engine) { return double(engine() >> 11) * 0x1p-53; }

/// Discs of thickness 1, or spheres, and functions that make flow solvers of their pores.
template <int Dim>
struct assembly {
    using position_type = lacuna::vec<double, Dim>;
    std::vector<position_type> x;
    std::vector<double> r;

    lacuna::points_view<double, Dim> points() const { return lacuna::view_points(x); }
    template <class Boundary = lacuna::all_sealed>
    lacuna::pore_network<double, Dim> network(Boundary const& boundary = {}) const {
        return lacuna::make_pore_network(lacuna::triangulate_body(points(), r.data()), points(), r.data(), boundary);
    }
    /// K_f = 1000 Pa, k = 1, no throat skipped, apertures of 0.1 m at zero force.
    template <class Solver>
    static typename Solver::parameters settings() {
        typename Solver::parameters p;
        p.bulk_modulus = 1000;
        p.conductivity = 1;
        p.skip_ratio = std::numeric_limits<double>::infinity();
        if constexpr (requires { p.aperture.half_force; }) p.aperture = {0.1, 1, 1};
        return p;
    }
    template <class Solver, class Boundary = lacuna::all_sealed>
    Solver flow(typename Solver::parameters const& p, Boundary const& boundary = {}) const {
        return {p, network(boundary), 1.0, points(), r.data()};
    }
    /// Records as in a particle store: {x, y, arc, radius}, in space {x, y, z, radius}; then two padding particles.
    template <class Real = double>
    lacuna::particle_column<Real> records() const {
        lacuna::particle_column<Real> column;
        column.resize(x.size() + 2);
        for (std::size_t i = 0; i < x.size() + 2; ++i) {
            bool const padding = i >= x.size();
            for (int axis = 0; axis < Dim; ++axis)
                column.at(i, axis) = !padding ? Real(x[i][axis]) : axis == 0 ? Real(i) : Real(0);
            column.at(i, 3) = padding ? Real(0.25) : Real(r[i]);
        }
        return column;
    }
    /// Forces of the present pressures, one per particle.
    template <class Solver>
    std::vector<position_type> tractions(Solver flow, int threads = 1) const {
        constexpr std::size_t per_particle = Dim == 2 ? 1 : 2;
        lacuna::record_column<double> extra;
        extra.resize(per_particle * x.size());
        flow.template step<false>(records(), no_force, 0, threads, &extra);
        std::vector<position_type> force(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            for (int axis = 0; axis < Dim; ++axis) force[i][axis] = extra.at(per_particle * i, axis);
        return force;
    }
    static constexpr double no_force[4] = {0, 0, 0, 0};
};
using body = assembly<2>;
using space_body = assembly<3>;

/// Spheres of different radii on a disturbed cubic lattice of spacing 2; some overlap, some have gaps.
inline space_body scattered_spheres(std::uint64_t seed, int n, double least, double most) {
    std::mt19937_64 engine(seed);
    space_body b;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
                auto const shake = [&] { return 0.4 * (uniform(engine) - 0.5); };
                double const u = shake(), v = shake(), w = shake();
                b.x.push_back({2 * i + u, 2 * j + v, 2 * k + w});
                b.r.push_back(least + (most - least) * uniform(engine));
            }
    return b;
}
/// Touching spheres of radius 1 on a cubic lattice.
inline space_body cubic(int n) {
    auto b = scattered_spheres(1, n, 1, 1);
    for (auto& x : b.x)
        for (int axis = 0; axis < 3; ++axis) x[axis] = 2 * std::round(x[axis] / 2);
    return b;
}

/// Discs of different radii on a disturbed lattice; some overlap, some have gaps.
inline body scattered(std::uint64_t seed, int rows, int columns, double least, double most) {
    std::mt19937_64 engine(seed);
    body b;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            b.x.push_back({2 * j + (i % 2) + 0.4 * (uniform(engine) - 0.5),
                           std::sqrt(3.0) * i + 0.4 * (uniform(engine) - 0.5)});
            b.r.push_back(least + (most - least) * uniform(engine));
        }
    return b;
}

/// Touching discs of radius 1 on a triangular lattice; every second row has one less.
inline body triangular(int rows, int columns) {
    body b;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns - i % 2; ++j) {
            b.x.push_back({2.0 * j + i % 2, std::sqrt(3.0) * i});
            b.r.push_back(1);
        }
    return b;
}

/// Displaces the discs of b from their positions in rest, such that pores deform and rotate.
inline void stir(body& b, body const& rest, double phase, double amplitude = 0.01) {
    for (std::size_t i = 0; i < b.x.size(); ++i)
        b.x[i] = rest.x[i] +
                 point{std::sin(5 * phase + 0.3 * double(i)), std::cos(4 * phase + 0.7 * double(i))} * amplitude;
}

} // namespace bodies
