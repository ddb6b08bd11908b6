// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <exception>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <lacuna/simulation.hpp>

/// \file
/// Packings that several tests of the simulator use.

namespace setups {

inline constexpr double never = std::numeric_limits<double>::infinity();
inline constexpr double pi = std::numbers::pi;

using plane = lacuna::default_model<2>;
using space = lacuna::default_model<3>;
struct plane_locally_damped : plane {
    using damping = lacuna::local_damping;
};
struct plane_viscous : plane {
    using damping = lacuna::viscous_damping;
};
struct plane_combined : plane {
    using damping = lacuna::combined_damping;
};
using plane_in_single = lacuna::default_model<2, float>;
struct ring : plane {
    using domain = lacuna::periodic_domain;
};

/// The same springs for bonds and contacts.
template <class Model>
lacuna::simulation_parameters<Model> springs(double kn, double ks, double friction = 0, double density = 1000,
                                             double tensile = never, double shear = never) {
    lacuna::simulation_parameters<Model> p;
    p.materials = {{density, {kn, ks, friction}, {kn, ks, tensile, shear}}};
    return p;
}

/// Density of a disc of radius 0.5 m and thickness 1 m, or of a sphere of radius 0.5 m, that has a mass of 1 kg.
inline double unit_density(int dim) { return dim == 2 ? 4 / pi : 6 / pi; }

/// `count` touching particles of radius 0.5 along x, the first at the origin; bonded to their neighbours.
template <int Dim>
lacuna::packing<double, Dim> chain(int count, bool bonded = true) {
    lacuna::packing<double, Dim> p;
    for (int k = 0; k < count; ++k) {
        lacuna::vec<double, Dim> x{};
        x[0] = k;
        p.add(x, 0.5);
        if (k > 0 && bonded) p.bonds.push_back({k - 1, k});
    }
    return p;
}

/// Bonds between all pairs whose gap is below `gap`, by a check of every pair.
template <int Dim>
void bond_touching(lacuna::packing<double, Dim>& p, double gap = 1e-6) {
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = i + 1; j < p.size(); ++j)
            if (norm(p.position[j] - p.position[i]) < p.radius[i] + p.radius[j] + gap)
                p.bonds.push_back({std::int32_t(i), std::int32_t(j)});
}

/// Rows of touching discs of radius 0.5, each shifted by half a disc (triangular) or not (square), bonded.
inline lacuna::packing<double, 2> lattice(int columns, int rows, bool triangular) {
    lacuna::packing<double, 2> p;
    double const height = triangular ? std::sqrt(0.75) : 1.0;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) p.add({c + (triangular && r % 2 == 1 ? 0.5 : 0.0), r * height}, 0.5);
    bond_touching(p);
    return p;
}

/// A number of [-1, 1] for the k-th of some things, another one for another salt.
inline double noise(std::size_t k, int salt) { return std::sin(12.9898 * double(k) + 78.233 * salt); }

/// Force of the pair (a, b), by stable ids, on a, at the last step: {F_x, F_y[, F_z]}.
template <class Model>
lacuna::vec<double, Model::dim> pair_force(lacuna::simulation<Model> const& s, int a, int b) {
    return s.pair_force(std::size_t(a), std::size_t(b));
}

/// Normal force, positive in tension, from the last force and the positions before the last motion; along x.
template <class Model>
double force_along_x(lacuna::simulation<Model> const& s, int a, int b) {
    return pair_force(s, a, b)[0];
}

template <class Model>
lacuna::vec<double, Model::dim> momentum(lacuna::simulation<Model> const& s) {
    lacuna::vec<double, Model::dim> p{};
    for (std::size_t k = 0; k < s.size(); ++k) p += s.velocity(k) * s.mass(k);
    return p;
}

/// Text of the exception that `play()` throws; "" if it throws none.
template <class Play>
std::string thrown_by(Play const& play) {
    try {
        play();
    } catch (std::exception const& e) {
        return e.what();
    }
    return "";
}

/// Stops a run after step `last`: one that goes on to the same end later is the same run.
struct stop_after {
    static constexpr lacuna::stage stages = lacuna::stage::step;
    long long last;
    template <class Simulation>
    lacuna::run_control on_step(Simulation const& s) const {
        return s.steps() >= last ? lacuna::run_control::stop : lacuna::run_control::go_on;
    }
};

/// Orbital and spin angular momentum about the origin.
template <class Model>
lacuna::vec<double, lacuna::rotation_dim<Model::dim>> angular_momentum(lacuna::simulation<Model> const& s) {
    lacuna::vec<double, lacuna::rotation_dim<Model::dim>> total{};
    for (std::size_t k = 0; k < s.size(); ++k) {
        total += s.spin(k) * s.moment_of_inertia(k);
        auto const orbital = cross(s.position(k), s.velocity(k) * s.mass(k));
        if constexpr (Model::dim == 2)
            total[0] += orbital;
        else
            total += orbital;
    }
    return total;
}

} // namespace setups
