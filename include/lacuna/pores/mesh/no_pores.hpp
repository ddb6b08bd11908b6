// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/particle_refusal.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh/scaled_particles.hpp>

namespace lacuna {

/// Refuses particles that have no pore between them, and says why: they are too few, lie on one line (in space: in one
/// plane), or are too far apart.
/// \throws particle_refusal, always
template <class Real, int Dim>
[[noreturn]] void refuse_no_pores(points_view<Real, Dim> points, Real const* radii) {
    constexpr auto corners = std::size_t(Dim) + 1;
    auto const refusal = [](std::string const& why, std::vector<std::int32_t> particles = {}) {
        return particle_refusal("number of pores", 0, "at least 1 where there is fluid: " + why, std::move(particles));
    };
    if (points.size() < corners)
        throw refusal("a pore has " + std::to_string(corners) + " particles around it, and there are " +
                      std::to_string(points.size()));
    auto const all = detail::scale_particles(points, radii);
    auto const text = [&](std::int32_t i) {
        std::string at = "particle # at (";
        for (int axis = 0; axis < Dim; ++axis)
            at.append(axis == 0 ? "" : ", ").append(to_text(double(points(std::size_t(i), axis))));
        return at + ") m";
    };
    std::int32_t const first = all.particle.front(), last = all.particle.back();
    std::string const ends = text(first) + " to " + text(last);
    if (detail::lie_flat(all))
        throw refusal("all particles, from " + ends + ", lie " + (Dim == 2 ? "on one line" : "in one plane"),
                      {first, last});
    throw refusal(std::string("no ") + (Dim == 2 ? "three" : "four") + " particles, from " + ends +
                      ", enclose a pore: they are too far from each other, or too near to a " +
                      (Dim == 2 ? "line" : "plane"),
                  {first, last});
}

} // namespace lacuna
