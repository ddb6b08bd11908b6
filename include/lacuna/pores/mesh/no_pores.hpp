// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/mesh/scaled_particles.hpp>

namespace lacuna {

/// Says why particles have no pores: they are too few, lie on one line (in space: in one plane), or too far apart.
/// \param name callable: the number that the caller knows particle i by
/// \throws std::invalid_argument, always
template <class Real, int Dim, class Name>
[[noreturn]] void refuse_no_pores(points_view<Real, Dim> points, Real const* radii, Name const& name) {
    std::string const rule = "at least 1 where there is fluid: ";
    constexpr auto corners = std::size_t(Dim) + 1;
    if (points.size() < corners)
        refuse("number of pores", 0, rule + "a pore has " + std::to_string(corners) + " particles around it, and there are " +
                                         std::to_string(points.size()));
    auto const all = detail::scale_particles(points, radii);
    auto const text = [&](std::int32_t i) {
        std::string at = "particle " + std::to_string(name(std::size_t(i))) + " at (";
        for (int axis = 0; axis < Dim; ++axis)
            at.append(axis == 0 ? "" : ", ").append(to_text(double(points(std::size_t(i), axis))));
        return at + ") m";
    };
    std::string const ends = text(all.particle.front()) + " to " + text(all.particle.back());
    if (detail::lie_flat(all))
        refuse("number of pores", 0, rule + "all particles, from " + ends + ", lie " + (Dim == 2 ? "on one line" : "in one plane"));
    refuse("number of pores", 0, rule + "no " + (Dim == 2 ? "three" : "four") + " particles, from " + ends +
                                     ", are near enough to each other to enclose one");
}

} // namespace lacuna
