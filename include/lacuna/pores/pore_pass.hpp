// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include <lacuna/core/fetch.hpp>
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

/// Particles as particle_store has them, as far as pores read them: {x, y, -, radius}, in space {x, y, z, radius}, m.
template <class Real, int Dim>
body_column<Real> particle_records(points_view<Real, Dim> points, Real const* radii) {
    body_column<Real> place;
    place.resize(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        for (int axis = 0; axis < Dim; ++axis) place.at(k, axis) = points(k, axis);
        place.at(k, 3) = radii[k];
    }
    return place;
}

/// What the pass reads and writes besides the network: where the corners' records begin, least volumes, the throats
/// of each pore, and the forces on the corners. Whole packs; the last pore fills up the last one, with a least volume
/// that no pore has: its volume and pressure never change, so it adds nothing to any sum.
template <class Real, int Dim>
class pore_table {
public:
    static constexpr int width = native_width<Real>;
    static constexpr std::size_t corners = std::size_t(Dim) + 1;
    /// Reals of the force on a corner: a pair, in space a record with a 0 at its end.
    static constexpr std::size_t force_reals = Dim == 2 ? 2 : 4;
    /// Packs that one thread handles at a time.
    static constexpr std::size_t chunk_packs = 128;

    /// \param minimum_share least volume of a pore as a share of its size at build time, times the thickness, m
    void build(pore_network<Real, Dim>& net, Real minimum_share) {
        std::size_t const count = net.pores();
        packs_ = (count + width - 1) / width;
        std::size_t const slots = packs_ * width;
        set_fillers(net);
        floor_.assign(slots, filler_volume);
        before_.assign(slots, Real(0));
        if (!net.bare()) {
            force_.assign((corners * slots + 1) * force_reals, Real(0));
            for (std::size_t c = 0; c < corners; ++c) {
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
        sign_.assign(slots * row_, 0.0f);
        for (std::size_t p = 0; p < count; ++p)
            for (auto e = throats.first[p]; e < throats.first[p + 1]; ++e) {
                std::size_t const at = (p / width * row_ + std::size_t(e - throats.first[p])) * width + p % width;
                inflow_[at] = throats.entry[std::size_t(e)] / 2;
                sign_[at] = throats.entry[std::size_t(e)] % 2 == 0 ? 1.0f : -1.0f;
            }
    }

    /// Gives what fills up the last pack its values; for a network that comes from elsewhere.
    static void set_fillers(pore_network<Real, Dim>& net) noexcept {
        net.volume.set_fillers(filler_volume);
        net.old_volume.set_fillers(filler_volume);
        net.pressure.set_fillers(Real(0));
        net.vapour.set_fillers(Real(0));
    }

    int chunks() const noexcept { return int((packs_ + chunk_packs - 1) / chunk_packs); }
    /// Calls visit(particle, where the force on it stands in forces()) for every corner of every pore.
    template <class Visit>
    void for_each_corner(pore_network<Real, Dim> const& net, Visit const& visit) const {
        if (net.bare()) return;
        for (std::size_t p = 0; p < net.pores(); ++p)
            for (std::size_t c = 0; c < corners; ++c)
                visit(std::size_t(net.corner[c][p]), std::uint32_t(place_of(p, c)));
    }
    /// Where the zeros of a force that is none stand in forces().
    std::uint32_t zero_offset() const noexcept { return std::uint32_t(corners * packs_ * width * force_reals); }
    /// Forces on the corners, force_reals numbers each, N.
    Real const* forces() const noexcept { return force_.data(); }
    /// Pressures before the last step that kept the ledger, Pa.
    Real const* pressure_before() const noexcept { return before_.data(); }

    /// Measures the pores of one chunk anew: their volumes, and the forces on their corners for 1 Pa.
    [[gnu::noinline, gnu::flatten]] void measure(int chunk, pore_network<Real, Dim>& net, Real const* place,
                                                 Real body_thickness) noexcept {
        using lanes = pack<Real, width>;
        lanes thickness(body_thickness), zero(Real(0));
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            std::size_t const slot = p * width;
            auto shape = measure_pack(place, slot);
            lanes free_volume = volume_of(shape) * thickness, floor = lanes::load(floor_.data() + slot);
            lanes exerts = select(free_volume > floor, thickness, zero);
            max(free_volume, floor).store(net.volume.data() + slot);
            store_forces(slot, shape, exerts);
        }
    }

    /// Turns the forces for 1 Pa, as measure() left them, into those of the pressures.
    [[gnu::noinline, gnu::flatten]] void press(int chunk, pore_network<Real, Dim> const& net) noexcept {
        using lanes = pack<Real, width>;
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            lanes pressure = lanes::load(net.pressure.data() + p * width);
            for (std::size_t c = 0; c < corners; ++c) {
                Real* to = force_.data() + (corners * p + c) * force_reals * width;
                for (int k = 0; k < width; ++k, to += force_reals)
                    for (int axis = 0; axis < Dim; ++axis) to[axis] *= pressure[k];
            }
        }
    }

    /// Writes the forces of one pore, whose pressure has changed since the pass.
    void press_one(std::size_t pore, pore_network<Real, Dim> const& net, Real const* place,
                   Real body_thickness) noexcept {
        std::array<vec<Real, Dim>, corners> x;
        std::array<Real, corners> r;
        for (std::size_t c = 0; c < corners; ++c) {
            Real const* at = place + corner_[c][pore];
            for (int axis = 0; axis < Dim; ++axis) x[c][axis] = at[axis];
            r[c] = at[3];
        }
        auto const shape = measure_simplex(x, r);
        Real const push = net.volume[pore] > floor_[pore] ? net.pressure[pore] * body_thickness : Real(0);
        for (std::size_t c = 0; c < corners; ++c) {
            Real* to = force_.data() + place_of(pore, c);
            for (int axis = 0; axis < Dim; ++axis) to[axis] = shape.traction[c][axis] * push;
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
    [[gnu::noinline, gnu::flatten]] void advance(int chunk, pore_network<Real, Dim>& net, Real const* place,
                                                 pore_constants<Real> const& fluid, Real time_step, bool flows,
                                                 [[maybe_unused]] Real share, pore_sums<Real>& sums) noexcept {
        using lanes = pack<Real, width>;
        bool const tears = fluid.minimum_pressure > -std::numeric_limits<Real>::infinity();
        lanes stiffness(fluid.bulk_modulus), compliance(Real(1) / fluid.bulk_modulus), thickness(fluid.thickness);
        lanes least(fluid.minimum_pressure), dt(time_step), zero(Real(0)), half(Real(0.5));
        lanes content(Real(0)), changed(Real(0)), work(Real(0)), vapour_work(Real(0)), prefactor(Real(0));
        Real const* flow = net.flow.data();
        std::size_t const ahead = net.particles < few_particles ? 0 : 16;
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            std::size_t const slot = p * width;
            shape_of<lanes> shape;
            lanes volume, exerts, last = lanes::load(net.old_volume.data() + slot);
            if constexpr (Moves) {
                // The other corners are those of pores before, most of them.
                if (ahead > 0 && p + ahead < packs_)
                    fetch_records<width>(place, corner_[corners - 1].data() + slot + ahead * width);
                shape = measure_pack(place, slot);
                lanes free_volume = volume_of(shape) * thickness, floor = lanes::load(floor_.data() + slot);
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
                    came += detail::load_single<Real, width>(sign_.data() + at) * detail::gather<Real, width>(flow, inflow_.data() + at);
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
    template <class T>
    using shape_of = std::conditional_t<Dim == 2, pore_shape<T>, tetrahedron_shape<T>>;

    template <class T>
    static T const& volume_of(pore_shape<T> const& shape) noexcept {
        return shape.void_area;
    }
    template <class T>
    static T const& volume_of(tetrahedron_shape<T> const& shape) noexcept {
        return shape.void_volume;
    }
    /// Where the force on a corner stands.
    static std::size_t place_of(std::size_t pore, std::size_t corner) noexcept {
        return ((pore / width * corners + corner) * width + pore % width) * force_reals;
    }

    [[gnu::always_inline]] auto measure_pack(Real const* place, std::size_t slot) const noexcept {
        using lanes = pack<Real, width>;
        auto a = load_turned<Real, width>(place, corner_[0].data() + slot);
        auto b = load_turned<Real, width>(place, corner_[1].data() + slot);
        auto c = load_turned<Real, width>(place, corner_[2].data() + slot);
        if constexpr (Dim == 2) {
            return measure_pore<lanes>({{a[0], a[1]}}, {{b[0], b[1]}}, {{c[0], c[1]}}, a[3], b[3], c[3]);
        } else {
            auto d = load_turned<Real, width>(place, corner_[3].data() + slot);
            return measure_pore<lanes>({{a[0], a[1], a[2]}}, {{b[0], b[1], b[2]}}, {{c[0], c[1], c[2]}},
                                       {{d[0], d[1], d[2]}}, a[3], b[3], c[3], d[3]);
        }
    }

    void store_forces(std::size_t slot, shape_of<pack<Real, width>> const& shape,
                      pack<Real, width> const& push) noexcept {
        Real* to = force_.data() + corners * force_reals * slot;
        if constexpr (Dim == 2) {
            detail::store_pairs(to, shape.traction[0][0] * push, shape.traction[0][1] * push);
            detail::store_pairs(to + 2 * width, shape.traction[1][0] * push, shape.traction[1][1] * push);
            detail::store_pairs(to + 4 * width, shape.traction[2][0] * push, shape.traction[2][1] * push);
        } else {
            for (std::size_t c = 0; c < corners; ++c) {
                auto const& t = shape.traction[c];
                store_turned<Real, width>(to + 4 * c * width,
                                          {t[0] * push, t[1] * push, t[2] * push, pack<Real, width>(Real(0))});
            }
        }
    }

    static constexpr Real filler_volume = Real(1e30);
    std::size_t packs_ = 0, row_ = 0;
    std::array<aligned_vector<std::uint32_t>, corners> corner_;
    aligned_vector<Real> floor_, before_, force_;
    // Of pack p: row_ times a throat for each pore, and whether its flow comes in (1) or goes out (-1), or is none (0).
    aligned_vector<std::int32_t> inflow_;
    aligned_vector<float> sign_;
};

} // namespace lacuna
