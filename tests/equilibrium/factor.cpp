// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include <lacuna/equilibrium/multifrontal_factor.hpp>

#include "catch.hpp"

using lacuna::multifrontal_factor;
using place = multifrontal_factor::place;
using sparse = multifrontal_factor::sparse;

namespace {

double noise(std::uint64_t key) {
    std::uint64_t x = (key + 1) * 0x9E3779B97F4A7C15ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return double((x ^ (x >> 31)) >> 11) * 0x1p-53 - 0.5;
}

struct problem {
    sparse lower;
    std::vector<place> places;
};

/// Blocks of unknowns on a grid of columns x rows x layers, joined to their neighbours by random entries. Every
/// fourth unknown has a negative diagonal, if the matrix is quasi-definite. The last two unknowns are at no place.
problem grid(std::array<int, 3> size, int per_node, bool quasi_definite) {
    problem p;
    std::vector<std::array<int, 3>> cell;
    for (int z = 0; z < size[2]; ++z)
        for (int y = 0; y < size[1]; ++y)
            for (int x = 0; x < size[0]; ++x)
                for (int k = 0; k < per_node; ++k) {
                    cell.push_back({x, y, z});
                    p.places.push_back({x + 0.1 * noise(cell.size() / std::size_t(per_node)), double(y), double(z)});
                    if (k > 0) p.places.back() = *(p.places.end() - 2);
                }
    int const n = int(cell.size()) + 2;
    double const nowhere = std::numeric_limits<double>::quiet_NaN();
    p.places.resize(std::size_t(n), {nowhere, nowhere, nowhere});
    std::vector<Eigen::Triplet<double>> entries;
    for (int r = 0; r < n; ++r)
        for (int c = 0; c <= r; ++c) {
            bool near = r == c || (r >= n - 2 && c % 7 == r % 2);
            if (r < n - 2) {
                int away = 0;
                for (std::size_t a = 0; a < 3; ++a)
                    away += std::abs(cell[std::size_t(r)][a] - cell[std::size_t(c)][a]);
                near = near || away <= 1;
            }
            if (!near) continue;
            // Diagonally dominant, also the last rows.
            double const diagonal = (r >= n - 2 ? double(n) : 4.0 * per_node) * (quasi_definite && r % 4 == 3 ? -1 : 1);
            entries.emplace_back(r, c, r == c ? diagonal : noise(std::uint64_t(r) * 1000003 + std::uint64_t(c)));
        }
    p.lower.resize(n, n);
    p.lower.setFromTriplets(entries.begin(), entries.end());
    return p;
}

Eigen::MatrixXd dense(sparse const& lower) {
    Eigen::MatrixXd const all = lower;
    return all.selfadjointView<Eigen::Lower>();
}

} // namespace

TEST_CASE("the multifrontal factors solve what a dense matrix says", "[equilibrium][factor]") {
    for (auto const& [size, per_node] : std::vector<std::pair<std::array<int, 3>, int>>{
             {{1, 1, 1}, 1}, {{40, 1, 1}, 3}, {{12, 11, 1}, 3}, {{5, 5, 4}, 6}, {{30, 9, 1}, 1}})
        for (bool const quasi_definite : {false, true}) {
            INFO(size[0] << " x " << size[1] << " x " << size[2] << ", " << per_node << ", " << quasi_definite);
            auto const p = grid(size, per_node, quasi_definite);
            Eigen::MatrixXd const a = dense(p.lower);
            multifrontal_factor factor;
            factor.analyse(p.lower, p.places);
            // Other values in the same structure, too.
            for (double const scale : {1.0, -3.0}) {
                sparse const scaled = p.lower * scale;
                REQUIRE(factor.factorise(scaled));
                Eigen::VectorXd x(a.rows());
                for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = noise(std::uint64_t(k) + 77);
                Eigen::VectorXd const b = scale * a * x;
                REQUIRE((factor.solve(b) - x).lpNorm<Eigen::Infinity>() < 1e-12);
            }
        }
}

TEST_CASE("the factors of a chain are as few as elimination from its ends needs", "[equilibrium][factor]") {
    // Each unknown of a chain changes one other: 2 n - 1 numbers, and steps of up to 16 unknowns store zeros, too.
    auto p = grid({500, 1, 1}, 1, false);
    int const n = 500;
    sparse const chain = p.lower.topLeftCorner(n, n);
    p.places.resize(std::size_t(n));
    multifrontal_factor factor;
    factor.analyse(chain, p.places);
    REQUIRE(factor.factorise(chain));
    REQUIRE(factor.fill() >= std::size_t(2 * n - 1));
    REQUIRE(factor.fill() <= std::size_t(17 * n));
}

TEST_CASE("a matrix whose pivot is zero or no number has no factors", "[equilibrium][factor]") {
    auto p = grid({4, 4, 1}, 3, false);
    multifrontal_factor factor;
    factor.analyse(p.lower, p.places);
    for (double const bad : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
        sparse broken = p.lower;
        for (int k = 0; k < int(broken.nonZeros()); ++k) broken.valuePtr()[k] *= bad;
        REQUIRE(!factor.factorise(broken));
    }
    REQUIRE(factor.factorise(p.lower));
}

TEST_CASE("orders of elimination hold every node once, and nodes without a place last", "[equilibrium][factor]") {
    int const n = 60;
    lacuna::node_graph ring;
    std::vector<place> places;
    for (int k = 0; k < n; ++k) {
        auto const [low, high] = std::minmax({(k + n - 1) % n, (k + 1) % n});
        ring.neighbour.insert(ring.neighbour.end(), {low, high});
        ring.begin.push_back(int(ring.neighbour.size()));
        places.push_back({std::cos(0.1 * k), std::sin(0.1 * k), 0});
    }
    places[17][0] = std::numeric_limits<double>::quiet_NaN();
    REQUIRE(lacuna::nested_dissection(ring, places).order().back() == 17);
    for (auto order : {lacuna::minimum_degree_order(ring), lacuna::nested_dissection(ring, places).order()}) {
        std::sort(order.begin(), order.end());
        std::vector<int> all(std::size_t(n), 0);
        std::iota(all.begin(), all.end(), 0);
        REQUIRE(order == all);
    }
}
