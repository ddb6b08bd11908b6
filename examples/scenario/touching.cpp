// SPDX-License-Identifier: BSD-3-Clause
#include "touching.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <lacuna/core/points.hpp>
#include <lacuna/neighbors/kd_tree.hpp>

namespace lacuna_run {

namespace {

template <int Dim>
std::vector<pair> search(particles const& p, double gap) {
    std::vector<lacuna::vec<double, Dim>> at(p.size());
    for (std::size_t k = 0; k < p.size(); ++k)
        for (int axis = 0; axis < Dim; ++axis) at[k][axis] = p.position[k][std::size_t(axis)];
    std::vector<lacuna::neighbor_pair> found;
    lacuna::kd_tree<double, Dim>().touching_pairs(lacuna::view_points(at), p.radius, gap, found);
    std::vector<pair> pairs;
    for (auto const& one : found)
        if (!(at[std::size_t(one.i)] == at[std::size_t(one.j)])) pairs.push_back({one.i, one.j});
    return pairs;
}

} // namespace

std::vector<pair> touching_pairs(particles const& p, int dimension, double gap) {
    return dimension == 2 ? search<2>(p, gap) : search<3>(p, gap);
}

std::vector<std::int32_t> row_on_side(particles const& p, side where, double margin) {
    bool const upright = where == side::top || where == side::bottom;
    double const sign = where == side::top || where == side::right ? 1 : -1;
    auto const along = [&](std::size_t k) { return p.position[k][upright ? 0 : 1]; };
    auto const out = [&](std::size_t k) { return sign * p.position[k][upright ? 1 : 0]; };
    // In order along the side; a disc in front can only be within the largest radius.
    std::vector<std::size_t> order(p.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return along(a) < along(b); });
    double const largest = *std::max_element(p.radius.begin(), p.radius.end());
    double const slack = 1 + 1e-9; // discs of a regular row just touch the line of sight of those behind
    std::vector<std::int32_t> row;
    for (std::size_t n = 0; n < order.size(); ++n) {
        std::size_t const k = order[n];
        bool hidden = false;
        auto const covers = [&](std::size_t j) {
            return out(j) > out(k) && std::fabs(along(j) - along(k)) <= p.radius[j] * slack;
        };
        for (std::size_t m = n; m-- > 0 && !hidden && along(k) - along(order[m]) <= largest * slack;) hidden = covers(order[m]);
        for (std::size_t m = n + 1; m < order.size() && !hidden && along(order[m]) - along(k) <= largest * slack; ++m)
            hidden = covers(order[m]);
        if (!hidden) row.push_back(std::int32_t(k));
    }
    double low = 0, high = 0;
    for (std::size_t n = 0; n < row.size(); ++n) {
        double const x = along(std::size_t(row[n]));
        low = n == 0 ? x : std::min(low, x);
        high = n == 0 ? x : std::max(high, x);
    }
    std::erase_if(row, [&](std::int32_t k) {
        double const x = along(std::size_t(k));
        return x - low < margin || high - x < margin;
    });
    std::sort(row.begin(), row.end());
    return row;
}

} // namespace lacuna_run
