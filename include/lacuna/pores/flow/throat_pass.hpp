// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/prefetch.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/laws/aperture.hpp>
#include <lacuna/pores/flow/flow_sums.hpp>
#include <lacuna/pores/mesh/geometry.hpp>
#include <lacuna/pores/flow/pack_access.hpp>
#include <lacuna/pores/network/pore_network.hpp>

/// \file
/// The passes of the flow step over the throats, pack by pack.

namespace lacuna {

LACUNA_BEGIN_PACKS
/// The passes over the interior and drained throats, and the tables that they read besides the network. A pack is
/// omitted if all its throats are skipped. In other packs a skipped throat has both ends at the same pore, so that
/// nothing flows.
///
/// A throat in space is the facet between three particles. Its aperture is the mean of the law's apertures of its three
/// pairs. A law of the section (throat_section_law) gets the facet itself.
template <class Real, int Dim>
class throat_table {
public:
    static constexpr int width = native_width<Real>;
    /// Number of pairs of particles that a throat lies between.
    static constexpr std::size_t pairs = Dim == 2 ? 1 : 3;
    /// Packs that one thread handles at a time.
    static constexpr std::size_t chunk_packs = 128;

    /// \param conductivity k of the paper's eq. 14, m/(s Pa); see flow_parameters::conductivity
    void build(pore_network<Real, Dim> const& net, Real conductivity) {
        std::size_t const packs = (net.open_throats() + width - 1) / width, slots = packs * width;
        far_.assign(slots, 0);
        factor_.assign(slots, Real(0));
        for (std::size_t t = 0; t < net.open_throats(); ++t) factor_[t] = conductivity / net.length[t];
        for (auto& force : force_) force.assign(slots, 0);
        all_packs_.resize(packs);
        for (std::size_t p = 0; p < packs; ++p) all_packs_[p] = std::int32_t(p);
        in_order_ = true;
        for (std::size_t t = 0; t < net.interior_throats; ++t)
            in_order_ = in_order_ && net.throat_pore[0][t] < net.throat_pore[1][t] &&
                        (t == 0 || net.throat_pore[0][t - 1] <= net.throat_pore[0][t]);
        collect_active(net);
    }

    /// Lists the packs with a throat that is not skipped; call it when net.inactive has changed.
    void collect_active(pore_network<Real, Dim> const& net) {
        active_packs_.clear();
        throats_ = 0;
        for (std::size_t p = 0; p < all_packs_.size(); ++p) {
            std::size_t const before = throats_;
            for (std::size_t t = p * width; t < (p + 1) * width; ++t) {
                // A skipped throat leads from a pore to itself: nothing flows.
                bool const passes = t < net.open_throats() && !net.inactive[t];
                far_[t] = net.throat_pore[passes && t < net.interior_throats ? 1 : 0][t];
                throats_ += passes;
            }
            if (throats_ > before) active_packs_.push_back(std::int32_t(p));
        }
    }
    /// Whether in all interior throats side 0 is the lower-numbered pore, and throats ascend with that pore.
    /// make_pore_network() creates this order.
    bool in_order() const noexcept { return in_order_; }
    /// Number of throats that are not skipped.
    std::size_t active_throats() const noexcept { return throats_; }

    /// \param lookup callable (particle i, particle j) -> index of the pair's normal force; 0 if there is no such pair
    template <class Lookup>
    void map(pore_network<Real, Dim> const& net, Lookup const& lookup) {
        for (std::size_t t = 0; t < net.open_throats(); ++t)
            for (std::size_t k = 0; k < pairs; ++k)
                force_[k][t] = std::uint32_t(
                    lookup(net.throat_particle[k][t], net.throat_particle[(k + 1) % std::size_t(Dim)][t]));
    }

    /// Packs of a pass: all, or those with a throat that is not skipped.
    std::vector<std::int32_t> const& packs(bool all) const noexcept { return all ? all_packs_ : active_packs_; }
    int chunks(bool all) const noexcept { return int((packs(all).size() + chunk_packs - 1) / chunk_packs); }
    /// Index in packs(false), from `from` on, of the first pack that begins at `pore` or a later one, or has a drained
    /// throat. Requires in_order().
    std::size_t first_beyond(pore_network<Real, Dim> const& net, std::size_t pore, std::size_t from) const noexcept {
        auto const within = [&](std::size_t slot) {
            return slot + width <= net.interior_throats && std::size_t(net.throat_pore[0][slot]) < pore;
        };
        return std::size_t(std::partition_point(active_packs_.begin() + std::ptrdiff_t(from), active_packs_.end(),
                                                [&](std::int32_t p) { return within(std::size_t(p) * width); }) -
                           active_packs_.begin());
    }

    /// The paper's eq. 14 for the throats of one chunk.
    /// \tparam Moves whether to update apertures first, from the gaps and normal forces of the pairs
    /// \tparam Flows whether to compute flows from the network's pressures, for throats that are not skipped. Otherwise
    ///         only apertures and conductances are computed, for all throats.
    /// \param particles records of the particles; used if Moves
    /// \param normal_forces of the pairs, N, the first is 0; used if Moves
    template <bool Moves, bool Flows, class Aperture>
    void pass(int chunk, pore_network<Real, Dim>& net, Real const* particles, Real const* normal_forces,
              typename Aperture::parameters const& parameters) const noexcept {
        std::size_t const first = std::size_t(chunk) * chunk_packs;
        pass<Moves, Flows, Aperture>(first, std::min(first + chunk_packs, packs(!Flows).size()), net, particles,
                                     normal_forces, parameters);
    }
    /// The same for packs(!Flows)[first, end).
    template <bool Moves, bool Flows, class Aperture>
    [[gnu::noinline, gnu::flatten]] void pass(std::size_t first, std::size_t end, pore_network<Real, Dim>& net,
                                              Real const* particles, Real const* normal_forces,
                                              typename Aperture::parameters const& aperture_parameters) const noexcept {
        using lanes = pack<Real, width>;
        auto const parameters = aperture_parameters;
        auto const& list = packs(!Flows);
        Real const* pressure = net.pressure.data();
        std::size_t const ahead = net.particles < few_particles ? 0 : 24;
        for (std::size_t n = first; n < end; ++n) {
            std::size_t const slot = std::size_t(list[n]) * width;
            lanes conductance;
            if constexpr (Moves) {
                // Earlier throats have already loaded most of the other particles.
                if (ahead > 0 && n + ahead < list.size())
                    prefetch_records<width>(particles,
                                            net.throat_particle[1].data() + std::size_t(list[n + ahead]) * width,
                                            particle_column<Real>::stride);
                auto [aperture, opening] = compute_opening<Aperture>(net, slot, particles, normal_forces, parameters);
                conductance = lanes::load(factor_.data() + slot) * opening;
                aperture.store(net.aperture.data() + slot);
                conductance.store(net.conductance.data() + slot);
            } else {
                conductance = lanes::load(net.conductance.data() + slot);
            }
            if constexpr (Flows) {
                lanes near = detail::gather<Real, width>(pressure, net.throat_pore[0].data() + slot);
                lanes far = detail::gather<Real, width>(pressure, far_.data() + slot);
                if (slot + width > net.interior_throats) far = with_reservoirs(net, slot, far);
                lanes q = conductance * (far - near);
                q.store(net.flow.data() + slot);
            }
        }
    }

    /// Adds half of the energies of the flows of one chunk, with the present pressures. The energies of a step use the
    /// mean of old and new pressures: call this once before and once after the pressures change.
    [[gnu::noinline, gnu::flatten]] void add_up(int chunk, pore_network<Real, Dim> const& net, Real time_step,
                                                throat_sums<Real>& sums) const noexcept {
        using lanes = pack<Real, width>;
        lanes dissipation(Real(0)), work(Real(0)), inflow(Real(0)), gross(Real(0));
        lanes dt(time_step * Real(0.5)), zero(Real(0));
        Real const* pressure = net.pressure.data();
        std::size_t const first = std::size_t(chunk) * chunk_packs,
                          end = std::min(first + chunk_packs, active_packs_.size());
        for (std::size_t n = first; n < end; ++n) {
            std::size_t const slot = std::size_t(active_packs_[n]) * width;
            lanes moved = lanes::load(net.flow.data() + slot) * dt;
            lanes near = detail::gather<Real, width>(pressure, net.throat_pore[0].data() + slot);
            lanes far = detail::gather<Real, width>(pressure, far_.data() + slot);
            if (slot + width > net.interior_throats) {
                far = with_reservoirs(net, slot, far);
                lanes in = moved;
                for (int k = 0; k < width; ++k)
                    if (slot + std::size_t(k) < net.interior_throats) in.v[k] = Real(0);
                inflow += in;
                work += in * far;
            }
            dissipation += moved * (far - near);
            gross += abs(moved);
        }
        sums += {sum(dissipation), sum(work), sum(inflow), sum(gross)};
    }

private:
    /// Apertures of the throats of a pack, m, and the factor `opening` of their conductances (k / l) opening: a^3, m^3,
    /// or that of the law of the section.
    struct throat_opening {
        pack<Real, width> aperture, opening;
    };
    template <class Aperture>
    [[gnu::always_inline]] throat_opening
    compute_opening(pore_network<Real, Dim> const& net, std::size_t slot, Real const* particles,
                    Real const* normal_forces, typename Aperture::parameters const& parameters) const noexcept {
        using lanes = pack<Real, width>;
        if constexpr (throat_section_law<Aperture>) {
            static_assert(Dim == 3, "flow: a throat has a section in space alone (Dim = 3)");
            auto a = detail::load_particles<Real, width>(particles, net.throat_particle[0].data() + slot);
            auto b = detail::load_particles<Real, width>(particles, net.throat_particle[1].data() + slot);
            auto c = detail::load_particles<Real, width>(particles, net.throat_particle[2].data() + slot);
            auto facet = measure_facet<lanes>({{a[0], a[1], a[2]}}, {{b[0], b[1], b[2]}}, {{c[0], c[1], c[2]}}, a[3],
                                              b[3], c[3]);
            lanes radius = max(facet.hydraulic_radius, lanes(Real(0)));
            return {radius, Aperture::opening(parameters, facet.void_area, radius)};
        } else {
            lanes aperture = aperture_of_pair<Aperture>(net, 0, slot, particles, normal_forces, parameters);
            if constexpr (pairs > 1) {
                for (std::size_t k = 1; k < pairs; ++k)
                    aperture += aperture_of_pair<Aperture>(net, k, slot, particles, normal_forces, parameters);
                aperture *= lanes(Real(1) / Real(pairs));
            }
            return {aperture, aperture * aperture * aperture};
        }
    }
    /// Aperture by the law, from the gap and the normal force of the throat's pair number k, m.
    template <class Aperture>
    [[gnu::always_inline]] pack<Real, width>
    aperture_of_pair(pore_network<Real, Dim> const& net, std::size_t k, std::size_t slot, Real const* particles,
                     Real const* normal_forces, typename Aperture::parameters const& p) const noexcept {
        using lanes = pack<Real, width>;
        using rec = record<Real>;
        rec difference_and_sum(Real(-1));
        difference_and_sum.v[3] = 1;
        std::int32_t const *i = net.throat_particle[k].data() + slot,
                           *j = net.throat_particle[(k + 1) % std::size_t(Dim)].data() + slot;
        auto pair = transpose_load<Real, width>([&](int lane) {
            return detail::load_particle(particles, j[lane]) +
                   detail::load_particle(particles, i[lane]) * difference_and_sum;
        });
        lanes squared = pair[0] * pair[0] + pair[1] * pair[1];
        if constexpr (Dim == 3) squared += pair[2] * pair[2];
        lanes gap = sqrt(squared) - pair[3];
        lanes normal = detail::gather<Real, width>(normal_forces, force_[k].data() + slot);
        return Aperture::aperture(p, normal, gap);
    }

    /// Pressures at the far ends of a pack with drained throats: those of the reservoirs there.
    [[gnu::noinline]] static pack<Real, width> with_reservoirs(pore_network<Real, Dim> const& net, std::size_t slot,
                                                               pack<Real, width> far) noexcept {
        for (int k = 0; k < width; ++k) {
            std::size_t const t = slot + std::size_t(k);
            if (net.drained(t) && !net.inactive[t]) far.v[k] = net.reservoir_pressure(t);
        }
        return far;
    }

    std::size_t throats_ = 0;
    bool in_order_ = true;
    std::vector<std::int32_t> far_; // pore at the far end; the pore at the near end if nothing flows
    std::array<aligned_vector<std::uint32_t>, pairs> force_; // indices of normal forces
    aligned_vector<Real> factor_; // k / l; 0 for the padding of the last pack
    std::vector<std::int32_t> all_packs_, active_packs_;
};
LACUNA_END_PACKS

} // namespace lacuna
