// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/pores/flow/flow_ledger.hpp>
#include <lacuna/pores/flow/flow_sums.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// The few pores that a flow_source acts on directly, and what has come through each source. One after the other, in
/// the order of the sources: the same bits for any number of threads.
template <class Real>
class source_exchange {
public:
    struct fed_pore {
        std::size_t pore, source;
        double share;
        Real pressure, volume, vapour; ///< before the pass over the pores: Pa, m^3, m^3
    };

    /// \throws std::invalid_argument for a name given twice, a pore held twice.
    template <int Dim>
    void build(pore_network<Real, Dim> const& net) {
        pores_.clear();
        mark_.clear();
        for (std::size_t s = 0; s < net.sources.size(); ++s) {
            auto const& source = net.sources[s];
            for (std::size_t other = 0; other < s; ++other)
                if (net.sources[other].name == source.name) refuse("flow source", source.name, "a name given once");
            mark_.push_back(source.volume);
            for (std::size_t k = 0; k < source.pores.size(); ++k)
                pores_.push_back({std::size_t(source.pores[k]), s,
                                  source.kind == flow_source_kind::rate ? source.shares[k] : 0, 0, 0, 0});
        }
        auto const held = [&](fed_pore const& f) { return net.sources[f.source].kind == flow_source_kind::pressure; };
        std::sort(pores_.begin(), pores_.end(), [&](fed_pore const& a, fed_pore const& b) {
            return std::tuple(a.pore, held(a), a.source, a.share) < std::tuple(b.pore, held(b), b.source, b.share);
        });
        for (std::size_t k = 1; k < pores_.size(); ++k)
            if (pores_[k].pore == pores_[k - 1].pore && held(pores_[k - 1]))
                refuse("flow source", net.sources[pores_[k].source].name,
                       "the only one to hold the pressure of pore " + std::to_string(pores_[k].pore));
    }

    std::vector<fed_pore> const& pores() const noexcept { return pores_; }

    /// To be called before the pass over the pores.
    template <int Dim>
    void remember(pore_network<Real, Dim> const& net) noexcept {
        for (auto& f : pores_) {
            f.pressure = net.pressure[f.pore];
            f.volume = net.old_volume[f.pore];
            f.vapour = net.vapour_of(f.pore);
        }
    }

    /// After the pass over the pores: adds the volume that a rate brings within dt [s], and the one that it takes to
    /// hold a pressure; enters it, and what came through the drained throats, into the sources.
    /// \param pores, throats sums of the pass, which this corrects
    template <int Dim>
    void apply(pore_network<Real, Dim>& net, pore_constants<Real> const& fluid, Real dt, bool flows,
               pore_sums<Real>& pores, throat_sums<Real>& throats) noexcept {
        Real const half(0.5);
        std::size_t last = std::size_t(-1);
        Real sum(0);
        for (auto& f : pores_) {
            if (f.pore != last) sum = Real(0);
            last = f.pore;
            auto& source = net.sources[f.source];
            Real const volume = net.old_volume[f.pore], per_volume = fluid.bulk_modulus / volume;
            Real const pressure = net.pressure[f.pore], vapour = net.vapour_of(f.pore);
            Real fed, next, left(0);
            if (source.kind == flow_source_kind::rate) {
                fed = Real(source.value * f.share) * dt;
                next = pressure + per_volume * (fed - vapour);
                if (next < fluid.minimum_pressure) {
                    left = (fluid.minimum_pressure - next) / per_volume;
                    next = fluid.minimum_pressure;
                }
            } else {
                next = Real(source.value);
                fed = (next - pressure) / per_volume + vapour;
            }
            net.pressure[f.pore] = next;
            if (!net.vapour.empty()) net.vapour[f.pore] = left;
            source.volume += double(fed);
            Real const before = (f.pressure + pressure) * half, after = (f.pressure + next) * half;
            pores.content += fed;
            pores.pressure_work += (after - before) * (volume - f.volume);
            pores.vapour_work += after * (left - f.vapour) - before * (vapour - f.vapour);
            // What came before into the same pore did its work against the pressure that is now known.
            throats.reservoir_work += after * (sum + fed) - before * sum;
            sum += fed;
            throats.inflow += fed;
            throats.gross += fed < Real(0) ? -fed : fed;
        }
        count(net, dt, flows);
    }

    /// What has come through drained throats within dt [s]; apply() does it itself.
    template <int Dim>
    void count(pore_network<Real, Dim>& net, Real dt, bool flows) noexcept {
        if (!flows) return;
        for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t)
            if (!net.inactive[t]) net.sources[std::size_t(net.throat_source(t))].volume += double(net.flow[t]) * double(dt);
    }

    /// At the end of a step of dt [s] in which fluid flowed.
    template <int Dim>
    void close(pore_network<Real, Dim>& net, Real dt) noexcept {
        for (std::size_t s = 0; s < mark_.size(); ++s) {
            auto& source = net.sources[s];
            source.rate = (source.volume - mark_[s]) / double(dt);
            mark_[s] = source.volume;
        }
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(fixed_length{mark_});
    }

private:
    std::vector<fed_pore> pores_;
    std::vector<double> mark_; // volumes of the sources when the last step with flow ended
};

} // namespace lacuna
