// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <lacuna/core/pack.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/pores/flow_sums.hpp>
#include <lacuna/pores/geometry.hpp>
#include <lacuna/pores/pack_access.hpp>
#include <lacuna/pores/pore_network.hpp>

/// \file
/// The pass of the flow step over the pores, pack by pack.

namespace lacuna {

/// Particles as particle_store has them, as far as pores read them: {x, y, -, radius}, m.
template <class Real>
body_column<Real> particle_records(points_view<Real, 2> points, Real const* radii) {
    body_column<Real> place;
    place.resize(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        place.at(k, 0) = points(k, 0);
        place.at(k, 1) = points(k, 1);
        place.at(k, 3) = radii[k];
    }
    return place;
}

/// What the pass reads and writes besides the network: where the corners' records begin, least volumes, the throats
/// of each pore, and the forces on the corners. Whole packs; the last pore fills up the last one, with a least volume
/// that no pore has: its volume and pressure never change, so it adds nothing to any sum.
template <class Real>
class pore_table {
public:
    static constexpr int width = native_width<Real>;
    /// Packs that one thread handles at a time.
    static constexpr std::size_t chunk_packs = 128;

    /// \param minimum_share least volume of a pore as a share of its size at build time, times the thickness, m
    void build(pore_network<Real, 2>& net, Real minimum_share) {
        std::size_t const count = net.pores();
        packs_ = (count + width - 1) / width;
        std::size_t const slots = packs_ * width;
        set_fillers(net);
        floor_.assign(slots, filler_volume);
        before_.assign(slots, Real(0));
        if (!net.bare()) {
            force_.assign(6 * slots + 2, Real(0));
            for (std::size_t c = 0; c < 3; ++c) {
                corner_[c].assign(slots, 0);
                for (std::size_t p = 0; p < slots; ++p)
                    corner_[c][p] = std::uint32_t(body_column<Real>::stride) * std::uint32_t(net.corner[c][std::min(p, count - 1)]);
            }
            for (std::size_t p = 0; p < count; ++p) floor_[p] = minimum_share * net.size[p];
        }
        auto const& throats = net.pore_throats;
        row_ = 0;
        for (std::size_t p = 0; p < count; ++p)
            row_ = std::max(row_, std::size_t(throats.first[p + 1] - throats.first[p]));
        inflow_.assign(slots * row_, 0);
        sign_.assign(slots * row_, Real(0));
        for (std::size_t p = 0; p < count; ++p)
            for (auto e = throats.first[p]; e < throats.first[p + 1]; ++e) {
                std::size_t const at = (p / width * row_ + std::size_t(e - throats.first[p])) * width + p % width;
                inflow_[at] = throats.entry[std::size_t(e)] / 2;
                sign_[at] = throats.entry[std::size_t(e)] % 2 == 0 ? Real(1) : Real(-1);
            }
    }

    /// Gives what fills up the last pack its values; for a network that comes from elsewhere.
    static void set_fillers(pore_network<Real, 2>& net) noexcept {
        net.volume.set_fillers(filler_volume);
        net.old_volume.set_fillers(filler_volume);
        net.pressure.set_fillers(Real(0));
        net.vapour.set_fillers(Real(0));
    }

    int chunks() const noexcept { return int((packs_ + chunk_packs - 1) / chunk_packs); }
    /// Calls visit(particle, where the force on it stands in forces()) for every corner of every pore.
    template <class Visit>
    void for_each_corner(pore_network<Real, 2> const& net, Visit const& visit) const {
        if (net.bare()) return;
        for (std::size_t p = 0; p < net.pores(); ++p)
            for (std::size_t c = 0; c < 3; ++c)
                visit(std::size_t(net.corner[c][p]), std::uint32_t(((p / width * 3 + c) * width + p % width) * 2));
    }
    /// Where two zeros stand in forces().
    std::uint32_t zero_offset() const noexcept { return std::uint32_t(6 * packs_ * width); }
    /// Forces on the corners, two components each, N.
    Real const* forces() const noexcept { return force_.data(); }
    /// Pressures before the last step that kept the ledger, Pa.
    Real const* pressure_before() const noexcept { return before_.data(); }

    /// Measures the pores of one chunk anew: their volumes, and the forces on their corners for 1 Pa.
    [[gnu::noinline, gnu::flatten]] void measure(int chunk, pore_network<Real, 2>& net, Real const* place,
                                                 Real body_thickness) noexcept {
        using lanes = pack<Real, width>;
        lanes thickness(body_thickness), zero(Real(0));
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            std::size_t const slot = p * width;
            auto a = load_turned<Real, width>(place, corner_[0].data() + slot);
            auto b = load_turned<Real, width>(place, corner_[1].data() + slot);
            auto c = load_turned<Real, width>(place, corner_[2].data() + slot);
            auto shape = measure_pore<lanes>({{a[0], a[1]}}, {{b[0], b[1]}}, {{c[0], c[1]}}, a[3], b[3], c[3]);
            lanes free_volume = shape.void_area * thickness, floor = lanes::load(floor_.data() + slot);
            lanes exerts = select(free_volume > floor, thickness, zero);
            max(free_volume, floor).store(net.volume.data() + slot);
            store_forces(slot, shape, exerts);
        }
    }

    /// Turns the forces for 1 Pa, as measure() left them, into those of the pressures.
    [[gnu::noinline, gnu::flatten]] void press(int chunk, pore_network<Real, 2> const& net) noexcept {
        using lanes = pack<Real, width>;
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            lanes pressure = lanes::load(net.pressure.data() + p * width);
            for (std::size_t c = 0; c < 3; ++c) {
                Real* to = force_.data() + (3 * p + c) * 2 * width;
                for (int k = 0; k < width; ++k) {
                    to[2 * k] *= pressure[k];
                    to[2 * k + 1] *= pressure[k];
                }
            }
        }
    }

    /// Writes the forces of one pore, whose pressure has changed since the pass.
    void press_one(std::size_t pore, pore_network<Real, 2> const& net, Real const* place,
                   Real body_thickness) noexcept {
        std::array<vec<Real, 2>, 3> x;
        std::array<Real, 3> r;
        for (std::size_t c = 0; c < 3; ++c) {
            Real const* at = place + corner_[c][pore];
            x[c] = {at[0], at[1]};
            r[c] = at[3];
        }
        auto const shape = measure_pore<Real>(x[0], x[1], x[2], r[0], r[1], r[2]);
        Real const push = net.volume[pore] > floor_[pore] ? net.pressure[pore] * body_thickness : Real(0);
        for (std::size_t c = 0; c < 3; ++c) {
            Real* to = force_.data() + ((pore / width * 3 + c) * width + pore % width) * 2;
            to[0] = shape.traction[c][0] * push;
            to[1] = shape.traction[c][1] * push;
        }
    }

    /// Eq. 15 for the pores of one chunk, from the flows that the network holds.
    /// \tparam Moves first measures the pores anew, and writes eq. 16's forces of the new pressures. A pore at its
    ///         least volume exerts none: its volume does not change when its corners move.
    /// \tparam WithLedger also keeps the old pressures and sums up energies
    /// \param place records of the particles, as particle_store has them; used if Moves
    /// \param flows whether any throat is open
    /// \param share unless Moves: how much of the way from the old volumes to the network's the pores go
    template <bool Moves, bool WithLedger>
    [[gnu::noinline, gnu::flatten]] void advance(int chunk, pore_network<Real, 2>& net, Real const* place,
                                                 pore_constants<Real> const& fluid, Real time_step, bool flows,
                                                 [[maybe_unused]] Real share, pore_sums<Real>& sums) noexcept {
        using lanes = pack<Real, width>;
        bool const tears = fluid.minimum_pressure > -std::numeric_limits<Real>::infinity();
        lanes stiffness(fluid.bulk_modulus), compliance(Real(1) / fluid.bulk_modulus), thickness(fluid.thickness);
        lanes least(fluid.minimum_pressure), dt(time_step), zero(Real(0)), half(Real(0.5));
        lanes content(Real(0)), changed(Real(0)), work(Real(0)), vapour_work(Real(0)), prefactor(Real(0));
        Real const* flow = net.flow.data();
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            std::size_t const slot = p * width;
            pore_shape<lanes> shape;
            lanes volume, exerts, last = lanes::load(net.old_volume.data() + slot);
            if constexpr (Moves) {
                auto a = load_turned<Real, width>(place, corner_[0].data() + slot);
                auto b = load_turned<Real, width>(place, corner_[1].data() + slot);
                auto c = load_turned<Real, width>(place, corner_[2].data() + slot);
                shape = measure_pore<lanes>({{a[0], a[1]}}, {{b[0], b[1]}}, {{c[0], c[1]}}, a[3], b[3], c[3]);
                lanes free_volume = shape.void_area * thickness, floor = lanes::load(floor_.data() + slot);
                volume = max(free_volume, floor);
                exerts = select(free_volume > floor, thickness, zero);
                volume.store(net.volume.data() + slot);
            } else {
                volume = lanes::load(net.volume.data() + slot);
                if (share < Real(1)) volume = last + (volume - last) * lanes(share);
            }
            lanes grown = volume - last;
            lanes old = lanes::load(net.pressure.data() + slot);
            lanes came = zero;
            if (flows) {
                for (std::size_t e = 0; e < row_; ++e) {
                    std::size_t const at = (p * row_ + e) * width;
                    came += lanes::load(sign_.data() + at) * detail::gather<Real, width>(flow, inflow_.data() + at);
                }
                came *= dt;
            }
            lanes per_volume = stiffness / volume;
            lanes next = old + per_volume * (came - grown);
            lanes torn = zero;
            if (tears) {
                lanes vapour = lanes::load(net.vapour.data() + slot);
                lanes wanted = next - per_volume * vapour;
                next = max(wanted, least);
                // No vapour at all where the pressure holds: rounding must not leave a trace of it.
                lanes now = select(wanted < least, (least - wanted) * volume * compliance, zero);
                torn = now - vapour;
                now.store(net.vapour.data() + slot);
            }
            next.store(net.pressure.data() + slot);
            volume.store(net.old_volume.data() + slot);
            if constexpr (Moves) {
                store_forces(slot, shape, next * exerts);
            }
            if constexpr (WithLedger) {
                lanes middle = (next + old) * half;
                content += volume * (next - old) * compliance + grown - torn;
                changed += abs(grown);
                work += middle * grown;
                vapour_work += middle * torn;
                prefactor += old * old * grown * (compliance * half);
                old.store(before_.data() + slot);
            }
        }
        if constexpr (WithLedger) sums = {sum(content), sum(changed), sum(work), sum(vapour_work), sum(prefactor)};
    }

private:
    void store_forces(std::size_t slot, pore_shape<pack<Real, width>> const& shape,
                      pack<Real, width> const& push) noexcept {
        Real* to = force_.data() + 6 * slot;
        detail::store_pairs(to, shape.traction[0][0] * push, shape.traction[0][1] * push);
        detail::store_pairs(to + 2 * width, shape.traction[1][0] * push, shape.traction[1][1] * push);
        detail::store_pairs(to + 4 * width, shape.traction[2][0] * push, shape.traction[2][1] * push);
    }

    static constexpr Real filler_volume = Real(1e30);
    std::size_t packs_ = 0, row_ = 0;
    std::array<aligned_vector<std::uint32_t>, 3> corner_;
    aligned_vector<Real> floor_, before_, force_;
    // Of pack p: row_ times a throat for each pore, and whether its flow comes in (1) or goes out (-1), or is none (0).
    aligned_vector<std::int32_t> inflow_;
    aligned_vector<Real> sign_;
};

} // namespace lacuna
