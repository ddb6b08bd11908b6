// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <lacuna/core/points.hpp>
#include <lacuna/neighbors/search.hpp>

namespace clouds {

using lacuna::neighbor_pair;

inline double uniform(std::mt19937_64& rng) { return double(rng() >> 11) * 0x1p-53; }

template <class Real, int Dim>
struct cloud {
    std::string name;
    std::vector<lacuna::vec<Real, Dim>> points;
    std::vector<Real> radii;
    lacuna::points_view<Real, Dim> view() const { return lacuna::view_points(points); }
};

template <class Real, int Dim>
lacuna::vec<Real, Dim> random_point(std::mt19937_64& rng, double length) {
    lacuna::vec<Real, Dim> p{};
    for (int axis = 0; axis < Dim; ++axis) p[axis] = Real(length * uniform(rng));
    return p;
}

/// The inputs for every search. Lengths are micrometres, in m, as in a cartilage simulation.
template <class Real, int Dim>
std::vector<cloud<Real, Dim>> all_clouds() {
    using point = lacuna::vec<Real, Dim>;
    std::mt19937_64 rng(20240229);
    std::vector<cloud<Real, Dim>> all;
    auto const radius = [&](double low, double high) { return Real(low + (high - low) * uniform(rng)); };
    auto const add = [&](std::string name, std::size_t n, auto point_of, double r_low, double r_high) {
        cloud<Real, Dim> c;
        c.name = std::move(name);
        for (std::size_t k = 0; k < n; ++k) {
            c.points.push_back(point_of(k));
            c.radii.push_back(radius(r_low, r_high));
        }
        all.push_back(std::move(c));
    };
    double const side = Dim == 2 ? 60e-6 : 24e-6;
    auto const in_box = [&](std::size_t) { return random_point<Real, Dim>(rng, side); };
    auto const origin = [&](std::size_t) { return point{}; };

    add("empty", 0, in_box, 1e-6, 2e-6);
    add("one", 1, in_box, 1e-6, 2e-6);
    add(
        "two", 2,
        [&](std::size_t k) {
            point p{};
            p[0] = Real(3e-6 * double(k));
            return p;
        },
        1.6e-6, 1.7e-6);
    add("random", 400, in_box, 1.5e-6, 2e-6);
    add(
        "shifted far from the origin", 400,
        [&](std::size_t) {
            point p = random_point<Real, Dim>(rng, side);
            for (int axis = 0; axis < Dim; ++axis) p[axis] -= Real(1e-3);
            return p;
        },
        1.5e-6, 2e-6);
    add(
        "clusters far apart", 400,
        [&](std::size_t k) {
            point p = random_point<Real, Dim>(rng, 12e-6);
            p[0] += Real(double(k % 3) * 2e-3);
            p[1] -= Real(double(k % 4) * 1e-3);
            return p;
        },
        1e-6, 2e-6);
    add(
        "flown away", 400,
        [&](std::size_t k) {
            if (k % 100 != 7) return random_point<Real, Dim>(rng, side);
            point p{};
            for (int axis = 0; axis < Dim; ++axis) p[axis] = Real((axis == 0 ? -1e12 : 1e3) * double(k));
            return p;
        },
        1.5e-6, 2e-6);
    add(
        "along an axis", 300,
        [&](std::size_t) {
            point p{};
            p[0] = Real(400e-6 * uniform(rng));
            return p;
        },
        1e-6, 2e-6);
    add(
        "along the last axis", 300,
        [&](std::size_t) {
            point p{};
            p[Dim - 1] = Real(400e-6 * uniform(rng));
            return p;
        },
        1e-6, 2e-6);
    add(
        "along the diagonal", 300,
        [&](std::size_t) {
            point p{};
            auto const x = Real(600e-6 * uniform(rng));
            for (int axis = 0; axis < Dim; ++axis) p[axis] = x;
            return p;
        },
        1e-6, 2e-6);
    add("coincident", 60, origin, 1e-6, 2e-6);
    add("coincident without size", 60, origin, 0, 0);
    add("without size", 200, in_box, 0, 0);
    add(
        "very elongated", 400,
        [&](std::size_t) {
            point p = random_point<Real, Dim>(rng, 3e-6);
            p[1] = Real(2e-3 * uniform(rng));
            return p;
        },
        1.5e-6, 2e-6);
    cloud<Real, Dim> wide;
    wide.name = "radii over three decades";
    for (int k = 0; k < 500; ++k) {
        wide.points.push_back(random_point<Real, Dim>(rng, side));
        wide.radii.push_back(Real(8e-6 * std::pow(10.0, -3.0 * uniform(rng))));
    }
    all.push_back(wide);
    wide.name = "radii over six decades, one large";
    for (auto& r : wide.radii) r = Real(1e-9 + 1e-7 * uniform(rng));
    wide.radii[250] = Real(1e-3 * 0.02);
    all.push_back(wide);
    return all;
}

/// Every pair with distance <= r_i + r_j + margin, from the definition, in long double. `doubtful` counts pairs so
/// close to the limit that rounding decides: tests use inputs without such pairs.
template <class Real, int Dim>
std::vector<neighbor_pair> reference_pairs(std::vector<lacuna::vec<Real, Dim>> const& points,
                                           std::vector<Real> const& radii, Real margin, int& doubtful) {
    std::vector<neighbor_pair> expected;
    doubtful = 0;
    long double const band = 4.0L * std::numeric_limits<Real>::epsilon();
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j) {
            long double square = 0;
            for (int axis = 0; axis < Dim; ++axis) {
                long double const d = (long double)(points[i][axis]) - (long double)(points[j][axis]);
                square += d * d;
            }
            long double const distance = std::sqrt(square);
            long double const limit = (long double)(radii[i]) + (long double)(radii[j]) + (long double)(margin);
            if (distance <= limit) expected.push_back({std::int32_t(i), std::int32_t(j)});
            if (limit > 0 && std::fabs(distance - limit) <= band * limit) ++doubtful;
        }
    return expected;
}

} // namespace clouds
