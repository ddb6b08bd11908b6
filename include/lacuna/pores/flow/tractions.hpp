// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <lacuna/core/pack.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh/geometry.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// Void and tractions of a pore at the given positions.
/// \param net not bare; \param points centres, m; \param radii m
template <class Real, int Dim>
auto measure_corners(pore_network<Real, Dim> const& net, std::size_t pore, points_view<Real, Dim> points,
                     Real const* radii) noexcept {
    std::array<vec<Real, Dim>, std::size_t(Dim) + 1> x;
    std::array<Real, std::size_t(Dim) + 1> r;
    for (std::size_t c = 0; c < x.size(); ++c) {
        auto const k = std::size_t(net.corner[c][pore]);
        x[c] = points[k];
        r[c] = radii[k];
    }
    return measure_simplex(x, r);
}

/// Forces on the corners of a pore per pressure of 1 Pa, N: the derivatives of its volume by the positions of the
/// corners, while the volume is above its least value. Displacements u of the corners change the pressure by
/// -K_f / V_p sum(force . u).
/// \param thickness m, 1 in space
template <class Real, int Dim>
std::array<vec<Real, Dim>, std::size_t(Dim) + 1> pore_tractions(pore_network<Real, Dim> const& net, Real thickness,
                                                                std::size_t pore, points_view<Real, Dim> points,
                                                                Real const* radii) noexcept {
    std::array<vec<Real, Dim>, std::size_t(Dim) + 1> force;
    auto const shape = measure_corners(net, pore, points, radii);
    for (std::size_t c = 0; c < force.size(); ++c) force[c] = shape.traction[c] * thickness;
    return force;
}

/// Energy stored in the compressed fluid, sum of V p^2 / 2 K_f, J.
/// \param net the pressure of its padding must be 0; \param bulk_modulus K_f, Pa
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
