// SPDX-License-Identifier: BSD-3-Clause
#include "touching.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include <lacuna/core/points.hpp>
#include <lacuna/neighbors/kd_tree.hpp>
#include <lacuna/neighbors/own_reach.hpp>
#include <lacuna/particles/touching.hpp>

namespace lacuna_run {

namespace {

/// A packing has fewer bonds per particle.
constexpr std::size_t most_bonds = 100;

template <int Dim>
std::vector<pair> search(particle_list const& p, double gap) {
    std::vector<lacuna::vec<double, Dim>> at(p.size());
    std::vector<double> reach(p.size());
    for (std::size_t k = 0; k < p.size(); ++k) {
        for (int axis = 0; axis < Dim; ++axis) at[k][axis] = p.position[k][std::size_t(axis)];
        reach[k] = lacuna::touching_radius(at[k], p.radius[k]);
    }
    std::vector<lacuna::neighbor_pair> found;
    lacuna::kd_tree<double, Dim> tree;
    tree.set_most_pairs(most_bonds * (p.size() + 10));
    tree.touching_pairs(lacuna::view_points(at), reach, gap, found);
    std::vector<pair> pairs;
    for (auto const& one : found)
        if (!(at[std::size_t(one.i)] == at[std::size_t(one.j)])) pairs.push_back({one.i, one.j});
    return pairs;
}

} // namespace

std::vector<pair> touching_pairs(particle_list const& p, int dimension, value const& gap) {
    double const most = 10 * lacuna::median_radius(std::span<double const>(p.radius));
    if (gap.number() > most) gap.refuse("at most ten times the median radius, " + lacuna::to_text(most) + " m");
    try {
        return dimension == 2 ? search<2>(p, gap.number()) : search<3>(p, gap.number());
    } catch (std::length_error const&) {
        gap.refuse("a gap within which there are at most " + std::to_string(most_bonds) +
                   " times as many pairs as particles");
    }
}

std::vector<std::int32_t> row_on_side(particle_list const& p, side where, double margin) {
    bool const upright = where == side::top || where == side::bottom;
    double const sign = where == side::top || where == side::right ? 1 : -1;
    auto const along = [&](std::size_t k) { return p.position[k][upright ? 0 : 1]; };
    auto const out = [&](std::size_t k) { return sign * p.position[k][upright ? 1 : 0]; };
    // Sorted along the side, because a disc hides only centres within its own radius.
    std::vector<std::size_t> order(p.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return along(a) < along(b); });
    std::vector<char> hidden(p.size(), 0);
    for (std::size_t n = 0; n < order.size(); ++n) {
        std::size_t const j = order[n];
        // In a regular packing discs just touch the line of sight of the centres behind.
        double const wide = p.radius[j] * (1 + lacuna::touching_slack<double>);
        auto const hide = [&](std::size_t k) {
            if (std::fabs(along(k) - along(j)) > wide) return false;
            if (out(j) > out(k)) hidden[k] = 1;
            return true;
        };
        for (std::size_t m = n; m-- > 0 && hide(order[m]);) {}
        for (std::size_t m = n + 1; m < order.size() && hide(order[m]); ++m) {}
    }
    std::vector<std::int32_t> row;
    for (std::size_t const k : order)
        if (!hidden[k]) row.push_back(std::int32_t(k));
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
