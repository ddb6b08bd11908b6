// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <lacuna/particles/packing.hpp>

#include "sheet.hpp"

/// \file
/// The block of spheres on which step rates in space are measured: random radii on a face-centred cubic topology,
/// squeezed like the sheet. Bottom and sides are held. The top layer carries the force with which the squeezed block
/// pushes against it. The block is not relaxed: the spheres oscillate about their equilibrium. Units and constants are
/// those of the sheet.

namespace bench {

/// Spheres at the points of a grid of columns x rows x layers with even i + j + k. Rows are stacked along y.
struct block {
    static constexpr int dim = 3;
    int columns = 0, rows = 0, layers = 0;
    double load = 0; ///< downward force on each free sphere of the top layer
    std::vector<std::array<std::int16_t, 3>> cell;
    std::vector<double> x, y, z, radius;

    std::size_t size() const noexcept { return radius.size(); }
    bool held(std::size_t k) const noexcept {
        auto const& c = cell[k];
        return c[1] == 0 || c[0] == 0 || c[0] == columns - 1 || c[2] == 0 || c[2] == layers - 1;
    }
    bool loaded(std::size_t k) const noexcept { return !held(k) && cell[k][1] == rows - 1; }
    std::int32_t number(int i, int j, int k) const noexcept { return (((j * layers) + k) * columns + i) / 2; }

    /// Calls visit(i, j) for each pair of lattice neighbours.
    template <class Visit>
    void for_each_neighbour_pair(Visit const& visit) const {
        for (std::size_t n = 0; n < size(); ++n) {
            auto const& c = cell[n];
            for (auto const& step : {std::array{1, 1, 0}, std::array{-1, 1, 0}, std::array{0, 1, 1},
                                     std::array{0, 1, -1}, std::array{1, 0, 1}, std::array{-1, 0, 1}}) {
                int const i = c[0] + step[0], j = c[1] + step[1], k = c[2] + step[2];
                if (i < 0 || i >= columns || j >= rows || k < 0 || k >= layers) continue;
                visit(std::int32_t(n), number(i, j, k));
            }
        }
    }
};

namespace detail {

/// Columns, rows and layers of a grid with about twice as many points as particles. The number of columns is even.
inline std::array<int, 3> block_shape(std::size_t particles) {
    if (particles == 3200) return {20, 16, 20};
    if (particles == 100000) return {50, 80, 50};
    int const side = std::max(4, 2 * int(std::lround(std::cbrt(2 * double(particles)) / 2)));
    return {side, side, side};
}

inline double distance(block const& b, std::size_t i, std::size_t j) {
    return std::hypot(b.x[i] - b.x[j], b.y[i] - b.y[j], b.z[i] - b.z[j]);
}

/// Lists the grid points of all spheres. Does not set positions and radii.
inline block lay_out(std::array<int, 3> const& shape) {
    block b;
    b.columns = shape[0];
    b.rows = shape[1];
    b.layers = shape[2];
    for (int j = 0; j < b.rows; ++j)
        for (int k = 0; k < b.layers; ++k)
            for (int i = 0; i < b.columns; ++i)
                if ((i + j + k) % 2 == 0) b.cell.push_back({std::int16_t(i), std::int16_t(j), std::int16_t(k)});
    return b;
}

} // namespace detail

inline sheet_statistics measure(block const& b, sheet_constants const& = {}) {
    sheet_statistics found;
    b.for_each_neighbour_pair([&](std::int32_t i, std::int32_t j) {
        auto const p = std::size_t(i), q = std::size_t(j);
        double const touch = b.radius[p] + b.radius[q], over = touch - detail::distance(b, p, q);
        if (over <= 0) return;
        ++found.contacts;
        found.mean_overlap += over / touch;
    });
    double const count = double(std::max<std::size_t>(found.contacts, 1));
    found.contacts_per_disc = 2 * count / double(b.size());
    found.mean_overlap /= count;
    return found;
}

/// Makes a block of about `particles` spheres; 3,200 and 100,000 are exact. The result has the same bits each time.
inline block make_block(std::size_t particles, sheet_constants const& c = {}, std::uint64_t seed = 2024) {
    block b = detail::lay_out(detail::block_shape(particles));
    std::mt19937_64 generator(seed);
    double const half = c.spacing / std::sqrt(2.0);
    for (auto const& cell : b.cell) {
        b.radius.push_back(c.smallest_radius +
                           (c.largest_radius - c.smallest_radius) * (double(generator() >> 11) * 0x1p-53));
        b.x.push_back(half * cell[0]);
        b.y.push_back(half * cell[1]);
        b.z.push_back(half * cell[2]);
    }
    double reaction = 0;
    std::size_t loaded = 0;
    for (std::size_t k = 0; k < b.size(); ++k) loaded += b.loaded(k);
    b.for_each_neighbour_pair([&](std::int32_t i, std::int32_t j) {
        auto const p = std::size_t(i), q = std::size_t(j);
        if (!b.loaded(q) || b.loaded(p)) return;
        double const d = detail::distance(b, p, q);
        reaction += c.normal_stiffness * std::max(b.radius[p] + b.radius[q] - d, 0.0) * (b.y[q] - b.y[p]) / d;
    });
    b.load = reaction / double(loaded);
    return b;
}

/// The block as a packing of the library, with or without bonds between neighbours.
template <class Real>
lacuna::packing<Real, 3> to_packing(block const& b, work w) {
    lacuna::packing<Real, 3> result;
    for (std::size_t k = 0; k < b.size(); ++k)
        result.add({Real(b.x[k]), Real(b.y[k]), Real(b.z[k])}, Real(b.radius[k]));
    if (w == work::frictional3) return result;
    b.for_each_neighbour_pair([&](std::int32_t i, std::int32_t j) {
        auto const p = std::size_t(i), q = std::size_t(j);
        if (detail::distance(b, p, q) / (b.radius[p] + b.radius[q]) - 1 <= 0.02) result.bonds.push_back({i, j});
    });
    return result;
}

/// Writes the block for LAMMPS, as for a sheet. A comment in the first line holds columns, rows, layers and load.
/// \throws std::runtime_error if the file cannot be written
inline void write_lammps(block const& b, std::string const& path) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "w"), &std::fclose);
    if (!file) throw std::runtime_error("cannot write " + path);
    std::FILE* const f = file.get();
    double const wide = 3, free = 10, end[3] = {b.x.back() + 6, b.y.back() + 6, b.z.back() + 6};
    std::fprintf(f, "# block %d %d %d %.17g\n\n%zu atoms\n3 atom types\n\n", b.columns, b.rows, b.layers, b.load,
                 b.size());
    std::fprintf(f, "%g %.9g xlo xhi\n%g %.9g ylo yhi\n%g %.9g zlo zhi\n\nAtoms\n\n", -wide, end[0], -wide,
                 end[1] + free, -wide, end[2]);
    for (std::size_t k = 0; k < b.size(); ++k)
        std::fprintf(f, "%zu %d %.17g 1 %.17g %.17g %.17g\n", k + 1,
                     b.held(k)     ? 2
                     : b.loaded(k) ? 3
                                   : 1,
                     2 * b.radius[k], b.x[k], b.y[k], b.z[k]);
    if (std::fflush(f) != 0) throw std::runtime_error("cannot write " + path);
}

/// Reads a block that write_lammps() wrote.
/// \throws std::runtime_error if the file is missing or has another format
inline block read_block(std::string const& path) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "r"), &std::fclose);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::FILE* const f = file.get();
    std::array<int, 3> shape{};
    double load = 0;
    char line[256];
    bool good = std::fgets(line, sizeof line, f) &&
                std::sscanf(line, "# block %d %d %d %lf", &shape[0], &shape[1], &shape[2], &load) == 4 &&
                shape[0] > 0 && shape[0] % 2 == 0 && shape[1] > 0 && shape[2] > 0 &&
                *std::max_element(shape.begin(), shape.end()) < 1000;
    if (!good) throw std::runtime_error(path + ": not a block");
    block b = detail::lay_out(shape);
    b.load = load;
    while (good && (good = std::fgets(line, sizeof line, f) != nullptr) && std::string(line) != "Atoms\n") {}
    for (std::size_t k = 0; good && k < b.cell.size(); ++k) {
        double diameter = 0, density = 0, x = 0, y = 0, z = 0;
        good = std::fscanf(f, "%*d %*d %lf %lf %lf %lf %lf", &diameter, &density, &x, &y, &z) == 5;
        b.x.push_back(x);
        b.y.push_back(y);
        b.z.push_back(z);
        b.radius.push_back(diameter / 2);
    }
    if (!good) throw std::runtime_error(path + ": not a block");
    return b;
}

} // namespace bench
