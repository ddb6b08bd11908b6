// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lacuna/core/vec.hpp>

namespace lacuna {

/// What lies behind a throat on the boundary of the body: nothing that fluid passes, or a reservoir.
enum class boundary_kind : std::uint8_t { sealed, drained };

/// Side of the body's bounding box that a boundary throat is nearest to: left and right along the first axis, bottom
/// and top along the second, back and front along the third.
enum class body_side : std::uint8_t { left, right, bottom, top, back, front };

/// What a selection of boundaries answers for one throat. A reservoir takes and gives fluid; it does not press on
/// the body's outside (that is a load).
template <class Real>
struct throat_boundary {
    boundary_kind kind = boundary_kind::sealed;
    Real pressure = Real(0); ///< of the reservoir behind a drained throat, Pa
    /// Number of the flow_source: the reservoir behind a drained throat, or a rate that is fed into the pore at a
    /// sealed one. Without, drained throats belong to a source of their own, "drained".
    std::int32_t source = -1;
};

/// What a selection of boundaries is told about one throat.
template <class Real, int Dim>
struct boundary_throat {
    std::array<std::int32_t, std::size_t(Dim)> particles;
    vec<Real, Dim> middle;  ///< mean of the particles' centres, m
    vec<Real, Dim> outward; ///< unit normal, out of the body
    body_side side;
};

/// The default selection: fluid stays in the body.
struct all_sealed {
    template <class Real, int Dim>
    throat_boundary<Real> operator()(boundary_throat<Real, Dim> const&) const {
        return {};
    }
};

namespace detail {

/// The side of a bounding box that a throat is nearest to; at a corner, where several are equally near, the one that it
/// faces.
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
