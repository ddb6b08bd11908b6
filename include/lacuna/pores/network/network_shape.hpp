// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include <lacuna/core/state.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// Writes or reads the shape of a network, which steps do not change: its pores and throats, the particles around them,
/// and where sources act.
/// \throws std::runtime_error if the archive holds another number of sources.
template <class Archive, class Network>
void archive_shape(Archive& ar, Network& net) {
    ar(net.corner, net.size, net.throat_particle, net.throat_pore, net.length, net.interior_throats,
       net.drained_throats, net.drained_source);
    std::uint64_t sources = net.sources.size();
    ar(sources);
    require_state(sources == net.sources.size(), "its pores have other sources of fluid");
    for (auto& source : net.sources) ar(source.name, source.kind, source.pores, source.shares);
}

/// Whether two networks have the same shape; pore_network::size is not compared.
template <class Real, int Dim>
bool same_shape(pore_network<Real, Dim> const& a, pore_network<Real, Dim> const& b) {
    bool same = a.corner == b.corner && a.throat_particle == b.throat_particle && a.throat_pore == b.throat_pore &&
                a.length == b.length && a.interior_throats == b.interior_throats &&
                a.drained_throats == b.drained_throats && a.drained_source == b.drained_source &&
                a.sources.size() == b.sources.size();
    for (std::size_t s = 0; same && s < a.sources.size(); ++s) {
        auto const &p = a.sources[s], &q = b.sources[s];
        same = p.name == q.name && p.kind == q.kind && p.pores == q.pores && p.shares == q.shares;
    }
    return same;
}

} // namespace lacuna
