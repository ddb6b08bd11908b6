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

/// Pores that have become one (the paper's Fig. 5b): those joined by throats whose conductance exceeds a threshold.
/// They are a cluster with one pressure and the sum of the volumes, and flow within it needs no time step.
///
/// Each pore of a cluster is advanced by itself, as if the throats within the cluster were shut; then they all take the
/// mean of their pressures, weighted with their volumes, which is eq. 15 of the cluster as a whole. The same mean is
/// taken when pores join: no fluid is made or lost, and the energy that it costs is booked as dissipation. Pores that
/// part keep the pressure. Clusters are formed anew at the beginning of each step in which a conductance has crossed
/// the threshold since the last. Throats to reservoirs and pores that a flow_source acts on do not merge.
///
/// Not in parallel: the same bits for any number of threads. Allocates no memory after build().
template <class Real, int Dim = 2>
class pore_clusters {
public:
    /// \param threshold conductance above which a throat joins its pores, m^3/(s Pa); > 0, infinity for none
    void build(pore_network<Real, Dim> const& net, double threshold) {
        threshold_ = Real(threshold);
        if (!on()) return;
        std::size_t const pores = net.pores();
        joined_.assign(net.interior_throats, 0);
        label_.resize(pores);
        apart_.assign(pores, 0);
        clustered_.assign(pores, 0);
        for (auto const& source : net.sources)
            for (auto const p : source.pores) apart_[std::size_t(p)] = 1;
        members_.clear();
        members_.reserve(pores);
        first_.clear();
        first_.reserve(pores + 1);
        before_.resize(pores);
        form(net);
    }

    bool on() const noexcept { return threshold_ < std::numeric_limits<Real>::infinity(); }
    /// Clusters of at least two pores.
    std::size_t clusters() const noexcept { return first_.empty() ? 0 : first_.size() - 1; }
    /// Pores that are in a cluster, cluster by cluster.
    std::vector<std::int32_t> const& members() const noexcept { return members_; }
    /// The lowest-numbered pore of the cluster that a pore is in: itself if it is alone.
    std::size_t label(std::size_t pore) const noexcept { return on() ? std::size_t(label_[pore]) : pore; }

    /// Forms the clusters anew if a conductance has crossed the threshold.
    void update(pore_network<Real, Dim> const& net) noexcept {
        if (!on()) return;
        for (std::size_t t = 0; t < net.interior_throats; ++t)
            if (joins(net, t) != (joined_[t] != 0)) return form(net);
    }

    /// Mixes the fluid of pores that have joined since the last call.
    /// \return energy lost by that, J, >= 0 but for rounding
    Real settle(pore_network<Real, Dim>& net, pore_constants<Real> const& fluid) noexcept {
        if (!unsettled_) return Real(0);
        unsettled_ = false;
        Real lost(0);
        for (std::size_t c = 0; c < clusters(); ++c) {
            bool even = true;
            auto const lowest = std::size_t(members_[std::size_t(first_[c])]);
            for (auto k = first_[c]; k < first_[c + 1]; ++k) {
                auto const p = std::size_t(members_[std::size_t(k)]);
                even = even && net.pressure[p] == net.pressure[lowest] && net.vapour_of(p) == Real(0);
            }
            if (even) continue;
            lost += stored(net, fluid, c);
            mix(net, fluid, c, [](std::size_t, Real, Real) {});
            lost -= stored(net, fluid, c);
        }
        return lost;
    }

    /// To be called before the pass over the pores, when the ledger is kept.
    void remember(pore_network<Real, Dim> const& net) noexcept {
        for (std::size_t k = 0; k < members_.size(); ++k) {
            auto const p = std::size_t(members_[k]);
            before_[k] = {net.pressure[p], net.old_volume[p], net.vapour_of(p)};
        }
    }

    /// After the pass over the pores: one pressure in each cluster.
    /// \param sums of the pass, which this corrects if WithLedger
    template <bool WithLedger>
    void equalise(pore_network<Real, Dim>& net, pore_constants<Real> const& fluid, pore_sums<Real>& sums) noexcept {
        Real const half(0.5);
        for (std::size_t c = 0; c < clusters(); ++c)
            mix(net, fluid, c, [&](std::size_t k, Real pressure, Real vapour) {
                if constexpr (WithLedger) {
                    auto const p = std::size_t(members_[k]);
                    auto const& old = before_[k];
                    Real const volume = net.old_volume[p];
                    // As net holds the pore after the pass; pressure and vapour are those after mixing.
                    Real const passed = (old.pressure + net.pressure[p]) * half,
                               mixed = (old.pressure + pressure) * half;
                    sums.content +=
                        volume * (pressure - net.pressure[p]) / fluid.bulk_modulus - (vapour - net.vapour_of(p));
                    sums.pressure_work += (mixed - passed) * (volume - old.volume);
                    sums.vapour_work += mixed * (vapour - old.vapour) - passed * (net.vapour_of(p) - old.vapour);
                }
            });
    }

    /// flow_critical_time_step() of the clusters: flow within them needs none.
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
        return net.conductance[t] > threshold_ && !apart_[std::size_t(net.throat_pore[0][t])] &&
               !apart_[std::size_t(net.throat_pore[1][t])];
    }

    std::int32_t root(std::int32_t p) noexcept {
        while (label_[std::size_t(p)] != p) {
            auto& up = label_[std::size_t(p)];
            up = label_[std::size_t(up)];
            p = up;
        }
        return p;
    }

    /// Union-find over the throats, the lowest number as root; then the members of each cluster, in ascending order.
    void form(pore_network<Real, Dim> const& net) noexcept {
        unsettled_ = true;
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

    /// Gives the pores of cluster c one pressure; what liquid does not fill is spread evenly.
    /// \param look called with (place among the members, new pressure, new vapour) before the network has them
    template <class Look>
    void mix(pore_network<Real, Dim>& net, pore_constants<Real> const& fluid, std::size_t c, Look const& look) noexcept {
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
            look(std::size_t(k), pressure, left);
            net.pressure[p] = pressure;
            if (!net.vapour.empty()) net.vapour[p] = left;
        }
    }

    Real threshold_ = std::numeric_limits<Real>::infinity();
    std::vector<std::uint8_t> joined_;    // of interior throats: above the threshold
    std::vector<std::uint8_t> apart_;     // of pores: a source acts on it
    std::vector<std::uint8_t> clustered_; // of pores: not alone
    std::vector<std::int32_t> label_, members_, first_;
    std::vector<state> before_; // of members
    bool unsettled_ = false;
};

} // namespace lacuna
