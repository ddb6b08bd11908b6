// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/flow_source.hpp>
#include <lacuna/pores/mesh.hpp>
#include <lacuna/pores/padded_array.hpp>

namespace lacuna {

/// What lies behind a throat on the boundary of the body: nothing that fluid passes, or a reservoir.
enum class boundary_kind : std::uint8_t { sealed, drained };

/// Where a pore lies: within the body, or at its boundary; drained when at least one of its throats is.
enum class pore_place : std::uint8_t { interior, sealed, drained };

/// Side of the body's bounding box that a boundary throat is nearest to.
enum class body_side : std::uint8_t { left, right, bottom, top };

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
    vec<Real, Dim> middle;  ///< between the two particles' centres, m
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

/// A throat given by hand: between two pores, or from one pore to a reservoir (second = -1).
template <class Real>
struct bare_throat {
    std::int32_t first, second;
    Real length, aperture;          ///< m, both > 0
    Real reservoir_pressure = Real(0); ///< Pa
    std::int32_t source = -1;          ///< as in throat_boundary
};

/// Rows of a sparse table: entries first[i] to first[i + 1] belong to i. An entry 2 * throat + side says that i is
/// at side 0 or 1 of the throat.
struct incidence {
    std::vector<std::int32_t> first{0};
    std::vector<std::int32_t> entry;
};

/// Pores and throats of a body, one array per quantity (structure of arrays).
///
/// A throat's pores are [0] to the left of the line from particle [0] to particle [1], and [1] to its right, -1
/// where the body ends. Throats come in the order interior, drained, sealed. In a bare network the particles are -1.
template <class Real, int Dim>
struct pore_network {
    std::array<std::vector<std::int32_t>, std::size_t(Dim) + 1> corner; ///< particles around a pore; empty when bare
    std::vector<Real> size;        ///< of a pore's simplex at build time, m^Dim; empty when bare
    padded_array<Real> volume;     ///< V_p, m^3
    padded_array<Real> old_volume; ///< V_p when the pressure was last advanced, m^3
    padded_array<Real> pressure;   ///< Pa
    padded_array<Real> vapour;     ///< part of the volume that is void of liquid, at the minimum pressure, m^3
    std::vector<pore_place> place;

    std::array<std::vector<std::int32_t>, 2> throat_particle;
    std::array<std::vector<std::int32_t>, 2> throat_pore;
    std::vector<Real> length;              ///< l, m
    padded_array<Real> aperture;           ///< a, m
    padded_array<Real> conductance;        ///< C = k a^3 / l, m^3/(s Pa)
    padded_array<Real> flow;               ///< q of the last step, from pore [1] (or the reservoir) to pore [0], m^3/s
    padded_array<Real> reservoir_pressure; ///< Pa; of drained throats
    std::vector<std::int32_t> throat_source; ///< number in `sources` of a drained throat, else -1
    std::vector<flow_source> sources;
    std::vector<std::uint8_t> idle;        ///< 1 where the flow is skipped
    std::size_t interior_throats = 0;
    std::size_t drained_throats = 0;

    incidence pore_throats;     ///< of each pore
    incidence particle_throats; ///< of each particle

    std::size_t pores() const noexcept { return volume.size(); }
    std::size_t throats() const noexcept { return length.size(); }
    /// Throats that fluid can pass: interior and drained.
    std::size_t open_throats() const noexcept { return interior_throats + drained_throats; }
    bool bare() const noexcept { return corner[0].empty(); }
    boundary_kind kind(std::size_t throat) const noexcept {
        return throat < open_throats() ? boundary_kind::drained : boundary_kind::sealed;
    }
    /// What a run changes; its shape is that of the receiver.
    template <class Archive>
    void serialize(Archive& ar) {
        ar(volume, old_volume, pressure, vapour, aperture, conductance, flow, reservoir_pressure, fixed_length{idle});
        for (auto& source : sources) ar(source.value, source.volume, source.rate);
    }
};

namespace detail {

template <class Real>
struct throat_record {
    std::array<std::int32_t, 2> particle, pore;
    Real length, aperture, reservoir_pressure;
    int rank; ///< 0 interior, 1 drained, 2 sealed
    std::int32_t source = -1;
    double width = 0; ///< of a throat on the boundary, m
};

inline incidence make_incidence(std::array<std::vector<std::int32_t>, 2> const& ends, std::size_t count) {
    incidence table;
    table.first.assign(count + 1, 0);
    auto const each = [&](auto&& use) {
        for (std::size_t t = 0; t < ends[0].size(); ++t)
            for (std::size_t side = 0; side < 2; ++side)
                if (ends[side][t] >= 0) use(std::size_t(ends[side][t]), std::int32_t(2 * t + side));
    };
    each([&](std::size_t i, std::int32_t) { ++table.first[i + 1]; });
    for (std::size_t i = 0; i < count; ++i) table.first[i + 1] += table.first[i];
    table.entry.resize(std::size_t(table.first.back()));
    auto next = table.first;
    each([&](std::size_t i, std::int32_t entry) { table.entry[std::size_t(next[i]++)] = entry; });
    return table;
}

/// Fills in the throats, and the arrays that every network has.
template <class Real, int Dim>
void finish(pore_network<Real, Dim>& net, std::vector<throat_record<Real>> records, std::size_t particles) {
    std::stable_sort(records.begin(), records.end(),
                     [](auto const& a, auto const& b) { return a.rank < b.rank; });
    std::size_t const pores = net.volume.size();
    net.old_volume = net.volume;
    net.pressure.assign(pores, Real(0));
    net.vapour.assign(pores, Real(0));
    net.place.assign(pores, pore_place::interior);
    for (auto const& r : records) {
        for (std::size_t side = 0; side < 2; ++side) {
            net.throat_particle[side].push_back(r.particle[side]);
            net.throat_pore[side].push_back(r.pore[side]);
        }
        net.length.push_back(r.length);
        auto& place = net.place[std::size_t(r.pore[0])];
        if (r.rank == 1) place = pore_place::drained;
        if (r.rank == 2 && place == pore_place::interior) place = pore_place::sealed;
        net.interior_throats += r.rank == 0;
        net.drained_throats += r.rank == 1;
    }
    net.aperture.assign(records.size(), Real(0));
    net.reservoir_pressure.assign(records.size(), Real(0));
    for (std::size_t t = 0; t < records.size(); ++t) {
        net.aperture[t] = records[t].aperture;
        net.reservoir_pressure[t] = records[t].reservoir_pressure;
    }
    net.throat_source = connect_sources(net.sources, records);
    net.conductance.assign(records.size(), Real(0));
    net.flow.assign(records.size(), Real(0));
    net.idle.assign(records.size(), 0);
    net.pore_throats = make_incidence(net.throat_pore, pores);
    net.particle_throats = make_incidence(net.throat_particle, particles);
}

} // namespace detail

/// The pores and throats of a body: each triangle a pore, each edge a throat of length r_i + r_j. Volumes and
/// apertures are left at 0 for the flow solver to fill in.
///
/// \param mesh from triangulate_body()
/// \param points centres of all particles, m; \param radii theirs, m, > 0 at every corner of the mesh
/// \param boundary callable boundary_throat -> throat_boundary, asked once for every throat on the boundary; what its
///        member sources() returns, if it has one, becomes the network's `sources` (see flow_boundaries())
/// \throws std::invalid_argument for a corner that is no particle, a radius or a pressure out of range, a source that
///         acts on no throat.
template <class Real, class Boundary = all_sealed>
pore_network<Real, 2> make_pore_network(pore_mesh<2> const& mesh, points_view<Real, 2> points, Real const* radii,
                                        Boundary const& boundary = {}) {
    pore_network<Real, 2> net;
    net.volume.assign(mesh.size(), Real(0));
    vec<Real, 2> low{}, high{};
    for (std::size_t t = 0; t < mesh.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            auto const i = mesh.simplices[t][c];
            if (i < 0 || std::size_t(i) >= points.size())
                refuse("corner of triangle " + std::to_string(t), std::to_string(i), "the number of a particle");
            require_positive("radius of particle " + std::to_string(i), double(radii[i]));
            net.corner[c].push_back(i);
            auto const x = points[std::size_t(i)];
            for (int axis = 0; axis < 2; ++axis) {
                low[axis] = t + c == 0 ? x[axis] : min(low[axis], x[axis]);
                high[axis] = t + c == 0 ? x[axis] : max(high[axis], x[axis]);
            }
        }
    std::vector<detail::throat_record<Real>> records;
    for (std::size_t t = 0; t < mesh.size(); ++t) {
        auto const& corners = mesh.simplices[t];
        net.size.push_back(triangle_area(points[std::size_t(corners[0])], points[std::size_t(corners[1])],
                                         points[std::size_t(corners[2])]));
        for (std::size_t c = 0; c < 3; ++c) {
            auto const other = mesh.neighbours[t][c];
            if (other >= 0 && std::size_t(other) < t) continue;
            auto const i = corners[(c + 1) % 3], j = corners[(c + 2) % 3];
            throat_boundary<Real> end;
            double width = 0;
            if (other < 0) {
                auto const along = points[std::size_t(j)] - points[std::size_t(i)];
                auto const outward = perpendicular(-along) / norm(along);
                auto const middle = (points[std::size_t(i)] + points[std::size_t(j)]) * Real(0.5);
                // At a corner of the body, where two sides are equally near, the one the throat faces.
                Real const near[4] = {middle[0] - low[0], high[0] - middle[0], middle[1] - low[1], high[1] - middle[1]};
                Real const faces[4] = {-outward[0], outward[0], -outward[1], outward[1]};
                int side = 0;
                for (int s = 1; s < 4; ++s)
                    if (near[s] < near[side] || (near[s] == near[side] && faces[s] > faces[side])) side = s;
                end = boundary(boundary_throat<Real, 2>{{i, j}, middle, outward, body_side(side)});
                require_finite("reservoir pressure", double(end.pressure));
                width = double(norm(along));
            }
            int const rank = other >= 0 ? 0 : end.kind == boundary_kind::drained ? 1 : 2;
            records.push_back({{i, j}, {std::int32_t(t), other}, radii[i] + radii[j], Real(0), end.pressure, rank,
                               end.source, width});
        }
    }
    if constexpr (requires { boundary.sources(); }) net.sources = boundary.sources();
    detail::finish(net, std::move(records), points.size());
    return net;
}

/// A network without particles: rigid pores of the given volumes, throats of constant aperture.
/// \param volumes m^3, > 0; \param sources that throats to reservoirs name
/// \throws std::invalid_argument for a value out of range, or a throat's end that is no pore.
template <class Real, int Dim = 2>
pore_network<Real, Dim> make_bare_network(std::vector<Real> const& volumes,
                                          std::vector<bare_throat<Real>> const& throats,
                                          std::vector<flow_source> sources = {}) {
    pore_network<Real, Dim> net;
    for (std::size_t p = 0; p < volumes.size(); ++p)
        require_positive("volume of pore " + std::to_string(p), double(volumes[p]));
    net.volume = padded_array<Real>(volumes);
    std::vector<detail::throat_record<Real>> records;
    for (std::size_t t = 0; t < throats.size(); ++t) {
        auto const& one = throats[t];
        std::string const name = "throat " + std::to_string(t);
        auto const count = std::int32_t(volumes.size());
        if (one.first < 0 || one.first >= count) refuse(name + ".first", one.first, "a pore");
        if (one.second < -1 || one.second >= count || one.second == one.first)
            refuse(name + ".second", one.second, "another pore, or -1 for a reservoir");
        require_positive(name + ".length", double(one.length));
        require_positive(name + ".aperture", double(one.aperture));
        require_finite(name + ".reservoir_pressure", double(one.reservoir_pressure));
        records.push_back({{-1, -1}, {one.first, one.second}, one.length, one.aperture, one.reservoir_pressure,
                           one.second < 0 ? 1 : 0, one.source, 1.0});
    }
    net.sources = std::move(sources);
    detail::finish(net, std::move(records), 0);
    return net;
}

/// Middle of a pore, the mean of its corners, m: where pictures put its pressure.
template <class Real, int Dim>
vec<Real, Dim> pore_middle(pore_network<Real, Dim> const& net, std::size_t pore, points_view<Real, Dim> points) {
    vec<Real, Dim> sum{};
    for (auto const& corner : net.corner) sum += points[std::size_t(corner[pore])];
    return sum / Real(Dim + 1);
}

} // namespace lacuna
