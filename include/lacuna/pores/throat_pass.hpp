// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/fetch.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/laws/aperture.hpp>
#include <lacuna/pores/flow_sums.hpp>
#include <lacuna/pores/geometry.hpp>
#include <lacuna/pores/pack_access.hpp>
#include <lacuna/pores/pore_network.hpp>

/// \file
/// The passes of the flow step over the throats, pack by pack.

namespace lacuna {

/// What the passes read besides the network: where the particles' and the pairs' records begin, the pores, the
/// constants of the throats that fluid can pass. A pack is passed over when all of its throats are skipped; a
/// skipped throat in another pack has both its ends in one pore.
///
/// A throat in space is the facet between three particles. Its aperture is the mean of what the law says of its three
/// pairs; a law of the section (throat_section_law) sees the facet itself.
template <class Real, int Dim>
class throat_table {
public:
    static constexpr int width = native_width<Real>;
    /// Pairs of particles that a throat lies between.
    static constexpr std::size_t pairs = Dim == 2 ? 1 : 3;
    /// Packs that one thread handles at a time.
    static constexpr std::size_t chunk_packs = 128;

    /// \param conductivity k of eq. 14, m/(s Pa)
    void build(pore_network<Real, Dim> const& net, Real conductivity) {
        std::size_t const open = net.open_throats(), packs = (open + width - 1) / width, slots = packs * width;
        interior_ = net.interior_throats;
        for (auto& particle : particle_) particle.assign(slots, 0);
        for (auto& pore : pore_) pore.assign(slots, 0);
        factor_.assign(slots, Real(0));
        drained_.assign(slots - std::min(slots, first_drained_slot()), Real(0));
        for (auto& force : force_) force.assign(slots, 0);
        for (std::size_t t = 0; t < std::min(slots, net.throats()); ++t) {
            for (std::size_t side = 0; side < particle_.size(); ++side)
                particle_[side][t] = std::uint32_t(body_column<Real>::stride) * std::uint32_t(std::max(net.throat_particle[side][t], 0));
            pore_[0][t] = net.throat_pore[0][t];
            if (t >= open) continue;
            factor_[t] = conductivity / net.length[t];
        }
        every_.resize(packs);
        for (std::size_t p = 0; p < packs; ++p) every_[p] = std::int32_t(p);
        collect_active(net);
    }

    /// Takes over which throats are skipped.
    void collect_active(pore_network<Real, Dim> const& net) {
        active_.clear();
        throats_ = 0;
        for (std::size_t p = 0; p < every_.size(); ++p) {
            std::size_t const before = throats_;
            for (std::size_t t = p * width; t < (p + 1) * width; ++t) {
                // Between a pore and itself nothing flows.
                bool const passes = t < net.open_throats() && !net.idle[t];
                pore_[1][t] = passes && t < interior_ ? net.throat_pore[1][t] : pore_[0][t];
                if (t >= first_drained_slot()) drained_[t - first_drained_slot()] = Real(passes && t >= interior_);
                throats_ += passes;
            }
            if (throats_ > before) active_.push_back(std::int32_t(p));
        }
    }
    /// Throats that are not skipped.
    std::size_t active_throats() const noexcept { return throats_; }

    /// \param lookup lookup(particle i, particle j): place of the pair's normal force; 0 if there is none
    template <class Lookup>
    void map(pore_network<Real, Dim> const& net, Lookup const& lookup) {
        for (std::size_t t = 0; t < net.open_throats(); ++t)
            for (std::size_t k = 0; k < pairs; ++k)
                force_[k][t] = std::uint32_t(lookup(net.throat_particle[k][t], net.throat_particle[(k + 1) % std::size_t(Dim)][t]));
    }

    /// Packs of a pass: those with a throat that is not skipped, or all.
    std::vector<std::int32_t> const& packs(bool all) const noexcept { return all ? every_ : active_; }
    int chunks(bool all) const noexcept { return int((packs(all).size() + chunk_packs - 1) / chunk_packs); }

    /// Eq. 14 for the throats of one chunk.
    /// \tparam Moves first takes the apertures anew from the gaps and the pairs' normal forces
    /// \tparam Flows computes the flows from the network's pressures; else apertures and conductances alone, of all
    ///         throats
    /// \param place records of the particles; \param normal_forces of the pairs, the first is 0; used if Moves
    template <bool Moves, bool Flows, class Aperture>
    [[gnu::noinline, gnu::flatten]] void pass(int chunk, pore_network<Real, Dim>& net, Real const* place,
                                              Real const* normal_forces,
                                              typename Aperture::parameters const& aperture_parameters) const noexcept {
        using lanes = pack<Real, width>;
        auto const parameters = aperture_parameters;
        auto const& list = packs(!Flows);
        Real const* pressure = net.pressure.data();
        std::size_t const ahead = net.particles < few_particles ? 0 : 24;
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, list.size());
        for (std::size_t n = first; n < end; ++n) {
            std::size_t const slot = std::size_t(list[n]) * width;
            lanes conductance;
            if constexpr (Moves) {
                // The other particles are those of throats before, most of them.
                if (ahead > 0 && n + ahead < list.size())
                    fetch_records<width>(place, particle_[1].data() + std::size_t(list[n + ahead]) * width);
                auto [aperture, opening] = open<Aperture>(slot, place, normal_forces, parameters);
                conductance = lanes::load(factor_.data() + slot) * opening;
                aperture.store(net.aperture.data() + slot);
                conductance.store(net.conductance.data() + slot);
            } else {
                conductance = lanes::load(net.conductance.data() + slot);
            }
            if constexpr (Flows) {
                lanes near = detail::gather<Real, width>(pressure, pore_[0].data() + slot);
                lanes far = detail::gather<Real, width>(pressure, pore_[1].data() + slot);
                if (slot + width > interior_)
                    far = select(drained(slot), lanes::load(net.reservoir_pressure.data() + slot), far);
                lanes q = conductance * (far - near);
                q.store(net.flow.data() + slot);
            }
        }
    }

    /// Energies of the flows of one chunk in the step just made, with the mean of old and new pressures.
    /// \param before pressures before the step
    [[gnu::noinline, gnu::flatten]] void add_up(int chunk, pore_network<Real, Dim> const& net, Real const* before,
                                                Real time_step, throat_sums<Real>& sums) const noexcept {
        using lanes = pack<Real, width>;
        lanes dissipation(Real(0)), work(Real(0)), inflow(Real(0)), gross(Real(0));
        lanes dt(time_step), zero(Real(0)), half(Real(0.5));
        Real const* after = net.pressure.data();
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, active_.size());
        for (std::size_t n = first; n < end; ++n) {
            std::size_t const slot = std::size_t(active_[n]) * width;
            std::int32_t const *one = pore_[0].data() + slot, *other = pore_[1].data() + slot;
            lanes moved = lanes::load(net.flow.data() + slot) * dt;
            lanes near = (detail::gather<Real, width>(before, one) + detail::gather<Real, width>(after, one)) * half;
            lanes far = (detail::gather<Real, width>(before, other) + detail::gather<Real, width>(after, other)) * half;
            if (slot + width > interior_) {
                far = select(drained(slot), lanes::load(net.reservoir_pressure.data() + slot), far);
                lanes in = select(drained(slot), moved, zero);
                inflow += in;
                work += in * far;
            }
            dissipation += moved * (far - near);
            gross += abs(moved);
        }
        sums = {sum(dissipation), sum(work), sum(inflow), sum(gross)};
    }

private:
    /// Of the throats of a pack: their apertures, m, and what their conductances are k / l times of.
    struct opened {
        pack<Real, width> aperture, opening;
    };
    template <class Aperture>
    [[gnu::always_inline]] opened open(std::size_t slot, Real const* place, Real const* normal_forces,
                                       typename Aperture::parameters const& parameters) const noexcept {
        using lanes = pack<Real, width>;
        if constexpr (throat_section_law<Aperture>) {
            static_assert(Dim == 3, "flow: a throat has a section in space alone (Dim = 3)");
            auto a = load_turned<Real, width>(place, particle_[0].data() + slot);
            auto b = load_turned<Real, width>(place, particle_[1].data() + slot);
            auto c = load_turned<Real, width>(place, particle_[2].data() + slot);
            auto facet = measure_facet<lanes>({{a[0], a[1], a[2]}}, {{b[0], b[1], b[2]}}, {{c[0], c[1], c[2]}}, a[3],
                                              b[3], c[3]);
            lanes radius = max(facet.hydraulic_radius, lanes(Real(0)));
            return {radius, Aperture::opening(parameters, facet.void_area, radius)};
        } else {
            lanes aperture = aperture_of_pair<Aperture>(0, slot, place, normal_forces, parameters);
            if constexpr (pairs > 1) {
                for (std::size_t k = 1; k < pairs; ++k)
                    aperture += aperture_of_pair<Aperture>(k, slot, place, normal_forces, parameters);
                aperture *= lanes(Real(1) / Real(pairs));
            }
            return {aperture, aperture * aperture * aperture};
        }
    }
    /// By the aperture law, from the gap and the normal force of the throat's pair number k.
    template <class Aperture>
    [[gnu::always_inline]] pack<Real, width> aperture_of_pair(std::size_t k, std::size_t slot, Real const* place,
                                                              Real const* normal_forces,
                                                              typename Aperture::parameters const& p) const noexcept {
        using lanes = pack<Real, width>;
        using rec = record<Real>;
        rec difference_and_sum(Real(-1));
        difference_and_sum.v[3] = 1;
        std::uint32_t const *i = particle_[k].data() + slot, *j = particle_[(k + 1) % std::size_t(Dim)].data() + slot;
        auto pair = turn_records<Real, width>(
            [&](int lane) { return rec::load(place + j[lane]) + rec::load(place + i[lane]) * difference_and_sum; });
        lanes squared = pair[0] * pair[0] + pair[1] * pair[1];
        if constexpr (Dim == 3) squared += pair[2] * pair[2];
        lanes gap = sqrt(squared) - pair[3];
        lanes normal = detail::gather<Real, width>(normal_forces, force_[k].data() + slot);
        return Aperture::aperture(p, normal, gap);
    }

    /// Where the first pack with a throat to a reservoir begins.
    std::size_t first_drained_slot() const noexcept { return interior_ / width * width; }
    auto drained(std::size_t slot) const noexcept {
        using lanes = pack<Real, width>;
        return lanes::load(drained_.data() + (slot - first_drained_slot())) > lanes(Real(0));
    }

    std::size_t interior_ = 0, throats_ = 0;
    std::array<aligned_vector<std::uint32_t>, std::size_t(Dim)> particle_;
    std::array<aligned_vector<std::int32_t>, 2> pore_;
    std::array<aligned_vector<std::uint32_t>, pairs> force_; // places of normal forces
    aligned_vector<Real> factor_;  // k / l
    aligned_vector<Real> drained_; // 1 or 0: to a reservoir and not skipped; from first_drained_slot() on
    std::vector<std::int32_t> every_, active_;
};

} // namespace lacuna
