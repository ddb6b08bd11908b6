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
#include <lacuna/pores/flow/solved_flow.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// Exchange of fluid with the pores on which a flow_source acts directly, and the volume that each source has supplied.
/// These few pores are treated one after the other, in fixed order: results are the same bits for any number of
/// threads.
template <class Real>
class source_exchange {
public:
    struct fed_pore {
        std::size_t pore, source;
        double share;
        Real pressure, volume, vapour; ///< before the pass over the pores: Pa, m^3, m^3
    };

    /// \throws std::invalid_argument if two sources have the same name or hold the pressure of the same pore.
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

    /// Stores the state of the fed pores; call it before the pass over the pores.
    template <int Dim>
    void remember(pore_network<Real, Dim> const& net) noexcept {
        for (auto& f : pores_) {
            f.pressure = net.pressure[f.pore];
            f.volume = net.old_volume[f.pore];
            f.vapour = net.vapour_of(f.pore);
        }
    }

    /// Adds to the fed pores the volume that a rate supplies in dt [s], or that is needed to hold a pressure. Adds
    /// these volumes, and the inflow through drained throats, to the sources. Call it after the pass over the pores.
    /// \param pores, throats sums of the pass; corrected here
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
            // Volume that other sources fed into this pore did its work against the final pressure, known only now.
            throats.reservoir_work += after * (sum + fed) - before * sum;
            sum += fed;
            throats.inflow += fed;
            throats.gross += fed < Real(0) ? -fed : fed;
        }
        count(net, dt, flows);
    }

    /// Adds the volumes that the sources supplied to the fed pores in a solved step. Call it after take_pores().
    /// \param throats sums of the pass; corrected here
    template <int Dim>
    void take(pore_network<Real, Dim>& net, solved_flow const& next, throat_sums<Real>& throats) const noexcept {
        for (std::size_t k = 0; k < pores_.size(); ++k) {
            auto const& f = pores_[k];
            Real const fed = Real(next.fed[k]);
            net.sources[f.source].volume += next.fed[k];
            throats.reservoir_work += Real(next.middle_pressure(f.pore)) * fed;
            throats.inflow += fed;
            throats.gross += fed < Real(0) ? -fed : fed;
        }
    }

    /// Adds the inflow through drained throats in dt [s] to the sources. apply() calls it.
    template <int Dim>
    void count(pore_network<Real, Dim>& net, Real dt, bool flows) noexcept {
        if (!flows) return;
        for (std::size_t t = net.interior_throats; t < net.open_throats(); ++t)
            if (!net.inactive[t])
                net.sources[std::size_t(net.throat_source(t))].volume += double(net.flow[t]) * double(dt);
    }

    /// Updates the mean rates of the sources at the end of a step of dt [s] in which fluid flowed.
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
    std::vector<double> mark_; // volume of each source at the end of the last step with flow
};

} // namespace lacuna
