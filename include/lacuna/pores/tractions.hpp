// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <lacuna/core/pack.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/geometry.hpp>
#include <lacuna/pores/pore_network.hpp>

namespace lacuna {

/// Forces on the three corners of a pore for 1 Pa in it, N: the derivatives of its volume, as long as that is above its
/// least value. Displacements u change its pressure by -K_f / V_p sum(force . u).
/// \param net with particles, not bare; \param thickness m; \param points m; \param radii m
template <class Real>
std::array<vec<Real, 2>, 3> pore_tractions(pore_network<Real, 2> const& net, Real thickness, std::size_t pore,
                                           points_view<Real, 2> points, Real const* radii) noexcept {
    auto const corner = [&](std::size_t c) { return std::size_t(net.corner[c][pore]); };
    std::size_t const a = corner(0), b = corner(1), c = corner(2);
    auto const shape = measure_pore<Real>(points[a], points[b], points[c], radii[a], radii[b], radii[c]);
    return {shape.traction[0] * thickness, shape.traction[1] * thickness, shape.traction[2] * thickness};
}

/// Energy stored in the compressed fluid, sum of V p^2 / 2 K_f, J.
/// \param net whose fillers have no pressure; \param bulk_modulus K_f, Pa
template <class Real, int Dim>
Real storage_energy(pore_network<Real, Dim> const& net, double bulk_modulus) noexcept {
    using lanes = pack<Real, native_width<Real>>;
    lanes total(Real(0));
    for (std::size_t p = 0; p < net.pores(); p += lanes::width) {
        lanes pressure = lanes::load(net.pressure.data() + p);
        total += lanes::load(net.volume.data() + p) * pressure * pressure;
    }
    return sum(total) / Real(2 * bulk_modulus);
}

} // namespace lacuna
