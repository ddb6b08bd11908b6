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
#include <lacuna/core/particle_refusal.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/pores/network/boundary_throat.hpp>
#include <lacuna/pores/network/flow_source.hpp>
#include <lacuna/pores/mesh/mesh.hpp>
#include <lacuna/pores/network/padded_array.hpp>
#include <lacuna/pores/network/pore_throats.hpp>

namespace lacuna {

/// Position of a pore: in the interior, or at the boundary; drained if at least one of its throats is.
enum class pore_location : std::uint8_t { interior, sealed, drained };

/// A throat of a bare network: between two pores, or from one pore to a reservoir (second = -1).
template <class Real>
struct bare_throat {
    std::int32_t first, second;
    Real length, aperture;          ///< m, both > 0
    Real reservoir_pressure = Real(0); ///< Pa
    std::int32_t source = -1;          ///< as in throat_boundary
};

LACUNA_BEGIN_PACKS
/// Pores and throats of a packing, one array per quantity (structure of arrays).
///
/// A throat lies between two particles in the plane, three in space. throat_pore[0] is the pore to the left of the line
/// from its particle [0] to its particle [1]; in space the particles are counter-clockwise as seen from outside that
/// pore. throat_pore[1] is the pore on the other side, or -1 on the boundary of the mesh. Throats are in the order
/// interior, drained, sealed. In a bare network throat_particle is -1.
template <class Real, int Dim>
struct pore_network {
    std::array<padded_array<std::int32_t>, std::size_t(Dim) + 1> corner; ///< particles around a pore; empty when bare
    /// Reference for the least volume of a pore, m^Dim: the size of its simplex at build time. In space it is at least
    /// the regular tetrahedron whose edge is the smallest sphere's diameter. Empty when bare.
    padded_array<Real> size;
    padded_array<Real> volume;     ///< V_p, m^3
    padded_array<Real> old_volume; ///< V_p when the pressure was last advanced, m^3
    padded_array<Real> pressure;   ///< Pa
    /// Part of the volume without liquid in pores at the minimum pressure, m^3. Empty if the fluid has no minimum
    /// pressure; see vapour_of().
    padded_array<Real> vapour;
    std::vector<pore_location> location;

    std::array<padded_array<std::int32_t>, std::size_t(Dim)> throat_particle;
    std::array<padded_array<std::int32_t>, 2> throat_pore;
    padded_array<Real> length;      ///< l, m
    padded_array<Real> aperture;    ///< a, m
    padded_array<Real> conductance; ///< C = k a^3 / l, m^3/(s Pa)
    padded_array<Real> flow;        ///< q of the last step, from pore [1] (or the reservoir) to pore [0], m^3/s
    std::vector<std::uint8_t> inactive; ///< 1 for throats whose flow is skipped
    std::size_t interior_throats = 0;
    std::size_t drained_throats = 0;
    /// Reservoir pressure [Pa] and source number of each drained throat. Entry 0 belongs to throat interior_throats;
    /// see reservoir_pressure(), throat_source().
    std::vector<Real> drained_pressure;
    std::vector<std::int32_t> drained_source;
    std::vector<flow_source> sources;

    pore_throats<Real> throats_of; ///< the throats of each pore
    std::size_t particles = 0;     ///< number of all particles, also of those at no pore; 0 when bare

    std::size_t pores() const noexcept { return volume.size(); }
    std::size_t throats() const noexcept { return length.size(); }
    /// Number of throats that fluid can pass: interior and drained ones.
    std::size_t open_throats() const noexcept { return interior_throats + drained_throats; }
    bool drained(std::size_t throat) const noexcept { return throat >= interior_throats && throat < open_throats(); }
    bool bare() const noexcept { return corner[0].empty(); }
    /// Pressure of the reservoir behind a drained throat, Pa; 0 for other throats.
    Real reservoir_pressure(std::size_t throat) const noexcept {
        return drained(throat) ? drained_pressure[throat - interior_throats] : Real(0);
    }
    /// Index in `sources` of the reservoir behind a drained throat; -1 for other throats.
    std::int32_t throat_source(std::size_t throat) const noexcept {
        return drained(throat) ? drained_source[throat - interior_throats] : -1;
    }
    Real vapour_of(std::size_t pore) const noexcept { return vapour.empty() ? Real(0) : vapour[pore]; }
    boundary_kind kind(std::size_t throat) const noexcept {
        return throat < open_throats() ? boundary_kind::drained : boundary_kind::sealed;
    }
    /// State that a run changes. It is read into a network of the same shape.
    template <class Archive>
    void serialize(Archive& ar) {
        ar(volume, old_volume, pressure, vapour, aperture, conductance, flow, fixed_length{drained_pressure},
           fixed_length{inactive});
        for (auto& source : sources) ar(source.value, source.volume, source.rate);
    }
};
LACUNA_END_PACKS

namespace detail {

template <class Real, int Dim>
struct throat_record {
    std::array<std::int32_t, std::size_t(Dim)> particle;
    std::array<std::int32_t, 2> pore;
    Real length, aperture, reservoir_pressure;
    int rank; ///< 0 interior, 1 drained, 2 sealed
    std::int32_t source = -1;
    double width = 0; ///< of a throat on the boundary: distance of its particles, m; in space its area, m^2
};

/// Fills in the throats, sorted by rank and then in the order of `records`, and the arrays that every network has.
template <class Real, int Dim>
void finish(pore_network<Real, Dim>& net, std::vector<throat_record<Real, Dim>> const& records, std::size_t particles) {
    for (auto const& r : records) {
        net.interior_throats += r.rank == 0;
        net.drained_throats += r.rank == 1;
    }
    std::array<std::size_t, 3> next{0, net.interior_throats, net.open_throats()};
    std::size_t const pores = net.volume.size();
    net.old_volume = net.volume;
    net.pressure.assign(pores, Real(0));
    net.vapour.assign(pores, Real(0));
    net.location.assign(pores, pore_location::interior);
    for (auto& column : net.throat_particle) column.assign(records.size(), 0);
    for (auto& column : net.throat_pore) column.assign(records.size(), 0);
    net.length.assign(records.size(), Real(0));
    net.aperture.assign(records.size(), Real(0));
    for (auto const& r : records) {
        std::size_t const t = next[std::size_t(r.rank)]++;
        for (std::size_t side = 0; side < r.particle.size(); ++side) net.throat_particle[side][t] = r.particle[side];
        for (std::size_t side = 0; side < 2; ++side) net.throat_pore[side][t] = r.pore[side];
        net.length[t] = r.length;
        net.aperture[t] = r.aperture;
        auto& position = net.location[std::size_t(r.pore[0])];
        if (r.rank == 1) position = pore_location::drained;
        if (r.rank == 2 && position == pore_location::interior) position = pore_location::sealed;
        if (r.rank == 1) net.drained_pressure.push_back(r.reservoir_pressure);
    }
    net.drained_source = connect_sources(net.sources, records);
    net.conductance.assign(records.size(), Real(0));
    net.flow.assign(records.size(), Real(0));
    net.inactive.assign(records.size(), 0);
    net.throats_of.build(net.throat_pore, pores);
    net.particles = particles;
}

} // namespace detail

namespace detail {

/// Refuses a simplex of zero, negative or too large size, and names its corners. \throws particle_refusal, always
template <std::size_t Corners, class Real, int Dim>
[[noreturn]] void refuse_size(std::array<std::int32_t, Corners> const& corners, points_view<Real, Dim> points,
                              double size) {
    std::string who;
    for (auto const i : corners) {
        who.append(who.empty() ? "# at (" : ", # at (");
        for (int axis = 0; axis < Dim; ++axis)
            who.append(axis == 0 ? "" : ", ").append(to_text(double(points(std::size_t(i), axis))));
        who.append(")");
    }
    auto const rule = !std::isfinite(size) ? "finite: these numbers cannot hold the size"
                      : Dim == 2 ? "> 0: corners of a mesh are in counter-clockwise order, and not on a line"
                                 : "> 0: corners of a mesh are in counter-clockwise order, and not on a plane";
    throw particle_refusal("size of the pore between the particles " + who + " m", size, rule,
                           {corners.begin(), corners.end()});
}

} // namespace detail

/// Makes the pores and throats of a packing. In the plane each triangle is a pore, and each edge a throat of length
/// r_i + r_j. In space each tetrahedron is a pore, and each facet a throat; its length is the mean of r_i + r_j over
/// the three edges. Volumes and apertures stay 0: the flow solver fills them in.
///
/// \param mesh from triangulate_body()
/// \param points centres of all particles, m
/// \param radii one per particle, m, > 0 at every corner of the mesh
/// \param boundary callable boundary_throat -> throat_boundary, called once for every throat on the boundary. If it has
///        a member sources(), the network's `sources` are set to its result (see flow_boundaries()).
/// \throws std::invalid_argument for a corner that is no particle, a simplex of no, negative or infinite size, a radius
///         or a pressure out of range, or a source that acts on no throat.
template <class Real, int Dim, class Boundary = all_sealed>
pore_network<Real, Dim> make_pore_network(pore_mesh<Dim> const& mesh, points_view<Real, Dim> points, Real const* radii,
                                          Boundary const& boundary = {}) {
    pore_network<Real, Dim> net;
    net.volume.assign(mesh.size(), Real(0));
    net.size.assign(mesh.size(), Real(0));
    for (auto& column : net.corner) column.assign(mesh.size(), 0);
    vec<Real, Dim> low{}, high{};
    for (std::size_t t = 0; t < mesh.size(); ++t)
        for (std::size_t c = 0; c <= Dim; ++c) {
            auto const i = mesh.simplices[t][c];
            if (i < 0 || std::size_t(i) >= points.size())
                refuse((Dim == 2 ? "corner of triangle " : "corner of tetrahedron ") + std::to_string(t),
                       std::to_string(i), "the number of a particle");
            if (double const r = double(radii[i]); !(r > 0) || !std::isfinite(r))
                throw particle_refusal("radius of particle #", r, "> 0 and finite", {i});
            net.corner[c][t] = i;
            auto const x = points[std::size_t(i)];
            for (int axis = 0; axis < Dim; ++axis) {
                low[axis] = t + c == 0 ? x[axis] : min(low[axis], x[axis]);
                high[axis] = t + c == 0 ? x[axis] : max(high[axis], x[axis]);
            }
        }
    auto const has_throat = [&](std::size_t t, std::size_t c) {
        auto const other = mesh.neighbours[t][c];
        return other < 0 || std::size_t(other) > t;
    };
    std::size_t throats = 0;
    for (std::size_t t = 0; t < mesh.size(); ++t)
        for (std::size_t c = 0; c <= Dim; ++c) throats += has_throat(t, c);
    std::vector<detail::throat_record<Real, Dim>> records;
    records.reserve(throats);
    for (std::size_t t = 0; t < mesh.size(); ++t) {
        auto const& corners = mesh.simplices[t];
        net.size[t] = detail::reference_size(corners, points, radii);
        if (double const size = double(net.size[t]); !(size > 0 && std::isfinite(size)))
            detail::refuse_size(corners, points, size);
        for (std::size_t c = 0; c <= Dim; ++c) {
            if (!has_throat(t, c)) continue;
            auto const other = mesh.neighbours[t][c];
            auto const around = detail::side_of(corners, c);
            Real length(0);
            for (auto const i : around) length += radii[i];
            throat_boundary<Real> end;
            double width = 0;
            if (other < 0) {
                auto const side = detail::look_outwards(around, points);
                end = boundary(boundary_throat<Real, Dim>{
                    around, side.middle, side.normal, detail::nearest_side(side.middle, side.normal, low, high)});
                require_finite("reservoir pressure", double(end.pressure));
                width = double(side.size);
            }
            int const rank = other >= 0 ? 0 : end.kind == boundary_kind::drained ? 1 : 2;
            records.push_back({around, {std::int32_t(t), other}, length * Real(2.0 / Dim), Real(0), end.pressure, rank,
                               end.source, width});
        }
    }
    if constexpr (requires { boundary.sources(); }) net.sources = boundary.sources();
    detail::finish(net, records, points.size());
    return net;
}

/// Makes a bare network, without particles: rigid pores of the given volumes, throats of constant aperture.
/// \param volumes one per pore, m^3, > 0
/// \param throats see bare_throat
/// \param sources the reservoirs to which bare_throat::source refers
/// \throws std::invalid_argument for a value out of range, or a throat's end that is no pore.
template <class Real, int Dim = 2>
pore_network<Real, Dim> make_bare_network(std::vector<Real> const& volumes,
                                          std::vector<bare_throat<Real>> const& throats,
                                          std::vector<flow_source> sources = {}) {
    pore_network<Real, Dim> net;
    for (std::size_t p = 0; p < volumes.size(); ++p)
        require_positive("volume of pore " + std::to_string(p), double(volumes[p]));
    net.volume = padded_array<Real>(volumes);
    std::vector<detail::throat_record<Real, Dim>> records;
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
        std::array<std::int32_t, std::size_t(Dim)> no_particles;
        no_particles.fill(-1);
        records.push_back({no_particles, {one.first, one.second}, one.length, one.aperture, one.reservoir_pressure,
                           one.second < 0 ? 1 : 0, one.source, 1.0});
    }
    net.sources = std::move(sources);
    detail::finish(net, records, 0);
    return net;
}

/// Middle of a pore, m: the mean of its corners. Pictures draw its pressure there.
template <class Real, int Dim>
vec<Real, Dim> pore_middle(pore_network<Real, Dim> const& net, std::size_t pore, points_view<Real, Dim> points) {
    vec<Real, Dim> sum{};
    for (auto const& corner : net.corner) sum += points[std::size_t(corner[pore])];
    return sum / Real(Dim + 1);
}

} // namespace lacuna
