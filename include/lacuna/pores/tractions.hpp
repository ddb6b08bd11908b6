// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <lacuna/core/points.hpp>
#include <lacuna/pores/geometry.hpp>
#include <lacuna/pores/pore_network.hpp>

namespace lacuna {

/// Adds the forces of the pore pressures (eq. 16) on particles `begin` to `end` - 1: to force[i * stride + 0 and 1]
/// the components of the force on particle i, N. Each particle sums over its throats in a fixed order, so that ranges
/// give the same bits as all at once.
/// \param net with particles, not bare; \param thickness m; \param points m; \param radii m
template <class Real>
void add_tractions(pore_network<Real, 2> const& net, Real thickness, points_view<Real, 2> points, Real const* radii,
                   Real* force, std::size_t stride, std::size_t begin, std::size_t end) noexcept {
    auto const& table = net.particle_throats;
    for (std::size_t i = begin; i < end; ++i) {
        Real total[2] = {0, 0};
        for (auto e = table.first[i]; e < table.first[i + 1]; ++e) {
            auto const entry = std::size_t(table.entry[std::size_t(e)]);
            std::size_t const t = entry / 2, side = entry % 2;
            auto const j = std::size_t(net.throat_particle[1 - side][t]);
            // Two pores meet at a joint; each has one end of its chord there, the pore to the left of the line
            // from i to j the last, the one to the right the first. So a joint's two pores enter by their difference.
            Real across = net.pressure[std::size_t(net.throat_pore[0][t])];
            if (t < net.interior_throats) across -= net.pressure[std::size_t(net.throat_pore[1][t])];
            if (side == 1) across = -across;
            auto const arm = (points[j] - points[i]) * joint_share(points[i], points[j], radii[i], radii[j]);
            total[0] += across * arm[1];
            total[1] -= across * arm[0];
        }
        for (std::size_t c = 0; c < 2; ++c) force[i * stride + c] += total[c] * thickness;
    }
}

/// Forces on the three corners of a pore for 1 Pa in it, N: the derivatives of its volume. Displacements u change its
/// pressure by -K_f / V_p sum(force . u).
template <class Real>
std::array<vec<Real, 2>, 3> pore_tractions(pore_network<Real, 2> const& net, Real thickness, std::size_t pore,
                                           points_view<Real, 2> points, Real const* radii) noexcept {
    std::array<vec<Real, 2>, 3> result;
    for (std::size_t c = 0; c < 3; ++c) {
        auto const corner = [&](std::size_t turn) { return std::size_t(net.corner[(c + turn) % 3][pore]); };
        std::size_t const i = corner(0), j = corner(1), k = corner(2);
        result[c] = pore_traction(points[i], points[j], points[k], radii[i], radii[j], radii[k], thickness);
    }
    return result;
}

} // namespace lacuna
