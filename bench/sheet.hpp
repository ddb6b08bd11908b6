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

/// \file
/// The sheet of discs on which step rates are measured: random radii on a hexagonal topology, squeezed and relaxed.
/// Bottom and sides are held. The top row carries the force with which the squeezed sheet pushes against it.
/// Units are dimensionless: length 1, mass 1, time 1.

namespace bench {

/// A workload: bonds, contacts and pores of a sheet. In `half`, only rows with even numbers are bonded. The last two
/// workloads use a block of spheres.
enum class work { full, half, frictional, half_fluid, full3, frictional3 };

inline constexpr std::array<char const*, 6> work_names{"full",       "half",  "frictional",
                                                       "half_fluid", "full3", "frictional3"};

inline constexpr bool in_space(work w) { return w == work::full3 || w == work::frictional3; }

inline work parse_work(std::string const& name) {
    for (std::size_t w = 0; w < work_names.size(); ++w)
        if (name == work_names[w]) return work(w);
    throw std::invalid_argument("work: '" + name +
                                "', must be one of full, half, frictional, half_fluid, full3, frictional3");
}

/// Constants of all workloads, for Lacuna and LAMMPS alike.
struct sheet_constants {
    double normal_stiffness = 20, shear_stiffness = 10, friction = 0.1;
    double smallest_radius = 1.5, largest_radius = 2;
    double spacing = 3.3; ///< of the squeezed lattice; without stress it would be 3.5
    double jitter = 0.01;
    double time_step = 0.08;
    double skin = 1.2; ///< of the neighbour lists; excludes second neighbours on the lattice
};

/// A sheet with rows and columns; the index of a disc is row * columns + column.
struct sheet {
    static constexpr int dim = 2;
    int columns = 0, rows = 0;
    double load = 0; ///< force on each free disc of the top row, downwards
    std::vector<double> x, y, radius;

    std::size_t size() const noexcept { return radius.size(); }
    /// The frame: bottom row and both sides.
    bool held(std::size_t k) const noexcept {
        int const column = int(k) % columns;
        return int(k) < columns || column == 0 || column == columns - 1;
    }
    bool loaded(std::size_t k) const noexcept { return !held(k) && int(k) / columns == rows - 1; }

    /// Calls visit(i, j, in_row) for each pair of lattice neighbours. in_row: both are in one row.
    template <class Visit>
    void for_each_neighbour_pair(Visit const& visit) const {
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                std::int32_t const k = row * columns + column;
                if (column + 1 < columns) visit(k, k + 1, true);
                if (row + 1 == rows) continue;
                int const left = column - 1 + row % 2;
                for (int const above : {left, left + 1})
                    if (above >= 0 && above < columns) visit(k, (row + 1) * columns + above, false);
            }
    }
};

/// Statistics of a sheet or block.
struct sheet_statistics {
    std::size_t contacts = 0;
    double contacts_per_disc = 0, mean_overlap = 0; ///< overlap divided by the sum of the radii
    double residual = 0; ///< root mean square of the net force on free discs, divided by the mean contact force
};

namespace detail {

/// Columns and rows for about `particles` discs; the rows' number is even.
inline std::array<int, 2> sheet_shape(std::size_t particles) {
    if (particles == 3200) return {50, 64};
    if (particles == 100000) return {400, 250};
    if (particles == 1000000) return {1250, 800};
    int const rows = std::max(4, 2 * int(std::lround(std::sqrt(double(particles) * 0.8) / 2)));
    return {std::max(4, int(std::lround(double(particles) / rows))), rows};
}

/// Forces on the inner discs of one row from their twelve nearest lattice neighbours. The outer six stop a disc that
/// slips between two of the inner six.
inline void row_forces(sheet const& s, int row, double stiffness, double* fx, double* fy) {
    std::ptrdiff_t const n = s.columns, base = std::ptrdiff_t(row) * n, diagonal = row % 2 ? 0 : -1;
    double const *x = s.x.data() + base, *y = s.y.data() + base, *r = s.radius.data() + base;
    std::fill(fx, fx + n, 0.0);
    std::fill(fy, fy + n, 0.0);
    auto const add = [&](std::ptrdiff_t to) {
        for (std::ptrdiff_t i = 1; i < n - 1; ++i) {
            double const dx = x[i] - x[i + to], dy = y[i] - y[i + to], touch = r[i] + r[i + to];
            double const over = stiffness * std::max(touch / std::sqrt(dx * dx + dy * dy) - 1, 0.0);
            fx[i] += over * dx;
            fy[i] += over * dy;
        }
    };
    add(-1);
    add(1);
    for (std::ptrdiff_t const side : {n, -n})
        for (std::ptrdiff_t const along : {-1, 0, 1, 2}) add(side + diagonal + along);
    if (row > 1) add(-2 * n);
    if (row < s.rows - 2) add(2 * n);
}

} // namespace detail

inline sheet_statistics measure(sheet const& s, sheet_constants const& c = {}) {
    sheet_statistics found;
    double force = 0, left = 0;
    std::size_t inner = 0;
    s.for_each_neighbour_pair([&](std::int32_t i, std::int32_t j, bool) {
        auto const a = std::size_t(i), b = std::size_t(j);
        double const touch = s.radius[a] + s.radius[b], over = touch - std::hypot(s.x[a] - s.x[b], s.y[a] - s.y[b]);
        if (over <= 0) return;
        ++found.contacts;
        found.mean_overlap += over / touch;
        force += c.normal_stiffness * over;
    });
    std::vector<double> fx(std::size_t(s.columns)), fy(fx);
    for (int row = 1; row < s.rows - 1; ++row) {
        detail::row_forces(s, row, c.normal_stiffness, fx.data(), fy.data());
        for (std::size_t i = 1; i + 1 < fx.size(); ++i, ++inner) left += fx[i] * fx[i] + fy[i] * fy[i];
    }
    double const count = double(std::max<std::size_t>(found.contacts, 1));
    found.contacts_per_disc = 2 * count / double(s.size());
    found.mean_overlap /= count;
    found.residual = std::sqrt(left / double(std::max<std::size_t>(inner, 1))) / (force / count);
    return found;
}

namespace detail {

/// A squeezed sheet with random radii, whose inner discs are displaced at random; without a load.
inline sheet disordered_sheet(std::size_t particles, sheet_constants const& c, std::uint64_t seed) {
    sheet s;
    auto const shape = sheet_shape(particles);
    s.columns = shape[0];
    s.rows = shape[1];
    auto const count = std::size_t(s.columns) * std::size_t(s.rows);
    for (auto* column : {&s.x, &s.y, &s.radius}) column->reserve(count);
    std::mt19937_64 generator(seed);
    auto const uniform = [&](double low, double high) {
        return low + (high - low) * (double(generator() >> 11) * 0x1p-53);
    };
    double const height = c.spacing * std::sqrt(3.0) / 2;
    for (int row = 0; row < s.rows; ++row)
        for (int column = 0; column < s.columns; ++column) {
            bool const edge = row == 0 || row == s.rows - 1 || column == 0 || column == s.columns - 1;
            double const shake = edge ? 0 : c.jitter;
            s.radius.push_back(uniform(c.smallest_radius, c.largest_radius));
            double const a = uniform(-shake, shake), b = uniform(-shake, shake);
            s.x.push_back(c.spacing * (column + 0.5 * (row % 2)) + a);
            s.y.push_back(height * row + b);
        }
    return s;
}

/// Relaxes the inner discs by FIRE (Bitzek et al. 2006): steps along the motion while the energy falls, a stop when it
/// rises. Mass and stiffness are 1; omega^2 of the stiffest mode of the lattice is then near 6.
inline void relax(sheet& s, int iterations) {
    auto const count = s.size();
    std::vector<double> vx(count, 0), vy(count, 0), fx(count, 0), fy(count, 0);
    double step = 0.2, mix = 0.1;
    int downhill = 0;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        double power = 0, speed = 0, force = 0;
        for (int row = 1; row < s.rows - 1; ++row) {
            auto const base = std::size_t(row) * std::size_t(s.columns);
            row_forces(s, row, 1, fx.data() + base, fy.data() + base);
            for (std::size_t k = base + 1; k + 1 < base + std::size_t(s.columns); ++k) {
                power += fx[k] * vx[k] + fy[k] * vy[k];
                speed += vx[k] * vx[k] + vy[k] * vy[k];
                force += fx[k] * fx[k] + fy[k] * fy[k];
            }
        }
        bool const down = power > 0;
        double const keep = down ? 1 - mix : 0;
        double const mixed = (down && force > 0 ? mix * std::sqrt(speed / force) : 0) + step;
        if (!down) {
            step *= 0.5;
            mix = 0.1;
            downhill = 0;
        } else if (++downhill > 5) {
            step = std::min(step * 1.1, 0.4);
            mix *= 0.99;
        }
        for (int row = 1; row < s.rows - 1; ++row) {
            auto const base = std::size_t(row) * std::size_t(s.columns);
            for (std::size_t k = base + 1; k + 1 < base + std::size_t(s.columns); ++k) {
                vx[k] = keep * vx[k] + mixed * fx[k];
                vy[k] = keep * vy[k] + mixed * fy[k];
                s.x[k] += step * vx[k];
                s.y[k] += step * vy[k];
            }
        }
    }
}

} // namespace detail

/// Makes a sheet of about `particles` discs; 3,200, 100,000 and 1,000,000 are exact. The result has the same bits each
/// time. The top row is held during relaxation; its reaction becomes the load.
inline sheet make_sheet(std::size_t particles, sheet_constants const& c = {}, int iterations = 200,
                        std::uint64_t seed = 2024) {
    sheet s = detail::disordered_sheet(particles, c, seed);
    detail::relax(s, iterations);
    double reaction = 0;
    s.for_each_neighbour_pair([&](std::int32_t i, std::int32_t j, bool) {
        auto const a = std::size_t(i), b = std::size_t(j);
        if (!s.loaded(b) || s.loaded(a)) return;
        double const d = std::hypot(s.x[b] - s.x[a], s.y[b] - s.y[a]);
        reaction += c.normal_stiffness * std::max(s.radius[a] + s.radius[b] - d, 0.0) * (s.y[b] - s.y[a]) / d;
    });
    s.load = reaction / (s.columns - 2);
    return s;
}

/// The sheet as a packing of the library, with the bonds of a workload and discs in the order of the rows.
template <class Real>
lacuna::packing<Real, 2> to_packing(sheet const& s, work w) {
    lacuna::packing<Real, 2> result;
    for (std::size_t k = 0; k < s.size(); ++k) result.add({Real(s.x[k]), Real(s.y[k])}, Real(s.radius[k]));
    if (w == work::frictional) return result;
    s.for_each_neighbour_pair([&](std::int32_t i, std::int32_t j, bool in_row) {
        auto const a = std::size_t(i), b = std::size_t(j);
        // The few neighbours with a wide gap are not bonded.
        double const gap = std::hypot(s.x[a] - s.x[b], s.y[a] - s.y[b]) / (s.radius[a] + s.radius[b]) - 1;
        if (gap > 0.02) return;
        if (w == work::full || (in_row && int(i) / s.columns % 2 == 0)) result.bonds.push_back({i, j});
    });
    return result;
}

/// Writes the sheet for LAMMPS (atom_style sphere). Types: 1 free, 2 held, 3 loaded. A comment in the first line holds
/// columns, rows and load.
/// \throws std::runtime_error if the file cannot be written
inline void write_lammps(sheet const& s, std::string const& path) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "w"), &std::fclose);
    if (!file) throw std::runtime_error("cannot write " + path);
    std::FILE* const f = file.get();
    double low[2] = {0, 0}, high[2] = {0, 0};
    for (std::size_t k = 0; k < s.size(); ++k) {
        low[0] = std::min(low[0], s.x[k] - s.radius[k]);
        high[0] = std::max(high[0], s.x[k] + s.radius[k]);
        low[1] = std::min(low[1], s.y[k] - s.radius[k]);
        high[1] = std::max(high[1], s.y[k] + s.radius[k]);
    }
    std::fprintf(f, "# sheet %d %d %.17g\n\n%zu atoms\n3 atom types\n\n", s.columns, s.rows, s.load, s.size());
    std::fprintf(f, "%.9g %.9g xlo xhi\n%.9g %.9g ylo yhi\n-3 3 zlo zhi\n\nAtoms\n\n", low[0] - 1, high[0] + 1,
                 low[1] - 1, high[1] + 10);
    for (std::size_t k = 0; k < s.size(); ++k)
        std::fprintf(f, "%zu %d %.17g 1 %.17g %.17g 0\n", k + 1, s.held(k) ? 2 : s.loaded(k) ? 3 : 1, 2 * s.radius[k],
                     s.x[k], s.y[k]);
    if (std::fflush(f) != 0) throw std::runtime_error("cannot write " + path);
}

/// Reads a sheet that write_lammps() wrote.
/// \throws std::runtime_error if the file is missing or has another format
inline sheet read_lammps(std::string const& path) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "r"), &std::fclose);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::FILE* const f = file.get();
    sheet s;
    char line[256];
    bool good = std::fgets(line, sizeof line, f) &&
                std::sscanf(line, "# sheet %d %d %lf", &s.columns, &s.rows, &s.load) == 3 && s.columns > 0 &&
                s.rows > 0;
    while (good && (good = std::fgets(line, sizeof line, f) != nullptr) && std::string(line) != "Atoms\n") {}
    for (std::size_t k = 0; good && k < std::size_t(s.columns) * std::size_t(s.rows); ++k) {
        double diameter = 0, density = 0, x = 0, y = 0;
        good = std::fscanf(f, "%*d %*d %lf %lf %lf %lf %*f", &diameter, &density, &x, &y) == 4;
        s.x.push_back(x);
        s.y.push_back(y);
        s.radius.push_back(diameter / 2);
    }
    if (!good) throw std::runtime_error(path + ": not a sheet");
    return s;
}

} // namespace bench
