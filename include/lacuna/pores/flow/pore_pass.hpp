// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

#include <lacuna/core/prefetch.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/pores/flow/corner_forces.hpp>
#include <lacuna/pores/flow/flow_sums.hpp>
#include <lacuna/pores/mesh/geometry.hpp>
#include <lacuna/pores/flow/pack_access.hpp>
#include <lacuna/pores/network/pore_network.hpp>

/// \file
/// The pass of the flow step over the pores, pack by pack.

namespace lacuna {

/// Records of particles, laid out as in particle_store, with the numbers that pores read: {x, y, -, radius}, in space
/// {x, y, z, radius}, m.
template <class Real, int Dim>
particle_column<Real> particle_records(points_view<Real, Dim> points, Real const* radii) {
    particle_column<Real> particles;
    particles.resize(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        for (int axis = 0; axis < Dim; ++axis) particles.at(k, axis) = points(k, axis);
        particles.at(k, 3) = radii[k];
    }
    return particles;
}

LACUNA_BEGIN_PACKS
/// The pass over the pores, in whole packs. The last pack is padded with copies of the last pore's corners and a huge
/// least volume. The volume and pressure of padding never change, so it adds nothing to any sum.
template <class Real, int Dim>
class pore_table {
public:
    static constexpr int width = native_width<Real>;
    using forces = corner_forces<Real, Dim>;
    static constexpr std::size_t corners = forces::corners;
    /// Packs that one thread handles at a time.
    static constexpr std::size_t chunk_packs = 128;

    /// \param minimum_share least pore volume as a share of pore_network::size, times the thickness, m (1 in space)
    void build(pore_network<Real, Dim>& net, Real minimum_share) {
        packs_ = (net.pores() + width - 1) / width;
        minimum_share_ = minimum_share;
        set_padding(net);
    }

    /// Sets the padding of a network that was not set up by build().
    void set_padding(pore_network<Real, Dim>& net) const noexcept {
        Real const volume = minimum_share_ * padding_size;
        net.volume.set_padding(volume);
        net.old_volume.set_padding(volume);
        net.pressure.set_padding(Real(0));
        if (!net.vapour.empty()) net.vapour.set_padding(Real(0));
        if (net.bare()) return;
        net.size.set_padding(padding_size);
        for (auto& corner : net.corner) corner.set_padding(corner[net.pores() - 1]);
    }

    int chunks() const noexcept { return int((packs_ + chunk_packs - 1) / chunk_packs); }

    /// Updates the pores of one chunk: their volumes, and the forces on their corners for 1 Pa.
    [[gnu::noinline, gnu::flatten]] void update_geometry(int chunk, pore_network<Real, Dim>& net, Real const* particles,
                                                 Real body_thickness, forces& exerted) const noexcept {
        using lanes = pack<Real, width>;
        lanes thickness(body_thickness), share(minimum_share_), zero(Real(0));
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            std::size_t const slot = p * width;
            auto shape = measure_pack(net, particles, slot);
            lanes free_volume = void_of(shape) * thickness, floor = lanes::load(net.size.data() + slot) * share;
            lanes exerts = select(free_volume > floor, thickness, zero);
            max(free_volume, floor).store(net.volume.data() + slot);
            store_forces(exerted.of_pack(p), shape, exerts);
        }
    }

    /// Multiplies the forces for 1 Pa from update_geometry() by the pressures.
    [[gnu::noinline, gnu::flatten]] void apply_pressures(int chunk, pore_network<Real, Dim> const& net,
                                               forces& exerted) const noexcept {
        using lanes = pack<Real, width>;
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            lanes pressure = lanes::load(net.pressure.data() + p * width);
            Real* to = exerted.of_pack(p);
            for (std::size_t c = 0; c < corners; ++c)
                for (int k = 0; k < width; ++k, to += forces::force_reals)
                    for (int axis = 0; axis < Dim; ++axis) to[axis] *= pressure[k];
        }
    }

    /// Writes the forces of one pore again, after its pressure has changed since the pass.
    void rewrite_forces(std::size_t pore, pore_network<Real, Dim> const& net, Real const* particles,
                        Real body_thickness, forces& exerted) const noexcept {
        std::array<vec<Real, Dim>, corners> x;
        std::array<Real, corners> r;
        for (std::size_t c = 0; c < corners; ++c) {
            Real const* at = particles + particle_column<Real>::stride * std::size_t(net.corner[c][pore]);
            for (int axis = 0; axis < Dim; ++axis) x[c][axis] = at[axis];
            r[c] = at[3];
        }
        auto const shape = measure_simplex(x, r);
        bool const at_least_volume = !(net.volume[pore] > minimum_share_ * net.size[pore]);
        Real const push = at_least_volume ? Real(0) : net.pressure[pore] * body_thickness;
        for (std::size_t c = 0; c < corners; ++c)
            for (int axis = 0; axis < Dim; ++axis) exerted.of(pore, c)[axis] = shape.traction[c][axis] * push;
    }

    /// The paper's eq. 15 for the pores of one chunk, from the flows stored in the network.
    /// \tparam Moves whether to update the pores' geometry first, and to write the forces of the new pressures (eq.
    ///         16). A pore at its least volume exerts none: its volume does not change when its corners move.
    /// \tparam WithLedger whether to sum energies
    /// \param particles records of the particles, as in particle_store; used if Moves
    /// \param flows whether any throat has flow
    /// \param part share of the change from old_volume to volume that takes particles now; 1 if Moves
    template <bool Moves, bool WithLedger>
    [[gnu::noinline, gnu::flatten]] void advance(int chunk, pore_network<Real, Dim>& net, Real const* particles,
                                                 pore_constants<Real> const& fluid, Real time_step, bool flows,
                                                 [[maybe_unused]] Real part, [[maybe_unused]] forces& exerted,
                                                 pore_sums<Real>& sums) const noexcept {
        using lanes = pack<Real, width>;
        bool const tears = fluid.minimum_pressure > -std::numeric_limits<Real>::infinity();
        lanes stiffness(fluid.bulk_modulus), compliance(Real(1) / fluid.bulk_modulus), thickness(fluid.thickness);
        lanes least(fluid.minimum_pressure), dt(time_step), zero(Real(0)), half(Real(0.5)), share(minimum_share_);
        lanes content(Real(0)), changed(Real(0)), work(Real(0)), vapour_work(Real(0)), prefactor(Real(0));
        std::size_t const ahead = net.particles < few_particles ? 0 : 16;
        std::size_t const first = std::size_t(chunk) * chunk_packs, end = std::min(first + chunk_packs, packs_);
        for (std::size_t p = first; p < end; ++p) {
            std::size_t const slot = p * width;
            shape_of<lanes> shape;
            lanes volume, exerts, last = lanes::load(net.old_volume.data() + slot);
            if constexpr (Moves) {
                // Earlier pores have already loaded most of the other corners.
                if (ahead > 0 && p + ahead < packs_)
                    prefetch_records<width>(particles, net.corner[corners - 1].data() + slot + ahead * width,
                                         particle_column<Real>::stride);
                shape = measure_pack(net, particles, slot);
                lanes free_volume = void_of(shape) * thickness, floor = lanes::load(net.size.data() + slot) * share;
                volume = max(free_volume, floor);
                exerts = select(free_volume > floor, thickness, zero);
                volume.store(net.volume.data() + slot);
            } else {
                volume = lanes::load(net.volume.data() + slot);
                if (part < Real(1)) volume = last + (volume - last) * lanes(part);
            }
            lanes grown = volume - last;
            lanes old = lanes::load(net.pressure.data() + slot);
            lanes inflow = flows ? inflow_of(net, p) * dt : zero;
            lanes per_volume = stiffness / volume;
            lanes next = old + per_volume * (inflow - grown);
            lanes torn = zero;
            if (tears) {
                lanes vapour = lanes::load(net.vapour.data() + slot);
                lanes wanted = next - per_volume * vapour;
                next = max(wanted, least);
                // Exactly zero above the minimum pressure: rounding must leave no vapour there.
                lanes now = select(wanted < least, (least - wanted) * volume * compliance, zero);
                torn = now - vapour;
                now.store(net.vapour.data() + slot);
            }
            next.store(net.pressure.data() + slot);
            volume.store(net.old_volume.data() + slot);
            if constexpr (Moves) store_forces(exerted.of_pack(p), shape, next * exerts);
            if constexpr (WithLedger) {
                lanes middle = (next + old) * half;
                content += volume * (next - old) * compliance + grown - torn;
                changed += abs(grown);
                work += middle * grown;
                vapour_work += middle * torn;
                prefactor += old * old * grown * (compliance * half);
            }
        }
        if constexpr (WithLedger) sums = {sum(content), sum(changed), sum(work), sum(vapour_work), sum(prefactor)};
    }

private:
    /// Fluid that flows into each pore of a pack through its throats, m^3/s.
    static pack<Real, width> inflow_of(pore_network<Real, Dim> const& net, std::size_t p) noexcept {
        using lanes = pack<Real, width>;
        lanes sum(Real(0)), outflows = detail::load_single<Real, width>(net.throats_of.outflows(p));
        for (std::size_t e = 0; e < net.throats_of.row(); ++e) {
            lanes q = detail::gather<Real, width>(net.flow.data(), net.throats_of.throats(p, e));
            sum += select(outflows > lanes(Real(e)), -q, q);
        }
        return sum;
    }
    template <class T>
    using shape_of = std::conditional_t<Dim == 2, pore_shape<T>, tetrahedron_shape<T>>;

    [[gnu::always_inline]] static auto measure_pack(pore_network<Real, Dim> const& net, Real const* particles,
                                                    std::size_t slot) noexcept {
        using lanes = pack<Real, width>;
        auto const at = [&](std::size_t c) {
            return detail::load_particles<Real, width>(particles, net.corner[c].data() + slot);
        };
        auto a = at(0), b = at(1), c = at(2);
        if constexpr (Dim == 2) {
            return measure_pore<lanes>({{a[0], a[1]}}, {{b[0], b[1]}}, {{c[0], c[1]}}, a[3], b[3], c[3]);
        } else {
            auto d = at(3);
            return measure_pore<lanes>({{a[0], a[1], a[2]}}, {{b[0], b[1], b[2]}}, {{c[0], c[1], c[2]}},
                                       {{d[0], d[1], d[2]}}, a[3], b[3], c[3], d[3]);
        }
    }

    static void store_forces(Real* to, shape_of<pack<Real, width>> const& shape,
                             pack<Real, width> const& push) noexcept {
        if constexpr (Dim == 2) {
            detail::store_pairs(to, shape.traction[0][0] * push, shape.traction[0][1] * push);
            detail::store_pairs(to + 2 * width, shape.traction[1][0] * push, shape.traction[1][1] * push);
            detail::store_pairs(to + 4 * width, shape.traction[2][0] * push, shape.traction[2][1] * push);
        } else {
            for (std::size_t c = 0; c < corners; ++c) {
                auto const& t = shape.traction[c];
                transpose_store<Real, width>(to + 4 * c * width,
                                          {t[0] * push, t[1] * push, t[2] * push, pack<Real, width>(Real(0))});
            }
        }
    }

    static constexpr Real padding_size = Real(1e30);
    std::size_t packs_ = 0;
    Real minimum_share_ = Real(1);
};
LACUNA_END_PACKS

} // namespace lacuna
