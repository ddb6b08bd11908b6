// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <lacuna/pores/flow/flow_sums.hpp>
#include <lacuna/pores/network/pore_network.hpp>

namespace lacuna {

/// Clusters of pores that have merged (the paper's Fig. 5b): pores joined by throats whose conductance exceeds a
/// threshold. A cluster has one pressure and the sum of the volumes. Flow within a cluster does not limit the time
/// step.
///
/// Each pore of a cluster is advanced by itself. Then all its pores get the mean of their pressures, weighted with the
/// volumes. That is eq. 15 for the whole cluster, since flow between its pores cancels in the mean. Pores that join get
/// the same mean: it conserves the fluid, and the energy lost is booked as dissipation. Pores that separate keep their
/// pressure. Clusters are formed again at the beginning of a step if a conductance has crossed the threshold since the
/// last step. Throats to reservoirs do not merge pores, nor do pores merge on which a flow_source acts.
///
/// Runs on one thread, so results are the same bits for any number of threads. Allocates no memory after build().
template <class Real, int Dim = 2>
class pore_clusters {
public:
    /// \param threshold conductance above which a throat merges its pores, m^3/(s Pa); > 0, infinity for none
    void build(pore_network<Real, Dim> const& net, double threshold) {
        threshold_ = Real(threshold);
        if (!on()) return;
        std::size_t const pores = net.pores();
        joined_.assign(net.interior_throats, 0);
        label_.resize(pores);
        excluded_.assign(pores, 0);
        clustered_.assign(pores, 0);
        for (auto const& source : net.sources)
            for (auto const p : source.pores) excluded_[std::size_t(p)] = 1;
        members_.clear();
        members_.reserve(pores);
        first_.clear();
        first_.reserve(pores + 1);
        before_.resize(pores);
        form(net);
    }

    /// Whether pores can merge: the threshold is finite.
    bool on() const noexcept { return threshold_ < std::numeric_limits<Real>::infinity(); }
    /// Number of clusters; each has at least two pores.
    std::size_t clusters() const noexcept { return first_.empty() ? 0 : first_.size() - 1; }
    /// Pores that are in a cluster, cluster by cluster.
    std::vector<std::int32_t> const& members() const noexcept { return members_; }
    /// Lowest number of a pore in the cluster of `pore`; `pore` itself if it is in no cluster.
    std::size_t label(std::size_t pore) const noexcept { return on() ? std::size_t(label_[pore]) : pore; }

    /// Forms the clusters again if a conductance has crossed the threshold.
    void update(pore_network<Real, Dim> const& net) noexcept {
        if (!on()) return;
        for (std::size_t t = 0; t < net.interior_throats; ++t)
            if (joins(net, t) != (joined_[t] != 0)) return form(net);
    }

    /// Mixes the fluid of pores that have joined since the last call.
    /// \return energy lost by mixing, J; >= 0 up to rounding
    Real settle(pore_network<Real, Dim>& net, pore_constants<Real> const& fluid) noexcept {
        if (!unmixed_) return Real(0);
        unmixed_ = false;
        Real lost(0);
        for (std::size_t c = 0; c < clusters(); ++c) {
            bool uniform = true;
            auto const lowest = std::size_t(members_[std::size_t(first_[c])]);
            for (auto k = first_[c]; k < first_[c + 1]; ++k) {
                auto const p = std::size_t(members_[std::size_t(k)]);
                uniform = uniform && net.pressure[p] == net.pressure[lowest] && net.vapour_of(p) == Real(0);
            }
            if (uniform) continue;
            lost += stored(net, fluid, c);
            mix(net, fluid, c, [](std::size_t, Real, Real) {});
            lost -= stored(net, fluid, c);
        }
        return lost;
    }

    /// Stores pressures, volumes and vapour for the ledger; call it before the pass over the pores.
    void remember(pore_network<Real, Dim> const& net) noexcept {
        for (std::size_t k = 0; k < members_.size(); ++k) {
            auto const p = std::size_t(members_[k]);
            before_[k] = {net.pressure[p], net.old_volume[p], net.vapour_of(p)};
        }
    }

    /// Gives each cluster one pressure; call it after the pass over the pores.
    /// \tparam WithLedger whether to correct `sums`, the sums of that pass
    template <bool WithLedger>
    void equalise(pore_network<Real, Dim>& net, pore_constants<Real> const& fluid, pore_sums<Real>& sums) noexcept {
        Real const half(0.5);
        for (std::size_t c = 0; c < clusters(); ++c)
            mix(net, fluid, c, [&](std::size_t k, Real pressure, Real vapour) {
                if constexpr (WithLedger) {
                    auto const p = std::size_t(members_[k]);
                    auto const& old = before_[k];
                    Real const volume = net.old_volume[p];
                    // net still holds the state before mixing; `pressure` and `vapour` are the state after it.
                    Real const passed = (old.pressure + net.pressure[p]) * half,
                               mixed = (old.pressure + pressure) * half;
                    sums.content +=
                        volume * (pressure - net.pressure[p]) / fluid.bulk_modulus - (vapour - net.vapour_of(p));
                    sums.pressure_work += (mixed - passed) * (volume - old.volume);
                    sums.vapour_work += mixed * (vapour - old.vapour) - passed * (net.vapour_of(p) - old.vapour);
                }
            });
    }

    /// As flow_critical_time_step(), with each cluster as one pore: throats within clusters set no limit. s
    Real critical_time_step(pore_network<Real, Dim> const& net, double bulk_modulus) const noexcept {
        double limit = std::numeric_limits<double>::infinity();
        auto const outflow = [&](std::size_t p) {
            double sum = 0;
            net.throats_of.for_each(p, [&](std::size_t t, int side) {
                auto const other = net.throat_pore[std::size_t(1 - side)][t];
                if (!net.inactive[t] && (other < 0 || label_[std::size_t(other)] != label_[p]))
                    sum += double(net.conductance[t]);
            });
            return sum;
        };
        auto const look = [&](double volume, double conductance) {
            if (conductance > 0) limit = std::min(limit, volume / (bulk_modulus * conductance));
        };
        for (std::size_t p = 0; p < net.pores(); ++p)
            if (!clustered_[p]) look(double(net.volume[p]), outflow(p));
        for (std::size_t c = 0; c < clusters(); ++c) {
            double volume = 0, conductance = 0;
            for (auto k = first_[c]; k < first_[c + 1]; ++k) {
                auto const p = std::size_t(members_[std::size_t(k)]);
                volume += double(net.volume[p]);
                conductance += outflow(p);
            }
            look(volume, conductance);
        }
        return Real(limit);
    }

private:
    struct state {
        Real pressure, volume, vapour;
    };

    bool joins(pore_network<Real, Dim> const& net, std::size_t t) const noexcept {
        return net.conductance[t] > threshold_ && !excluded_[std::size_t(net.throat_pore[0][t])] &&
               !excluded_[std::size_t(net.throat_pore[1][t])];
    }

    std::int32_t root(std::int32_t p) noexcept {
        while (label_[std::size_t(p)] != p) {
            auto& up = label_[std::size_t(p)];
            up = label_[std::size_t(up)];
            p = up;
        }
        return p;
    }

    /// Union-find over the throats, with the lowest number as root, then sorts the members by cluster and number.
    void form(pore_network<Real, Dim> const& net) noexcept {
        unmixed_ = true;
        std::size_t const pores = net.pores();
        for (std::size_t p = 0; p < pores; ++p) label_[p] = std::int32_t(p);
        for (std::size_t t = 0; t < net.interior_throats; ++t) {
            joined_[t] = joins(net, t);
            if (!joined_[t]) continue;
            auto const a = root(net.throat_pore[0][t]), b = root(net.throat_pore[1][t]);
            label_[std::size_t(std::max(a, b))] = std::min(a, b);
        }
        std::fill(clustered_.begin(), clustered_.end(), 0);
        for (std::size_t p = 0; p < pores; ++p) {
            label_[p] = root(std::int32_t(p));
            if (label_[p] != std::int32_t(p)) clustered_[p] = clustered_[std::size_t(label_[p])] = 1;
        }
        members_.clear();
        first_.clear();
        for (std::size_t p = 0; p < pores; ++p)
            if (clustered_[p]) members_.push_back(std::int32_t(p));
        std::sort(members_.begin(), members_.end(), [&](std::int32_t a, std::int32_t b) {
            auto const of_a = label_[std::size_t(a)], of_b = label_[std::size_t(b)];
            return of_a != of_b ? of_a < of_b : a < b;
        });
        for (std::size_t k = 0; k < members_.size(); ++k)
            if (members_[k] == label_[std::size_t(members_[k])]) first_.push_back(std::int32_t(k));
        first_.push_back(std::int32_t(members_.size()));
    }

    /// Energy stored in a cluster, J.
    Real stored(pore_network<Real, Dim> const& net, pore_constants<Real> const& fluid, std::size_t c) const noexcept {
        Real sum(0);
        for (auto k = first_[c]; k < first_[c + 1]; ++k) {
            auto const p = std::size_t(members_[std::size_t(k)]);
            sum += net.old_volume[p] * net.pressure[p] * net.pressure[p];
        }
        return sum / (Real(2) * fluid.bulk_modulus);
    }

    /// Gives the pores of cluster c one pressure, and distributes the vapour in proportion to the volumes.
    /// \param visit called with (index in members_, new pressure, new vapour) before the network is changed
    template <class Visit>
    void mix(pore_network<Real, Dim>& net, pore_constants<Real> const& fluid, std::size_t c,
             Visit const& visit) noexcept {
        Real volume(0), content(0), vapour(0);
        for (auto k = first_[c]; k < first_[c + 1]; ++k) {
            auto const p = std::size_t(members_[std::size_t(k)]);
            volume += net.old_volume[p];
            content += net.old_volume[p] * net.pressure[p];
            vapour += net.vapour_of(p);
        }
        Real const wanted = (content - fluid.bulk_modulus * vapour) / volume;
        bool const torn = wanted < fluid.minimum_pressure;
        Real const pressure = torn ? fluid.minimum_pressure : wanted;
        Real const share = torn ? (pressure - wanted) / fluid.bulk_modulus : Real(0);
        for (auto k = first_[c]; k < first_[c + 1]; ++k) {
            auto const p = std::size_t(members_[std::size_t(k)]);
            Real const left = share * net.old_volume[p];
            visit(std::size_t(k), pressure, left);
            net.pressure[p] = pressure;
            if (!net.vapour.empty()) net.vapour[p] = left;
        }
    }

    Real threshold_ = std::numeric_limits<Real>::infinity();
    std::vector<std::uint8_t> joined_;    // per interior throat: whether it merges its pores
    std::vector<std::uint8_t> excluded_;  // per pore: whether a source acts on it
    std::vector<std::uint8_t> clustered_; // per pore: whether it is in a cluster
    std::vector<std::int32_t> label_;     // per pore: see label()
    std::vector<std::int32_t> members_;
    std::vector<std::int32_t> first_; // per cluster: index in members_ of its first pore
    std::vector<state> before_;       // per member: state before the pass over the pores
    bool unmixed_ = false;
};

} // namespace lacuna
