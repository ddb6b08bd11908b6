// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lacuna/core/vec.hpp>

namespace lacuna {

/// Kind of a throat on the boundary: closed to fluid, or open to a reservoir.
enum class boundary_kind : std::uint8_t { sealed, drained };

/// Side of the packing's bounding box that a boundary throat is nearest to: left and right along the first axis, bottom
/// and top along the second, back and front along the third.
enum class body_side : std::uint8_t { left, right, bottom, top, back, front };

/// Boundary condition of one throat. A reservoir exchanges fluid with the pore; it exerts no pressure on the outside of
/// the packing (that is a load).
template <class Real>
struct throat_boundary {
    boundary_kind kind = boundary_kind::sealed;
    Real pressure = Real(0); ///< of the reservoir behind a drained throat, Pa
    /// Number of the flow_source: the reservoir behind a drained throat, or the inflow into the pore at a sealed one.
    /// If it is -1, a drained throat belongs to a source named "drained", which is added.
    std::int32_t source = -1;
};

/// A throat on the boundary: the argument of the boundary callable of make_pore_network().
template <class Real, int Dim>
struct boundary_throat {
    std::array<std::int32_t, std::size_t(Dim)> particles;
    vec<Real, Dim> middle;  ///< mean of the particles' centres, m
    vec<Real, Dim> outward; ///< unit normal, out of the packing
    body_side side;
};

/// The default boundary: every throat is sealed.
struct all_sealed {
    template <class Real, int Dim>
    throat_boundary<Real> operator()(boundary_throat<Real, Dim> const&) const {
        return {};
    }
};

namespace detail {

/// The side of a bounding box that a throat is nearest to. At a corner, where several are equally near, it is the side
/// that the throat faces.
template <class Real, int Dim>
body_side nearest_side(vec<Real, Dim> const& middle, vec<Real, Dim> const& outward, vec<Real, Dim> const& low,
                       vec<Real, Dim> const& high) noexcept {
    int side = 0;
    auto const near = [&](int s) { return s % 2 == 0 ? middle[s / 2] - low[s / 2] : high[s / 2] - middle[s / 2]; };
    auto const faces = [&](int s) { return s % 2 == 0 ? -outward[s / 2] : outward[s / 2]; };
    for (int s = 1; s < 2 * Dim; ++s)
        if (near(s) < near(side) || (near(s) == near(side) && faces(s) > faces(side))) side = s;
    return body_side(side);
}

} // namespace detail

} // namespace lacuna
