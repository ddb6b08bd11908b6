// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/parallel.hpp>
#include <lacuna/core/points.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/laws/aperture.hpp>
#include <lacuna/pores/corner_rows.hpp>
#include <lacuna/pores/flow.hpp>
#include <lacuna/pores/flow_parameters.hpp>
#include <lacuna/pores/flow_sums.hpp>
#include <lacuna/pores/flow_time_step.hpp>
#include <lacuna/pores/pore_network.hpp>
#include <lacuna/pores/pore_pass.hpp>
#include <lacuna/pores/throat_pass.hpp>
#include <lacuna/pores/tractions.hpp>

namespace lacuna {

/// The paper's explicit scheme, eq. 14 to 16: all flows from the old pressures, then all pressures.
///
/// A pore's pressure below `minimum_pressure` is held there; the volume that the liquid does not fill is remembered
/// as vapour, which closes before the pressure rises again, so that no mass is made.
///
/// In the coupled step: step(), then write_tractions(). Neither allocates memory; both give the same bits for any
/// number of threads.
template <class Real, int Dim, aperture_law Aperture>
class explicit_flow_solver {
    static_assert(Dim == 2, "explicit_flow: pores exist in the plane only, so far (Dim = 2)");

public:
    using parameters = flow_parameters<Aperture>;
    using network_type = pore_network<Real, Dim>;

    /// Rigid pores: a bare network, whose volumes and apertures stay as given.
    /// \throws std::invalid_argument for parameters out of range.
    explicit_flow_solver(parameters const& p, network_type network)
        : explicit_flow_solver(p, std::move(network), Real(1)) {}

    /// Pores of a body, at its present geometry and the apertures of pairs at zero force that touch.
    /// \param thickness of the body, out of the plane, m; > 0
    /// \param points centres, m; \param radii m: of all particles, here and below
    /// \throws std::invalid_argument for parameters out of range.
    explicit_flow_solver(parameters const& p, network_type network, Real thickness, points_view<Real, Dim> points,
                         Real const* radii)
        : explicit_flow_solver(p, std::move(network), thickness) {
        refresh_geometry(points, radii);
        network_.old_volume = network_.volume;
    }

    network_type const& network() const noexcept { return network_; }
    parameters const& settings() const noexcept { return parameters_; }
    /// Kept by the steps with a ledger.
    flow_ledger<Real> const& ledger() const noexcept { return ledger_; }

    void set_pressure(std::size_t pore, Real pressure) noexcept { network_.pressure[pore] = pressure; }

    /// Goes back to an earlier network() and ledger() of the same body.
    void restore(network_type network, flow_ledger<Real> const& ledger) {
        network_ = std::move(network);
        ledger_ = ledger;
        pores_.set_fillers(network_);
        collect_active();
    }

    /// New pore volumes. The volume change that the next step sees is that since the last one. step() does it itself.
    void refresh_geometry(points_view<Real, Dim> points, Real const* radii) {
        if (network_.bare()) return;
        record_column<Real> place;
        place.resize(points.size());
        for (std::size_t k = 0; k < points.size(); ++k) {
            place.at(k, 0) = points(k, 0);
            place.at(k, 1) = points(k, 1);
            place.at(k, 3) = radii[k];
        }
        // The step's own arithmetic, so that a body at rest has no volume change, not even a rounding.
        auto old_volume = network_.old_volume, pressure = network_.pressure, vapour = network_.vapour;
        for (int c = 0; c < pores_.chunks(); ++c)
            pores_.template advance<true, false>(c, network_, place.data(), constants(), Real(0), false, pore_sums_[0]);
        network_.old_volume = std::move(old_volume);
        network_.pressure = std::move(pressure);
        network_.vapour = std::move(vapour);
    }

    /// Tells each throat where the force of its pair is; to be called whenever the pairs' places in memory change.
    /// \param lookup callable (particle i, particle j) -> where the record of the pair's force begins, in reals from
    ///        the beginning of all; negative where there is no such pair: no force
    template <class Lookup>
    void map_throats(Lookup const& lookup) {
        if (!network_.bare()) throats_.map(network_, lookup);
    }

    /// New apertures of all throats, of those that are skipped as well.
    /// \param place records of the particles, as particle_store has them; here and below
    /// \param pair_forces records of the pairs' forces, at least one; the fourth number is the normal force, N,
    ///        positive in tension; here and below
    void refresh_apertures(record_column<Real> const& place, Real const* pair_forces, int threads = 1) noexcept {
        if (network_.bare()) return;
        for_each_chunk(throats_.chunks(true), threads, [&](int c) {
            throats_.template pass<true, false, Aperture>(c, network_, place.data(), pair_forces,
                                                          parameters_.aperture);
        });
    }

    /// Leaves out, from now on, the throats through which practically nothing passes within `duration` [s]: those
    /// whose own step limit, 2 / (K_f C (1/V_1 + 1/V_2)), is more than `skip_ratio` times as long (they let at most
    /// 2 / skip_ratio of a pressure difference through), and takes up again those that have opened. Call it after
    /// refresh_apertures(), at the start and whenever throats may have opened.
    /// \return how many throats are skipped
    /// \throws std::invalid_argument for a duration that is not positive.
    std::size_t skip_idle_throats(Real duration) {
        require_positive("duration", double(duration));
        for (std::size_t t = 0; t < network_.open_throats(); ++t) {
            auto const other = network_.throat_pore[1][t];
            Real rate = Real(1) / network_.volume[std::size_t(network_.throat_pore[0][t])];
            if (other >= 0) rate += Real(1) / network_.volume[std::size_t(other)];
            double const limit = 2 / (parameters_.bulk_modulus * double(network_.conductance[t]) * double(rate));
            network_.idle[t] = limit <= parameters_.skip_ratio * double(duration) ? 0 : 1;
            if (network_.idle[t]) network_.flow[t] = Real(0);
        }
        collect_active();
        return network_.open_throats() - throats_.active_throats();
    }

    /// One step of dt [s] of a body: new geometry and apertures, eq. 14 for all throats that are not skipped from the
    /// old pressures, eq. 15 for all pores, eq. 16's forces from the new pressures.
    /// \tparam WithLedger also keeps ledger()
    template <bool WithLedger>
    void step(record_column<Real> const& place, Real const* pair_forces, Real dt, int threads = 1) noexcept {
        if (network_.bare())
            advance<WithLedger>(dt, threads);
        else
            take_step<true, WithLedger>(place.data(), pair_forces, dt, threads);
    }
    /// The same with volumes and apertures as they are, and without forces: the step of rigid pores.
    template <bool WithLedger = true>
    void advance(Real dt, int threads = 1) noexcept {
        take_step<false, WithLedger>(nullptr, nullptr, dt, threads);
    }

    /// Writes the forces of the pore pressures, as the last step() left them, for every particle: the record
    /// {F_x, F_y, 0, 0}, N. A pore at its least volume exerts none: it does not change its volume either.
    void write_tractions(record_column<Real>& extra, int threads = 1) const noexcept {
        for_each_chunk(corners_.chunks(), threads, [&](int c) { corners_.write(c, pores_.forces(), extra); });
    }

    /// Forces on the three corners of a pore for 1 Pa in it, N; also of a pore at its least volume.
    std::array<vec<Real, Dim>, 3> pore_tractions(std::size_t pore, points_view<Real, Dim> points,
                                                 Real const* radii) const noexcept {
        return lacuna::pore_tractions(network_, thickness_, pore, points, radii);
    }

    /// Energy stored in the compressed fluid, sum of V p^2 / 2 K_f, J.
    Real storage_energy() const noexcept {
        using lanes = pack<Real, native_width<Real>>;
        lanes total(Real(0));
        for (std::size_t p = 0; p < network_.pores(); p += lanes::width) {
            lanes pressure = lanes::load(network_.pressure.data() + p);
            total += lanes::load(network_.volume.data() + p) * pressure * pressure;
        }
        return sum(total) / Real(2 * parameters_.bulk_modulus);
    }

    /// Largest safe dt of a step, s, as pores/flow_time_step.hpp has it: skipped throats do not count.
    Real critical_time_step() const { return flow_critical_time_step(network_, parameters_.bulk_modulus); }
    /// Eq. 19 as printed, s: not safe where apertures differ. Skipped throats count.
    Real equation_19_time_step() const {
        return lacuna::equation_19_time_step(network_, parameters_.bulk_modulus, parameters_.conductivity);
    }

private:
    explicit_flow_solver(parameters const& p, network_type network, Real thickness)
        : parameters_(p), thickness_(thickness), network_(std::move(network)) {
        parameters_.validate("flow");
        require_positive("thickness", double(thickness));
        std::fill(network_.pressure.begin(), network_.pressure.end(), Real(p.initial_pressure));
        if (!network_.bare()) {
            Real const aperture = Aperture::aperture(p.aperture, Real(0), Real(0));
            std::fill(network_.aperture.begin(), network_.aperture.end(), aperture);
        }
        for (std::size_t t = 0; t < network_.open_throats(); ++t) {
            Real const a = network_.aperture[t];
            network_.conductance[t] = Real(p.conductivity) * (a * a * a / network_.length[t]);
        }
        pores_.build(network_, Real(p.minimum_volume_fraction) * thickness);
        throats_.build(network_, Real(p.conductivity));
        pore_sums_.resize(std::size_t(std::max(pores_.chunks(), 1)));
        throat_sums_.resize(std::size_t(throats_.chunks(true)));
        std::size_t const particles = network_.particle_throats.first.size() - 1;
        corners_.build(
            particles, [&](auto const& visit) { pores_.for_each_corner(network_, visit); }, pores_.zero_offset());
    }

    pore_constants<Real> constants() const noexcept {
        return {Real(parameters_.bulk_modulus), thickness_, Real(parameters_.minimum_pressure)};
    }
    void collect_active() { throats_.collect_active(network_); }

    template <bool Moves, bool WithLedger>
    void take_step(Real const* place, Real const* pair_forces, Real dt, int threads) noexcept {
        bool const flows = throats_.active_throats() > 0;
        if (flows)
            for_each_chunk(throats_.chunks(false), threads, [&](int c) {
                throats_.template pass<Moves, true, Aperture>(c, network_, place, pair_forces, parameters_.aperture);
            });
        for_each_chunk(pores_.chunks(), threads, [&](int c) {
            pores_.template advance<Moves, WithLedger>(c, network_, place, constants(), dt, flows,
                                                       pore_sums_[std::size_t(c)]);
        });
        if constexpr (WithLedger) keep_ledger(dt, threads);
    }

    /// Adds up what the chunks report, in their order.
    void keep_ledger(Real dt, int threads) noexcept {
        int const chunks = throats_.chunks(false);
        for_each_chunk(chunks, threads, [&](int c) {
            throats_.add_up(c, network_, pores_.pressure_before(), dt, throat_sums_[std::size_t(c)]);
        });
        throat_sums<Real> throats;
        for (int c = 0; c < chunks; ++c) throats += throat_sums_[std::size_t(c)];
        pore_sums<Real> pores;
        for (int c = 0; c < pores_.chunks(); ++c) pores += pore_sums_[std::size_t(c)];
        book(ledger_, pores, throats);
    }

    parameters parameters_;
    Real thickness_;
    network_type network_;
    flow_ledger<Real> ledger_;
    pore_table<Real> pores_;
    throat_table<Real> throats_;
    corner_rows<Real> corners_;
    std::vector<pore_sums<Real>> pore_sums_;
    std::vector<throat_sums<Real>> throat_sums_;
};

/// Flow policy: explicit_flow_solver with an aperture law of one's choice.
template <aperture_law Aperture>
struct explicit_flow_with {
    using parameters = flow_parameters<Aperture>;
    template <class Real, int Dim>
    using solver = explicit_flow_solver<Real, Dim, Aperture>;
};

/// Flow policy: the paper's explicit scheme with the aperture from the contact force.
using explicit_flow = explicit_flow_with<contact_force_aperture>;

} // namespace lacuna
