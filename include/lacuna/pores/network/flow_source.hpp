// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// Quantity that a flow_source prescribes: a pressure, or a volume per time.
enum class flow_source_kind : std::uint8_t { pressure, rate };

/// A named source of a pore network: a reservoir of given pressure, or an inflow of given rate (an outflow if
/// negative). It acts through the drained throats that refer to it, and on the pores listed here. The rules and
/// functions of pores/network/flow_boundaries.hpp make sources.
struct flow_source {
    std::string name{};
    flow_source_kind kind = flow_source_kind::pressure;
    double value = 0;                  ///< Pa, or m^3/s into the pores; flow solvers' set_source() changes it
    std::vector<std::int32_t> pores{}; ///< pores held at the pressure, or fed at the rate
    std::vector<double> shares{};      ///< share of the rate for each of `pores`; the shares sum to 1
    double volume = 0;                 ///< net volume that has entered through the source, m^3
    double rate = 0;                   ///< mean inflow over the last step in which fluid flowed, m^3/s
};

namespace detail {

/// Assigns sources to the throats on the boundary, and pores and shares to the sources.
/// \return the source of each drained throat
/// \throws std::invalid_argument for a source that does not exist, is of the wrong kind, or acts at no throat.
template <class Record>
std::vector<std::int32_t> connect_sources(std::vector<flow_source>& sources, std::vector<Record> const& records) {
    auto const named = std::int32_t(sources.size());
    std::vector<double> width(sources.size(), 0.0);
    std::vector<std::int32_t> of_throat;
    std::int32_t rest = -1;
    for (std::size_t t = 0; t < records.size(); ++t) {
        auto const& r = records[t];
        bool const drained = r.rank == 1;
        if (r.source < -1 || r.source >= named) refuse("source of a throat", double(r.source), "a flow source, or -1");
        if (drained && r.source < 0 && rest < 0) {
            rest = std::int32_t(sources.size());
            sources.push_back({"drained", flow_source_kind::pressure, double(r.reservoir_pressure)});
        }
        if (drained) of_throat.push_back(r.source < 0 ? rest : r.source);
        if (r.source < 0) continue;
        auto const s = std::size_t(r.source);
        if (r.rank == 0 || drained != (sources[s].kind == flow_source_kind::pressure))
            refuse("source of a throat", sources[s].name,
                   "a pressure behind a drained throat or a rate at a sealed one");
        if (!drained) {
            sources[s].pores.push_back(r.pore[0]);
            sources[s].shares.push_back(r.width);
        }
        width[s] += r.width;
    }
    for (std::size_t s = 0; s < width.size(); ++s) {
        if (!(width[s] > 0)) refuse("flow source", sources[s].name, "at some throat of the boundary");
        for (double& share : sources[s].shares) share /= width[s];
    }
    return of_throat;
}

} // namespace detail

} // namespace lacuna
