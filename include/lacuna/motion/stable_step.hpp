// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <lacuna/core/vec.hpp>

namespace lacuna {

/// Rigorous upper bound of the highest eigenfrequency of an assembly, in one pass over its stiffnesses.
///
/// The explicit scheme is stable while dt < 2 / omega_max. omega_max^2 is the largest eigenvalue of the mass-scaled
/// tangent matrix A = M^-1/2 K M^-1/2 over translations and rotations. By Gershgorin's theorem no eigenvalue exceeds
/// the largest sum of absolute values of a row. This also holds after a similarity transformation diag(1, a): a row is
/// summed separately over translations and rotations, and the smallest bound for several a is taken. Diagonal blocks
/// are summed with their signs (they cancel in part), the rest by absolute value.
template <int Dim>
class frequency_bound {
public:
    static constexpr int rotations = rotation_dim<Dim>;
    static constexpr int freedoms = Dim + rotations;
    using point = vec<double, Dim>;
    using gradient = std::array<double, std::size_t(freedoms)>;

    frequency_bound() = default;
    explicit frequency_bound(std::size_t particles) { reset(particles); }
    /// Removes all stiffnesses. Allocates nothing unless the number of particles exceeds all earlier ones.
    void reset(std::size_t particles) {
        rows_.resize(particles);
        for (auto& r : rows_) r.block = {}, r.off_diagonal = {};
    }

    /// Sets the inverse mass of a particle along `axis`, 1/kg (axis >= Dim: the inverse moment of inertia, 1/(kg m^2));
    /// 0 if fixed.
    void set_mobility(std::size_t k, int axis, double mobility) {
        rows_[k].root_mobility[std::size_t(axis)] = std::sqrt(mobility);
    }

    /// Adds a spring between two particles, with stiffnesses along the normal and across it, N/m. The shear stiffness
    /// acts with lever arms to the centres, m; the prestress stiffness (force over distance) has no lever arms.
    void add_pair(std::size_t i, std::size_t j, point const& normal, double normal_stiffness, double shear_stiffness,
                  double prestress, double lever_i, double lever_j) {
        auto const axes = frame(normal);
        for (int a = 0; a < Dim; ++a) {
            std::array<std::size_t, 2> const who{i, j};
            auto const& axis = axes[std::size_t(a)];
            if (a > 0) add(who, std::array{gradient_of(-axis, normal, 0), gradient_of(axis, normal, 0)}, prestress);
            add(who, std::array{gradient_of(-axis, normal, lever_i), gradient_of(axis, normal, -lever_j)},
                a == 0 ? normal_stiffness : shear_stiffness);
        }
    }

    /// Adds a spring between a particle and a fixed support. Units: N/m, m.
    void add_support(std::size_t i, point const& normal, double normal_stiffness, double shear_stiffness,
                     double lever) {
        auto const axes = frame(normal);
        for (int a = 0; a < Dim; ++a)
            add(std::array{i}, std::array<gradient, 1>{gradient_of(-axes[std::size_t(a)], normal, lever)},
                a == 0 ? normal_stiffness : shear_stiffness);
    }

    /// Adds springs against the relative rotation of two particles, across the normal and about it, N m/rad.
    void add_rotational(std::size_t i, std::size_t j, point const& normal, double bending, double twisting) {
        std::array<std::size_t, 2> const who{i, j};
        for_each_rotation(normal, [&](int a, gradient const& g) {
            gradient opposite{};
            for (int x = Dim; x < freedoms; ++x) opposite[std::size_t(x)] = -g[std::size_t(x)];
            add(who, std::array{g, opposite}, a == 0 ? twisting : bending);
        });
    }
    /// Adds springs against the rotation of a particle relative to a fixed support, N m/rad.
    void add_rotational(std::size_t i, point const& normal, double bending, double twisting) {
        for_each_rotation(normal, [&](int a, gradient const& g) {
            add(std::array{i}, std::array<gradient, 1>{g}, a == 0 ? twisting : bending);
        });
    }

    /// Adds the energy 1/2 stiffness (sum over particles g . displacement)^2, as for a pore that resists compression.
    template <std::size_t Count>
    void add(std::array<std::size_t, Count> const& who, std::array<gradient, Count> const& g, double stiffness) {
        for (std::size_t p = 0; p < Count; ++p)
            for (int a = 0; a < freedoms; ++a) {
                auto& own = rows_[who[p]];
                double const ga = g[p][std::size_t(a)] * own.root_mobility[std::size_t(a)];
                if (ga == 0) continue;
                for (std::size_t q = 0; q < Count; ++q)
                    for (int b = 0; b < freedoms; ++b) {
                        double const entry =
                            stiffness * ga * g[q][std::size_t(b)] * rows_[who[q]].root_mobility[std::size_t(b)];
                        if (q == p)
                            own.block[std::size_t(a * freedoms + b)] += entry;
                        else
                            own.off_diagonal[std::size_t(2 * a + (b >= Dim))] += std::fabs(entry);
                    }
            }
    }

    /// A force on particle k alone: minus its derivative by the position (or velocity), by rows, N/m (N s/m). It need
    /// not be symmetric: Gershgorin's theorem holds for any matrix.
    void add_matrix(std::size_t k, std::array<point, std::size_t(Dim)> const& derivative) {
        auto& own = rows_[k];
        for (int a = 0; a < Dim; ++a)
            for (int b = 0; b < Dim; ++b)
                own.block[std::size_t(a * freedoms + b)] += derivative[std::size_t(a)][b] *
                                                            own.root_mobility[std::size_t(a)] *
                                                            own.root_mobility[std::size_t(b)];
    }

    /// The upper bound of omega_max, rad/s; 0 without any stiffness.
    double frequency() const {
        constexpr int scales = 7; // 0.5 to 4
        std::array<double, scales> scale{0.5}, largest{};
        for (std::size_t s = 1; s < scales; ++s) scale[s] = scale[s - 1] * std::sqrt(2.0);
        for (auto const& own : rows_)
            for (int a = 0; a < freedoms; ++a) {
                double sums[2] = {own.off_diagonal[std::size_t(2 * a)], own.off_diagonal[std::size_t(2 * a + 1)]};
                for (int b = 0; b < freedoms; ++b)
                    sums[b >= Dim] += std::fabs(own.block[std::size_t(a * freedoms + b)]);
                // This form passes not-a-number on to the bound, so that the step becomes zero.
                if (sums[0] + sums[1] == 0) continue;
                for (std::size_t s = 0; s < scales; ++s) {
                    double const row = a < Dim ? sums[0] + scale[s] * sums[1] : sums[0] / scale[s] + sums[1];
                    if (!(row <= largest[s] || std::isnan(largest[s]))) largest[s] = row;
                }
            }
        double best = std::numeric_limits<double>::infinity();
        for (double const row : largest) {
            if (std::isnan(row)) return std::numeric_limits<double>::infinity();
            best = std::min(best, row);
        }
        return std::sqrt(best);
    }

    /// The safe step of the explicit scheme, 2 / frequency(), s; infinite without any stiffness.
    double time_step() const { return 2 / frequency(); }
    /// The safe step with damping, s. It is shorter, because the scheme uses the velocity of half a step before.
    ///
    /// With damping forces C v of that velocity, K + 2 C / dt replaces K. This gives dt^2 a + 2 dt b = 4, where a and b
    /// bound the largest eigenvalues of the mass-scaled K and C.
    /// \param dashpots a bound to which damping coefficients, N s/m, were added instead of stiffnesses
    /// \param force_factor largest factor by which damping enlarges a force: 1 + alpha for local damping
    /// \param drag_rate drag over momentum, 1/s
    double time_step(frequency_bound const& dashpots, double force_factor, double drag_rate = 0) const {
        double const stiff = frequency(), viscous = dashpots.frequency();
        return step_of(force_factor * stiff * stiff, force_factor * (viscous * viscous + drag_rate));
    }
    /// The positive solution dt of dt^2 a + 2 dt b = 4, s; see time_step().
    static double step_of(double a, double b) noexcept { return 4 / (b + std::sqrt(b * b + 4 * a)); }

private:
    /// Calls use(axis, gradient of the rotation about it). Axis 0 is the normal, in space only.
    template <class Use>
    static void for_each_rotation(point const& normal, Use const& use) {
        auto const axes = frame(normal);
        for (int a = Dim == 2 ? 1 : 0; a < Dim; ++a) {
            gradient g{};
            for (int x = 0; x < rotations; ++x) g[std::size_t(Dim + x)] = Dim == 2 ? 1 : axes[std::size_t(a)][x];
            use(a, g);
        }
    }
    /// The normal, followed by the tangents.
    static std::array<point, std::size_t(Dim)> frame(point const& normal) {
        std::array<point, std::size_t(Dim)> axes{};
        axes[0] = normal;
        if constexpr (Dim == 2) {
            axes[1] = perpendicular(normal);
        } else {
            point e{};
            e[std::fabs(normal[0]) < 0.6 ? 0 : 1] = 1;
            axes[1] = cross(normal, e) / norm(cross(normal, e));
            axes[2] = cross(normal, axes[1]);
        }
        return axes;
    }
    /// Derivative of the displacement along `axis` of the contact point, which is lever * normal from the centre.
    static gradient gradient_of(point const& axis, point const& normal, double lever) {
        gradient g{};
        for (int x = 0; x < Dim; ++x) g[std::size_t(x)] = axis[x];
        if constexpr (Dim == 2) {
            g[2] = lever * cross(normal, axis);
        } else {
            point const t = cross(normal, axis) * lever;
            for (int x = 0; x < 3; ++x) g[std::size_t(3 + x)] = t[x];
        }
        return g;
    }

    /// The matrix rows of one particle.
    struct particle_rows {
        std::array<double, std::size_t(freedoms)> root_mobility{};
        std::array<double, std::size_t(freedoms * freedoms)> block{}; ///< rows of the diagonal block
        std::array<double, std::size_t(2 * freedoms)> off_diagonal{}; ///< sums per row: translations, rotations
    };
    std::vector<particle_rows> rows_;
};

} // namespace lacuna
